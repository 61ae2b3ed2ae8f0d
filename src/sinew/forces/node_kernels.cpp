#include "sinew/forces/node_kernels.h"

#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/forces/node_kernels.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Three doubles: the lower lanes of a vector with the fourth zero, or single values if the
// instruction set has no vectors of four.
#if HWY_MAX_BYTES >= 32

using Wide = hn::CappedTag<double, 4>;
using Narrow = hn::Rebind<float, Wide>;
struct Three {
  hn::Vec<Wide> v;
};

HWY_INLINE Three operator+(const Three& a, const Three& b) {
  return {hn::Add(a.v, b.v)};
}
HWY_INLINE Three operator-(const Three& a, const Three& b) {
  return {hn::Sub(a.v, b.v)};
}
HWY_INLINE Three operator*(double s, const Three& a) {
  return {hn::Mul(hn::Set(Wide(), s), a.v)};
}
HWY_INLINE Three load(const Vec3& x) {
  return {hn::MaskedLoad(hn::FirstN(Wide(), 3), Wide(), x.data())};
}
HWY_INLINE Three load(const float* four) {
  return {hn::PromoteTo(Wide(), hn::LoadU(Narrow(), four))};
}
HWY_INLINE void store(const Three& a, Vec3& x) {
  hn::BlendedStore(a.v, hn::FirstN(Wide(), 3), Wide(), x.data());
}
HWY_INLINE void store(const Three& a, float* four) {
  hn::StoreU(hn::DemoteTo(Narrow(), a.v), Narrow(), four);
}
HWY_INLINE bool is_within(const Three& a, double farthest) {
  return hn::AllTrue(Wide(), hn::Le(hn::Abs(a.v), hn::Set(Wide(), farthest)));
}

#else

struct Three {
  double c[3];
};

HWY_INLINE Three operator+(const Three& a, const Three& b) {
  return {{a.c[0] + b.c[0], a.c[1] + b.c[1], a.c[2] + b.c[2]}};
}
HWY_INLINE Three operator-(const Three& a, const Three& b) {
  return {{a.c[0] - b.c[0], a.c[1] - b.c[1], a.c[2] - b.c[2]}};
}
HWY_INLINE Three operator*(double s, const Three& a) {
  return {{s * a.c[0], s * a.c[1], s * a.c[2]}};
}
HWY_INLINE Three load(const Vec3& x) {
  return {{x[0], x[1], x[2]}};
}
HWY_INLINE Three load(const float* four) {
  return {{double{four[0]}, double{four[1]}, double{four[2]}}};
}
HWY_INLINE void store(const Three& a, Vec3& x) {
  x = Vec3(a.c[0], a.c[1], a.c[2]);
}
HWY_INLINE void store(const Three& a, float* four) {
  for (int c = 0; c < 3; ++c) four[c] = static_cast<float>(a.c[c]);
  four[3] = 0.0f;
}
HWY_INLINE bool is_within(const Three& a, double farthest) {
  return std::abs(a.c[0]) <= farthest && std::abs(a.c[1]) <= farthest &&
         std::abs(a.c[2]) <= farthest;
}

#endif

// R^T x; the rows of R are the columns of R^T.
struct TurnBack {
  explicit TurnBack(const Mat3& R)
      : row{load(Vec3(R.row(0))), load(Vec3(R.row(1))), load(Vec3(R.row(2)))} {}
  HWY_INLINE Three operator()(const Vec3& x, const Vec3& from) const {
    return (x[0] - from[0]) * row[0] + (x[1] - from[1]) * row[1] + (x[2] - from[2]) * row[2];
  }
  Three row[3];
};

void displacements(const Frame& frame, std::span<const Index> nodes, const Model& model,
                   const Vec3* x, float* u) {
  const TurnBack turn_back(frame.rotation);
  const Three rest_centre = load(frame.rest_centre);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k] < 0) continue;
    const auto i = uz(nodes[k]);
    store(turn_back(x[i], frame.centre) - (load(model.rest_position[i]) - rest_centre), u + 4 * k);
  }
}

