#pragma once
// ∂/∂q of Φ and of the lengths of quaternions: what Newton's method on positions needs where q is
// taken coordinate by coordinate. With u = N(q) q̇ it is (Φ_q N; quaternions), Φ_q the matrix over
// rates; without balls it is Φ_q itself.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

class CoordinateJacobian {
 public:
  explicit CoordinateJacobian(const Mechanism& mechanism);

  bool has_balls() const { return !balls_.empty(); }
  int balls() const { return static_cast<int>(balls_.size()); }
  int rows() const { return m_ + balls(); }
  const std::vector<KktPattern::Entry>& rate_pattern() const { return rate_pattern_; }  ///< Φ_q
  const std::vector<KktPattern::Entry>& pattern() const { return pattern_; }
  /// Weights of coordinates (nq) from those of rates (nv): ω is twice the rate of a quaternion
  /// across it.
  Eigen::VectorXd weights(const Eigen::VectorXd& of_rates) const;

  /// Φ and (|quaternion|² − 1)/2 at the placed q: rows() of them.
  void residual(Evaluation<double>& e, const Eigen::VectorXd& q, Eigen::VectorXd& phi) const;
  /// Entries over rates and over coordinates at the placed q, in the order of the patterns.
  void evaluate(Evaluation<double>& e, const Eigen::VectorXd& q, std::vector<double>& of_rates,
                std::vector<double>& values);

 private:
  /// A joint with a quaternion.
  struct Ball {
    int q, nq, u, nv;
    Eigen::MatrixXd N;  ///< nv × nq
    int quaternion() const { return q + nq - 4; }
  };
  /// Entries over rates that become entries over coordinates: one, or those of a row and a ball.
  struct Share {
    std::size_t first;
    int ball;
  };

  const Tree& tree_;
  int m_;
  std::vector<Ball> balls_;
  std::vector<Share> shares_;
  std::vector<KktPattern::Entry> rate_pattern_, pattern_;
  Eigen::VectorXd qdot_, u_;
};

}  // namespace momenta
