#include "sinew/scene/parse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "tests/scene/support.h"
#include "tests/support/source_dir.h"

namespace sinew {
namespace {

using test::error_of;
using test::parse;

TEST(Parse, ReadsEveryKindOfTable) {
  const Scene s = parse(R"(
name = "all"
title = "t"
look_for = "l"
duration = 3
dt = 0.001
substeps = 4
safety = 0.5
allow_unstable = true
gravity = [0, 0, -1]
limit_sweeps = 7
limit_tolerance = 0.01

[body.two]
shape = "ellipsoid"
radii = [1, 2, 3]
resolution = 2
scale = 0.5
center = true
position = [1, 2, 3]
velocity = [4, 5, 6]
spin = [7, 8, 9]
law = "vangelder"
density = 1000
young = 1
poisson = 0
length = "edge"
damping = "published"
damping_ratio = 0.5
drag = 2
stretch_limit = 0.1
compress_limit = 0.2

[body.two.region.r]
labels = [3, -1]
law = "uniform"
spring_stiffness = 10
spring_damping = 20

[body.one]
mesh = "x.mesh"

[pin.p]
body = "two"
select = { label = 3, surface = true }
path = [{ time = 1, move = [1, 0, 0], turn = [0, 0, 180] }, { time = 2 }]
smooth = true
pivot = [1, 1, 1]

[attachment.a]
body = "one"
select = { nearest = [0, 0, 0] }
to_body = "two"
to_select = { face_label = 2 }
stiffness = 5
damping = 6
rest_length = 0

[force.f]
body = "one"
select = { nodes = [0, 5] }
force = [1, 2, 3]
start = 1
end = 2
ramp = 0.5

[probe.q]
body = "one"
select = { node_label = 4 }

[ground]
point = [0, -1, 0]
normal = [0, 2, 0]
restitution = 1
friction = 0

[output]
fps = 10
vtu = false
encoding = "ascii"
checkpoint = 0
)");
  EXPECT_EQ(s.name, "all");
  EXPECT_EQ(s.duration, 3.0);
  EXPECT_EQ(s.dt, 0.001);
  EXPECT_EQ(s.substeps, 4);
  EXPECT_TRUE(s.allow_unstable);
  EXPECT_EQ(s.gravity, Vec3(0, 0, -1));
  EXPECT_EQ(s.limit_sweeps, 7);
  ASSERT_EQ(s.bodies.size(), 2U);
  const SceneBody& b = s.bodies[0];
  EXPECT_EQ(b.name, "two");  // the order of the file
  EXPECT_EQ(b.radii, Vec3(1, 2, 3));
  EXPECT_EQ(b.spin, Vec3(7, 8, 9));
  EXPECT_EQ(b.material.law, Law::vangelder);
  EXPECT_EQ(b.material.length, LloydLength::edge);
  EXPECT_EQ(b.material.damping, Damping::published);
  EXPECT_EQ(b.material.compress_limit, 0.2);
  ASSERT_EQ(b.regions.size(), 1U);
  EXPECT_EQ(b.regions[0].labels, (std::vector<int>{3, -1}));
  EXPECT_EQ(b.regions[0].material.law, Law::uniform);
  EXPECT_EQ(b.regions[0].material.spring_damping, 20.0);
  EXPECT_EQ(b.regions[0].material.drag, 2.0);  // the body's
  ASSERT_EQ(s.pins.size(), 1U);
  EXPECT_EQ(s.pins[0].select.label, 3);
  EXPECT_TRUE(s.pins[0].select.surface);
  EXPECT_NEAR(s.pins[0].path.keys[0].turn.z(), std::numbers::pi, 1e-15);
  EXPECT_TRUE(s.pins[0].path.smooth);
  EXPECT_TRUE(s.pins[0].pivot_given);
  EXPECT_EQ(s.attachments[0].to_body, "two");
  EXPECT_EQ(s.attachments[0].to_select->face_label, 2);
  EXPECT_EQ(s.attachments[0].rest_length, 0.0);
  EXPECT_EQ(s.forces[0].select.nodes, (std::vector<Index>{0, 5}));
  EXPECT_EQ(s.forces[0].end, 2.0);
  EXPECT_EQ(s.probes[0].select.node_label, 4);
  EXPECT_EQ(s.ground->normal, Vec3(0, 1, 0));
  EXPECT_EQ(s.output.encoding, io::VtuEncoding::ascii);
  EXPECT_EQ(parse(s.document).document, s.document);
}

TEST(Parse, DampingByTheMaterial) {
  const Material m = parse("[body.b]\nshape = \"beam\"\ndamping = \"material\"\nviscosity = 50.0\n")
                         .bodies[0]
                         .material;
  EXPECT_EQ(m.damping, Damping::material);
  EXPECT_EQ(m.damping_ratio, 0.1);
  EXPECT_EQ(m.viscosity, 50.0);
}

TEST(Parse, SelectsByPlace) {
  const Scene s = parse(R"(
[body.b]
shape = "beam"
[probe.p]
select = { box = { min = [0, 0, 0], max = [1, 1, 1] }, sphere = { center = [1, 2, 3], radius = 4 }, half_space = { point = [0, 0, 1], normal = [0, 3, 4] }, side = "+y", depth = 0.5 }
)");
  const Selection& select = s.probes[0].select;
  EXPECT_EQ(select.box->max, Vec3(1, 1, 1));
  EXPECT_EQ(select.sphere->radius, 4.0);
  EXPECT_TRUE(select.half_space->normal.isApprox(Vec3(0, 0.6, 0.8)));
  EXPECT_EQ(select.side->axis, 1);
  EXPECT_TRUE(select.side->upper);
  EXPECT_EQ(select.side->depth, 0.5);
  EXPECT_EQ(s.probes[0].body, "b");
}

TEST(Parse, TurnsAboutXThenYThenZ) {
  const auto rotation = [](const std::string& value) {
    return parse("[body.b]\nshape = \"beam\"\nrotation = " + value).bodies[0].rotation;
  };
  EXPECT_TRUE((rotation("[90, 0, 0]") * Vec3(0, 0, 1)).isApprox(Vec3(0, -1, 0)));
  EXPECT_TRUE((rotation("[90, 0, 90]") * Vec3(0, 0, 1)).isApprox(Vec3(1, 0, 0)));
  EXPECT_TRUE((rotation("[0, 90, 90]") * Vec3(0, 0, 1)).isApprox(Vec3(0, 1, 0)));
  const double h = std::sqrt(0.5);
  EXPECT_TRUE(rotation("[2, 2, 0, 0]").isApprox(Eigen::Quaterniond(h, h, 0, 0)));
  EXPECT_TRUE(rotation("[1e300, 1e300, 0, 0]").isApprox(Eigen::Quaterniond(h, h, 0, 0)));
}

TEST(Parse, NamesTheSceneByItsFile) {
  EXPECT_EQ(parse("[body.b]\nshape = \"beam\"\n").name, "scene");
  EXPECT_EQ(parse("name = \"x\"\n[body.b]\nshape = \"beam\"\n").name, "x");
}

TEST(Load, StartsMeshPathsFromTheScenesFolder) {
  const Scene s = load_scene(test::source_path("scenes/beam.toml"));
  EXPECT_EQ(s.base, test::source_path("scenes"));
  EXPECT_EQ(s.name, "beam");
  EXPECT_EQ(s.file, test::source_path("scenes/beam.toml"));
}

TEST(Load, NamesWhatItCannotRead) {
  EXPECT_EQ(error_of([] { load_scene("no/such.toml"); }),
            "no/such.toml: there is no such scene file\n  remedy: check the path");
  EXPECT_EQ(error_of([] { load_scene("/"); }),
            "/: this is no file\n  remedy: name a scene file, such as scenes/beam.toml");
}

}  // namespace
}  // namespace sinew
