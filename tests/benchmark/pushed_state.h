#pragma once
// A state of which nothing is zero: the scene's positions, its rates and a push of up to 1 rad/s or
// m/s, which the loops need not allow.

#include <momenta/dae/mechanism/evaluation.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <cmath>

namespace momenta {

struct PushedState {
  Eigen::VectorXd q, p;  ///< nq, nv
};

inline PushedState pushed_state(const Mechanism& mechanism, const Eigen::VectorXd& q) {
  PushedState s{q, Eigen::VectorXd(mechanism.nv())};
  Eigen::VectorXd u = mechanism.tree().u0;
  for (Eigen::Index i = 0; i < u.size(); ++i) u[i] += std::sin(static_cast<double>(i));
  const auto e = mechanism.evaluation<double>();
  e->place(0, s.q.data());
  e->move(u.data());
  e->momenta(nullptr, s.p.data());
  return s;
}

}  // namespace momenta
