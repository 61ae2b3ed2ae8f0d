#include "sinew/cut/tear.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "sinew/base/parallel.h"
#include "sinew/cut/release.h"

namespace sinew {
namespace {

constexpr double advance = 1.5;  // of the mean edge: a layer of tets is passed completely
constexpr double most_turn = 70.0 / 180.0 * std::numbers::pi;  // from straight ahead [rad]

Vec3 centroid(const Model& model, Index t) {
  Vec3 sum = Vec3::Zero();
  for (const Index node : model.tets[uz(t)]) sum += model.rest_position[uz(node)];
  return 0.25 * sum;
}

// The unit vector nearest to v among those across the front and at most most_turn from straight
// ahead; straight ahead if v leads backwards.
Vec3 direction(const CrackFront& front, std::size_t s, const Vec3& v) {
  const Vec3& ahead = front.ahead[s];
  const Vec3 up = front.along[s].cross(ahead);
  const double turn = std::clamp(std::atan2(v.dot(up), v.dot(ahead)), -most_turn, most_turn);
  if (v.dot(ahead) <= 0.0) return ahead;
  return std::cos(turn) * ahead + std::sin(turn) * up;
}

// How far the front wants to go at its nodes: zero where it stays.
struct Advance {
  std::vector<Vec3> to;          // unit or zero (nodes of the front)
  std::vector<double> strength;  // release or strain over what it takes [-] (nodes of the front)
};

// The strip that the front passes: from a little behind it to `advance` ahead, where both ends of
// an edge are above the limit in the mean.
CutTriangles strip(const Model& model, const Body& body, std::span<const double> size,
                   const CrackFront& front, const Advance& a) {
  std::vector<char> moves(front.nodes.size(), 0);
  for (const auto& e : front.edges)
    if (0.5 * (a.strength[uz(e[0])] + a.strength[uz(e[1])]) >= 1.0)
      moves[uz(e[0])] = moves[uz(e[1])] = 1;
  CutTriangles out;
  const auto at = [&](std::size_t s) { return model.rest_position[uz(front.nodes[s])]; };
  const auto length = [&](std::size_t s) { return size[uz(front.nodes[s] - body.nodes.begin)]; };
  // Behind, on and ahead of each node; the front itself lies within the strip, so its nodes do not
  // lie on the border. Beyond the ends of the front the strip leaves the body.
  std::vector<std::array<Index, 3>> rows(front.nodes.size());
  const auto add_row = [&](std::size_t s, const Vec3& shift) {
    std::array<Index, 3> row{};
    const auto first = static_cast<Index>(out.vertices.size());
    const Vec3 x = at(s) + shift;
    out.vertices.push_back(x - 0.25 * length(s) * front.ahead[s]);
    out.vertices.push_back(x);
    out.vertices.push_back(x + (moves[s] != 0 ? advance * length(s) : 0.0) * a.to[s]);
    for (std::size_t k = 0; k < 3; ++k) row[k] = first + static_cast<Index>(k);
    return row;
  };
  const auto join = [&](const std::array<Index, 3>& p, const std::array<Index, 3>& q) {
    for (std::size_t k = 0; k < 2; ++k) {
      out.triangles.push_back({p[k], q[k], q[k + 1]});
      out.triangles.push_back({p[k], q[k + 1], p[k + 1]});
    }
  };
  for (std::size_t s = 0; s < front.nodes.size(); ++s) rows[s] = add_row(s, Vec3::Zero());
  for (const auto& e : front.edges) {
    const auto p = uz(e[0]), q = uz(e[1]);
    if (moves[p] == 0 && moves[q] == 0) continue;
    join(rows[p], rows[q]);
    for (const auto& [end, inner] : {std::pair{p, q}, std::pair{q, p}}) {
      if (front.ends[end] == 0 || moves[end] == 0) continue;
      const Vec3 out_of = (at(end) - at(inner)).normalized();
      join(rows[end], add_row(end, length(end) * out_of));
    }
  }
  return out;
}

// The largest principal strain of a mean of F^T F, and its direction in the rest shape.
struct Strain {
  double value = 0.0;  // [-]
  Vec3 along = Vec3::Zero();
};

Strain largest_strain(const Mat3& mean) {
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(mean);
  return {std::sqrt(std::max(0.0, eigen.eigenvalues()[2])) - 1.0, eigen.eigenvectors().col(2)};
}

// The material of a body at its nodes and tets, and the deformation of its tets.
class TearingBody {
 public:
  TearingBody(const Model& model, const Body& body, const CutBody& part, const CrackFront& front,
              std::span<const Vec3> x)
      : model_(model), body_(body), part_(part), front_(front), x_(x) {
    size_ = std::cbrt(body.rest_volume);
    if (front.empty()) return;
    tets_at_.resize(front.nodes.size());
    for (Index t = body.tets.begin; t < body.tets.end; ++t)
      for (const Index node : model.tets[uz(t)]) {
        const auto at = std::lower_bound(front.nodes.begin(), front.nodes.end(), node);
        if (at != front.nodes.end() && *at == node)
          tets_at_[static_cast<std::size_t>(at - front.nodes.begin())].push_back(t);
      }
  }

