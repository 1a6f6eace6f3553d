#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/kkt/multipliers.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace momenta {

UniqueMultipliers::UniqueMultipliers(const Mechanism& mechanism, Evaluation<double>& e,
                                     LoopSolver& solver)
    : mechanism_(mechanism),
      e_(e),
      solver_(solver),
      tells_(mechanism.solver().filters_pivots()),
      units_(LoopUnits(mechanism).equations),
      centre_(static_cast<std::size_t>(mechanism.m())),
      moved_(centre_.size()),
      udot_(static_cast<std::size_t>(mechanism.nv())),
      unique_(centre_.size(), true) {
  std::mt19937 random(1);  // the same direction every time
  std::uniform_real_distribution<double> size(0.5, 1);
  for (std::size_t i = 0; i < centre_.size(); ++i)
    direction_.push_back(random() % 2 ? size(random) : -size(random));
}

const std::vector<bool>& UniqueMultipliers::find(double t, const double* q, const double* u,
                                                 const double* lambda) {
  unique_.assign(centre_.size(), true);
  idle_.clear();
  if (tells_ && solver_.pivots().faded == 0) return unique_;
  // Multipliers count as accelerations, λ_i W_ii, in the units D_i of the rows [1/s²]: lengths of
  // the scene and radians, so that forces and moments compare.
  e_.place(t, q);
  std::vector<double> scale = row_scales(mechanism_, e_);
  double largest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    scale[i] /= units_[static_cast<Eigen::Index>(i)];
    largest = std::max(largest, std::abs(lambda[i]) * scale[i]);
  }
  if (!(largest > 0)) largest = 1;
  for (std::size_t i = 0; i < scale.size(); ++i) centre_[i] = direction_[i] * largest / scale[i];
  if (!solver_.acceleration(t, q, u, centre_.data(), 0, 0, udot_.data(), moved_.data())) {
    unique_.assign(unique_.size(), false);
    return unique_;
  }
  double furthest = 0;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    idle_.push_back(moved_[i] - lambda[i]);
    moved_[i] = std::abs(idle_[i]) * scale[i];
    furthest = std::max(furthest, moved_[i]);
  }
  // Regular rows move by rounding over their pivots, which are above those that fade.
  constexpr double takes_part = 1e-6;
  if (!(furthest > takes_part * largest))
    idle_.clear();
  else
    for (std::size_t i = 0; i < unique_.size(); ++i)
      unique_[i] = !(moved_[i] > takes_part * furthest);
  return unique_;
}

}  // namespace momenta
