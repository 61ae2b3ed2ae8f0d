// The messages between the server and the page: docs/protocol.md says what they hold.
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

// What only the socket is concerned with.
struct Seen {
  std::uint64_t frame = 0;  // the page has got this one
};
struct TakeControls {};
// What the server's library is asked for: a scene that is shipped, or a file that was given.
struct Open {
  std::string scene, file;  // one of them is empty
};
using Request = std::variant<live::Command, Seen, TakeControls, Open>;

// Reads a message of the page. Throws Error(usage) for everything that is no message of this
// protocol: no JSON, an unknown type or key, a missing or wrong value.
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
