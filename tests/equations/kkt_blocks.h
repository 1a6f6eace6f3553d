#pragma once
#include <momenta/dae/mechanism/mechanism.h>

#include <algorithm>
#include <vector>

namespace momenta::equations {

/// M (nv × nv) and Φ_q (m × nv) of (7), dense, at the configuration placed in `e`.
struct KktBlocks {
  Eigen::MatrixXd M, J;
  KktBlocks(const Mechanism& mechanism, Evaluation<double>& e)
      : M(Eigen::MatrixXd::Zero(mechanism.nv(), mechanism.nv())),
        J(Eigen::MatrixXd::Zero(mechanism.m(), mechanism.nv())) {
    const auto& pattern = mechanism.kkt_pattern();
    std::vector<double> values(std::max(pattern.mass.size(), pattern.constraint.size()));
    e.mass_entries(values.data());
    for (std::size_t i = 0; i < pattern.mass.size(); ++i)
      M(pattern.mass[i].row, pattern.mass[i].column) =
          M(pattern.mass[i].column, pattern.mass[i].row) = values[i];
    e.constraint_entries(values.data());
    for (std::size_t i = 0; i < pattern.constraint.size(); ++i)
      J(pattern.constraint[i].row, pattern.constraint[i].column) = values[i];
  }
};

}  // namespace momenta::equations
