#include "sinew/solver/two_level.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>

#include "sinew/base/rotation.h"
#include "sinew/mesh/bisect.h"

namespace sinew {
namespace {

// The number of groups is small enough that their system costs less than a product with K, and
// large enough that the iterations do not grow with the mesh.
constexpr Index smallest_group = 90;
constexpr Index most_groups = 200;

// Share of the diagonal that is added, so that the coarse matrix of a body that nothing holds is
// not singular.
constexpr double regularisation = 1e-5;

// The free nodes by body and by the region whose tets are stiffest at the node.
std::map<std::pair<Index, int>, std::vector<Index>> nodes_by_region(const Model& model) {
  std::vector<std::map<int, double>> hold(model.rest_position.size());
  for (std::size_t t = 0; t < model.tets.size(); ++t) {
    for (const Index i : model.tets[t]) {
      if (model.inverse_mass[uz(i)] == 0.0) continue;
      hold[uz(i)][model.tet_region[t]] += model.tet_modulus[t] * model.rest_volume[t];
    }
  }
  std::map<std::pair<Index, int>, std::vector<Index>> nodes;
  Index body = 0;
  for (Index i = 0; i < model.body_node_count(); ++i) {
    while (!model.bodies[uz(body)].nodes.contains(i)) ++body;
    if (model.inverse_mass[uz(i)] == 0.0) continue;
    const auto stiffest =
        std::max_element(hold[uz(i)].begin(), hold[uz(i)].end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    nodes[{body, stiffest == hold[uz(i)].end() ? 0 : stiffest->first}].push_back(i);
  }
  return nodes;
}

}  // namespace

TwoLevel::TwoLevel(const Model& model, Index group_size) : model_(model) {
  Index most = group_size;
  if (most == 0) most = std::max(smallest_group, model.node_count() / most_groups);
  std::vector<std::vector<Index>> groups;
  for (auto& [region, nodes] : nodes_by_region(model)) {
    for (const std::span<Index> part : bisect(model.rest_position, nodes, most)) {
      groups.emplace_back(part.begin(), part.end());
    }
  }

  group_.assign(model.rest_position.size(), -1);
  shape_.assign(model.rest_position.size(), Eigen::Vector4f::Zero());
  start_.push_back(0);
  for (std::vector<Index>& nodes : groups) {
    std::sort(nodes.begin(), nodes.end());
    Vec3 centre = Vec3::Zero();
    for (const Index i : nodes) centre += model.rest_position[uz(i)];
    centre /= static_cast<double>(nodes.size());
    Mat3 spread = Mat3::Zero();
    for (const Index i : nodes) {
      const Vec3 d = model.rest_position[uz(i)] - centre;
      spread += d * d.transpose();
    }
    spread /= static_cast<double>(nodes.size());
    // Linear motions along the group's principal axes; none along an axis without extent.
    const Eigen::SelfAdjointEigenSolver<Mat3> eigen(spread);
    for (const Index i : nodes) {
      group_[uz(i)] = static_cast<Index>(centre_.size());
      Eigen::Vector4f& shape = shape_[uz(i)];
      shape[0] = 1.0f;
      for (int a = 0; a < 3; ++a) {
        const double width2 = eigen.eigenvalues()[a];
        if (width2 <= 1e-6 * eigen.eigenvalues()[2]) continue;
        shape[a + 1] = static_cast<float>(
            eigen.eigenvectors().col(a).dot(model.rest_position[uz(i)] - centre) /
            std::sqrt(width2));
      }
    }
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    start_.push_back(static_cast<Index>(nodes_.size()));
    centre_.push_back(centre);
  }
  rotation_.assign(centre_.size(), Mat3::Identity());
  coarse_.resize(centre_.size());
}

void TwoLevel::factor(const TangentMatrix& rest) {
  std::vector<std::map<Index, CoarseBlock>> column(centre_.size());
  const auto block = [&](Index row, Index col) -> CoarseBlock& {
    const auto [entry, added] = column[uz(col)].try_emplace(row);
    if (added) entry->second.setZero();
    return entry->second;
  };
  rest.for_each_block([&](Index i, Index j, const Mat3& k) {
    const Index gi = group_[uz(i)];
    const Index gj = group_[uz(j)];
    if (gi < gj || gj < 0) return;
    CoarseBlock& b = block(gi, gj);
    for (int p = 0; p < 4; ++p) {
      for (int q = 0; q < 4; ++q) {
        const double weight =
            static_cast<double>(shape_[uz(i)][p]) * static_cast<double>(shape_[uz(j)][q]);
        b.block<3, 3>(3 * p, 3 * q) += weight * k;
      }
    }
  });
  using Row = Eigen::Matrix<double, coarse_size, 1>;
  std::map<Index, Row> rate;  // of the cell's volume, for the motions of a group
  rest.for_each_cell(
      [&](double stiffness, std::span<const Index> nodes, std::span<const Float4> gradients) {
        rate.clear();
        for (std::size_t k = 0; k < nodes.size(); ++k) {
          const Index g = group_[uz(nodes[k])];
          if (g < 0) continue;
          const auto [entry, added] = rate.try_emplace(g);
          if (added) entry->second.setZero();
          for (int p = 0; p < 4; ++p) {
            entry->second.segment<3>(3 * p) +=
                static_cast<double>(shape_[uz(nodes[k])][p]) * gradients[k].vec3();
          }
        }
        for (const auto& [gj, rj] : rate) {
          for (const auto& [gi, ri] : rate) {
            if (gi >= gj) block(gi, gj).noalias() += stiffness * ri * rj.transpose();
          }
        }
      });
  for (Index g = 0; g < group_count(); ++g) {
    CoarseBlock& b = block(g, g);
    const double mean = b.trace() / coarse_size;
    for (int p = 0; p < coarse_size; ++p) {
      b(p, p) = b(p, p) > 0.0 ? b(p, p) + regularisation * mean : 1.0;
    }
  }
  factor_ = std::make_unique<BlockCholesky>(std::move(column));
}

void TwoLevel::turn(const Field& x) {
  parallel_for(group_count(), [&](Index g) {
    Vec3 middle = Vec3::Zero();
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) middle += x[uz(nodes_[k])];
    middle /= static_cast<double>(start_[uz(g) + 1] - start_[uz(g)]);
    Mat3 moment = Mat3::Zero();
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) {
      const auto i = uz(nodes_[k]);
      moment += (x[i] - middle) * (model_.rest_position[i] - centre_[uz(g)]).transpose();
    }
    rotation_[uz(g)] = nearest_rotation(moment);
  });
}

