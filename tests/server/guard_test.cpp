#include "sinew/server/guard.h"

#include <gtest/gtest.h>

namespace sinew::server {
namespace {

TEST(Guard, OnlyNamesOfThisMachineLeadHere) {
  const Door door{"127.0.0.1", 8650, ""};
  for (const char* host : {"127.0.0.1:8650", "localhost:8650", "LocalHost:8650", "[::1]:8650"}) {
    EXPECT_TRUE(host_allowed(door, host)) << host;
  }
  for (const char* host : {"", "localhost", "127.0.0.1", "127.0.0.1:80", "evil.example:8650",
                           "localhost.evil.example:8650", "127.0.0.1:8650.evil.example"}) {
    EXPECT_FALSE(host_allowed(door, host)) << host;
  }
  EXPECT_TRUE(host_allowed({"0.0.0.0", 8650, "secret"}, "liver.local:8650"));
}

TEST(Guard, OriginsAreThoseOfTheHost) {
  EXPECT_TRUE(origin_allowed("http://localhost:8650", "localhost:8650"));
  EXPECT_TRUE(origin_allowed("", "localhost:8650"));
  for (const char* origin : {"null", "http://evil.example", "https://localhost:8650",
                             "http://localhost:8651", "http://localhost:8650.evil.example"}) {
    EXPECT_FALSE(origin_allowed(origin, "localhost:8650")) << origin;
  }
}

TEST(Guard, TokensAreComparedWhole) {
  const Door door{"0.0.0.0", 1, "abcdef"};
  EXPECT_TRUE(token_allowed(door, "/?token=abcdef"));
  EXPECT_TRUE(token_allowed(door, "/live?x=1&token=abcdef&y"));
  for (const char* target : {"/", "/?", "/?token=", "/?token=abcde", "/?token=abcdefg",
                             "/?token=abcdeF", "/?xtoken=abcdef", "/token=abcdef"}) {
    EXPECT_FALSE(token_allowed(door, target)) << target;
  }
  EXPECT_TRUE(token_allowed({"127.0.0.1", 1, ""}, "/"));
}

TEST(Guard, TokensAreLongAndNeverTheSame) {
  EXPECT_EQ(make_token().size(), 32u);
  EXPECT_NE(make_token(), make_token());
}

TEST(Guard, Loopback) {
  for (const char* a : {"127.0.0.1", "127.1.2.3", "localhost", "::1"}) EXPECT_TRUE(is_loopback(a));
  for (const char* a : {"0.0.0.0", "::", "192.168.1.2", "example.org"})
    EXPECT_FALSE(is_loopback(a));
}

}  // namespace
}  // namespace sinew::server
