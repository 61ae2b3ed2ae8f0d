// The one file that knows Boost.Beast. Everything here runs on the thread of Server::run(), but for
// stop() and Impl::wake().
#include "sinew/server/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <vector>

#include "sinew/base/error.h"
#include "sinew/server/viewer.h"

namespace sinew {
extern const char page_html[];  // embedded: web/dist/index.html
}  // namespace sinew

namespace sinew::server {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using tcp = net::ip::tcp;
using Failure = beast::error_code;

constexpr std::chrono::seconds http_timeout(10);
constexpr unsigned most_header_bytes = 8192;
constexpr int most_faults = 20;  // malformed messages before a socket is closed

// The page is one file that fetches nothing and talks to nobody but this server.
constexpr const char* content_policy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src 'self' data: blob:; media-src blob:; connect-src 'self'; worker-src blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

std::string_view view(beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

class Socket;

// What all connections share.
class Hub {
 public:
  explicit Hub(const Options& options) : door{options.host, options.port, options.token} {}

  void join(Socket* socket);
  void leave(Socket* socket);
  void take_controls(Socket* socket);
  bool controls(const Socket* socket) const { return socket == controller_; }
  void tell_roles();
  void pump();
  void close_all();

  Door door;
  int connections = 0;
  std::unique_ptr<live::Runner> runner;  // null: the server is being taken down

 private:
  std::vector<Socket*> sockets_;
  Socket* controller_ = nullptr;
};

// One count of a connection, for as long as it lives.
class Place {
 public:
  explicit Place(Hub& hub) : hub_(&hub) { ++hub.connections; }
  Place(Place&& other) noexcept : hub_(std::exchange(other.hub_, nullptr)) {}
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;
  Place& operator=(Place&&) = delete;
  ~Place() {
    if (hub_ != nullptr) --hub_->connections;
  }

 private:
  Hub* hub_;
};

// A browser at the other end of a WebSocket.
class Socket : public std::enable_shared_from_this<Socket> {
 public:
  Socket(Hub& hub, Place place, beast::tcp_stream&& stream)
      : hub_(hub), place_(std::move(place)), stream_(std::move(stream)), viewer_(SINEW_VERSION) {}
  ~Socket() { hub_.leave(this); }

  void start(const http::request<http::empty_body>& request) {
    beast::get_lowest_layer(stream_).expires_never();
    beast::get_lowest_layer(stream_).socket().set_option(tcp::no_delay(true));
    websocket::stream_base::timeout timeout =
        websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.handshake_timeout = std::chrono::seconds(5);  // also of goodbyes
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

  Viewer& viewer() { return viewer_; }

  // Sends what is next, unless something is still being sent.
  void pump() {
    if (!open_ || writing_) return;
    std::optional<Outgoing> next = viewer_.next(hub_.runner->snapshot());
    if (!next) return;
    writing_ = true;
    outgoing_ = std::move(*next);
    stream_.binary(outgoing_.binary);
    stream_.async_write(net::buffer(outgoing_.bytes),
                        [self = shared_from_this()](Failure failure, std::size_t) {
                          self->writing_ = false;
                          if (failure) return self->drop();
                          if (self->closing_) return self->say_goodbye();
                          self->pump();
                        });
  }

  void close(websocket::close_code why) {
    if (!open_ || closing_) return;
    closing_ = true;
    why_ = why;
    if (!writing_) say_goodbye();
  }

 private:
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
      Request request = parse_request(text);
      if (const auto* seen = std::get_if<Seen>(&request)) {
        viewer_.seen(seen->frame);
      } else if (std::holds_alternative<TakeControls>(request)) {
        hub_.take_controls(this);
      } else if (!hub_.controls(this)) {
        viewer_.note(error_text("another browser has the controls"));
      } else if (!hub_.runner->post(std::get<live::Command>(std::move(request)))) {
        viewer_.note(error_text("the simulation is busy: the command was dropped"));
      }
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

void Hub::join(Socket* socket) {
  sockets_.push_back(socket);
  if (controller_ == nullptr) controller_ = socket;
  tell_roles();
}

void Hub::leave(Socket* socket) {
  if (std::erase(sockets_, socket) == 0 || !runner) return;
  if (controller_ == socket) {
    for (int hand = 0; hand < live::most_hands; ++hand) runner->post(live::Release{hand});
    controller_ = sockets_.empty() ? nullptr : sockets_.front();
  }
  tell_roles();
}

void Hub::take_controls(Socket* socket) {
  controller_ = socket;
  tell_roles();
}

void Hub::tell_roles() {
  for (Socket* s : sockets_) {
    s->viewer().note(role_text(s == controller_, static_cast<int>(sockets_.size())));
    s->pump();
  }
}

void Hub::pump() {
  for (Socket* s : sockets_) s->pump();
}

void Hub::close_all() {
  for (Socket* s : sockets_) s->close(websocket::close_code::going_away);
}

namespace {

// A connection that has not (yet) become a WebSocket.
class Visitor : public std::enable_shared_from_this<Visitor> {
 public:
  Visitor(Hub& hub, tcp::socket socket) : hub_(hub), place_(hub), stream_(std::move(socket)) {}

  void read() {
    parser_.emplace();
    parser_->header_limit(most_header_bytes);
    parser_->body_limit(0);
    stream_.expires_after(http_timeout);
    http::async_read(stream_, buffer_, *parser_,
                     [self = shared_from_this()](Failure failure, std::size_t) {
                       if (!failure) self->answer();
                     });
  }

 private:
  void answer() {
    const auto request = parser_->release();
    const std::string_view target = view(request.target());
    const std::string_view host = view(request[http::field::host]);
    const std::string_view path = path_of(target);
    keep_alive_ = request.keep_alive();
    head_ = request.method() == http::verb::head;
    if (!host_allowed(hub_.door, host)) {
      return send(http::status::forbidden, "text/plain", "this name does not lead here\n");
    }
    if (!token_allowed(hub_.door, target)) {
      return send(http::status::forbidden, "text/plain",
                  "open the address that sinew view printed, with its token\n");
    }
    if (websocket::is_upgrade(request)) {
      if (buffer_.size() > 0) {  // it would be lost: nobody speaks before the handshake is done
        keep_alive_ = false;
        return send(http::status::bad_request, "text/plain", "wait for the handshake\n");
      }
      if (path != "/live" || !origin_allowed(view(request[http::field::origin]), host)) {
        return send(http::status::forbidden, "text/plain", "no socket for this page\n");
      }
      std::make_shared<Socket>(hub_, std::move(place_), std::move(stream_))->start(request);
      return;
    }
    if (request.method() != http::verb::get && !head_) {
      return send(http::status::method_not_allowed, "text/plain", "only GET\n");
    }
    if (path == "/") return send(http::status::ok, "text/html; charset=utf-8", page_html);
    if (path == "/scene.toml") {
      return send(http::status::ok, "text/plain; charset=utf-8",
                  hub_.runner->snapshot().parameters->document);
    }
    send(http::status::not_found, "text/plain", "nothing here\n");
  }

  void send(http::status status, const char* type, std::string body) {
    response_.emplace(status, 11);
    response_->set(http::field::content_type, type);
    response_->set(http::field::cache_control, "no-store");
    response_->set("Content-Security-Policy", content_policy);
    response_->set("X-Content-Type-Options", "nosniff");
    response_->set("X-Frame-Options", "DENY");
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
  std::optional<http::response<http::string_body>> response_;
  bool keep_alive_ = false, head_ = false;
};

}  // namespace

class Server::Impl {
 public:
  Impl(const Options& options, const Scene& scene)
      : most_connections_(options.most_connections),
        hub_(options),
        acceptor_(io_),
        retry_(io_),
        goodbye_(io_) {
    listen(options);
    hub_.door.port = acceptor_.local_endpoint().port();
    hub_.runner = std::make_unique<live::Runner>(scene, [this] { wake(); });
    accept();
  }
  // The simulation's thread ends first, while what it wakes is there.
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
  // What has not said goodbye after half a second is cut off.
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
      if (failure) {  // such as no file handles left: not to be asked again at once
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
  Hub hub_;  // goes after io_, whose handlers hold the sockets that leave it
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
