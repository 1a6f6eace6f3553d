#include "equations/looped_motion.h"

#include "equations/decompositions.h"

#include <algorithm>

namespace momenta::equations {

LoopedMotion::LoopedMotion(const Scene& scene, const Tree& tree)
    : motion_(scene, tree), loops_(scene, motion_) {}

double LoopedMotion::open(double t, const Eigen::VectorXd& q) const {
  return loops_.rows() > 0 ? static_cast<double>(loops_.positions_at(t, q).cwiseAbs().maxCoeff())
                           : 0;
}

double LoopedMotion::opening(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
  return loops_.rows() > 0
             ? static_cast<double>(loops_.velocities_at(t, q, u).cwiseAbs().maxCoeff())
             : 0;
}

double LoopedMotion::kinetic_energy(double t, const Eigen::VectorXd& q,
                                    const Eigen::VectorXd& u) const {
  return static_cast<double>(motion_.kinetic_energy(Real(t), {q.data(), q.data() + q.size()},
                                                    {u.data(), u.data() + u.size()}));
}

double LoopedMotion::energy(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
  return static_cast<double>(motion_.energy(t, q, u));
}

double LoopedMotion::power(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
  return static_cast<double>(motion_.energy_rate(t, q, u, accelerations(t, q, u)));
}

RealVector LoopedMotion::accelerations(Real t, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& u) const {
  const RealVector free = motion_.accelerations(t, q, u);
  if (loops_.rows() == 0 || u.size() == 0) return free;
  // Φ̈ is affine in u̇: what the loops add to `free` is −M⁻¹Φ_qᵀ(Φ_q M⁻¹ Φ_qᵀ)⁺ Φ̈(free), with
  // M = L Lᵀ the least x of Φ_q L⁻ᵀ x = −Φ̈(free).
  const Eigen::VectorXd rounded = free.cast<double>();
  const RealMatrix J = loops_.jacobian_at(t, q, u).first;
  const RealVector off =
      loops_.accelerations_at(t, q, u, rounded) + J * (free - rounded.cast<Real>());
  const Eigen::LLT<RealMatrix> mass(motion_.mass_matrix(t, q));
  const RealMatrix scaled = mass.matrixL().solve(J.transpose()).transpose();
  Eigen::CompleteOrthogonalDecomposition<RealMatrix> rows;
  // Redundant rows are independent where loops are open, by as much. Rows of joints that are all
  // held are rounding beside L⁻¹, the size of those that move (lengths are about 1).
  const Real moves =
      mass.matrixL().solve(RealMatrix::Identity(u.size(), u.size())).cwiseAbs().maxCoeff();
  rows.setThreshold(std::max({1e-11L, 100 * Real(open(static_cast<double>(t), q)),
                              1e-11L * moves / scaled.cwiseAbs().maxCoeff()}));
  rows.compute(scaled);
  const RealVector change = rows.solve(off);
  return free - mass.matrixU().solve(change);
}

double integral(const std::vector<double>& samples, double spacing) {
  constexpr std::array weights{14.0, 32.0, 12.0, 32.0};
  double sum = 7 * (samples.back() - samples.front());
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) sum += weights[i % 4] * samples[i];
  return 2 * spacing / 45 * sum;
}

}  // namespace momenta::equations
