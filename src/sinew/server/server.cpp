// HTTP by Boost.Beast, which only this file and socket.cpp include. Everything here runs on the
// thread of Server::run(), except stop() and Impl::wake().
#include "sinew/server/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cstdlib>
#include <limits>

#include "sinew/base/error.h"
#include "sinew/io/file_io.h"
#include "sinew/server/hub.h"
#include "sinew/server/socket.h"

namespace sinew {
extern const char page_html[];  // embedded: web/dist/index.html
}  // namespace sinew

namespace sinew::server {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
using tcp = net::ip::tcp;
using Failure = beast::error_code;

constexpr std::chrono::seconds http_timeout(10);
constexpr unsigned most_header_bytes = 8192;
constexpr std::chrono::seconds upload_timeout(120);
constexpr int most_uploads = 2;  // at a time

// The page is one file that downloads nothing and connects to this server only.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src 'self' data: blob:; media-src blob:; connect-src 'self'; worker-src blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors ";
constexpr const char* frames_of_this_machine =
    "http://localhost:* http://127.0.0.1:* https://localhost:* https://127.0.0.1:* vscode-webview:";

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

bool wants_socket(const http::request<http::empty_body>& request) {
  return request.method() == http::verb::get &&
         http::token_list{request[http::field::connection]}.exists("upgrade") &&
         beast::iequals(request[http::field::upgrade], "websocket");
}

// The page. For development, the file that SINEW_PAGE names is read again each time.
std::string the_page() {
  const char* other = std::getenv("SINEW_PAGE");
  return other == nullptr ? page_html : io::read_file(other);
}

// A connection that is not (yet) a WebSocket.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Hub& hub, tcp::socket socket) : hub_(hub), place_(hub), stream_(std::move(socket)) {}
  ~Visitor() { end_upload(); }
  Visitor(const Visitor&) = delete;
  Visitor& operator=(const Visitor&) = delete;

