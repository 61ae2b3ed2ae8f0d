#include "sinew/haptics/local_contact.h"

#include <cmath>

namespace sinew {

ToolForce balance(const LocalContact& contact, const Vec3& hand, double coupling, double friction) {
  if (!std::isfinite(contact.gap) || contact.stiffness <= 0.0) return {hand, Vec3::Zero()};
  const Vec3& n = contact.normal;
  const double k = contact.stiffness;
  const Vec3 d = hand - contact.at;
  const double dn = n.dot(d);
  // coupling (d - s) + c - k s = 0, c the normal force at s = 0
  const double c = n.dot(contact.force) - k * contact.gap;
  const double s = (coupling * dn + c) / (coupling + k);
  const double fn = c - k * s;
  if (fn <= 0.0) return {hand, Vec3::Zero()};
  const Vec3 dt = d - dn * n;
  const Vec3 ft_at = contact.force - n.dot(contact.force) * n;
  Vec3 ft = ft_at - k * (coupling * dt + ft_at) / (coupling + k);
  const double most = friction * fn, size = ft.norm();
  if (size > most) ft *= most / size;
  const Vec3 force = fn * n + ft;
  return {hand + force / coupling, force};
}

}  // namespace sinew
