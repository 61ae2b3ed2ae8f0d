#include "sinew/model/path.h"

#include <algorithm>
#include <cstddef>

namespace sinew {

KeyFrame Path::frame(double t) const {
  if (keys.empty()) return {};
  const auto after = std::upper_bound(keys.begin(), keys.end(), t,
                                      [](double time, const KeyFrame& k) { return time < k.time; });
  if (after == keys.end()) return keys.back();
  KeyFrame now;
  const KeyFrame from = after == keys.begin() ? KeyFrame{} : *(after - 1);
  const double span = after->time - from.time;
  double s = span > 0.0 ? std::clamp((t - from.time) / span, 0.0, 1.0) : 1.0;
  if (smooth) s = s * s * (3.0 - 2.0 * s);
  now.move = (1.0 - s) * from.move + s * after->move;
  now.turn = (1.0 - s) * from.turn + s * after->turn;
  now.deform = from.deform + s * (after->deform - from.deform);  // exact if both are equal
  return now;
}

Mat3 Path::rotation(double t) const {
  const Vec3 turn = frame(t).turn;
  const double angle = turn.norm();
  if (angle == 0.0) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, Vec3(turn / angle)).toRotationMatrix();
}

Vec3 Path::at(double t, const Vec3& X) const {
  if (keys.empty()) return X;
  const KeyFrame now = frame(t);
  const double angle = now.turn.norm();
  const bool deforms = now.deform != Mat3::Identity();
  if (angle == 0.0 && !deforms) return X + now.move;
  Vec3 arm = X - pivot;
  if (deforms) arm = now.deform * arm;
  if (angle > 0.0) arm = Eigen::AngleAxisd(angle, Vec3(now.turn / angle)) * arm;
  return pivot + arm + now.move;
}

}  // namespace sinew
