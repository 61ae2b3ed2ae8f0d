#include "sinew/contact/boxes.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sinew/contact/boxes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sinew {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::ScalableTag<float>;
using Indices = hn::RebindToSigned<Floats>;

// The mask of the boxes from i on that overlap `with` (lo x, y, z, hi x, y, z).
HWY_INLINE hn::Mask<Floats> overlap(const float* const* side, std::size_t i, std::size_t count,
                                    const float* with) {
  const Floats f;
  auto hit = hn::FirstN(f, count - i);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto lo = hn::LoadU(f, side[c] + i), hi = hn::LoadU(f, side[c + 3] + i);
    hit =
        hn::And(hit, hn::And(hn::Le(lo, hn::Set(f, with[c + 3])), hn::Ge(hi, hn::Set(f, with[c]))));
  }
  return hit;
}

std::size_t find(const float* const* side, const Index* item, std::size_t count, const float* with,
                 Index* out) {
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(Floats())) {
    const auto hit = overlap(side, i, count, with);
    if (hn::AllFalse(Floats(), hit)) continue;
    found += hn::CompressStore(hn::LoadU(Indices(), item + i), hn::RebindMask(Indices(), hit),
                               Indices(), out + found);
  }
  return found;
}

// Appends the overlapping boxes to other sides and items; `shift` is added to each side.
std::size_t copy(const float* const* side, const Index* item, std::size_t count, const float* with,
                 const float* shift, float* const* to_side, Index* to_item) {
  const Floats f;
  std::size_t found = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const auto hit = overlap(side, i, count, with);
    if (hn::AllFalse(f, hit)) continue;
    for (std::size_t c = 0; c < 6; ++c) {
      const auto moved = hn::Add(hn::LoadU(f, side[c] + i), hn::Set(f, shift[c]));
      hn::CompressStore(moved, hit, f, to_side[c] + found);
    }
    found += hn::CompressStore(hn::LoadU(Indices(), item + i), hn::RebindMask(Indices(), hit),
                               Indices(), to_item + found);
  }
  return found;
}

void gaps(const float* const* side, std::size_t count, const float* from, float* gap) {
  const Floats f;
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    auto most = hn::Set(f, -3.0e38f);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto lo = hn::LoadU(f, side[c] + i), hi = hn::LoadU(f, side[c + 3] + i);
      most = hn::Max(
          most, hn::Max(hn::Sub(lo, hn::Set(f, from[c + 3])), hn::Sub(hn::Set(f, from[c]), hi)));
    }
    hn::StoreU(most, f, gap + i);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace sinew
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sinew {

HWY_EXPORT(find);
HWY_EXPORT(copy);
HWY_EXPORT(gaps);

namespace {

constexpr Index longest_vector = 64;  // floats in a vector, for any instruction set

std::array<float, 6> rounded_out(const Box& box) {
  std::array<float, 6> sides;
  for (std::size_t c = 0; c < 3; ++c) {
    sides[c] = rounded_down(box.lo.data()[c]);
    sides[c + 3] = rounded_up(box.hi.data()[c]);
  }
  return sides;
}

std::array<const float*, 6> starts(const std::array<std::vector<float>, 6>& sides) {
  std::array<const float*, 6> start;
  for (std::size_t c = 0; c < 6; ++c) start[c] = sides[c].data();
  return start;
}

}  // namespace

void Boxes::make_room(Index more) {
  const std::size_t need = uz(count_ + more + longest_vector);
  if (item_.size() >= need) return;
  item_.resize(2 * need);
  for (auto& side : side_) side.resize(2 * need);
}

void Boxes::add(const Box& box, Index item) {
  make_room(1);
  const std::array<float, 6> sides = rounded_out(box);
  for (std::size_t c = 0; c < 6; ++c) side_[c][uz(count_)] = sides[c];
  item_[uz(count_++)] = item;
}

void Boxes::add_overlapping(const Boxes& other, const Box& box, const Vec3& displacement,
                            double margin) {
  if (other.count_ == 0) return;
  make_room(other.count_);
  const std::array<float, 6> with = rounded_out(box);
  std::array<float, 6> shift;
  for (std::size_t c = 0; c < 3; ++c) {
    shift[c] = rounded_down(std::min(0.0, displacement.data()[c]) - margin);
    shift[c + 3] = rounded_up(std::max(0.0, displacement.data()[c]) + margin);
  }
  std::array<float*, 6> to;
  for (std::size_t c = 0; c < 6; ++c) to[c] = side_[c].data() + count_;
  count_ += static_cast<Index>(
      HWY_DYNAMIC_DISPATCH(copy)(starts(other.side_).data(), other.item_.data(), uz(other.count_),
                                 with.data(), shift.data(), to.data(), item_.data() + count_));
}

void Boxes::find(const Box& box, std::vector<Index>& items) const {
  items.clear();
  if (count_ == 0) return;
  items.resize(uz(count_ + longest_vector));
  const std::array<float, 6> with = rounded_out(box);
  items.resize(HWY_DYNAMIC_DISPATCH(find)(starts(side_).data(), item_.data(), uz(count_),
                                          with.data(), items.data()));
}

void Boxes::gaps_to(const Box& box, std::vector<float>& gaps) const {
  gaps.resize(uz(count_ + longest_vector));
  if (count_ == 0) return;
  const std::array<float, 6> from = rounded_out(box);
  HWY_DYNAMIC_DISPATCH(gaps)
  (starts(side_).data(), uz(count_), from.data(), gaps.data());
}

}  // namespace sinew
#endif  // HWY_ONCE
