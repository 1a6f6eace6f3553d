#pragma once
// Products of dual quaternions x = e + ε g, ε² = 0, as matrices on (e, g), each (w, x, y, z).
//
// A displacement is a dual quaternion up to a factor, with e·g = 0 (Study's condition); of length
// one, e ē = 1, it turns by e and shifts by 2 g ē. A turn by θ about the line of unit direction l
// through c, and a shift by d along l, are
//
//   cos θ/2 + sin θ/2 (l + ε c × l),      1 + ε d/2 l

#include <Eigen/Geometry>

namespace momenta {

/// v e as a matrix on e, for a quaternion v = (w, x, y, z).
inline Eigen::Matrix4d times_from_left(const Eigen::Vector4d& v) {
  const double w = v[0], x = v[1], y = v[2], z = v[3];
  Eigen::Matrix4d m;
  m << w, -x, -y, -z,  //
      x, w, -z, y,     //
      y, z, w, -x,     //
      z, -y, x, w;
  return m;
}

/// e v
inline Eigen::Matrix4d times_from_right(const Eigen::Vector4d& v) {
  const double w = v[0], x = v[1], y = v[2], z = v[3];
  Eigen::Matrix4d m;
  m << w, -x, -y, -z,  //
      x, w, z, -y,     //
      y, -z, w, x,     //
      z, y, -x, w;
  return m;
}

inline Eigen::Vector4d pure(const Eigen::Vector3d& v) {
  return {0, v.x(), v.y(), v.z()};
}

using DualQuaternion = Eigen::Matrix<double, 8, 1>;
using DualProduct = Eigen::Matrix<double, 8, 8>;

/// a x as a matrix on x.
inline DualProduct times_from_left(const DualQuaternion& a) {
  DualProduct m = DualProduct::Zero();
  m.topLeftCorner<4, 4>() = m.bottomRightCorner<4, 4>() =
      times_from_left(Eigen::Vector4d(a.head<4>()));
  m.bottomLeftCorner<4, 4>() = times_from_left(Eigen::Vector4d(a.tail<4>()));
  return m;
}

/// x a
inline DualProduct times_from_right(const DualQuaternion& a) {
  DualProduct m = DualProduct::Zero();
  m.topLeftCorner<4, 4>() = m.bottomRightCorner<4, 4>() =
      times_from_right(Eigen::Vector4d(a.head<4>()));
  m.bottomLeftCorner<4, 4>() = times_from_right(Eigen::Vector4d(a.tail<4>()));
  return m;
}

}  // namespace momenta
