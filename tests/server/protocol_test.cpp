#include "sinew/server/protocol.h"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "sinew/base/error.h"
#include "sinew/base/random.h"
#include "sinew/live/session.h"
#include "tests/live/support.h"

namespace sinew::server {
namespace {

template <typename T>
T command(const std::string& text) {
  return std::get<T>(std::get<live::Command>(parse_request(text)));
}

template <typename T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof value);
  return value;
}

const std::vector<std::string> good = {
    R"({"type":"play","running":false})",
    R"({"type":"step"})",
    R"({"type":"step","frame":true})",
    R"({"type":"reset"})",
    R"({"type":"material","key":"young","value":15000.5})",
    R"({"type":"material","body":"a","region":"b","key":"law","value":"lloyd"})",
    R"({"type":"stepping","key":"stepper","value":"implicit"})",
    R"({"type":"gravity","value":[0,-9.81,0]})",
    R"({"type":"time_scale","value":0.5})",
    R"({"type":"quantity","value":"stress"})",
    R"({"type":"grab","hand":1,"node":7,"point":[0,1,2],"radius":0.1})",
    R"({"type":"drag","hand":1,"point":[0,1,2]})",
    R"({"type":"release","hand":1})",
    R"({"type":"seen","frame":12})",
    R"({"type":"control"})",
    R"({"type":"ball","point":[0,1,2],"radius":0.02})",
    R"({"type":"ball"})",
    R"({"type":"cut","normal":[1,0,0],"offset":0.1})",
    R"({"type":"cut"})",
    R"({"type":"springs","value":true})",
    R"({"type":"compare","law":"fem"})",
    R"({"type":"compare"})",
    R"({"type":"open","scene":"liver"})",
    R"({"type":"open","file":"a.mesh"})",
};

TEST(Protocol, MessagesAreRead) {
  for (const std::string& text : good) EXPECT_NO_THROW(parse_request(text)) << text;
  EXPECT_FALSE(command<live::Play>(good[0]).running);
  EXPECT_TRUE(command<live::Advance>(good[2]).frame);
  EXPECT_EQ(command<live::SetMaterial>(good[4]).value, "15000.5");
  EXPECT_EQ(command<live::SetMaterial>(R"({"type":"material","key":"young","value":1e9})").value,
            "1000000000");
  EXPECT_EQ(command<live::SetMaterial>(good[5]).region, "b");
  EXPECT_EQ(command<live::SetGravity>(good[7]).gravity, Vec3(0, -9.81, 0));
  EXPECT_EQ(command<live::SetQuantity>(good[9]).quantity, live::Quantity::stress);
  EXPECT_EQ(command<live::Grab>(good[10]).node, 7);
  EXPECT_EQ(command<live::Grab>(good[10]).point, Vec3(0, 1, 2));
  EXPECT_EQ(std::get<Seen>(parse_request(good[13])).frame, 12u);
  EXPECT_EQ(command<live::MoveBall>(good[15]).radius, 0.02);
  EXPECT_NO_THROW(command<live::RemoveBall>(good[16]));
  EXPECT_EQ(command<live::SetCut>(good[17]).cut.offset, 0.1);
  EXPECT_TRUE(command<live::SetCut>(good[18]).cut.normal.isZero());
  EXPECT_TRUE(command<live::SetSprings>(good[19]).shown);
  EXPECT_EQ(command<live::SetCompare>(good[20]).law, "fem");
  EXPECT_EQ(std::get<Open>(parse_request(good[22])).scene, "liver");
}

TEST(Protocol, EverythingElseIsRefused) {
  for (const std::string text : {"",
                                 "{",
                                 "[]",
                                 "null",
                                 "7",
                                 "\"play\"",
                                 "{}",
                                 R"({"type":7})",
                                 R"({"type":"fly"})",
                                 R"({"type":"play","running":1})",
                                 R"({"type":"play","speed":1})",
                                 R"({"type":"material","key":"young"})",
                                 R"({"type":"material","key":"young","value":[]})",
                                 R"({"type":"material","key":1,"value":2})",
                                 R"({"type":"gravity","value":[0,1]})",
                                 R"({"type":"gravity","value":[0,1,"2"]})",
                                 R"({"type":"gravity","value":{"x":1}})",
                                 R"({"type":"quantity","value":"soul"})",
                                 R"({"type":"grab","hand":0,"node":1})",
                                 R"({"type":"grab","hand":-1,"node":1,"point":[0,0,0]})",
                                 R"({"type":"grab","hand":16,"node":1,"point":[0,0,0]})",
                                 R"({"type":"grab","hand":0,"node":1.5,"point":[0,0,0]})",
                                 R"({"type":"grab","hand":0,"node":1e300,"point":[0,0,0]})",
                                 R"({"type":"time_scale","value":"fast"})",
                                 R"({"type":"seen","frame":-1})",
                                 R"({"type":"ball","point":[0,1]})",
                                 R"({"type":"cut","normal":1})",
                                 R"({"type":"springs"})",
                                 R"({"type":"compare","law":7})",
                                 R"({"type":"open"})",
                                 R"({"type":"open","scene":"a","file":"b"})",
                                 "{\"type\":\"\xff\xfe\"}"}) {
    EXPECT_THROW(parse_request(text), Error) << text;
  }
  EXPECT_THROW(parse_request(std::string(1 << 20, '[')), Error);
  EXPECT_THROW(parse_request(std::string(most_message_bytes, '[')), Error);
}

