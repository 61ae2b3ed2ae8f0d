#include "sinew/study/case.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "sinew/base/vec.h"
#include "sinew/model/material.h"
#include "tests/support/source_dir.h"

namespace sinew::study {
namespace {

namespace fs = std::filesystem;

const fs::path validation = sinew::test::source_path("validation");

class CaseFiles : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / "sinew-case-test";
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "one");
  }
  void TearDown() override { fs::remove_all(folder_); }
  void write(const char* name, const std::string& text) const {
    std::ofstream(folder_ / "one" / name) << text;
  }
  Case load() const { return load_case(folder_, "one"); }
  std::string message() const {
    try {
      load();
    } catch (const Error& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

const std::string good =
    "title = \"t\"\n[[quantity]]\nname = \"tip\"\nkind = \"probe\"\nof = \"tip\"\naxis = \"y\"\n"
    "limit = [0.1, 0.05]\n";
const std::string reference = "source = \"s\"\n[[value]]\nquantity = \"tip\"\nvalue = -1\n";

TEST_F(CaseFiles, WithoutVariantsAndMeshesHasOneOfEach) {
  write("case.toml", good);
  write("reference.toml", reference);
  const Case c = load();
  EXPECT_EQ(c.variants.size(), 1u);
  EXPECT_EQ(c.meshes.size(), 1u);
  EXPECT_EQ(c.laws.size(), 5u);
  ASSERT_NE(c.reference("", "tip"), nullptr);
  EXPECT_EQ(c.reference("", "tip")->value, -1.0);
  EXPECT_EQ(limit_of(c.quantities[0], c.variants[0], 0), 0.1);
  EXPECT_EQ(limit_of(c.quantities[0], c.variants[0], 7), 0.05);
}

TEST_F(CaseFiles, MistakesAreNamed) {
  write("case.toml", good);
  EXPECT_NE(message().find("has no reference values"), std::string::npos);
  write("reference.toml", "[[value]]\nquantity = \"tipp\"\nvalue = 1\n");
  EXPECT_NE(message().find("no quantity 'tipp'; did you mean 'tip'?"), std::string::npos);
  write("reference.toml", "source = \"s\"\n");
  EXPECT_NE(message().find("no reference value for the quantity 'tip'"), std::string::npos);
  write("reference.toml", reference);
  write("case.toml", "title = \"t\"\n[[quantity]]\nname = \"a\"\nkind = \"probee\"\n");
  EXPECT_NE(message().find("unknown kind 'probee'; did you mean 'probe'?"), std::string::npos);
  write("case.toml", good + "axes = 1\n");
  EXPECT_NE(message().find("unknown key 'axes' in [[quantity]]; did you mean 'axis'?"),
            std::string::npos);
  write("case.toml", "laws = [\"loyd\"]\n" + good);
  EXPECT_NE(message().find("unknown law 'loyd'; did you mean 'lloyd'?"), std::string::npos);
}

TEST(Cases, AllWithReferencesLoad) {
  for (const std::string& name : case_names(validation)) {
    if (!fs::exists(validation / name / "reference.toml")) continue;
    EXPECT_FALSE(load_case(validation, name).references.empty()) << name;
  }
  EXPECT_THROW(load_case(validation, "beem"), Error);
}

// P = mu F + (kappa (J - 1) - mu) cof F: what the README of the case says of its reference.
TEST(Cases, PatchReferenceIsTheLawsOwnFormula) {
  Mat3 F;
  F << 1.2, 0.3, -0.1, 0.05, 0.9, 0.2, 0.1, -0.15, 1.1;
  const double J = F.determinant();
  const Mat3 cofactor = J * F.inverse().transpose();
  for (const char* name : {"patch", "patch_liver"}) {
    const Case c = load_case(validation, name);
    for (const double nu : {0.3, 0.45, 0.499}) {
      const double mu = shear_modulus(15e3, nu);
      const double kappa = lame_lambda(15e3, nu) + mu;
      const Mat3 P = mu * F + (kappa * (J - 1.0) - mu) * cofactor;
      const std::string variant = nu == 0.3 ? "nu=0.3" : nu == 0.45 ? "nu=0.45" : "nu=0.499";
      for (const Quantity& q : c.quantities) {
        if (q.kind != Kind::stress) continue;
        const double value = c.reference(variant, q.name)->value;
        EXPECT_NEAR(value, P(q.axis[0] - 'x', q.axis[1] - 'x'), 1e-8 * P.norm()) << q.name;
      }
    }
  }
}

}  // namespace
}  // namespace sinew::study
