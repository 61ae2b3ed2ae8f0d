#include "sinew/scene/overrides.h"

#include <gtest/gtest.h>

#include "tests/scene/support.h"

namespace sinew {
namespace {

using test::parse;
using test::parse_error;

constexpr const char* kScene = R"(
[body.beam]
shape = "beam"
[body.beam.region.core]
label = 0
[body.ball]
shape = "sphere"
[pin.clamp]
body = "beam"
select = { side = "-z" }
path = [{ time = 0 }, { time = 1, move = [0, 0.1, 0] }]
[probe.clamp]
body = "beam"
select = { all = true }
[probe.ball]
body = "ball"
select = { all = true }
)";

TEST(Overrides, ReachValuesByPathAndByName) {
  const Scene s =
      parse(kScene, {"duration=0.5", "body.beam.young=2e4", "beam.poisson=0.3",
                     "beam.cells=[8,8,32]", "beam.region.core.density=900", "ball.radius = 0.02"});
  EXPECT_EQ(s.duration, 0.5);
  EXPECT_EQ(s.bodies[0].material.young, 2e4);
  EXPECT_EQ(s.bodies[0].material.poisson, 0.3);
  EXPECT_EQ(s.bodies[0].cells, (std::array<int, 3>{8, 8, 32}));
  EXPECT_EQ(s.bodies[0].regions[0].material.density, 900.0);
  EXPECT_EQ(s.bodies[0].regions[0].material.young, 2e4);
  EXPECT_EQ(s.bodies[1].radius, 0.02);  // "ball" is a probe too: the body comes first
}

TEST(Overrides, TakeWhatIsNotTomlAsText) {
  EXPECT_EQ(parse(kScene, {"beam.law=uniform"}).bodies[0].material.law, Law::uniform);
  EXPECT_EQ(parse(kScene, {"beam.law=\"uniform\""}).bodies[0].material.law, Law::uniform);
  EXPECT_EQ(parse(kScene, {"stepper=verlet"}).stepper, StepperKind::verlet);
  EXPECT_EQ(parse(kScene, {"title=2020-01-01 was a Wednesday"}).title,
            "2020-01-01 was a Wednesday");
  EXPECT_EQ(parse(kScene, {"title=x\nduration = 7"}).duration, 2.0);
  EXPECT_EQ(parse(kScene, {"dt=auto"}).dt, std::nullopt);
  EXPECT_EQ(parse(kScene, {"dt=0.001", "dt=0.002"}).dt, 0.002);
}

TEST(Overrides, ReachIntoArraysAndMakeTables) {
  const Scene s = parse(kScene, {"pin.clamp.path.1.move=[0,0,1]", "output.fps=60", "ground={}",
                                 "pin.clamp.select={all=true}"});
  EXPECT_EQ(s.pins[0].path.keys[1].move, Vec3(0, 0, 1));
  EXPECT_EQ(s.output.fps, 60.0);
  EXPECT_TRUE(s.ground.has_value());
  EXPECT_TRUE(s.pins[0].select.all);
  EXPECT_FALSE(s.pins[0].select.side.has_value());
}

TEST(Overrides, AreInTheDocument) {
  const Scene s = parse(kScene, {"beam.young=2e4", "output.fps=60"});
  const Scene again = parse(s.document);
  EXPECT_EQ(again.bodies[0].material.young, 2e4);
  EXPECT_EQ(again.output.fps, 60.0);
  EXPECT_EQ(again.document, s.document);
  EXPECT_NE(parse(kScene).document, s.document);
}

TEST(Overrides, NameTheirMistakes) {
  const auto error = [](const std::string& text) { return parse_error(kScene, {text}); };
  EXPECT_EQ(error("beam.young"),
            "--set beam.young: no '=' between the key and its value\n"
            "  remedy: write --set beam.young=20e3");
  EXPECT_EQ(error("beam.young="),
            "--set beam.young=: no value after '='\n"
            "  remedy: an empty text is written as '\"\"'");
  EXPECT_EQ(error("look_for=\xff\xfe"),
            "--set look_for=\xff\xfe: the value is no text: some of its bytes are not UTF-8\n"
            "  remedy: give numbers as 12.5, texts in UTF-8");
  EXPECT_EQ(error("=3"),
            "--set =3: a part of the key is empty\n"
            "  remedy: write --set beam.young=20e3");
  EXPECT_EQ(error("beam..young=3"),
            "--set beam..young=3: a part of the key is empty\n"
            "  remedy: write --set beam.young=20e3");
  EXPECT_EQ(error("beam.yuong=1"),
            "--set beam.yuong=1: unknown key 'yuong' in [body.beam]; did you mean 'young'?\n"
            "  remedy: docs/scene-format.md lists the keys of [body.NAME]");
  EXPECT_EQ(error("baem.young=1"),
            "--set baem.young=1: nothing in the scene is named 'baem'; did you mean 'beam'?\n"
            "  remedy: a key begins with a table of the scene (output.fps) or with the name of a "
            "body, pin, attachment, distance, force, probe, obstacle or cut (beam.young)");
  EXPECT_EQ(error("body.baem.young=1"),
            "--set body.baem.young=1: the scene has no body 'baem'; did you mean 'beam'?\n"
            "  remedy: --set changes what the scene file has");
  EXPECT_EQ(error("beam.region.cord.young=1"),
            "--set beam.region.cord.young=1: the scene has no region 'cord'; did you mean "
            "'core'?\n  remedy: --set changes what the scene file has");
  EXPECT_EQ(error("clamp.select.all=true"),
            "--set clamp.select.all=true: 'clamp' names both a pin and a probe\n"
            "  remedy: write pin.clamp or probe.clamp");
  EXPECT_EQ(error("beam.young=-1"),
            "--set beam.young=-1: 'young' in [body.beam] is -1; expected > 0 [Pa]\n"
            "  remedy: the default is young = 15e3");
  EXPECT_EQ(error("beam.shape.x=1"),
            "--set beam.shape.x=1: 'x' would be within \"beam\", which is no table\n"
            "  remedy: docs/scene-format.md lists the keys of a scene");
  EXPECT_EQ(error("pin.clamp.path.2.time=1"),
            "--set pin.clamp.path.2.time=1: '2' is not one of the array's 2 items\n"
            "  remedy: items count from 0");
  EXPECT_EQ(error("stepper=verlett"),
            "--set stepper=verlett: 'stepper' in the scene is \"verlett\"; expected one of "
            "\"verlet\", \"implicit\", \"static\", \"auto\"; did you mean 'verlet'?\n  remedy: the "
            "default "
            "is stepper = "
            "\"verlet\"");
}

TEST(Overrides, WrongUseIsNotABadScene) {
  try {
    parse(kScene, {"duration"});
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
  }
}
}  // namespace
}  // namespace sinew
