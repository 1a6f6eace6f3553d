#pragma once
// Vectors of a plane as polynomials, in isotropic coordinates: a complex number z and a number w in
// place of its conjugate, taken as independent.

#include <momenta/dae/analysis/kinematics/polynomial_system.h>

namespace momenta {

struct Isotropic {
  Polynomial z, w;
};
inline Isotropic operator+(const Isotropic& a, const Isotropic& b) {
  return {a.z + b.z, a.w + b.w};
}
inline Isotropic operator-(const Isotropic& a, const Isotropic& b) {
  return {a.z + scaled(b.z, -1), a.w + scaled(b.w, -1)};
}
inline Isotropic operator*(const Isotropic& a, const Isotropic& b) {
  return {a.z * b.z, a.w * b.w};
}
inline Isotropic constant(Complex c) {
  return {{{c, {}}}, {{std::conj(c), {}}}};
}

}  // namespace momenta
