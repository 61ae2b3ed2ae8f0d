// Access control of the server: pure functions of a request. docs/protocol.md, "Safety".
#pragma once

#include <string>
#include <string_view>

namespace sinew::server {

struct Door {
  std::string host = "127.0.0.1";  // the listening address
  unsigned short port = 0;
  std::string token;  // empty: not required
};

// Whether only this machine can reach the address.
bool is_loopback(std::string_view address);

// Without a token the Host header must be a name of this machine at the server's port, which
// prevents DNS rebinding. With a token any Host is accepted.
bool host_allowed(const Door& door, std::string_view host);

// A page of another site may not open a socket here: an Origin must be that of the Host. Programs
// other than browsers send none.
bool origin_allowed(std::string_view origin, std::string_view host);

// The value of a key in the query of a target, "/live?token=abc"; empty if there is none.
// Nothing is decoded.
std::string_view query_value(std::string_view target, std::string_view key);

// Comparison in constant time; an empty secret never matches.
bool same_secret(std::string_view given, std::string_view secret);

// Whether the target's query holds the token.
bool token_allowed(const Door& door, std::string_view target);

// The path of a target, without its query.
std::string_view path_of(std::string_view target);

// 128 bits from the system, as 32 hexadecimal digits.
std::string make_token();

}  // namespace sinew::server
