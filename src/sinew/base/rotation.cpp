#include "sinew/base/rotation.h"

#include <Eigen/SVD>
#include <cmath>

namespace sinew {

// With c the cosine of the angle, the quaternion's real part is cos(angle / 2) = sqrt((1 + c) / 2)
// and its vector is sin(angle / 2) = sin(angle) / (2 cos(angle / 2)) times the axis.
Eigen::Quaterniond rotation_between(const Vec3& from, const Vec3& to) {
  const Vec3 a = from.normalized();
  const Vec3 b = to.normalized();
  const double c = b.dot(a);
  if (c < -0.999) {  // 1 + c has lost its digits; the sine has not
    const Vec3 cross = a.cross(b);
    const double sine = cross.norm();
    int least = 0;  // the coordinate axis that is furthest from a
    a.cwiseAbs().minCoeff(&least);
    const Vec3 axis = sine > 0.0 ? Vec3(cross / sine) : a.cross(Vec3::Unit(least)).normalized();
    const double half = 0.5 * std::atan2(sine, c);
    const Vec3 v = sine > 0.0 ? Vec3(axis * std::sin(half)) : axis;
    return Eigen::Quaterniond(sine > 0.0 ? std::cos(half) : 0.0, v.x(), v.y(), v.z());
  }
  const double twice_half_cosine = std::sqrt((1.0 + c) * 2.0);
  const double scale = 1.0 / twice_half_cosine;
  const Vec3 v = a.cross(b) * scale;
  return Eigen::Quaterniond(twice_half_cosine * 0.5, v.x(), v.y(), v.z());
}

Mat3 nearest_rotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 u = svd.matrixU();
  if (u.determinant() * svd.matrixV().determinant() < 0.0) u.col(2) *= -1.0;
  return u * svd.matrixV().transpose();
}

}  // namespace sinew
