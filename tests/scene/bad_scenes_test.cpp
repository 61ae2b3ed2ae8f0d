// What a user reads after a mistake in a scene file, word by word.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "tests/scene/support.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

struct Bad {
  const char* scene;
  const char* message;
};

// A body, so that the rest of the scene is looked at.
#define BEAM "[body.beam]\nshape = \"beam\"\n"

const std::vector<Bad>& bad_scenes() {
  static const std::vector<Bad> scenes = {
      // --- keys ---
      {"durration = 1\n" BEAM,
       "scene.toml:1:1: unknown key 'durration' in the scene; did you mean 'duration'?\n"
       "  remedy: docs/scene-format.md lists the keys of the top level"},
      {BEAM "yuong = 15e3\n",
       "scene.toml:3:1: unknown key 'yuong' in [body.beam]; did you mean 'young'?\n"
       "  remedy: docs/scene-format.md lists the keys of [body.NAME]"},
      {BEAM "young_modulus = 15e3\n",
       "scene.toml:3:1: unknown key 'young_modulus' in [body.beam]; did you mean 'young'?\n"
       "  remedy: docs/scene-format.md lists the keys of [body.NAME]"},
      {BEAM "[pin.end]\nselect = { sid = \"-z\" }\n",
       "scene.toml:4:12: unknown key 'sid' in 'select' of [pin.end]; did you mean 'side'?\n"
       "  remedy: docs/scene-format.md lists the keys of a selection"},
      {BEAM "[outputs]\nfps = 3\n",
       "scene.toml:3:2: unknown key 'outputs' in the scene; did you mean 'output'?\n"
       "  remedy: docs/scene-format.md lists the keys of the top level"},
      {BEAM "qqq = 1\n",
       "scene.toml:3:1: unknown key 'qqq' in [body.beam]\n"
       "  remedy: docs/scene-format.md lists the keys of [body.NAME]"},
      // --- types ---
      {"duration = \"2 s\"\n" BEAM,
       "scene.toml:1:12: 'duration' in the scene is \"2 s\"; expected a number [s]\n"
       "  remedy: the default is duration = 2"},
      {"allow_unstable = 1\n" BEAM,
       "scene.toml:1:18: 'allow_unstable' in the scene is 1; expected true or false\n"
       "  remedy: the default is allow_unstable = false"},
      {"substeps = 1.5\n" BEAM,
       "scene.toml:1:12: 'substeps' in the scene is 1.5; expected an integer\n"
       "  remedy: the default is substeps = 1"},
      {"gravity = -9.81\n" BEAM,
       "scene.toml:1:11: 'gravity' in the scene is -9.81; expected 3 numbers [m/s2]\n"
       "  remedy: the default is gravity = [0, -9.81, 0]"},
      {"gravity = [0, -9.81]\n" BEAM,
       "scene.toml:1:11: 'gravity' in the scene is an array of 2; expected 3 numbers [m/s2]\n"
       "  remedy: the default is gravity = [0, -9.81, 0]"},
      {"gravity = [0, \"down\", 0]\n" BEAM,
       "scene.toml:1:15: 'gravity' in the scene holds \"down\"; expected 3 numbers [m/s2]\n"
       "  remedy: the default is gravity = [0, -9.81, 0]"},
      {BEAM "cells = [4, 4, 16.5]\n",
       "scene.toml:3:16: 'cells' in [body.beam] holds 16.5; expected 3 integers\n"
       "  remedy: the default is cells = [4, 4, 16]"},
      {BEAM "cells = [4, 4]\n",
       "scene.toml:3:9: 'cells' in [body.beam] is an array of 2; expected 3 integers\n"
       "  remedy: the default is cells = [4, 4, 16]"},
      {BEAM "length = 0.2\n",
       "scene.toml:3:10: 'length' in [body.beam] is 0.2; expected one of \"tet\", \"edge\"\n"
       "  remedy: the default is length = \"tet\""},
      {"body = 3\n",
       "scene.toml:1:8: 'body' in the scene is 3; expected a table\n"
       "  remedy: docs/scene-format.md says what 'body' takes"},
      {"[body]\nshape = \"beam\"\n",
       "scene.toml:2:1: 'shape' in [body] is \"beam\"; expected a table, [body.NAME]\n"
       "  remedy: give the body a name: [body.beam]"},
      {BEAM "[pin.end]\nselect = \"-z\"\n",
       "scene.toml:4:10: 'select' in [pin.end] is \"-z\"; expected a table\n"
       "  remedy: docs/scene-format.md says what 'select' takes"},
      {BEAM "[pin.end]\nselect = { all = true }\npath = { time = 1 }\n",
       "scene.toml:5:8: 'path' in [pin.end] is a table; expected an array of tables\n"
       "  remedy: docs/scene-format.md says what 'path' takes"},
      {"stepper = { kind = \"verlet\" }\n" BEAM,
       "scene.toml:1:11: 'stepper' in the scene is a table; expected one of \"verlet\", "
       "\"implicit\", \"static\", \"auto\"\n"
       "  remedy: the default is stepper = \"verlet\""},
      // --- ranges ---
      {BEAM "young = 0\n",
       "scene.toml:3:9: 'young' in [body.beam] is 0; expected > 0 [Pa]\n"
       "  remedy: the default is young = 15e3"},
      {BEAM "young = nan\n",
       "scene.toml:3:9: 'young' in [body.beam] is nan; expected > 0 [Pa]\n"
       "  remedy: the default is young = 15e3"},
      {BEAM "young = inf\n",
       "scene.toml:3:9: 'young' in [body.beam] is inf; expected > 0 [Pa]\n"
       "  remedy: the default is young = 15e3"},
      {BEAM "poisson = 0.5\n",
       "scene.toml:3:11: 'poisson' in [body.beam] is 0.5; expected in (-1, 0.5)\n"
       "  remedy: the default is poisson = 0.45"},
      {BEAM "compress_limit = 1.5\n",
       "scene.toml:3:18: 'compress_limit' in [body.beam] is 1.5; expected in (0, 1], or inf\n"
       "  remedy: the default is compress_limit = inf"},
      {BEAM "size = [0.1, -0.1, 0.4]\n",
       "scene.toml:3:14: 'size' in [body.beam] holds -0.1; expected > 0 [m]\n"
       "  remedy: the default is size = [0.1, 0.1, 0.4]"},
      {BEAM "cells = [0, 4, 16]\n",
       "scene.toml:3:10: 'cells' in [body.beam] holds 0; expected from 1 to 20000000\n"
       "  remedy: the default is cells = [4, 4, 16]"},
      {"safety = 1.1\n" BEAM,
       "scene.toml:1:10: 'safety' in the scene is 1.1; expected from 0.001 to 1\n"
       "  remedy: the default is safety = 0.9"},
      {"dt = -1\n" BEAM,
       "scene.toml:1:6: 'dt' in the scene is -1; expected in (0, 1000000] [s]\n"
       "  remedy: the default is dt = \"auto\""},
      {"dt = \"automatic\"\n" BEAM,
       "scene.toml:1:6: 'dt' in the scene is \"automatic\"; expected a number or \"auto\" [s]; did "
       "you mean 'auto'?\n"
       "  remedy: the default is dt = \"auto\""},
      {"substeps = 99999999999\n" BEAM,
       "scene.toml:1:12: 'substeps' in the scene is 99999999999; expected from 1 to 100000\n"
       "  remedy: the default is substeps = 1"},
      {"duration = 1e6\n" BEAM,
       "scene.toml:1:12: 1000000 s at 30 frames a second are more than 1000000 frames\n"
       "  remedy: lower output.fps or the duration"},
      {BEAM "[ground]\nrestitution = 2\n",
       "scene.toml:4:15: 'restitution' in [ground] is 2; expected from 0 to 1\n"
       "  remedy: the default is restitution = 0"},
      {BEAM "[ground]\nnormal = [0, 0, 0]\n",
       "scene.toml:4:10: 'normal' in [ground] is [0, 0, 0], which is no direction\n"
       "  remedy: up is [0, 1, 0]"},
      {BEAM "rotation = [0, 0, 0, 0]\n",
       "scene.toml:3:12: 'rotation' in [body.beam] is a quaternion of length 0\n"
       "  remedy: no rotation is [1, 0, 0, 0]"},
      // --- words ---
      {BEAM "law = \"loyd\"\n",
       "scene.toml:3:7: 'law' in [body.beam] is \"loyd\"; expected one of \"neo-hookean\", "
       "\"calibrated\", \"uniform\", \"lloyd\", "
       "\"vangelder\"; did you mean 'lloyd'?\n"
       "  remedy: the default is law = \"neo-hookean\""},
      {"[body.b]\nshape = \"cube\"\n",
       "scene.toml:2:9: 'shape' in [body.b] is \"cube\"; expected one of \"beam\", \"box\", "
       "\"sphere\", \"ellipsoid\", \"cylinder\", \"hollow_sphere\"\n"
       "  remedy: docs/scene-format.md says what 'shape' takes"},
      {"stepper = \"euler\"\n" BEAM,
       "scene.toml:1:11: 'stepper' in the scene is \"euler\"; expected one of \"verlet\", "
       "\"implicit\", \"static\", \"auto\"\n"
       "  remedy: the default is stepper = \"verlet\""},
      // --- what does not go together ---
      {"budget_ms = 4\n" BEAM,
       "scene.toml:1:13: stepper = \"verlet\" knows no budget_ms\n"
       "  remedy: take stepper = \"implicit\", or leave budget_ms out"},
      {"stepper = \"implicit\"\nscheme = \"sdirk2\"\nbudget_ms = 4\n" BEAM,
       "scene.toml:2:10: scheme = \"sdirk2\" does not go with budget_ms\n"
       "  remedy: leave scheme out: with a budget it is \"backward-euler\""},
      {"stepper = \"implicit\"\nbudget_ms = 0\n" BEAM,
       "scene.toml:2:13: 'budget_ms' in the scene is 0; expected > 0 [ms]\n"
       "  remedy: docs/scene-format.md says what 'budget_ms' takes"},
      {"duration = 1\n",
       "scene.toml: the scene has no body: there is nothing to simulate\n"
       "  remedy: add a table [body.NAME] with mesh = \"file\" or shape = \"beam\""},
      {"[body.b]\nyoung = 1\n",
       "scene.toml:1:1: [body.b] has neither a mesh nor a shape\n"
       "  remedy: add mesh = \"file\" or shape = \"beam\""},
      {BEAM "mesh = \"a.mesh\"\n",
       "scene.toml:2:9: [body.beam] has both a mesh and a shape\n"
       "  remedy: remove one of them"},
      {BEAM "radius = 0.1\n",
       "scene.toml:3:10: 'radius' in [body.beam] does not go with shape = \"beam\"\n"
       "  remedy: remove it; it belongs to: sphere, cylinder, hollow_sphere"},
      {"[body.b]\nmesh = \"a.mesh\"\ncells = [1, 1, 1]\n",
       "scene.toml:3:9: 'cells' in [body.b] does not go with a mesh file\n"
       "  remedy: remove it; it belongs to: beam, box"},
      {"[body.b]\nmesh = \"\"\n",
       "scene.toml:2:8: 'mesh' in [body.b] is empty; expected a file name\n"
       "  remedy: name a mesh file, relative to the scene's folder"},
      {BEAM "[body.beam.region.a]\nyoung = 1\n",
       "scene.toml:3:1: [body.beam.region.a] has no label, labels or select\n"
       "  remedy: say which tets it covers: label = 1, labels = [1, 2], or select = { box = { min "
       "= "
       "[0, 0, 0], max = [1, 1, 1] } }"},
      {BEAM "[body.beam.region.a]\nlabel = 1\nlabels = [2]\n",
       "scene.toml:3:1: [body.beam.region.a] has both label and labels\n"
       "  remedy: say which tets it covers: label = 1, labels = [1, 2], or select = { box = { min "
       "= "
       "[0, 0, 0], max = [1, 1, 1] } }"},
      {BEAM "[body.beam.region.a]\nlabel = 1\n[body.beam.region.b]\nlabels = [2, 1]\n",
       "scene.toml:6:10: label 1 of [body.beam] is in region 'a' and in region 'b'\n"
       "  remedy: a label belongs to one region, once"},
      {BEAM "[pin.end]\nbody = \"baem\"\nselect = { all = true }\n",
       "scene.toml:4:8: 'body' in [pin.end] names no body of the scene: 'baem'; did you mean "
       "'beam'?\n"
       "  remedy: the bodies are: beam"},
      {BEAM "[body.ball]\nshape = \"sphere\"\n[pin.end]\nselect = { all = true }\n",
       "scene.toml:5:1: [pin.end] does not say which body\n"
       "  remedy: add body = \"NAME\", one of: beam, ball"},
      {BEAM "[pin.end]\n",
       "scene.toml:3:1: [pin.end] has no 'select'\n"
       "  remedy: add select (docs/scene-format.md)"},
      {BEAM "[pin.end]\nselect = {}\n",
       "scene.toml:4:10: 'select' of [pin.end] has no condition\n"
       "  remedy: all = true selects every node"},
      {BEAM "[pin.end]\nselect = { depth = 0.1 }\n",
       "scene.toml:4:20: 'depth' in 'select' of [pin.end] goes with a side, and there is none\n"
       "  remedy: add side = \"-z\", or remove depth"},
      {BEAM "[pin.end]\nselect = { box = { min = [0, 0, 0] } }\n",
       "scene.toml:4:18: 'box' in 'select' of [pin.end] has no 'max'\n"
       "  remedy: add max (docs/scene-format.md)"},
      {BEAM "[pin.end]\nselect = { box = { min = [0, 1, 0], max = [1, 0, 1] } }\n",
       "scene.toml:4:43: 'max' in 'box' in 'select' of [pin.end] is less than min along y: 0 < 1\n"
       "  remedy: min holds the smaller coordinates"},
      {BEAM "[pin.end]\nselect = { all = true }\nsmooth = true\n",
       "scene.toml:5:10: 'smooth' in [pin.end] goes with a path, and there is none\n"
       "  remedy: add path = [{ time = 1, move = [0, 0.1, 0] }], or remove it"},
      {BEAM "[pin.end]\nselect = { all = true }\npath = [{ time = 1 }, { time = 1 }]\n",
       "scene.toml:5:23: key frame 1 of [pin.end] is at time 1, not after the one before it at 1\n"
       "  remedy: put the key frames in order of time"},
      {BEAM "[pin.end]\nselect = { all = true }\npath = [{ move = [0, 0, 0] }]\n",
       "scene.toml:5:9: key frame 0 of [pin.end] has no 'time'\n"
       "  remedy: add time (docs/scene-format.md)"},
      {BEAM "[attachment.a]\nselect = { all = true }\n",
       "scene.toml:3:1: [attachment.a] has neither a point nor to_body\n"
       "  remedy: its springs end at point = [x, y, z] or at to_body = \"NAME\""},
      {BEAM "[attachment.a]\nselect = { all = true }\nto_body = \"beam\"\n",
       "scene.toml:5:11: [attachment.a] ties body 'beam' to itself\n"
       "  remedy: its springs end at another body"},
      {BEAM "[attachment.a]\nselect = { all = true }\nto_body = \"beam\"\nsmooth = true\n",
       "scene.toml:6:10: 'smooth' in [attachment.a] goes with a point, and there is none\n"
       "  remedy: remove it; another body moves by itself"},
      {BEAM "[force.f]\nselect = { all = true }\n",
       "scene.toml:3:1: [force.f] has none of 'force', 'traction' and 'pressure'\n"
       "  remedy: a force in newtons is force = [0, 0, 1]; a table has one of the three"},
      {BEAM "[force.f]\nselect = { all = true }\nforce = [0, 0, 1]\npressure = 1\n",
       "scene.toml:3:1: [force.f] has more than one of 'force', 'traction' and 'pressure'\n"
       "  remedy: a force in newtons is force = [0, 0, 1]; a table has one of the three"},
      {BEAM "[pin.end]\nselect = { all = true }\npath = [{ time = 1, deform = [1, 0, 0] }]\n",
       "scene.toml:5:30: 'deform' in key frame 0 of [pin.end] is an array of 3; expected 9 "
       "numbers\n"
       "  remedy: the default is deform = [1, 0, 0, 0, 1, 0, 0, 0, 1]"},
      {BEAM "[obstacle.ball]\nradius = 1\n",
       "scene.toml:3:1: [obstacle.ball] has no 'center', which shape = \"sphere\" needs\n"
       "  remedy: add center (docs/scene-format.md)"},
      {BEAM "[obstacle.table]\nshape = \"box\"\ncenter = [0, 0, 0]\n",
       "scene.toml:3:1: [obstacle.table] has no 'size', which shape = \"box\" needs\n"
       "  remedy: add size (docs/scene-format.md)"},
      {BEAM "[obstacle.o]\nshape = \"plane\"\ncenter = [0, 0, 0]\nradius = 1\n",
       "scene.toml:6:10: 'radius' in [obstacle.o] does not go with shape = \"plane\"\n"
       "  remedy: remove it; it belongs to: sphere, capsule, cylinder"},
      {BEAM "[obstacle.o]\ncenter = [0, 0, 0]\nradius = 1\nrotation = [0, 90, 0]\n",
       "scene.toml:6:12: 'rotation' in [obstacle.o] does not go with shape = \"sphere\"\n"
       "  remedy: remove it; it belongs to: plane, capsule, box, cylinder, mesh"},
      {BEAM "[obstacle.o]\nshape = \"plane\"\ncenter = [0, 0, 0]\nnormal = [0, 1, 0]\n"
            "rotation = [0, 90, 0]\n",
       "scene.toml:7:12: [obstacle.o] has both normal and rotation\n"
       "  remedy: remove one of them"},
      {BEAM "[obstacle.o]\nshape = \"plane\"\ncenter = [0, 0, 0]\nstiffness = 1\n",
       "scene.toml:6:13: 'stiffness' in [obstacle.o] does not go with shape = \"plane\"\n"
       "  remedy: remove it: without a stiffness the obstacle is hard; only a sphere can be soft"},
      {BEAM "[obstacle.o]\ncenter = [0, 0, 0]\nradius = 1\nstiffness = \"sof\"\n",
       "scene.toml:6:13: 'stiffness' in [obstacle.o] is \"sof\"; expected a number or \"soft\" "
       "[N/m3]; did you mean 'soft'?\n"
       "  remedy: docs/scene-format.md says what 'stiffness' takes"},
      {BEAM "[obstacle.o]\ncenter = [0, 0, 0]\nradius = 1\nstiffness = 1\nfriction = 1\n",
       "scene.toml:7:12: 'friction' in [obstacle.o] goes with hard obstacles only, and "
       "[obstacle.o] has a stiffness\n"
       "  remedy: remove it, or remove stiffness"},
      {BEAM "[obstacle.o]\ncenter = [0, 0, 0]\nradius = 1\n"
            "path = [{ time = 1, deform = [2, 0, 0, 0, 1, 0, 0, 0, 1] }]\n",
       "scene.toml:6:8: key frame 0 of [obstacle.o] deforms it\n"
       "  remedy: an obstacle is rigid: use move and turn only"},
      {BEAM "[obstacle.o]\nmesh = \"\"\n",
       "scene.toml:4:8: 'mesh' in [obstacle.o] is empty; expected a file name\n"
       "  remedy: name a surface .off .obj .stl .ply, relative to the scene's folder"},
      {BEAM "[obstacle.a]\ncenter = [0, 0, 0]\nradius = 1\n[probe.a]\nselect = { all = true }\n",
       "scene.toml:3:1: an obstacle and a probe are both called 'a'\n"
       "  remedy: they share the table probes.csv: rename one of them"},
      {BEAM "start = \"flatt\"\n",
       "scene.toml:3:9: 'start' in [body.beam] is \"flatt\"; expected one of \"rest\", \"flat\", "
       "\"inverted\", \"random\"; did you mean 'flat'?\n"
       "  remedy: the default is start = \"rest\""},
      {BEAM "jitter = 0.5\n",
       "scene.toml:3:10: 'jitter' in [body.beam] is 0.5; expected from 0 to 0.45\n"
       "  remedy: the default is jitter = 0"},
      {BEAM "[force.f]\nselect = { all = true }\nforce = [0, 0, 1]\nstart = 2\nend = 1\n",
       "scene.toml:7:7: 'end' in [force.f] is 1, not after its start at 2\n"
       "  remedy: a force acts from start to end, in seconds"},
      {"[body.\"a b\"]\nshape = \"beam\"\n",
       "scene.toml:1:7: 'a b' cannot name a body; expected 1 to 64 letters, digits, '_' or '-'\n"
       "  remedy: names become parts of file names and of --set keys"},
      {"name = \"../evil\"\n" BEAM,
       "scene.toml:1:8: '../evil' cannot name a scene; expected 1 to 128 characters without / and "
       "\\, not starting with a dot\n"
       "  remedy: name = \"...\" in the scene names its folder and files"},
  };
  return scenes;
}

