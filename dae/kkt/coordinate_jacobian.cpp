#include <momenta/dae/kkt/coordinate_jacobian.h>

namespace momenta {

CoordinateJacobian::CoordinateJacobian(const Mechanism& mechanism)
    : tree_(mechanism.tree()), m_(mechanism.m()), qdot_(mechanism.nq()), u_(mechanism.nv()) {
  if (m_ > 0) rate_pattern_ = mechanism.constraint_pattern();
  std::vector<int> coordinate(static_cast<std::size_t>(mechanism.nv())),
      ball(coordinate.size(), -1);
  for (const auto& b : tree_.bodies) {
    for (int i = 0; i < b.nv; ++i) {
      coordinate[static_cast<std::size_t>(b.u + i)] = b.has_quaternion() ? b.q : b.q + i;
      if (b.has_quaternion()) ball[static_cast<std::size_t>(b.u + i)] = balls();
    }
    if (b.has_quaternion()) balls_.push_back({b.q, b.nq, b.u, b.nv, Eigen::MatrixXd(b.nv, b.nq)});
  }
  for (std::size_t i = 0; i < rate_pattern_.size(); ++i) {
    const auto column = static_cast<std::size_t>(rate_pattern_[i].column);
    shares_.push_back({i, ball[column]});
    const Ball* b = ball[column] < 0 ? nullptr : &balls_[static_cast<std::size_t>(ball[column])];
    for (int c = 0; c < (b ? b->nq : 1); ++c)
      pattern_.push_back({rate_pattern_[i].row, coordinate[column] + c});
    if (b) i += static_cast<std::size_t>(b->nv) - 1;
  }
  for (int k = 0; k < balls(); ++k)
    for (int c = 0; c < 4; ++c)
      pattern_.push_back({m_ + k, balls_[static_cast<std::size_t>(k)].quaternion() + c});
}

Eigen::VectorXd CoordinateJacobian::weights(const Eigen::VectorXd& of_rates) const {
  Eigen::VectorXd weights(qdot_.size());
  for (const auto& b : tree_.bodies)
    if (!b.has_quaternion()) weights.segment(b.q, b.nq) = of_rates.segment(b.u, b.nv);
  for (const Ball& b : balls_) {
    weights.segment(b.q, b.nq - 4) = of_rates.segment(b.u, b.nq - 4);
    weights.segment<4>(b.quaternion()).setConstant(2 * of_rates.segment<3>(b.u + b.nv - 3).mean());
  }
  return weights;
}

void CoordinateJacobian::residual(Evaluation<double>& e, const Eigen::VectorXd& q,
                                  Eigen::VectorXd& phi) const {
  e.positions(phi.data());
  for (int k = 0; k < balls(); ++k)
    phi[m_ + k] =
        0.5 * (q.segment<4>(balls_[static_cast<std::size_t>(k)].quaternion()).squaredNorm() - 1);
}

void CoordinateJacobian::evaluate(Evaluation<double>& e, const Eigen::VectorXd& q,
                                  std::vector<double>& of_rates, std::vector<double>& values) {
  e.constraint_entries(of_rates.data());
  if (!has_balls()) {
    values = of_rates;
    return;
  }
  // Column c of N, of all balls at once.
  for (int c = 0; c < 7; ++c) {
    qdot_.setZero();
    for (const Ball& b : balls_)
      if (c < b.nq) qdot_[b.q + c] = 1;
    e.joint_rates(q.data(), qdot_.data(), u_.data());
    for (Ball& b : balls_)
      if (c < b.nq) b.N.col(c) = u_.segment(b.u, b.nv);
  }
  double* value = values.data();
  for (const Share& share : shares_) {
    const double* rate = &of_rates[share.first];
    if (share.ball < 0) {
      *value++ = *rate;
      continue;
    }
    const Ball& b = balls_[static_cast<std::size_t>(share.ball)];
    Eigen::Map<Eigen::RowVectorXd>(value, b.nq).noalias() =
        Eigen::Map<const Eigen::RowVectorXd>(rate, b.nv) * b.N;
    value += b.nq;
  }
  for (const Ball& b : balls_)
    for (int i = 0; i < 4; ++i) *value++ = q[b.quaternion() + i];
}

}  // namespace momenta
