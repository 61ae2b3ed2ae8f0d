#include "sinew/server/network_device.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "sinew/base/error.h"
#include "tests/server/client.h"

namespace sinew::server {
namespace {

template <typename Condition>
bool soon(const Condition& condition) {
  for (int k = 0; k < 500 && !condition(); ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return condition();
}

TEST(NetworkDevice, TakesTheInputAndAnswersWithTheForce) {
  NetworkDevice device(0);
  EXPECT_FALSE(device.connected());
  test::Client client(device.port());
  EXPECT_EQ(client.shake("/"), "HTTP/1.1 101 Switching Protocols");
  EXPECT_TRUE(soon([&] { return device.connected(); }));
  device.write({{1.0, 2.0, 3.0}, {0.0, 0.5, 0.0}});
  client.say(R"({"position": [0.1, 0.2, 0.3], "button": true})");
  const auto answer = client.hear();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->payload, R"({"force":[1.0,2.0,3.0],"torque":[0.0,0.5,0.0]})");
  const HapticInput input = device.read(1e-3);
  EXPECT_EQ(input.position, (Point{0.1, 0.2, 0.3}));
  EXPECT_TRUE(input.button);

  client.say("up");
  const auto refusal = client.hear();
  ASSERT_TRUE(refusal);
  EXPECT_NE(refusal->payload.find("not a JSON object"), std::string::npos);
  EXPECT_EQ(device.read(1e-3).position, (Point{0.1, 0.2, 0.3}));

  test::Client second(device.port());
  EXPECT_EQ(second.shake("/"), "");  // turned away
  client.close();
  EXPECT_TRUE(soon([&] { return !device.connected(); }));
  test::Client third(device.port());
  EXPECT_EQ(third.shake("/"), "HTTP/1.1 101 Switching Protocols");
}

TEST(NetworkDevice, PagesOfOtherSitesStayOutside) {
  NetworkDevice device(0);
  test::Client page(device.port());
  EXPECT_EQ(page.shake("/", "Origin: http://evil.example\r\n"), "");
  test::Client rebound(device.port());
  EXPECT_EQ(rebound.shake("/", "", "evil.example"), "");
  EXPECT_FALSE(device.connected());
}

TEST(NetworkDevice, SaysThatAPortIsTaken) {
  NetworkDevice device(0);
  EXPECT_THROW(NetworkDevice second(device.port()), Error);
}

TEST(NetworkDevice, RefusesWhatIsNoInput) {
  for (const char* message : {"", "[]", "{}", R"({"position": 1})", R"({"position": [1, 2]})",
                              R"({"position": [1, 2, "3"]})", R"({"position": [1, 2, 1e300]})",
                              R"({"position": [0, 0, 0], "rotation": [0, 0, 0, 0]})",
                              R"({"position": [0, 0, 0], "button": 1})"})
    EXPECT_THROW(read_haptic_input(message), Error) << message;
}

}  // namespace
}  // namespace sinew::server