  // Of the tets at a node of the front, the mean; infinite where none has it.
  double mean_at(std::size_t s, double Material::*value) const {
    double sum = 0.0, volume = 0.0;
    for (const Index t : tets_at_[s]) {
      const double v = material(t).*value;
      if (v == no_limit) continue;
      sum += model_.rest_volume[uz(t)] * v;
      volume += model_.rest_volume[uz(t)];
    }
    return volume > 0.0 ? sum / volume : no_limit;
  }

  std::optional<Tear> by_energy() {
    if (front_.empty() || !any(&Material::tear_energy)) return std::nullopt;
    const std::vector<Vec3> release = measure_release(model_, body_, part_.node_size, front_, x_);
    std::vector<double> needed;
    double most = 0.0;  // of release over what it takes, whatever its direction
    for (std::size_t s = 0; s < release.size(); ++s) {
      needed.push_back(mean_at(s, &Material::tear_energy));
      most = std::max(most, release[s].norm() / needed[s]);
    }
    if (most < 1.0) return std::nullopt;
    measure_stretch_of_tets();
    Advance a;
    double energy = 0.0;
    for (std::size_t s = 0; s < release.size(); ++s) {
      const double r = 0.5 * front_reach * size_at(s);
      a.to.push_back(across_stretch(s, largest_strain(mean_ahead(s, r)).along));
      a.strength.push_back(needed[s] < no_limit ? release[s].dot(a.to[s]) / needed[s] : 0.0);
      if (a.strength[s] >= 1.0) energy = std::max(energy, needed[s]);
    }
    return made(strip(model_, body_, part_.node_size, front_, a), energy);
  }

  std::optional<Tear> by_strain() {
    if (!any(&Material::tear_strain)) return std::nullopt;
    measure_stretch_of_tets();
    if (!front_.empty()) {
      if (std::optional<Tear> tear = front_by_strain()) return tear;
    }
    return from_nothing();
  }

 private:
  const Material& material(Index t) const {
    const std::vector<int>& region = part_.spec.tet_region;
    return part_.spec
        .materials[region.empty() ? 0 : static_cast<std::size_t>(region[uz(t - body_.tets.begin)])];
  }
  bool any(double Material::*value) const {
    return std::any_of(part_.spec.materials.begin(), part_.spec.materials.end(),
                       [&](const Material& m) { return m.*value < no_limit; });
  }
  double size_at(std::size_t s) const {
    return part_.node_size[uz(front_.nodes[s] - body_.nodes.begin)];
  }
  void measure_stretch_of_tets() {
    if (!stretch_.empty()) return;
    stretch_.resize(uz(body_.tets.size()));
    place_.resize(stretch_.size());
    parallel_for(body_.tets.size(), [&](Index i) {
      const Mat3 F = gradient_of_tet(model_, x_, body_.tets.begin + i);
      stretch_[uz(i)] = F.transpose() * F;
      place_[uz(i)] = centroid(model_, body_.tets.begin + i);
    });
  }
  // Where node s of the front goes: across the front and the direction of the largest stretch.
  Vec3 across_stretch(std::size_t s, const Vec3& stretch) const {
    const Vec3 to = stretch.cross(front_.along[s]);
    if (!(to.norm() > 0.1)) return front_.ahead[s];
    return direction(front_, s, to.dot(front_.ahead[s]) < 0.0 ? Vec3(-to) : to);
  }
  double length_of(const Material& m) const {
    return m.tear_length > 0.0 ? m.tear_length : 0.1 * size_;
  }

