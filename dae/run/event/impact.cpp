#include <momenta/dae/run/event/impact.h>

#include <Eigen/QR>
#include <algorithm>
#include <stdexcept>
#include <string>

namespace momenta {

Impact::Impact(const Mechanism& mechanism)
    : mechanism_(mechanism), e_(mechanism.evaluation<double>()) {
  if (mechanism.m() > 0) solver_ = make_loop_solver(mechanism, *e_);
}

Eigen::VectorXd Impact::response(double t, const Eigen::VectorXd& q, int coordinate, double side) {
  const int nv = mechanism_.nv();
  Eigen::VectorXd n = Eigen::VectorXd::Zero(nv), w(nv);
  n[coordinate] = side;
  bool solved = true;
  if (solver_) {
    solved = solver_->free_velocity(t, q.data(), n.data(), w.data());
  } else {  // u of p is linear, and prescribed motion moves at p = 0 too
    Eigen::VectorXd rate(nv), none = Eigen::VectorXd::Zero(nv), moved(nv);
    solved = e_->open_momentum_rates(t, q.data(), n.data(), w.data(), rate.data()) &&
             e_->open_momentum_rates(t, q.data(), none.data(), moved.data(), rate.data());
    w -= moved;
  }
  if (!solved || !w.allFinite())
    throw std::runtime_error("an impact at t = " + std::to_string(t) +
                             " s has no solution: a joint without inertia");
  return w;
}

double Impact::jump(double t, const Eigen::VectorXd& q, Eigen::VectorXd& u,
                    std::vector<StopAtImpact>& stops) {
  const auto n = static_cast<Eigen::Index>(stops.size());
  Eigen::MatrixXd w(u.size(), n), W(n, n);
  Eigen::VectorXd before(n), wanted(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const StopAtImpact& s = stops[static_cast<std::size_t>(i)];
    w.col(i) = response(t, q, s.u, s.side);
    before[i] = s.side * u[s.u];
    wanted[i] = s.held    ? 0
                : s.stuck ? before[i]
                          : before[i] + s.restitution * std::max(before[i], 0.0);
  }
  for (Eigen::Index i = 0; i < n; ++i)
    W.row(i) =
        stops[static_cast<std::size_t>(i)].side * w.row(stops[static_cast<std::size_t>(i)].u);
  std::vector<Eigen::Index> active;
  for (Eigen::Index i = 0; i < n; ++i)
    if (wanted[i] >= 0 || stops[static_cast<std::size_t>(i)].stuck) active.push_back(i);
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(n);
  while (!active.empty()) {
    const auto size = static_cast<Eigen::Index>(active.size());
    Eigen::MatrixXd part(size, size);
    Eigen::VectorXd right(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      right[i] = wanted[active[static_cast<std::size_t>(i)]];
      for (Eigen::Index k = 0; k < size; ++k)
        part(i, k) = W(active[static_cast<std::size_t>(i)], active[static_cast<std::size_t>(k)]);
    }
    if (!(part.diagonal().minCoeff() > 0))
      throw std::runtime_error("an impact at t = " + std::to_string(t) +
                               " s has no solution: the loops hold the coordinate at the stop");
    const Eigen::VectorXd found = part.completeOrthogonalDecomposition().solve(right);
    Eigen::Index least = -1;
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto which = static_cast<std::size_t>(active[static_cast<std::size_t>(i)]);
      if (!stops[which].stuck && found[i] < (least < 0 ? 0 : found[least])) least = i;
    }
    if (least < 0) {
      for (Eigen::Index i = 0; i < size; ++i)
        impulse[active[static_cast<std::size_t>(i)]] = found[i];
      break;
    }
    active.erase(active.begin() + least);
  }
  const Eigen::VectorXd mean = u - 0.5 * w * impulse;
  u -= w * impulse;
  for (Eigen::Index i = 0; i < n; ++i) stops[static_cast<std::size_t>(i)].impulse = impulse[i];
  if (!mechanism_.plan().drives) {
    double taken = 0;
    for (const StopAtImpact& s : stops) taken += s.impulse * s.side * mean[s.u];
    return taken;
  }
  Eigen::VectorXd p(u.size());
  e_->place(t, q.data());
  e_->move(mean.data());
  e_->momenta(nullptr, p.data());
  return (w * impulse).dot(p);
}

}  // namespace momenta