double TwoLevel::apply(const TangentMatrix& matrix, const Field4& r, Field4& z) {
  parallel_for(group_count(), [&](Index g) {
    const Block3 back(Mat3(rotation_[uz(g)].transpose()));
    Float4 sum[4];
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) {
      const auto i = uz(nodes_[k]);
      for (int p = 0; p < 4; ++p) sum[p] += shape_[i][p] * r[i];
    }
    for (int p = 0; p < 4; ++p) {
      const Float4 turned = back * sum[p];
      for (int c = 0; c < 3; ++c) coarse_[uz(g)][3 * p + c] = turned.lanes[c];
    }
  });
  factor_->solve(coarse_);
  parallel_for(group_count(), [&](Index g) {
    const Block3 there(rotation_[uz(g)]);
    Float4 motion[4];
    for (int p = 0; p < 4; ++p) {
      const CoarseVector& c = coarse_[uz(g)];
      motion[p] = there * Float4(Float4::Lanes{c[3 * p], c[3 * p + 1], c[3 * p + 2], 0.0f});
    }
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) {
      const auto i = uz(nodes_[k]);
      Float4 sum = matrix.inverse_diagonal()[i] * r[i];
      for (int p = 0; p < 4; ++p) sum += shape_[i][p] * motion[p];
      z[i] = sum;
    }
  });
  return dot(r, z);
}

}  // namespace sinew
