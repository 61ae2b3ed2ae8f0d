// One vector per node, and sums over them in an order that does not depend on the thread count.
#pragma once

#include <vector>

#include "sinew/base/vec.h"

namespace sinew {

using Field = std::vector<Vec3>;  // (nodes)

double dot(const Field& a, const Field& b);
void add(Field& x, double a, const Field& y);  // x += a y

}  // namespace sinew
