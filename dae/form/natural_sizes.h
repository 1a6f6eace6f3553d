#pragma once
// How large the unknowns of a mechanism are by nature: a length of the scene or a radian, and that
// times the mechanism's own rate. Absolute tolerances are parts of these, so that a scene told in
// other units of length, mass and time takes the same steps. They are powers of ten, the unit of SI
// itself for what is about a metre large and as fast as a pendulum of some metres: tolerances say
// an order of magnitude, and one that jumps seldom does not depend on the last digits of a scene.

#include <momenta/dae/form/form.h>

#include <vector>

namespace momenta {

/// The largest 10^k below x; `edge`: by that part of a decade more.
double power_of_ten(double x, double edge);

struct NaturalSizes {
  NaturalSizes(const Mechanism& mechanism, const Start& start);

  /// p (nv) where `e` is placed: M_ii times `way` at a rate [1/s]. The momentum of a joint that
  /// moves no mass, such as that of a massless coupler, consists of loop impulses alone, which are
  /// as large as those of other joints; there it is that of the joint that moves the most.
  void of_momenta(Evaluation<double>& e, double at_rate, double* sizes) const;

  std::vector<double> q;    ///< nq; of components of quaternions 1
  std::vector<double> way;  ///< by rate u, nv: of what it changes [m or rad]
  double rate = 1;          ///< [1/s]; of u: `way` times that
  double fastest = 0;       ///< of that and of rates at the start, by `way` [1/s]
};

}  // namespace momenta