  void read() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    parser_->body_limit(std::numeric_limits<std::uint64_t>::max());  // none is read by this one
    stream_.expires_after(http_timeout);
    http::async_read_header(stream_, buffer_, *parser_,
                            [self = shared_from_this()](Failure failure, std::size_t) {
                              if (!failure) self->answer();
                            });
  }

 private:
  void answer() {
    const auto& request = parser_->get();
    const std::string_view target = view(request.target());
    const std::string_view host = view(request[http::field::host]);
    const std::string_view path = path_of(target);
    keep_alive_ = request.keep_alive();
    head_ = request.method() == http::verb::head;
    if (!host_allowed(hub_.door, host)) {
      return refuse(http::status::forbidden, "this name does not lead here");
    }
    if (!token_allowed(hub_.door, target)) {
      return refuse(http::status::forbidden,
                    "open the address that sinew view printed, with its token");
    }
    if (request.method() == http::verb::post && path == "/files") return receive(target, host);
    if (!parser_->is_done()) return refuse(http::status::bad_request, "no body is expected here");
    if (wants_socket(request)) return upgrade(path, host);
    if (request.method() != http::verb::get && !head_) {
      return refuse(http::status::method_not_allowed, "only GET");
    }
    try {
      serve(path);
    } catch (const Error& e) {
      refuse(http::status::internal_server_error, e.message());
    }
  }

  void upgrade(std::string_view path, std::string_view host) {
    const auto& request = parser_->get();
    if (buffer_.size() > 0) {  // it would be lost: no messages before the end of the handshake
      return refuse(http::status::bad_request, "wait for the handshake");
    }
    if (path != "/live" || !origin_allowed(view(request[http::field::origin]), host)) {
      return refuse(http::status::forbidden, "no socket for this page");
    }
    open_socket(hub_, std::move(place_), std::move(stream_), parser_->release());
  }

  void serve(std::string_view path) {
    if (path == "/") return send(http::status::ok, "text/html; charset=utf-8", the_page());
    if (path == "/scene.toml") {
      return send(http::status::ok, "text/plain; charset=utf-8",
                  hub_.runner->snapshot().parameters->document);
    }
    if (path == "/gallery.json") {
      return send(http::status::ok, "application/json", hub_.library.gallery());
    }
    if (path == "/state.vtu") return send_state();
    if (auto picture = hub_.library.picture(path)) {
      return send(http::status::ok, "image/jpeg", std::move(*picture));
    }
    send(http::status::not_found, "text/plain", "nothing here\n");
  }

  // The simulation's thread creates the file; this one sends it and then owns the connection.
  void send_state() {
    const auto executor = stream_.get_executor();
    const bool posted = hub_.runner->post(
        live::SaveState{[self = shared_from_this(), executor](std::string bytes) mutable {
          net::post(executor, [self = std::move(self), bytes = std::move(bytes)]() mutable {
            self->send(http::status::ok, "application/octet-stream", std::move(bytes));
          });
        }});
    if (!posted) refuse(http::status::service_unavailable, "the simulation is busy");
  }

  // A file for the library, from the viewer that has the controls.
  void receive(std::string_view target, std::string_view host) {
    if (!origin_allowed(view(parser_->get()[http::field::origin]), host) ||
        !hub_.has_ticket(target)) {
      return refuse(http::status::forbidden, "only the viewer with the controls may give files");
    }
    if (hub_.uploads == most_uploads) {
      return refuse(http::status::service_unavailable, "other files are being read: try again");
    }
    const auto length = parser_->content_length();
    if (!length || *length > Library::most_file_bytes) {
      return refuse(http::status::payload_too_large, "a file of at most 64 MiB, its length named");
    }
    uploading_ = true;
    ++hub_.uploads;
    name_ = query_value(target, "name");
    body_.emplace(std::move(*parser_));
    body_->body_limit(Library::most_file_bytes);
    stream_.expires_after(upload_timeout);
    http::async_read(stream_, buffer_, *body_,
                     [self = shared_from_this()](Failure failure, std::size_t) {
                       if (!failure) self->keep();
                     });
  }

  void keep() {
    const std::string bytes = std::move(body_->get().body());
    body_.reset();
    end_upload();
    try {
      hub_.library.keep(name_, bytes);
      send(http::status::ok, "text/plain", "kept\n");
    } catch (const Error& e) {
      refuse(http::status::bad_request, std::string(e.message()) + "; " + e.remedy());
    }
  }

  void end_upload() {
    if (uploading_) --hub_.uploads;
    uploading_ = false;
  }

  // Closes the connection afterwards: a body may follow that is not read.
  void refuse(http::status status, const std::string& why) {
    keep_alive_ = false;
    send(status, "text/plain; charset=utf-8", why + "\n");
  }

  void send(http::status status, const char* type, std::string body) {
    response_.emplace(status, 11);
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    response_->set("Content-Security-Policy",
                   content_policy + std::string(hub_.framed ? frames_of_this_machine : "'none'"));
    response_->set("X-Content-Type-Options", "nosniff");
    if (!hub_.framed) response_->set("X-Frame-Options", "DENY");
    response_->set("Referrer-Policy", "no-referrer");
    response_->set("Cross-Origin-Resource-Policy", "same-origin");
    response_->keep_alive(keep_alive_);
    response_->content_length(body.size());
    if (!head_) response_->body() = std::move(body);
    stream_.expires_after(http_timeout);
    http::async_write(stream_, *response_,
                      [self = shared_from_this()](Failure failure, std::size_t) {
                        if (failure) return;
                        if (self->keep_alive_) return self->read();
                        Failure ignored;
                        self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
                      });
  }

  Hub& hub_;
  Place place_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  std::optional<http::request_parser<http::empty_body>> parser_;
  std::optional<http::request_parser<http::string_body>> body_;
  std::string name_;  // of the file that is being received
  std::optional<http::response<http::string_body>> response_;
  bool keep_alive_ = false, head_ = false, uploading_ = false;
};

}  // namespace