// Good messages with bytes changed, cut and doubled: an Error or a Request, nothing else.
TEST(Protocol, DamagedMessagesNeverDoAnythingButFail) {
  std::uint64_t drawn = 0;
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(random_number(drawn++) * static_cast<double>(n));
  };
  int refused = 0;
  constexpr int rounds = 20000;
  for (int i = 0; i < rounds; ++i) {
    std::string text = good[below(good.size())];
    for (std::size_t k = 1 + below(4); k > 0; --k) {
      const std::size_t place = below(text.size());
      switch (below(4)) {
        case 0:
          text[place] = static_cast<char>(below(256));
          break;
        case 1:
          text.erase(place, 1 + below(8));
          break;
        case 2:
          text.insert(place, text.substr(place, 1 + below(8)));
          break;
        default:
          text.insert(place, 1, "{}[]\",:-e9"[below(10)]);
      }
      if (text.empty()) text = "x";
    }
    try {
      parse_request(text);
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, rounds / 2);
}

TEST(Protocol, BinaryMessagesAreLaidOutAsWritten) {
  live::Session s(test::hanging_box());
  const live::Topology& t = *s.topology();
  const std::string topology = encode_topology(t);
  EXPECT_EQ(topology.substr(0, 4), "SNVW");
  EXPECT_EQ(at<std::uint16_t>(topology, 4), protocol_version);
  EXPECT_EQ(at<std::uint16_t>(topology, 6), 1);
  EXPECT_EQ(at<std::uint32_t>(topology, 8), t.revision);
  EXPECT_EQ(at<std::uint32_t>(topology, 12), t.node.size());
  EXPECT_EQ(at<std::uint32_t>(topology, 32), t.triangle.size() / 3);
  EXPECT_EQ(topology.size(), 40 + 4 * t.triangle.size() + 14 * t.node.size());
  EXPECT_EQ(at<std::uint32_t>(topology, 40), t.triangle[0]);
  EXPECT_EQ(at<float>(topology, 40 + 4 * t.triangle.size()), t.rest[0]);

  const live::Frame f = s.frame();
  const std::string frame = encode_frame(f);
  EXPECT_EQ(at<std::uint16_t>(frame, 6), 2);
  EXPECT_EQ(at<std::uint64_t>(frame, 16), f.number);
  EXPECT_EQ(at<double>(frame, 24), f.time);
  EXPECT_EQ(frame.size(), 40 + 16 * t.node.size());
  EXPECT_EQ(at<float>(frame, 40), f.position[0]);
  EXPECT_EQ(at<std::uint32_t>(frame, 36), 0u);

  s.apply(live::SetSprings{true});
  s.apply(live::SetCompare{"lloyd"});
  s.apply(live::MoveBall{Vec3(0.05, 0, 0), 0.03});
  for (int i = 0; i < 10; ++i) s.advance(Clock::time_point::max());
  const std::string all = encode_topology(*s.topology());
  const std::size_t springs = s.topology()->spring.size();
  const std::size_t triangles = s.topology()->triangle.size();
  EXPECT_EQ(at<std::uint32_t>(all, 36), springs / 2);
  EXPECT_EQ(all.size(), 40 + 4 * triangles + 4 * springs + 14 * 64);
  EXPECT_EQ(at<std::uint32_t>(all, 40 + 4 * triangles + 12 * 64), s.topology()->spring[0]);
  const live::Frame both = s.frame();
  ASSERT_FALSE(both.contact.empty());
  const std::string more = encode_frame(both);
  EXPECT_EQ(at<std::uint32_t>(more, 36), 3u);
  EXPECT_EQ(more.size(), 40 + (16 + 12 + 1) * 64u);
  EXPECT_EQ(at<float>(more, 40 + 16 * 64), both.compared[0]);
  EXPECT_EQ(static_cast<std::uint8_t>(more.back()), both.contact.back());
}

TEST(Protocol, TextsAreJsonWhateverTheyHold) {
  live::Session s(test::hanging_box());
  live::Status status = s.status();
  status.error = "broken \xff\xfe text \"quoted\"";
  status.stable_step = no_limit;
  const auto json = nlohmann::json::parse(status_text(status));
  EXPECT_TRUE(json["stable_step"].is_null());
  EXPECT_EQ(json["type"], "status");
  const auto scene = nlohmann::json::parse(scene_text(*s.parameters(), *s.topology(), 3));
  EXPECT_EQ(scene["parts"][0]["young"], 2e4);
  EXPECT_EQ(scene["quantities"].size(), live::quantities.size());
  EXPECT_TRUE(nlohmann::json::parse(error_text("\x80"))["message"].is_string());
}

}  // namespace
}  // namespace sinew::server
