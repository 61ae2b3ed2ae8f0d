#include "sinew/live/ball.h"

#include <gtest/gtest.h>

#include "tests/live/support.h"

namespace sinew::live {
namespace {

using test::finite;
using test::frames;

TEST(Ball, PushesTheTissueAndIsPushedBack) {
  for (const char* stepper : {"verlet", "implicit"}) {
    Session s(test::hanging_box({std::string("stepper=") + stepper}));
    frames(s, 60);
    s.apply(MoveBall{Vec3(0.1, -0.03, 0), 0.03});
    frames(s, 10);
    ASSERT_TRUE(s.status().ball.has_value());
    EXPECT_NEAR(s.status().ball->radius, 0.03, 1e-12) << stepper;
    EXPECT_EQ(s.status().ball->contacts, 0) << stepper;
    s.apply(MoveBall{Vec3(0.06, -0.03, 0), 0.0});
    frames(s, 60);
    const Status pressed = s.status();
    EXPECT_LT((pressed.ball->center - Vec3(0.06, -0.03, 0)).norm(), 1e-12) << stepper;
    EXPECT_GT(pressed.ball->force.x(), 0.05) << stepper;
    EXPECT_GT(pressed.ball->contacts, 0) << stepper;
    EXPECT_GT(pressed.energy.work_in, 0.0) << stepper;
    EXPECT_FALSE(s.frame().contact.empty()) << stepper;
    s.apply(RemoveBall{});
    frames(s, 120);
    EXPECT_FALSE(s.status().ball.has_value()) << stepper;
    EXPECT_TRUE(s.frame().contact.empty()) << stepper;
    EXPECT_TRUE(s.status().error.empty()) << stepper << s.status().error;
  }
}

TEST(Ball, WhatItDoesIsInTheEnergyAccount) {
  // Steps of a third of the stable one: Verlet's own energy swings with the square of the step.
  Session s(test::hanging_box({"gravity=[0,0,0]", "box.damping_ratio=0", "safety=0.3"}));
  s.apply(MoveBall{Vec3(0.1, -0.03, 0), 0.03});
  for (int i = 0; i < 30; ++i) {
    s.apply(MoveBall{Vec3(0.1 - 0.0013 * i, -0.03, 0), 0.0});
    frames(s, 1);
  }
  s.apply(RemoveBall{});
  const Energies e = s.status().energy;
  EXPECT_GT(e.work_in, 0.0);
  EXPECT_NEAR(e.total(), 0.0, 0.05 * e.work_in);
}

TEST(Ball, PutIntoTheTissueOrThrownAboutItTearsNothing) {
  for (const char* young : {"3e3", "1e6"}) {
    Session s(test::hanging_box({std::string("box.young=") + young}));
    s.apply(MoveBall{Vec3(0, 0, 0), 0.04});  // in the middle of it
    frames(s, 20);
    for (int i = 0; i < 20; ++i) {
      s.apply(MoveBall{Vec3(i % 2 == 0 ? 5.0 : -0.05, -0.02, 0), 0.0});
      frames(s, 3);
    }
    s.apply(SetMaterial{"", "", "young", "1e5"});
    frames(s, 5);
    EXPECT_TRUE(s.status().error.empty()) << s.status().error;
    EXPECT_TRUE(finite(s));
    EXPECT_LT(s.status().max_stretch, 2.0) << young;
  }
}

}  // namespace
}  // namespace sinew::live