  // The mean of F^T F over the tets whose centres are in the ball; of the nearest if none is.
  Mat3 mean_in(const Vec3& center, double radius) const {
    Mat3 sum = Mat3::Zero();
    double volume = 0.0, least = no_limit;
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < place_.size(); ++i) {
      const double square = (place_[i] - center).squaredNorm();
      if (square < least) {
        least = square;
        nearest = i;
      }
      if (square > radius * radius) continue;
      const double v = model_.rest_volume[uz(body_.tets.begin) + i];
      sum += v * stretch_[i];
      volume += v;
    }
    return volume > 0.0 ? Mat3(sum / volume) : stretch_[nearest];
  }

  // Over balls ahead of node s of the front and the nodes near it.
  Mat3 mean_ahead(std::size_t s, double radius) const {
    Mat3 sum = Mat3::Zero();
    for (const Index o : front_.near[s]) {
      const Index node = front_.nodes[uz(o)];
      sum += mean_in(model_.rest_position[uz(node)] + radius * front_.ahead[s], radius);
    }
    return sum / static_cast<double>(front_.near[s].size());
  }

  std::optional<Tear> front_by_strain() const {
    Advance a;
    for (std::size_t s = 0; s < front_.nodes.size(); ++s) {
      const double limit = mean_at(s, &Material::tear_strain);
      a.to.push_back(front_.ahead[s]);
      a.strength.push_back(0.0);
      if (limit == no_limit) continue;
      const double r = 0.5 * length_of(material(tets_at_[s].front()));
      const Strain strain = largest_strain(mean_ahead(s, r));
      a.strength[s] = strain.value / limit;
      a.to[s] = across_stretch(s, strain.along);
    }
    return made(strip(model_, body_, part_.node_size, front_, a), 0.0);
  }

  // Where no front is near, a disc opens at the largest strain.
  std::optional<Tear> from_nothing() const {
    double most = 1.0;
    Index where = -1;
    Strain there;
    for (std::size_t i = 0; i < stretch_.size(); ++i) {
      const Index t = body_.tets.begin + static_cast<Index>(i);
      const Material& m = material(t);
      if (m.tear_strain == no_limit || largest_strain(stretch_[i]).value < most * m.tear_strain ||
          near_front(place_[i], length_of(m)))
        continue;
      const Strain mean = largest_strain(mean_in(place_[i], 0.5 * length_of(m)));
      if (mean.value < most * m.tear_strain) continue;
      most = mean.value / m.tear_strain;
      where = static_cast<Index>(i);
      there = mean;
    }
    if (where < 0) return std::nullopt;
    const Index t = body_.tets.begin + where;
    double edge = 0.0;
    for (const Index node : model_.tets[uz(t)])
      edge += 0.25 * part_.node_size[uz(node - body_.nodes.begin)];
    const double radius = std::max(0.5 * length_of(material(t)), 1.2 * edge);
    return made(disc_surface(place_[uz(where)], there.along, radius, 16), 0.0);
  }

  bool near_front(const Vec3& place, double length) const {
    return std::any_of(front_.nodes.begin(), front_.nodes.end(), [&](Index node) {
      const double size = part_.node_size[uz(node - body_.nodes.begin)];
      return (model_.rest_position[uz(node)] - place).norm() < length + size;
    });
  }

  static std::optional<Tear> made(CutTriangles surface, double energy) {
    if (surface.triangles.empty()) return std::nullopt;
    Tear tear{std::move(surface), {}, energy};
    for (const Triangle& t : tear.surface.triangles)
      for (const Index v : t) tear.box.add(tear.surface.vertices[uz(v)]);
    return tear;
  }

  const Model& model_;
  const Body& body_;
  const CutBody& part_;
  const CrackFront& front_;
  std::span<const Vec3> x_;
  double size_ = 0.0;                        // of the body [m]
  std::vector<std::vector<Index>> tets_at_;  // (nodes of the front)
  std::vector<Mat3> stretch_;                // F^T F (tets of the body)
  std::vector<Vec3> place_;                  // centroids at rest [m] (tets of the body)
};

}  // namespace

std::optional<Tear> find_tear(const Model& model, const Body& body, const CutBody& part,
                              const CrackFront& front, std::span<const Vec3> x) {
  TearingBody tearing(model, body, part, front, x);
  if (std::optional<Tear> tear = tearing.by_energy()) return tear;
  return tearing.by_strain();
}

}  // namespace sinew
