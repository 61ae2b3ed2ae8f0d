#include "sinew/server/guard.h"

#include <fmt/format.h>

#include <random>

#include "sinew/base/text.h"

namespace sinew::server {
namespace {}  // namespace

bool is_loopback(std::string_view address) {
  return address == "localhost" || address == "::1" || address.starts_with("127.");
}

bool host_allowed(const Door& door, std::string_view host) {
  if (!door.token.empty()) return true;
  const std::string name = lower_case(host);
  for (const char* own : {"127.0.0.1", "localhost", "[::1]"}) {
    if (name == fmt::format("{}:{}", own, door.port)) return true;
    if (door.port == 80 && name == own) return true;
  }
  return name == fmt::format("{}:{}", door.host, door.port);
}

bool origin_allowed(std::string_view origin, std::string_view host) {
  return origin.empty() || lower_case(origin) == "http://" + lower_case(host);
}

std::string_view query_value(std::string_view target, std::string_view key) {
  const std::size_t query = target.find('?');
  if (query == std::string_view::npos) return {};
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::size_t end = rest.find('&');
    const std::string_view part = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    if (part.size() > key.size() && part.starts_with(key) && part[key.size()] == '=') {
      return part.substr(key.size() + 1);
    }
  }
  return {};
}

bool same_secret(std::string_view given, std::string_view secret) {
  if (secret.empty() || given.size() != secret.size()) return false;
  int differs = 0;
  for (std::size_t i = 0; i < given.size(); ++i) differs |= given[i] ^ secret[i];
  return differs == 0;
}

bool token_allowed(const Door& door, std::string_view target) {
  return door.token.empty() || same_secret(query_value(target, "token"), door.token);
}

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));
}

std::string make_token() {
  std::random_device device;
  std::string token;
  for (int i = 0; i < 4; ++i) token += fmt::format("{:08x}", device());
  return token;
}

}  // namespace sinew::server
