#include "sinew/solver/two_level.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "sinew/base/rotation.h"
#include "sinew/mesh/bisect.h"
#include "sinew/solver/rest_forms.h"

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
  inverse_now_.resize(group_.size());
}

namespace {

// A symmetric positive definite 3 x 3 matrix near m; m itself if it is one.
Mat3 definite(const Mat3& m) {
  const Mat3 s = 0.5 * (m + m.transpose());
  const double mean = s.trace() / 3.0;
  if (s(0, 0) > 0.0 && s.topLeftCorner<2, 2>().determinant() > 0.0 &&
      s.determinant() > 1e-9 * mean * mean * mean) {
    return s;
  }
  return (mean > 0.0 ? mean : 1.0) * Mat3::Identity();
}

// The blocks of Q^T K Q of the lower triangle, by columns.
class CoarseBlocks {
 public:
  explicit CoarseBlocks(std::size_t groups) : column_(groups) {}
  CoarseBlock& at(Index row, Index col) {
    const auto [entry, added] = column_[uz(col)].try_emplace(row);
    if (added) entry->second.setZero();
    return entry->second;
  }
  template <class F>
  void for_each(const F& f) const {
    for (std::size_t col = 0; col < column_.size(); ++col)
      for (const auto& [row, block] : column_[col]) f(row, static_cast<Index>(col), block);
  }
  std::vector<std::map<Index, CoarseBlock>>&& take() { return std::move(column_); }

 private:
  std::vector<std::map<Index, CoarseBlock>> column_;
};

// What a form's nodes in one group add up to: one value of type T for each of the four motions.
template <class T>
struct Shares {
  Index group;
  std::array<T, 4> motion;
};

// Sums value_a times the motions of the nodes a in the same group.
template <class T, class Values>
void sum_by_group(std::span<const Index> nodes, const Values& values,
                  const std::vector<Index>& group, const std::vector<Eigen::Vector4f>& shape,
                  const T& zero, std::vector<Shares<T>>& sums) {
  sums.clear();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const Index g = group[uz(nodes[a])];
    if (g < 0) continue;
    auto found = std::find_if(sums.begin(), sums.end(),
                              [&](const Shares<T>& share) { return share.group == g; });
    if (found == sums.end()) {
      sums.push_back({g, {zero, zero, zero, zero}});
      found = sums.end() - 1;
    }
    for (int p = 0; p < 4; ++p)
      found->motion[static_cast<std::size_t>(p)] +=
          static_cast<double>(shape[uz(nodes[a])][p]) * values[a];
  }
}

// Calls f(row shares, column shares, block) for all pairs of groups of a form.
template <class T, class F>
void for_each_group_pair(const std::vector<Shares<T>>& sums, CoarseBlocks& blocks, const F& f) {
  for (const Shares<T>& row : sums) {
    for (const Shares<T>& col : sums) {
      if (row.group >= col.group) f(row.motion, col.motion, blocks.at(row.group, col.group));
    }
  }
}

// With the twelve numbers G of a cell's group, a vector G_p for each motion p, the cell's block of
// motions p and q is shear (G_p . G_q 1 + G_q G_p^T) + volume G_p G_q^T: it follows from the sums
// of shear G G^T and of volume G G^T over all cells.
using Twelve = Eigen::Matrix<double, coarse_size, 1>;

void add_outer(double weight, const std::array<Vec3, 4>& row, const std::array<Vec3, 4>& col,
               CoarseBlock& sum) {
  const Eigen::Map<const Twelve> g(row[0].data()), h(col[0].data());
  sum.noalias() += (weight * g) * h.transpose();
}

CoarseBlock block_of(const CoarseBlock& shear) {
  CoarseBlock out;
  for (int p = 0; p < coarse_size; p += 3) {
    for (int q = 0; q < coarse_size; q += 3) {
      const Mat3 sum = shear.block<3, 3>(p, q);
      out.block<3, 3>(p, q) = sum.trace() * Mat3::Identity() + sum.transpose();
    }
  }
  return out;
}

}  // namespace