void velocities(const Frame& frame, std::span<const Index> nodes, const Vec3* w, float* v) {
  const TurnBack turn_back(frame.rotation);
  for (std::size_t k = 0; k < nodes.size(); ++k)
    if (nodes[k] >= 0) store(turn_back(w[uz(nodes[k])], frame.velocity), v + 4 * k);
}

// m (g - drag w) of a free node; the power of the drag is added to `power`.
HWY_INLINE Three gravity_and_drag(const Model& model, const Three& gravity, const Vec3& w,
                                  std::size_t i, double& power) {
  const double m = model.mass[i];
  const double drag = model.drag[i];
  if (drag == 0.0) return m * gravity;
  power += m * drag * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
  return m * (gravity - drag * load(w));
}

double finish_range(const Model& model, const Vec3& g, const Vec3* w, Range nodes, Vec3* force) {
  const Three gravity = load(g);
  double power = 0.0;
  for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) {
    if (model.inverse_mass[i] == 0.0) continue;
    store(load(force[i]) + gravity_and_drag(model, gravity, w[i], i, power), force[i]);
  }
  return power;
}

double finish_nodes(const Model& model, const Vec3& g, const Vec3* w, std::span<const Index> nodes,
                    const float* given, Vec3* force) {
  const Three gravity = load(g);
  double power = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (nodes[k] < 0) continue;
    const auto i = uz(nodes[k]);
    Three f = load(given + 4 * k);
    if (model.inverse_mass[i] > 0.0) {
      f = f + gravity_and_drag(model, gravity, w[i], i, power);
    }
    store(f, force[i]);
  }
  return power;
}

bool move(const Model& model, const Vec3* force, double mean_step, double h, double farthest,
          Range nodes, State& state) {
  const double* inverse_mass = model.inverse_mass.data();
  Vec3* velocity = state.half_velocity.data();
  Vec3* position = state.position.data();
  bool within = true;
  for (auto i = uz(nodes.begin); i < uz(nodes.end); ++i) {
    if (inverse_mass[i] == 0.0) continue;
    const Three w = load(velocity[i]) + (mean_step * inverse_mass[i]) * load(force[i]);
    const Three x = load(position[i]) + h * w;
    store(w, velocity[i]);
    store(x, position[i]);
    within = within && is_within(x, farthest);
  }
  return within;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew {

HWY_EXPORT(displacements);
HWY_EXPORT(velocities);
HWY_EXPORT(finish_range);
HWY_EXPORT(finish_nodes);
HWY_EXPORT(move);

void frame_displacements(const Frame& frame, std::span<const Index> nodes, const Model& model,
                         std::span<const Vec3> x, float* u) {
  HWY_DYNAMIC_DISPATCH(displacements)(frame, nodes, model, x.data(), u);
}

void frame_velocities(const Frame& frame, std::span<const Index> nodes, std::span<const Vec3> w,
                      float* v) {
  HWY_DYNAMIC_DISPATCH(velocities)(frame, nodes, w.data(), v);
}

double add_gravity_and_drag(const Model& model, const Vec3& gravity, const std::vector<Vec3>& w,
                            Range nodes, std::vector<Vec3>& force) {
  return HWY_DYNAMIC_DISPATCH(finish_range)(model, gravity, w.data(), nodes, force.data());
}

double add_gravity_and_drag(const Model& model, const Vec3& gravity, const std::vector<Vec3>& w,
                            std::span<const Index> nodes, const float* given,
                            std::vector<Vec3>& force) {
  return HWY_DYNAMIC_DISPATCH(finish_nodes)(model, gravity, w.data(), nodes, given, force.data());
}

bool leapfrog(const Model& model, const std::vector<Vec3>& force, double mean_step, double h,
              double farthest, Range nodes, State& state) {
  return HWY_DYNAMIC_DISPATCH(move)(model, force.data(), mean_step, h, farthest, nodes, state);
}

}  // namespace sinew
#endif  // HWY_ONCE