class Server::Impl {
 public:
  Impl(const Options& options, const Scene& scene)
      : most_connections_(options.most_connections),
        hub_({options.host, options.port, options.token}, options.scenes, options.gallery),
        acceptor_(io_),
        retry_(io_),
        goodbye_(io_) {
    listen(options);
    hub_.door.port = acceptor_.local_endpoint().port();
    hub_.framed = options.framed;
    hub_.runner = std::make_unique<live::Runner>(
        scene, [this] { wake(); }, options.state);
    accept();
  }
  // The simulation's thread ends first, while the object that it wakes exists.
  ~Impl() { hub_.runner.reset(); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void run() { io_.run(); }

  void stop() {
    net::post(io_, [this] {
      Failure ignored;
      acceptor_.close(ignored);
      retry_.cancel();
      hub_.close_all();
      wait_for_goodbyes(25);
    });
  }

  // Called by the simulation after every frame; one call waits at most, however slow the sockets.
  void wake() {
    if (woken_.exchange(true)) return;
    net::post(io_, [this] {
      woken_ = false;
      hub_.pump();
    });
  }

  Hub& hub() { return hub_; }

 private:
  // Connections that are not closed after half a second are cut off.
  void wait_for_goodbyes(int looks) {
    if (hub_.connections == 0 || looks == 0) return io_.stop();
    goodbye_.expires_after(std::chrono::milliseconds(20));
    goodbye_.async_wait([this, looks](Failure) { wait_for_goodbyes(looks - 1); });
  }

  void listen(const Options& options) {
    Failure failure;
    const net::ip::address address =
        net::ip::make_address(options.host == "localhost" ? "127.0.0.1" : options.host, failure);
    if (failure) {
      throw Error(ErrorKind::usage, fmt::format("'{}' is no address", options.host),
                  "an IP address of this machine, or 0.0.0.0 for all of them");
    }
    const tcp::endpoint endpoint(address, options.port);
    acceptor_.open(endpoint.protocol(), failure);
    if (!failure) acceptor_.set_option(net::socket_base::reuse_address(true), failure);
    if (!failure) acceptor_.bind(endpoint, failure);
    if (!failure) acceptor_.listen(net::socket_base::max_listen_connections, failure);
    if (failure) {
      throw Error(
          ErrorKind::io,
          fmt::format("cannot listen at {}:{}: {}", options.host, options.port, failure.message()),
          "another --port, or --port 0 for any that is free");
    }
  }

  void accept() {
    acceptor_.async_accept([this](Failure failure, tcp::socket socket) {
      if (failure == net::error::operation_aborted || !acceptor_.is_open()) return;
      if (failure) {  // for example no file handles left: not to be retried at once
        retry_.expires_after(std::chrono::milliseconds(100));
        retry_.async_wait([this](Failure cancelled) {
          if (!cancelled) accept();
        });
        return;
      }
      if (hub_.connections < most_connections_) {
        std::make_shared<Visitor>(hub_, std::move(socket))->read();
      }
      accept();
    });
  }

  int most_connections_;
  std::atomic<bool> woken_{false};
  Hub hub_;  // destroyed after io_, whose handlers hold the sockets that leave it
  net::io_context io_{1};
  tcp::acceptor acceptor_;
  net::steady_timer retry_;
  net::steady_timer goodbye_;
};

Server::Server(const Options& options, const Scene& scene)
    : impl_(std::make_unique<Impl>(options, scene)) {}
Server::~Server() = default;

void Server::run() {
  impl_->run();
}

void Server::stop() {
  impl_->stop();
}

unsigned short Server::port() const {
  return impl_->hub().door.port;
}

std::string Server::url() const {
  const Door& door = impl_->hub().door;
  const bool all = door.host == "0.0.0.0" || door.host == "::";
  const std::string name = all                                        ? "localhost"
                           : door.host.find(':') != std::string::npos ? "[" + door.host + "]"
                                                                      : door.host;
  return fmt::format("http://{}:{}/{}", name, door.port,
                     door.token.empty() ? "" : "?token=" + door.token);
}

live::Runner& Server::runner() {
  return *impl_->hub().runner;
}

}  // namespace sinew::server
