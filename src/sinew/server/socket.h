// Turns a request for a WebSocket into a viewer of the live simulation.
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "sinew/server/hub.h"

namespace sinew::server {

// Answers the handshake; the socket lives until either side closes it. `hub` must outlive it.
void open_socket(Hub& hub, Place place, boost::beast::tcp_stream&& stream,
                 const boost::beast::http::request<boost::beast::http::empty_body>& request);

}  // namespace sinew::server