TEST(BadScenes, AreNamedExactly) {
  for (const Bad& bad : bad_scenes())
    EXPECT_EQ(test::parse_error(bad.scene), bad.message) << bad.scene;
}

// What is not TOML: the words are the TOML library's, the place and the remedy are ours.
TEST(BadScenes, MistakesInTomlNameTheLine) {
  const std::vector<Bad> mistakes = {{"title = 'x\n", "scene.toml:1:"},
                                     {"duration = \n", "scene.toml:1:"},
                                     {"[body.a]\nyoung = 1\nyoung = 2\n", "scene.toml:3:"},
                                     {"[body.a]\n[body.a]\n", "scene.toml:2:"},
                                     {"x = {\n", "scene.toml:1:"},
                                     {"duration = 1__0\n", "scene.toml:1:"}};
  const std::string remedy =
      "remedy: scenes are TOML: strings in quotes, key = value, [table] (docs/scene-format.md)";
  for (const Bad& bad : mistakes) {
    const std::string message = test::parse_error(bad.scene);
    EXPECT_TRUE(message.starts_with(bad.message)) << message;
    EXPECT_TRUE(message.ends_with(remedy)) << message;
  }
}

TEST(BadScenes, AreBadInput) {
  for (const Bad& bad : bad_scenes()) {
    try {
      test::parse(bad.scene);
      ADD_FAILURE() << bad.scene;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input) << bad.scene;
      EXPECT_EQ(error.location().file, "scene.toml") << bad.scene;
    }
  }
}

// The fuzzer's seeds: an Error or a scene, never anything else.
TEST(BadScenes, FuzzSeedsEndInAnErrorOrAScene) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_path("fuzz/corpus/scene"))) {
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    EXPECT_NO_THROW(test::parse_error(text.str())) << entry.path();
    ++files;
  }
  EXPECT_GT(files, 10);
}

}  // namespace
}  // namespace sinew
