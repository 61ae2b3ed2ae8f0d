#include "sinew/scene/tissues.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/scene/support.h"

namespace sinew {
namespace {

TEST(Tissues, AreCompleteAndPlausible) {
  ASSERT_GE(tissues().size(), 10U);
  std::set<std::string> names;
  for (const Tissue& t : tissues()) {
    EXPECT_TRUE(names.insert(t.name).second) << t.name;
    EXPECT_TRUE(names.rbegin()->compare(t.name) == 0) << t.name << " is out of order";
    EXPECT_FALSE(t.title.empty() || t.conditions.empty() || t.sources.empty()) << t.name;
    EXPECT_GT(t.young_lowest, 100.0) << t.name;
    EXPECT_LT(t.young_lowest, t.young_highest) << t.name;
    EXPECT_GE(t.young, t.young_lowest) << t.name;
    EXPECT_LE(t.young, t.young_highest) << t.name;
    EXPECT_LE(t.young_highest, 1e10) << t.name;
    EXPECT_GE(t.poisson, 0.4) << t.name;
    EXPECT_LT(t.poisson, 0.5) << t.name;
    EXPECT_GE(t.density, 900.0) << t.name;
    EXPECT_LE(t.density, 1200.0) << t.name;
    if (t.loss_factor) {
      EXPECT_TRUE(*t.loss_factor > 0.0 && *t.loss_factor < 1.0) << t.name;
    }
    for (const TissueSource& s : t.sources) {
      EXPECT_FALSE(s.authors.empty() || s.title.empty() || s.journal.empty()) << t.name;
      EXPECT_TRUE(s.year > 1900 && s.year < 2100) << t.name;
      EXPECT_FALSE(s.says.empty()) << t.name << ", " << s.authors;
      EXPECT_TRUE(s.doi.empty() || s.doi.starts_with("10.")) << s.doi;
    }
  }
}

TEST(Tissues, AreFoundByName) {
  ASSERT_NE(find_tissue("liver"), nullptr);
  EXPECT_EQ(find_tissue("liver")->name, "liver");
  EXPECT_EQ(find_tissue("Liver"), nullptr);
  EXPECT_EQ(unknown_tissue_message("silicone gel"),
            "there is no material 'silicone gel'; did you mean 'silicone-gel'?");
  EXPECT_EQ(unknown_tissue_message("granite"), "there is no material 'granite'");
  EXPECT_NE(tissue_names().find("kidney, ligament, liver, muscle"), std::string::npos);
}

TEST(Tissues, SetTheMaterialOfABody) {
  const Scene scene = test::parse("[body.b]\nshape = \"box\"\nmaterial = \"fat\"\ndrag = 2\n");
  const Material& m = scene.bodies[0].material;
  const Tissue& fat = *find_tissue("fat");
  EXPECT_EQ(m.young, fat.young);
  EXPECT_EQ(m.poisson, fat.poisson);
  EXPECT_EQ(m.density, fat.density);
  EXPECT_EQ(m.drag, 2.0);
  EXPECT_EQ(m.damping_ratio, Material{}.damping_ratio);
}

TEST(Tissues, YieldToWhatTheSameTableStates) {
  const std::string text = "[body.b]\nshape = \"box\"\nyoung = 4e3\nmaterial = \"fat\"\n";
  const Tissue& fat = *find_tissue("fat");
  const Scene scene = test::parse(text);
  EXPECT_EQ(scene.bodies[0].material.young, 4e3);
  EXPECT_EQ(scene.bodies[0].material.density, fat.density);
  const Scene changed = test::parse(text, {"b.material=liver", "b.density=1000"});
  EXPECT_EQ(changed.bodies[0].material.young, 4e3);
  EXPECT_EQ(changed.bodies[0].material.density, 1000.0);
  EXPECT_EQ(test::parse(changed.document).bodies[0].material.density, 1000.0);
}

// A region's tissue stands above everything of the body, which the region only fills up from.
TEST(Tissues, SetTheMaterialOfARegion) {
  const Scene scene = test::parse(
      "[body.b]\nshape = \"box\"\nmaterial = \"liver\"\nyoung = 8e3\ndamping_ratio = 0.3\n"
      "[body.b.region.fat]\nlabel = 1\nmaterial = \"fat\"\n"
      "[body.b.region.soft]\nlabel = 2\nyoung = 1e3\n");
  const Material& fat = scene.bodies[0].regions[0].material;
  EXPECT_EQ(fat.young, find_tissue("fat")->young);
  EXPECT_EQ(fat.density, find_tissue("fat")->density);
  EXPECT_EQ(fat.damping_ratio, 0.3);
  const Material& soft = scene.bodies[0].regions[1].material;
  EXPECT_EQ(soft.young, 1e3);
  EXPECT_EQ(soft.density, find_tissue("liver")->density);
}

TEST(Tissues, UnknownNamesAreErrors) {
  const std::string message =
      test::parse_error("[body.b]\nshape = \"box\"\nmaterial = \"kidny\"\n");
  EXPECT_EQ(message,
            "scene.toml:3:12: 'material' in [body.b]: there is no material 'kidny'; did "
            "you mean 'kidney'?\n  remedy: 'sinew materials' shows them all: " +
                tissue_names());
  EXPECT_NE(test::parse_error("[body.b]\nshape = \"box\"\nmaterial = 3\n")
                .find("'material' in [body.b] is 3; expected a text"),
            std::string::npos);
}

}  // namespace
}  // namespace sinew
