#include "sinew/server/viewer.h"

#include <gtest/gtest.h>

#include "tests/live/support.h"

namespace sinew::server {
namespace {

live::Snapshot snapshot_of(live::Session& s) {
  return {s.topology(), s.parameters(), std::make_shared<live::Status>(s.status()),
          std::make_shared<live::Frame>(s.frame())};
}

std::string kind(const std::optional<Outgoing>& out) {
  if (!out) return "nothing";
  if (out->binary) return out->bytes[6] == 1 ? "topology" : "frame";
  const std::size_t begin = out->bytes.find("\"type\":\"") + 8;
  return out->bytes.substr(begin, out->bytes.find('"', begin) - begin);
}

TEST(Viewer, DescribesTheSceneBeforeItsFrames) {
  live::Session s(test::hanging_box());
  const live::Snapshot now = snapshot_of(s);
  Viewer viewer("1", false);
  viewer.note(role_text(true, 1, "t"));
  for (const char* expected :
       {"hello", "role", "scene", "topology", "status", "frame", "nothing"}) {
    EXPECT_EQ(kind(viewer.next(now)), expected);
  }
}

TEST(Viewer, OneThatFallsBehindGetsTheNewestFrameAndNoQueue) {
  live::Session s(test::hanging_box());
  live::Snapshot now = snapshot_of(s);
  Viewer viewer("1", false);
  while (viewer.next(now)) {
  }
  int frames = 0;
  for (int i = 0; i < 50; ++i) {
    now.frame = std::make_shared<live::Frame>(s.frame());
    frames += kind(viewer.next(now)) == "frame" ? 1 : 0;
  }
  EXPECT_EQ(frames + 1, static_cast<int>(Viewer::most_unseen));
  viewer.seen(now.frame->number);
  const auto next = viewer.next(now);
  ASSERT_EQ(kind(next), "frame");
  EXPECT_EQ(next->bytes, encode_frame(*now.frame));
}

TEST(Viewer, AnotherSceneIsDescribedAnew) {
  live::Session s(test::hanging_box());
  live::Snapshot now = snapshot_of(s);
  Viewer viewer("1", false);
  while (viewer.next(now)) {
  }
  s.apply(live::Load{test::hanging_box({"box.cells=[2,2,2]"})});
  now = snapshot_of(s);
  EXPECT_EQ(kind(viewer.next(now)), "scene");
  EXPECT_EQ(kind(viewer.next(now)), "topology");
}

TEST(Viewer, NotesAreBoundedAndSoIsSpeech) {
  live::Session s(test::hanging_box());
  const live::Snapshot now = snapshot_of(s);
  Viewer viewer("1", false);
  for (int i = 0; i < 1000; ++i) viewer.note(error_text(std::to_string(i)));
  int notes = 0;
  while (const auto out = viewer.next(now)) notes += kind(out) == "error" ? 1 : 0;
  EXPECT_EQ(notes, 16);
  const std::chrono::steady_clock::time_point start{std::chrono::seconds(1000)};
  int heard = 0;
  for (int i = 0; i < 5000; ++i) heard += viewer.may_speak(start) ? 1 : 0;
  EXPECT_EQ(heard, 600);
  EXPECT_TRUE(viewer.may_speak(start + std::chrono::milliseconds(10)));
}

}  // namespace
}  // namespace sinew::server
