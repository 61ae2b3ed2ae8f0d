#include "sinew/server/socket.h"

#include <sinew/version.h>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <optional>

#include "sinew/base/error.h"

namespace sinew::server {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using tcp = net::ip::tcp;
using Failure = beast::error_code;

constexpr int most_faults = 20;  // malformed messages before a socket is closed

class BeastSocket final : public Socket, public std::enable_shared_from_this<BeastSocket> {
 public:
  BeastSocket(Hub& hub, Place place, beast::tcp_stream&& stream)
      : hub_(hub),
        place_(std::move(place)),
        stream_(std::move(stream)),
        viewer_(version(), hub.gallery) {}
  ~BeastSocket() override { hub_.leave(this); }

  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true));
    websocket::stream_base::timeout timeout =
        websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = std::chrono::seconds(5);  // also for closing
    timeout.idle_timeout = std::chrono::seconds(30);
    timeout.keep_alive_pings = true;
    stream_.set_option(timeout);
    websocket::permessage_deflate plain;
    plain.server_enable = false;
    stream_.set_option(plain);
    stream_.auto_fragment(false);
    stream_.write_buffer_bytes(65536);
    stream_.read_message_max(most_message_bytes);
    stream_.async_accept(request, [self = shared_from_this()](Failure failure) {
      if (failure) return;
      self->open_ = true;
      self->hub_.join(self.get());
      self->read();
    });
  }

  Viewer& viewer() override { return viewer_; }

  void pump() override {
    if (!open_ || writing_) return;
    std::optional<Outgoing> next = viewer_.next(hub_.runner->snapshot());
    if (!next) return;
    writing_ = true;
    outgoing_ = std::move(*next);
    if (!outgoing_.binary) hub_.library.leave_out_folder(outgoing_.bytes);
    stream_.binary(outgoing_.binary);
    stream_.async_write(net::buffer(outgoing_.bytes),
                        [self = shared_from_this()](Failure failure, std::size_t) {
                          self->writing_ = false;
                          if (failure) return self->drop();
                          if (self->closing_) return self->say_goodbye();
                          self->pump();
                        });
  }

  void go_away() override { close(websocket::close_code::going_away); }

 private:
  void close(websocket::close_code why) {
    if (!open_ || closing_) return;
    closing_ = true;
    why_ = why;
    if (!writing_) say_goodbye();
  }

  void drop() {
    open_ = false;
    beast::get_lowest_layer(stream_).close();
  }

  void say_goodbye() {
    open_ = false;
    stream_.async_close(why_, [self = shared_from_this()](Failure) {});
  }

  void read() {
    stream_.async_read(incoming_, [self = shared_from_this()](Failure failure, std::size_t) {
      if (failure) {
        self->open_ = false;
        self->hub_.leave(self.get());
        return;
      }
      if (!self->viewer_.may_speak(std::chrono::steady_clock::now())) {
        self->close(websocket::close_code::policy_error);
      } else if (!self->closing_) {
        self->hear(beast::buffers_to_string(self->incoming_.data()));
      }
      self->incoming_.consume(self->incoming_.size());
      self->pump();
      self->read();
    });
  }

  void hear(const std::string& text) {
    try {
      hub_.hear(this, text);
    } catch (const Error& e) {
      viewer_.note(error_text(e.message()));
      if (++faults_ >= most_faults) close(websocket::close_code::policy_error);
    }
  }

  Hub& hub_;
  Place place_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer incoming_;
  Outgoing outgoing_;
  Viewer viewer_;
  bool open_ = false, writing_ = false, closing_ = false;
  websocket::close_code why_ = websocket::close_code::normal;
  int faults_ = 0;
};

}  // namespace

void open_socket(Hub& hub, Place place, beast::tcp_stream&& stream,
                 const http::request<http::empty_body>& request) {
  std::make_shared<BeastSocket>(hub, std::move(place), std::move(stream))->start(request);
}

}  // namespace sinew::server
