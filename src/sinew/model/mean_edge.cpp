#include "sinew/model/mean_edge.h"

#include <numeric>
#include <vector>

namespace sinew {

double mean_edge(const Model& model) {
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  if (!model.tets.empty()) return regular_tet_edge(mean(model.rest_volume));
  return model.springs.empty() ? 0.0 : mean(model.rest_length);
}

}  // namespace sinew
