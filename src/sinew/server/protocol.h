// The messages between the server and the page. docs/protocol.md describes their content.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "sinew/live/frame.h"
#include "sinew/live/topology.h"

namespace sinew::server {

inline constexpr std::uint16_t protocol_version = 2;
inline constexpr std::size_t most_message_bytes = 4096;  // that the server takes

// Messages that concern only the socket.
struct Seen {
  std::uint64_t frame = 0;  // the page has received this one
};
struct TakeControls {};
// A request to the server's library: a scene of Sinew, or a received file.
struct Open {
  std::string scene, file;  // one of them is empty
};
using Request = std::variant<live::Command, Seen, TakeControls, Open>;

// Reads a message of the page. Throws Error(usage) for any other text: no JSON, an unknown type or
// key, a missing or wrong value.
Request parse_request(std::string_view text);

// Binary messages, little endian.
std::string encode_topology(const live::Topology& topology);
std::string encode_frame(const live::Frame& frame);

// Text messages.
std::string hello_text(std::string_view version, bool gallery);
std::string role_text(bool controls, int viewers, std::string_view ticket);
std::string scene_text(const live::Parameters& parameters, const live::Topology& topology,
                       std::uint32_t changes);
std::string status_text(const live::Status& status);
std::string error_text(std::string_view message);

}  // namespace sinew::server