void TwoLevel::factor(const Objective& rest, double time) {
  CoarseBlocks blocks(centre_.size()), shear(centre_.size()), volume(centre_.size());
  diagonal_.assign(group_.size(), Mat3::Zero());
  std::vector<Shares<Vec3>> of_cell;
  std::vector<Shares<double>> of_element;
  for_each_rest_form(
      rest, time,
      [&](const CellForm& cell) {
        for (std::size_t a = 0; a < cell.nodes.size(); ++a) {
          const Vec3& g = cell.gradients[a];
          Mat3& own = diagonal_[uz(cell.nodes[a])];
          own += ((cell.shear + cell.volume) * g) * g.transpose();
          own.diagonal().array() += cell.shear * g.squaredNorm();
        }
        sum_by_group(cell.nodes, cell.gradients, group_, shape_, Vec3(Vec3::Zero()), of_cell);
        for (const auto& [weight, sums] : {std::pair{cell.shear, &shear}, {cell.volume, &volume}}) {
          if (weight == 0.0) continue;
          for_each_group_pair(of_cell, *sums, [&](const auto& row, const auto& col, auto& sum) {
            add_outer(weight, row, col, sum);
          });
        }
      },
      [&](std::span<const Index> nodes, std::span<const double> weights, const Mat3& block,
          bool of_material) {
        for (std::size_t a = 0; of_material && a < nodes.size(); ++a)
          diagonal_[uz(nodes[a])] += weights[a] * weights[a] * block;
        sum_by_group(nodes, weights, group_, shape_, 0.0, of_element);
        for_each_group_pair(of_element, blocks, [&](const auto& v, const auto& w, auto& sum) {
          for (int p = 0; p < 4; ++p) {
            for (int q = 0; q < 4; ++q)
              sum.template block<3, 3>(3 * p, 3 * q) += v[uz(p)] * w[uz(q)] * block;
          }
        });
      });
  shear.for_each([&](Index row, Index col, const CoarseBlock& of_shear) {
    blocks.at(row, col) += block_of(of_shear);
  });
  volume.for_each([&](Index row, Index col, const CoarseBlock& of_volume) {
    blocks.at(row, col) += of_volume;
  });
  for (Index g = 0; g < group_count(); ++g) {
    CoarseBlock& b = blocks.at(g, g);
    const double mean = b.trace() / coarse_size;
    for (int p = 0; p < coarse_size; ++p) {
      b(p, p) = b(p, p) > 0.0 ? b(p, p) + regularisation * mean : 1.0;
    }
  }
  factor_ = std::make_unique<BlockCholesky>(blocks.take());
  inverse_.assign(group_.size(), Mat3::Zero());
  for (std::size_t i = 0; i < group_.size(); ++i)
    if (group_[i] >= 0) inverse_[i] = definite(diagonal_[i]).inverse();
}

void TwoLevel::turn(const Field& x, const std::vector<Mat3>& outer) {
  parallel_for(group_count(), [&](Index g) {
    Vec3 middle = Vec3::Zero();
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) middle += x[uz(nodes_[k])];
    middle /= static_cast<double>(start_[uz(g) + 1] - start_[uz(g)]);
    Mat3 moment = Mat3::Zero();
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) {
      const auto i = uz(nodes_[k]);
      moment += (x[i] - middle) * (model_.rest_position[i] - centre_[uz(g)]).transpose();
    }
    const Mat3 R = nearest_rotation(moment);
    rotation_[uz(g)] = R;
    for (auto k = uz(start_[uz(g)]); k < uz(start_[uz(g) + 1]); ++k) {
      const auto i = uz(nodes_[k]);
      if (outer.empty() || outer[i].isZero(0.0)) {
        inverse_now_[i] = Block3(Mat3(R * inverse_[i] * R.transpose()));
      } else {
        const Mat3 sum = R * diagonal_[i] * R.transpose() + outer[i];
        inverse_now_[i] = Block3(Mat3(definite(sum).inverse()));
      }
    }
  });
}

double TwoLevel::apply(const Field4& r, Field4& z) {
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
      Float4 sum = inverse_now_[i] * r[i];
      for (int p = 0; p < 4; ++p) sum += shape_[i][p] * motion[p];
      z[i] = sum;
    }
  });
  return dot(r, z);
}

}  // namespace sinew
