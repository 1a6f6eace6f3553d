#pragma once
// The state that runs start from, and the accelerations and multipliers there.

#include <Eigen/Core>

namespace momenta {

/// A consistent start: Φ(q, t) = 0, Φ_q u + Φ_t = 0. Redundant equations whose numbers contradict
/// each other are met in the least-squares sense.
struct Start {
  double t = 0;             ///< [s]
  Eigen::VectorXd q;        ///< nq
  Eigen::VectorXd u;        ///< nv
  Eigen::VectorXd udot;     ///< accelerations there: nv
  Eigen::VectorXd lambda;   ///< force multipliers there: m
  Eigen::VectorXd residue;  ///< Φ that contradictions leave (m); empty: none
};

}  // namespace momenta
