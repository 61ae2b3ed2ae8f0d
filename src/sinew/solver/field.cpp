#include "sinew/solver/field.h"

#include "sinew/base/parallel.h"

namespace sinew {

double dot(const Field& a, const Field& b) {
  return parallel_sum(static_cast<Index>(a.size()),
                      [&](Index i) { return a[uz(i)].dot(b[uz(i)]); });
}

void add(Field& x, double a, const Field& y) {
  parallel_for(static_cast<Index>(x.size()), [&](Index i) { x[uz(i)] += a * y[uz(i)]; });
}

}  // namespace sinew
