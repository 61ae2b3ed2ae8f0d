#include "sinew/server/network_device.h"

#include <fmt/format.h>

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "sinew/base/error.h"
#include "sinew/haptics/triple_buffer.h"
#include "sinew/server/guard.h"

namespace sinew::server {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
namespace net = boost::asio;
namespace websocket = beast::websocket;
using tcp = net::ip::tcp;

constexpr std::size_t most_bytes = 4096;

[[noreturn]] void not_an_input(const std::string& what) {
  throw Error(ErrorKind::input, what,
              R"(send {"position": [x, y, z], "rotation": [w, x, y, z], "button": false})");
}

template <std::size_t N>
std::array<double, N> numbers(const nlohmann::json& values, const char* key) {
  constexpr double farthest = 1e3;  // [m]
  std::array<double, N> out{};
  if (!values.is_array() || values.size() != N)
    not_an_input(fmt::format("{} needs {} numbers", key, N));
  for (std::size_t i = 0; i < N; ++i) {
    if (!values[i].is_number()) not_an_input(fmt::format("{}[{}] is not a number", key, i));
    out[i] = values[i].get<double>();
    if (!(std::abs(out[i]) <= farthest))
      not_an_input(fmt::format("{}[{}] is beyond {:g}", key, i, farthest));
  }
  return out;
}

}  // namespace

HapticInput read_haptic_input(const std::string& message) {
  const nlohmann::json in = nlohmann::json::parse(message, nullptr, false);
  if (!in.is_object()) not_an_input("the message is not a JSON object");
  HapticInput out;
  if (!in.contains("position")) not_an_input("the message has no position");
  out.position = numbers<3>(in["position"], "position");
  if (in.contains("rotation")) {
    out.rotation = numbers<4>(in["rotation"], "rotation");
    double square = 0.0;
    for (const double q : out.rotation) square += q * q;
    if (square < 1e-12) not_an_input("the rotation has no length");
  }
  if (in.contains("button")) {
    if (!in["button"].is_boolean()) not_an_input("button is neither true nor false");
    out.button = in["button"].get<bool>();
  }
  return out;
}

// One thread, asynchronous: accepts, reads a message, answers, and so on.
struct NetworkDevice::Inside {
  struct Link {
    explicit Link(tcp::socket&& socket) : stream(std::move(socket)) {}
    websocket::stream<beast::tcp_stream> stream;
    beast::flat_buffer read, request_bytes;
    http::request<http::empty_body> request;
    std::string answer;
  };

  explicit Inside(unsigned short port) try
      : acceptor(context, {net::ip::make_address("127.0.0.1"), port}) {
    accept();
    thread = std::thread([this] { context.run(); });
  } catch (const boost::system::system_error& error) {
    throw Error(ErrorKind::io,
                fmt::format("port {} cannot be listened on: {}", port, error.code().message()),
                "choose another port; 0 takes a free one");
  }
  ~Inside() {
    context.stop();
    thread.join();
  }

  void accept() {
    acceptor.async_accept([this](beast::error_code failure, tcp::socket socket) {
      if (failure) return;
      if (!link) greet(std::make_shared<Link>(std::move(socket)));  // else: turned away
      accept();
    });
  }

  void greet(std::shared_ptr<Link> next) {
    beast::get_lowest_layer(next->stream).expires_after(std::chrono::seconds(5));
    Link& l = *next;
    http::async_read(
        beast::get_lowest_layer(l.stream), l.request_bytes, l.request,
        [this, next](beast::error_code failure, std::size_t) {
          // A page of another site may not move the tool.
          const std::string origin(next->request[http::field::origin]);
          const std::string host(next->request[http::field::host]);
          const Door door{"127.0.0.1", acceptor.local_endpoint().port(), {}};
          if (failure || link || !websocket::is_upgrade(next->request) ||
              !origin_allowed(origin, host) || !host_allowed(door, host))
            return;
          link = next;
          beast::get_lowest_layer(next->stream).expires_never();
          beast::get_lowest_layer(next->stream).socket().set_option(tcp::no_delay(true));
          next->stream.set_option(
              websocket::stream_base::timeout::suggested(beast::role_type::server));
          next->stream.read_message_max(most_bytes);
          next->stream.async_accept(next->request, [this, next](beast::error_code fault) {
            if (fault) return leave();
            connected = true;
            read(next);
          });
        });
  }

  void read(const std::shared_ptr<Link>& from) {
    from->stream.async_read(from->read, [this, from](beast::error_code failure, std::size_t) {
      if (failure) return leave();
      const std::string message = beast::buffers_to_string(from->read.data());
      from->read.clear();
      try {
        inputs.write(read_haptic_input(message));
        forces.update();
        const Wrench& w = forces.value();
        from->answer = nlohmann::json{{"force", w.force}, {"torque", w.torque}}.dump();
      } catch (const Error& error) {
        from->answer = nlohmann::json{{"error", error.message()}}.dump();
      }
      from->stream.text(true);
      from->stream.async_write(net::buffer(from->answer),
                               [this, from](beast::error_code fault, std::size_t) {
                                 if (fault) return leave();
                                 read(from);
                               });
    });
  }

  void leave() {
    connected = false;
    link.reset();
  }

  net::io_context context{1};
  tcp::acceptor acceptor;
  std::shared_ptr<Link> link;
  TripleBuffer<HapticInput> inputs;  // from the network to the loop
  TripleBuffer<Wrench> forces;       // and back
  std::atomic<bool> connected{false};
  std::thread thread;
};

NetworkDevice::NetworkDevice(unsigned short port) : inside_(std::make_unique<Inside>(port)) {}
NetworkDevice::~NetworkDevice() = default;

unsigned short NetworkDevice::port() const {
  return inside_->acceptor.local_endpoint().port();
}
bool NetworkDevice::connected() const {
  return inside_->connected;
}
HapticInput NetworkDevice::read(double) {
  inside_->inputs.update();
  return inside_->inputs.value();
}
void NetworkDevice::write(const Wrench& wrench) {
  inside_->forces.write(wrench);
}

}  // namespace sinew::server
