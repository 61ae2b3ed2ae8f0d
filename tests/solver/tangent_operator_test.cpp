#include "sinew/solver/tangent_operator.h"

#include <gtest/gtest.h>

#include "sinew/forces/stiffness.h"
#include "tests/support/everything.h"
#include "tests/support/forces.h"

namespace sinew {
namespace {

// The product in single precision against the one in double (tests/forces/terms_test.cpp holds
// that against the terms one by one).
TEST(TangentOperator, HasEveryTerm) {
  const test::Everything e;
  const std::vector<Vec3> u = e.free_field();
  std::vector<Vec3> plain(u.size()), product(u.size());
  test::tangent_times(e.at(e.x), 1.0, 0.0, u, Tangent::full, plain);
  TangentOperator matrix(e.model, std::make_shared<PackedLayout>(e.model));
  ForceEvaluator forces(e.model, Precision::double_);
  matrix.assemble({e.model, e.controls}, e.x, e.time, forces);
  Field4 u4(u.size()), out4(u.size());
  for (std::size_t i = 0; i < u.size(); ++i) u4[i] = Float4(u[i]);
  matrix.times(u4, out4);
  for (std::size_t i = 0; i < u.size(); ++i) product[i] = out4[i].vec3();
  EXPECT_LT((test::flat(product) - test::flat(plain)).norm(), 1e-5 * test::flat(plain).norm());
}

}  // namespace
}  // namespace sinew
