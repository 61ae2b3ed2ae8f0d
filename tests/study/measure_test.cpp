#include "sinew/study/measure.h"

#include <gtest/gtest.h>

#include "sinew/scene/scene.h"

namespace sinew::study {
namespace {

// A box of gel, its lower side at y = 0, that moves downwards at 1 m/s.
Scene falling(const char* ground) {
  return parse_scene(std::string("duration = 0.1\ndt = \"auto\"\n"
                                 "[body.gel]\nshape = \"box\"\nsize = [0.1, 0.1, 0.1]\n"
                                 "cells = [2, 2, 2]\nposition = [0, 0.05, 0]\n"
                                 "velocity = [0, -1, 0]\nyoung = 1e6\ndamping_ratio = 0\n"
                                 "[output]\nfps = 1000\n") +
                         ground,
                     "falling.toml", ".");
}

Quantity quantity(Kind kind, const char* of) {
  Quantity q;
  q.kind = kind;
  q.of = of;
  q.axis = "y";
  return q;
}

TEST(Measure, AFreeFall) {
  const Scene scene = falling("");
  Experiment experiment(scene);
  ASSERT_TRUE(experiment.run(nullptr));
  EXPECT_NEAR(experiment.measure(quantity(Kind::sink, "gel")), 0.1 + 0.5 * 9.81 * 0.01, 1e-9);
  EXPECT_EQ(experiment.measure(quantity(Kind::contact_time, "")), 0.0);
  EXPECT_EQ(experiment.measure(quantity(Kind::leave, "gel")), 0.0);
  EXPECT_THROW(experiment.measure(quantity(Kind::sink, "jelly")), Error);
}

TEST(Measure, ARebound) {
  const Scene scene = falling("[ground]\nrestitution = 1\nfriction = 0\n");
  Experiment experiment(scene);
  ASSERT_TRUE(experiment.run(nullptr));
  // A wave takes 2 L / c = 6 ms, or less in a wide body, to the upper side and back.
  const double contact = experiment.measure(quantity(Kind::contact_time, ""));
  EXPECT_GT(contact, 0.002);
  EXPECT_LT(contact, 0.012);
  const double sink = experiment.measure(quantity(Kind::sink, "gel"));
  EXPECT_GT(sink, 0.0005);
  EXPECT_LT(sink, contact);
  const double leave = experiment.measure(quantity(Kind::leave, "gel"));
  // The rest of the energy vibrates.
  EXPECT_GT(leave, 0.5);
  EXPECT_LT(leave, 1.0);
}

}  // namespace
}  // namespace sinew::study
