#pragma once
// Vectors, symmetric and general 3 × 3 matrices of any scalar, as plain aggregates that stay in
// registers, and their turns about coordinate axes. No Eigen in the kernels.

#include <cmath>

namespace momenta {

template <class S>
struct Vec3 {
  S x[3]{};
  S& operator[](int i) { return x[i]; }
  const S& operator[](int i) const { return x[i]; }
  Vec3& operator+=(const Vec3& b) {
    for (int i = 0; i < 3; ++i) x[i] += b.x[i];
    return *this;
  }
  Vec3& operator-=(const Vec3& b) {
    for (int i = 0; i < 3; ++i) x[i] -= b.x[i];
    return *this;
  }
  friend Vec3 operator+(Vec3 a, const Vec3& b) { return a += b; }
  friend Vec3 operator-(Vec3 a, const Vec3& b) { return a -= b; }
  friend Vec3 operator-(const Vec3& a) { return {{-a.x[0], -a.x[1], -a.x[2]}}; }
  friend Vec3 operator*(const S& s, const Vec3& a) {
    return {{s * a.x[0], s * a.x[1], s * a.x[2]}};
  }
};

template <class S>
S dot(const Vec3<S>& a, const Vec3<S>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class S>
Vec3<S> cross(const Vec3<S>& a, const Vec3<S>& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}

/// Row-major.
template <class S>
struct Mat3 {
  S x[9]{};
  S& operator()(int i, int j) { return x[3 * i + j]; }
  const S& operator()(int i, int j) const { return x[3 * i + j]; }
  Vec3<S> column(int j) const { return {{x[j], x[3 + j], x[6 + j]}}; }
  void set_column(int j, const Vec3<S>& c) {
    for (int i = 0; i < 3; ++i) x[3 * i + j] = c[i];
  }
  Mat3& operator+=(const Mat3& b) {
    for (int i = 0; i < 9; ++i) x[i] += b.x[i];
    return *this;
  }
};

template <class S>
Mat3<S> identity3() {
  Mat3<S> r;
  for (int i = 0; i < 3; ++i) r(i, i) = S(1.0);
  return r;
}
template <class S>
Vec3<S> operator*(const Mat3<S>& m, const Vec3<S>& v) {
  return {{m(0, 0) * v[0] + m(0, 1) * v[1] + m(0, 2) * v[2],
           m(1, 0) * v[0] + m(1, 1) * v[1] + m(1, 2) * v[2],
           m(2, 0) * v[0] + m(2, 1) * v[1] + m(2, 2) * v[2]}};
}
/// mᵀ v
template <class S>
Vec3<S> transpose_times(const Mat3<S>& m, const Vec3<S>& v) {
  return {{m(0, 0) * v[0] + m(1, 0) * v[1] + m(2, 0) * v[2],
           m(0, 1) * v[0] + m(1, 1) * v[1] + m(2, 1) * v[2],
           m(0, 2) * v[0] + m(1, 2) * v[1] + m(2, 2) * v[2]}};
}
template <class S>
Mat3<S> operator*(const Mat3<S>& a, const Mat3<S>& b) {
  Mat3<S> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  return r;
}
template <class S>
Mat3<S> transpose(const Mat3<S>& a) {
  Mat3<S> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) r(i, j) = a(j, i);
  return r;
}

/// Symmetric; stored xx xy xz yy yz zz.
template <class S>
struct Sym3 {
  S x[6]{};
  static constexpr int index(int i, int j) {
    return i <= j ? (i == 0 ? j : i + j + 1) : index(j, i);
  }
  S& operator()(int i, int j) { return x[index(i, j)]; }
  const S& operator()(int i, int j) const { return x[index(i, j)]; }
  Sym3& operator+=(const Sym3& b) {
    for (int i = 0; i < 6; ++i) x[i] += b.x[i];
    return *this;
  }
};
template <class S>
Vec3<S> operator*(const Sym3<S>& m, const Vec3<S>& v) {
  return {{m.x[0] * v[0] + m.x[1] * v[1] + m.x[2] * v[2],
           m.x[1] * v[0] + m.x[3] * v[1] + m.x[4] * v[2],
           m.x[2] * v[0] + m.x[4] * v[1] + m.x[5] * v[2]}};
}

/// Inverse by m = L D Lᵀ: backward stable, unlike cofactors. m is positive definite when all
/// `pivots` D are positive; the caller checks.
template <class S>
Sym3<S> inverse(const Sym3<S>& m, Vec3<S>& pivots) {
  const S i0 = S(1.0) / m.x[0];
  const S l10 = i0 * m.x[1], l20 = i0 * m.x[2];
  const S d1 = m.x[3] - l10 * m.x[1], below = m.x[4] - l20 * m.x[1];
  const S i1 = S(1.0) / d1;
  const S l21 = i1 * below;
  const S d2 = m.x[5] - l20 * m.x[2] - l21 * below;
  const S i2 = S(1.0) / d2;
  pivots = {{m.x[0], d1, d2}};
  // L⁻¹ = (1; −l10 1; n20 −l21 1), m⁻¹ = L⁻ᵀ D⁻¹ L⁻¹
  const S n20 = l10 * l21 - l20;
  Sym3<S> r;
  r.x[5] = i2;
  r.x[4] = -(l21 * i2);
  r.x[2] = n20 * i2;
  r.x[3] = i1 - l21 * r.x[4];
  r.x[1] = -(l10 * i1) - l21 * r.x[2];
  r.x[0] = i0 + l10 * (l10 * i1) + n20 * r.x[2];
  return r;
}

// Turning about coordinate axis X by the angle with cosine c and sine s; Y, Z are the next axes in
// cyclic order.

/// R v
template <int X, class S, class C>
void turn(Vec3<S>& v, const C& c, const C& s) {
  constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
  const S y = c * v[Y] - s * v[Z];
  v[Z] = s * v[Y] + c * v[Z];
  v[Y] = y;
}
/// Rᵀ v
template <int X, class S, class C>
void turn_back(Vec3<S>& v, const C& c, const C& s) {
  constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
  const S y = c * v[Y] + s * v[Z];
  v[Z] = c * v[Z] - s * v[Y];
  v[Y] = y;
}
/// R m Rᵀ: the 2 × 2 block turns by its trace and difference, 4 products instead of 8.
template <int X, class S, class C>
void turn(Sym3<S>& m, const C& c, const C& s) {
  constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
  const C cs = c * s, ss = s * s;
  const S difference = m(Y, Y) - m(Z, Z), twice = m(Y, Z) + m(Y, Z);
  const S t = ss * difference + cs * twice;
  const S u = cs * difference - ss * twice;
  m(Y, Y) -= t;
  m(Z, Z) += t;
  m(Y, Z) += u;
  const S xy = c * m(X, Y) - s * m(X, Z);
  m(X, Z) = s * m(X, Y) + c * m(X, Z);
  m(X, Y) = xy;
}
template <int X, class S, class C>
void turn(Mat3<S>& m, const C& c, const C& s) {
  constexpr int Y = (X + 1) % 3, Z = (X + 2) % 3;
  const C cs = c * s, ss = s * s;
  const S difference = m(Y, Y) - m(Z, Z), twice = m(Y, Z) + m(Z, Y);
  const S t = ss * difference + cs * twice;
  const S u = cs * difference - ss * twice;
  m(Y, Y) -= t;
  m(Z, Z) += t;
  m(Y, Z) += u;
  m(Z, Y) += u;
  const S xy = c * m(X, Y) - s * m(X, Z);
  m(X, Z) = s * m(X, Y) + c * m(X, Z);
  m(X, Y) = xy;
  const S yx = c * m(Y, X) - s * m(Z, X);
  m(Z, X) = s * m(Y, X) + c * m(Z, X);
  m(Y, X) = yx;
}

/// Rotation from child to parent components by a unit quaternion w x y z. Homogeneous of degree
/// zero: a quaternion off unit length still gives a rotation.
template <class S>
[[gnu::always_inline]] inline Mat3<S> rotation_by(const S& w, const S& x, const S& y, const S& z) {
  const S two = S(2.0) / (w * w + x * x + y * y + z * z);
  Mat3<S> r;
  r(0, 0) = S(1.0) - two * (y * y + z * z);
  r(0, 1) = two * (x * y - w * z);
  r(0, 2) = two * (x * z + w * y);
  r(1, 0) = two * (x * y + w * z);
  r(1, 1) = S(1.0) - two * (x * x + z * z);
  r(1, 2) = two * (y * z - w * x);
  r(2, 0) = two * (x * z - w * y);
  r(2, 1) = two * (y * z + w * x);
  r(2, 2) = S(1.0) - two * (x * x + y * y);
  return r;
}
template <class S>
Mat3<S> rotation_of(const S* quaternion) {
  return rotation_by(quaternion[0], quaternion[1], quaternion[2], quaternion[3]);
}
/// Rᵀ g of one direction without R: with v = (x, y, z) and t = 2 v × g / |q|², Rᵀ g = g − w t + v ×
/// t.
template <class S>
[[gnu::always_inline]] inline Vec3<S> turned_back_by(const S& w, const S& x, const S& y, const S& z,
                                                     const Vec3<double>& g) {
  const S two = S(2.0) / (w * w + x * x + y * y + z * z);
  const S tx = two * (y * g[2] - z * g[1]), ty = two * (z * g[0] - x * g[2]),
          tz = two * (x * g[1] - y * g[0]);
  return {{g[0] - w * tx + (y * tz - z * ty), g[1] - w * ty + (z * tx - x * tz),
           g[2] - w * tz + (x * ty - y * tx)}};
}

}  // namespace momenta
