// A plain HTTP and WebSocket client on a socket: no library, so that it can also say what none
// would.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <utility>

namespace sinew::test {

class Client {
 public:
  explicit Client(unsigned short port) : port_(port), socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ = ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }
  ~Client() { close(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void close() {
    if (socket_ >= 0) ::close(socket_);
    socket_ = -1;
  }
  bool connected() const { return connected_; }

  bool send(const std::string& bytes) {
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) ==
           static_cast<ssize_t>(bytes.size());
  }

  // Reads until `end` is in what came, or the peer closes.
  std::string read_until(const std::string& end) {
    while (buffer_.find(end) == std::string::npos && fill()) {
    }
    const std::size_t at = buffer_.find(end);
    return take(at == std::string::npos ? buffer_.size() : at + end.size());
  }
  std::string read_all() {
    while (fill()) {
    }
    return take(buffer_.size());
  }

  // The answer's head and body.
  std::string get(const std::string& target, const std::string& host = "",
                  const std::string& more = "") {
    send("GET " + target + " HTTP/1.1\r\nHost: " + (host.empty() ? own_host() : host) + "\r\n" +
         more + "Connection: close\r\n\r\n");
    return read_all();
  }

  std::string own_host() const { return "127.0.0.1:" + std::to_string(port_); }

  // The status line of the answer to a handshake.
  std::string shake(const std::string& target = "/live", const std::string& more = "",
                    const std::string& host = "") {
    send("GET " + target + " HTTP/1.1\r\nHost: " + (host.empty() ? own_host() : host) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
         "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
         more + "\r\n");
    const std::string head = read_until("\r\n\r\n");
    return head.substr(0, head.find('\r'));
  }

  // One frame to the server, masked as a client's have to be.
  bool say(const std::string& text, unsigned char opcode = 1, bool masked = true) {
    std::string frame(1, static_cast<char>(0x80 | opcode));
    const unsigned char bit = masked ? 0x80 : 0;
    if (text.size() < 126) {
      frame += static_cast<char>(bit | text.size());
    } else if (text.size() < 65536) {
      frame += static_cast<char>(bit | 126);
      for (int s = 8; s >= 0; s -= 8) frame += static_cast<char>((text.size() >> s) & 0xff);
    } else {
      frame += static_cast<char>(bit | 127);
      for (int s = 56; s >= 0; s -= 8) frame += static_cast<char>((text.size() >> s) & 0xff);
    }
    const char mask[4] = {1, 2, 3, 4};
    if (masked) frame.append(mask, 4);
    for (std::size_t i = 0; i < text.size(); ++i) {
      frame += static_cast<char>(masked ? text[i] ^ mask[i % 4] : text[i]);
    }
    return send(frame);
  }

  struct Message {
    int opcode = 0;  // 1 text, 2 binary, 8 close, 9 ping
    std::string payload;
  };
  // The next message; nothing where the peer has closed.
  std::optional<Message> hear() {
    if (!need(2)) return std::nullopt;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(buffer_[i]); };
    std::uint64_t size = byte(1) & 0x7f;
    std::size_t head = 2;
    if (size >= 126) {
      const std::size_t more = size == 126 ? 2 : 8;
      if (!need(2 + more)) return std::nullopt;
      size = 0;
      for (std::size_t i = 0; i < more; ++i) size = size << 8 | byte(2 + i);
      head += more;
    }
    Message m;
    m.opcode = byte(0) & 0x0f;
    if (!need(head + size)) return std::nullopt;
    m.payload = take(head + size).substr(head);
    return m;
  }

  // Whether the peer says goodbye, or hangs up, after whatever else it says.
  bool is_closed() {
    while (const auto m = hear()) {
      if (m->opcode == 8) return true;
    }
    return !timed_out_;
  }

  // The next text that holds `part`, whatever else comes before; frames are said to be seen.
  std::optional<std::string> hear_text(const std::string& part) {
    while (const auto m = hear()) {
      if (m->opcode == 8) return std::nullopt;
      if (m->opcode == 1 && m->payload.find(part) != std::string::npos) return m->payload;
      acknowledge(*m);
    }
    return std::nullopt;
  }
  // The next binary message of this kind (1 topology, 2 frame).
  std::optional<std::string> hear_binary(int kind) {
    while (const auto m = hear()) {
      acknowledge(*m);
      if (m->opcode == 2 && m->payload.size() >= 40 && m->payload[6] == kind) return m->payload;
    }
    return std::nullopt;
  }
  void acknowledge(const Message& m) {
    if (m.opcode != 2 || m.payload.size() < 40 || m.payload[6] != 2) return;
    std::uint64_t number = 0;
    std::memcpy(&number, m.payload.data() + 16, 8);
    say(R"({"type":"seen","frame":)" + std::to_string(number) + "}");
  }

 private:
  // More bytes within 20 s.
  bool fill() {
    pollfd waiting{socket_, POLLIN, 0};
    timed_out_ = socket_ < 0 || ::poll(&waiting, 1, 20000) <= 0;
    if (timed_out_) return false;
    char bytes[65536];
    const ssize_t got = ::recv(socket_, bytes, sizeof bytes, 0);
    if (got <= 0) return false;
    buffer_.append(bytes, static_cast<std::size_t>(got));
    return true;
  }
  bool need(std::size_t count) {
    while (buffer_.size() < count) {
      if (!fill()) return false;
    }
    return true;
  }
  std::string take(std::size_t count) {
    std::string out = buffer_.substr(0, count);
    buffer_.erase(0, count);
    return out;
  }

  unsigned short port_;
  int socket_;
  bool connected_ = false, timed_out_ = false;
  std::string buffer_;
};

}  // namespace sinew::test
