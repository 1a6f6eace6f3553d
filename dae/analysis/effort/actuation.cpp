#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/effort/actuation.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

double size_of(const VectorXd& x) {
  return x.size() > 0 ? x.cwiseAbs().maxCoeff() : 0;
}

}  // namespace

Actuation::Actuation(const Mechanism& mechanism, std::vector<int> actuated,
                     std::vector<double> weights)
    : mechanism_(mechanism),
      actuated_(std::move(actuated)),
      weights_(static_cast<Eigen::Index>(actuated_.size())),
      r_(mechanism.nv()),
      still_(mechanism.nv()),
      moving_(mechanism.nv()),
      none_(VectorXd::Zero(mechanism.nv())) {
  const LoopIslands islands(mechanism);
  const LoopUnits units(mechanism);
  of_island_.resize(islands.all().size());
  place_.resize(of_island_.size());
  for (std::size_t i = 0; i < actuated_.size(); ++i) {
    const double unit = units.rates[actuated_[i]];
    const double given = i < weights.size() ? weights[i] : 0;
    weights_[static_cast<Eigen::Index>(i)] = given > 0 ? given / (unit * unit) : 1;
    const auto k = static_cast<std::size_t>(&islands.of(actuated_[i]) - islands.all().data());
    const std::vector<int>& rates = islands.all()[k].rates;
    of_island_[k].push_back(static_cast<int>(i));
    place_[k].push_back(static_cast<int>(
        std::lower_bound(rates.begin(), rates.end(), actuated_[i]) - rates.begin()));
  }
}

Actuation::Unheld Actuation::efforts(ScaledLoops& loops, const LoopIslands& islands, double t,
                                     const VectorXd& q, const VectorXd& u, const VectorXd& udot,
                                     VectorXd& tau) {
  const VectorXd& unit = loops.units().rates;
  Evaluation<double>& e = loops.evaluation();
  e.place(t, q.data());
  e.move(u.data());
  e.joint_forces(q.data(), u.data(), udot.data(), nullptr, r_.data());
  const bool tree_of_actuators = islands.all().size() == actuated_.size() && mechanism_.m() == 0;
  if (!tree_of_actuators) {  // scale of forces that nothing holds
    e.joint_forces(q.data(), u.data(), none_.data(), nullptr, moving_.data());
    e.move(none_.data());
    e.joint_forces(q.data(), none_.data(), none_.data(), nullptr, still_.data());
  }
  tau.resize(static_cast<Eigen::Index>(actuated_.size()));
  redundant_ = unactuated_ = 0;
  Unheld unheld;
  for (std::size_t k = 0; k < islands.all().size(); ++k) {
    const LoopIsland& island = islands.all()[k];
    const std::vector<int>& actuators = of_island_[k];
    const VectorXd scaled =
        LoopIsland::part(island.rates, r_).cwiseProduct(LoopIsland::part(island.rates, unit));
    const auto count = static_cast<Eigen::Index>(actuators.size());
    VectorXd left;
    if (island.rows.empty() && count == 1) {
      tau[actuators.front()] = r_[island.rates.front()];
      continue;
    }
    const VectorXd b = island.N.transpose() * scaled;
    MatrixXd G(island.freedoms(), count);
    VectorXd root(count);  // root of the weights
    for (Eigen::Index i = 0; i < count; ++i) {
      root[i] = std::sqrt(weights_[actuators[static_cast<std::size_t>(i)]]);
      G.col(i) = island.N.row(place_[k][static_cast<std::size_t>(i)]).transpose() / root[i];
    }
    int rank = 0;
    left = b;
    if (count > 0 && island.freedoms() > 0) {
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> cod;
      cod.setThreshold(independent_pivot);
      cod.compute(G);
      rank = static_cast<int>(cod.rank());
      VectorXd y = cod.solve(b);
      left = b - G * y;
      if (rank == island.freedoms()) {  // refined: b is met to rounding
        y += cod.solve(left);
        left = b - G * y;
      }
      for (Eigen::Index i = 0; i < count; ++i) {
        const int to = actuators[static_cast<std::size_t>(i)];
        tau[to] = y[i] / root[i] / unit[actuated_[static_cast<std::size_t>(to)]];
      }
    } else {
      for (const int i : actuators) tau[i] = 0;
    }
    redundant_ += static_cast<int>(count) - rank;
    unactuated_ += island.freedoms() - rank;
    if (rank == island.freedoms()) continue;
    double size = size_of(scaled);
    for (const VectorXd* part : {&moving_, &still_})
      size += size_of(
          LoopIsland::part(island.rates, *part).cwiseProduct(LoopIsland::part(island.rates, unit)));
    const double force = size_of(left);
    const double missing = force > 0 ? force / size : 0;
    if (missing > unheld.missing || !(force < INFINITY)) {
      unheld.missing = missing;
      unheld.force = force;
      unheld.way.setZero(mechanism_.nv());
      LoopIsland::put(island.rates, island.N * left, unheld.way);
    }
  }
  return unheld;
}

VectorXd Actuation::multipliers(const ScaledLoops& loops, const LoopIslands& islands,
                                const VectorXd& tau) const {
  VectorXd lambda = VectorXd::Zero(mechanism_.m()), forces = -r_;
  for (std::size_t i = 0; i < actuated_.size(); ++i)
    forces[actuated_[i]] += tau[static_cast<Eigen::Index>(i)];
  forces = forces.cwiseProduct(loops.units().rates);
  for (const LoopIsland& island : islands.all())
    if (!island.rows.empty())
      LoopIsland::put(island.rows, island.multipliers(LoopIsland::part(island.rates, forces)),
                      lambda);
  return lambda.cwiseQuotient(loops.units().equations);
}

}  // namespace momenta
