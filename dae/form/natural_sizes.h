#pragma once
// How large the unknowns of a mechanism are by nature: a length of the scene or a radian, and that
// times a rate of the mechanism. Absolute tolerances are parts of these, so that a scene told in
// other units of length, mass and time takes the same steps. They are powers of ten, the unit of SI
// itself for what is about a metre large and as fast as a pendulum of that size: tolerances say an
// order of magnitude, and one that jumps seldom does not depend on the last digits of a scene.

#include <momenta/dae/form/form.h>

#include <vector>

namespace momenta {

/// 10^k with least ≤ x / 10^k < 10 least.
double power_of_ten(double x, double least);

/// The larger of √a and rates, in lengths of what moves [1/s]; a: the accelerations that loops
/// cause, without loops all. Where nothing moves: ten per run of the scene.
double own_rate(const Mechanism& mechanism, const Start& start);

struct NaturalSizes {
  NaturalSizes(const Mechanism& mechanism, const Start& start);

  /// Sizes of p (nv) where `e` is placed at the start: M_ii times that of u. A joint that moves no
  /// mass, such as a massless coupler's, has loop impulses alone for momentum, as large as those of
  /// other joints: it takes the size of the joint that moves the most. Where bodies pass by fast,
  /// rounding of v × p, a part of 2T, sets a least size.
  void of_momenta(Evaluation<double>& e, const Start& start, double* sizes) const;

  /// DaeSystem::horizon() [s]
  double horizon() const { return 1e6 / rate; }

  double rate = 1;             ///< ρ [1/s]
  std::vector<double> q;       ///< nq; 1 for components of quaternions
  std::vector<double> way, u;  ///< nv: a length of the scene or a radian, and that times ρ
};

}  // namespace momenta
