#pragma once
// How large the unknowns of a mechanism are by nature: a length of the scene or a radian, and that
// times a rate of the mechanism. Absolute tolerances are parts of these, so that a scene told in
// other units of length, mass and time takes the same steps. They are powers of ten, the unit of SI
// itself for what is about a metre large and as fast as a pendulum of that size: tolerances say an
// order of magnitude, and one that jumps seldom does not depend on the last digits of a scene.

#include <momenta/dae/form/form.h>

#include <vector>

namespace momenta {

/// The 10^k for which x / 10^k is at least `least`, and less than ten times that.
double power_of_ten(double x, double least);

struct NaturalSizes {
  NaturalSizes(const Mechanism& mechanism, const Start& start);

  /// p (nv) where `e` is placed at the start: M_ii times that of u. The momentum of a joint that
  /// moves no mass, such as that of a massless coupler, consists of loop impulses alone, which are
  /// as large as those of other joints; there it is that of the joint that moves the most. Where
  /// bodies pass by fast, v × p is rounded by a part of the kinetic energy 2T: no less than what
  /// that makes of a joint's momentum.
  void of_momenta(Evaluation<double>& e, const Start& start, double* sizes) const;

  /// The longest span of a run that its first steps are parts of [s]: DaeSystem::horizon()
  double horizon() const { return 1e6 / rate; }

  double rate = 1;             ///< ρ [1/s]
  std::vector<double> q;       ///< nq; of components of quaternions 1
  std::vector<double> way, u;  ///< nv: a length of the scene or a radian, and that times ρ
};

}  // namespace momenta
