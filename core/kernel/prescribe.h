#pragma once
// f(t), ḟ, f̈ of a driven joint for every number type. Motion laws run out of line, in code compiled
// once for any machine: packs lane by lane, directions as eight derivatives of one evaluation.

#include <momenta/core/scalar/dual.h>
#include <momenta/core/scene/drive.h>

namespace momenta {

/// Prescribed position, rate and acceleration of a driven joint.
template <class S>
void prescribe(const MotionLaw& law, const S& t, S& f, S& fdot, S& fddot) {
  law.evaluate(t, f, fdot, fddot);
}

/// The same in doubles, and on Dual8 in plain arrays: t; f, ḟ, f̈; value and eight derivatives of
/// each.
void prescribed_motion(const MotionLaw& law, double t, double& f, double& fdot, double& fddot);
void prescribed_motion(const MotionLaw& law, const double* t, double* f);

template <int W, int L>
void prescribe(const MotionLaw& law, const Pack<W, L>& t, Pack<W, L>& f, Pack<W, L>& fdot,
               Pack<W, L>& fddot) {
  for (int i = 0; i < W; ++i) {
    double x, xdot, xddot;
    prescribed_motion(law, t.lane(i), x, xdot, xddot);
    f.set_lane(i, x);
    fdot.set_lane(i, xdot);
    fddot.set_lane(i, xddot);
  }
}
template <int W, int L>
void prescribe(const MotionLaw& law, const Directions<W, L>& t, Directions<W, L>& f,
               Directions<W, L>& fdot, Directions<W, L>& fddot) {
  double time[dual8_numbers]{}, motion[3 * dual8_numbers];
  spread(t, time);
  prescribed_motion(law, static_cast<const double*>(time), motion);
  gather(motion, f);
  gather(motion + dual8_numbers, fdot);
  gather(motion + 2 * dual8_numbers, fddot);
}

}  // namespace momenta
