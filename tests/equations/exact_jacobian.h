#pragma once
// Newton's matrix of a DAE against central differences of its residual.

#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/integrator/system.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta::equations {

/// ∂F/∂y + c ∂F/∂y' at (t, y, ydot), sparse for more than 60 unknowns, within 1e-8: h² of the third
/// derivative, ε/h of rounding.
inline void expect_exact_jacobian(DaeSystem& dae, double t, std::vector<double> y,
                                  std::vector<double> ydot, const std::string& name) {
  const auto n = static_cast<std::size_t>(dae.size());
  const double c = 7.3;
  const JacobianPattern& pattern = dae.pattern();
  const bool sparse = !pattern.column_start.empty();
  EXPECT_EQ(sparse, n > 60) << name;
  std::vector<double> values(sparse ? pattern.row.size() : n * n);
  ASSERT_TRUE(dae.jacobian(t, y.data(), ydot.data(), c, values.data()));
  Eigen::MatrixXd exact = Eigen::MatrixXd::Zero(dae.size(), dae.size());
  if (!sparse) exact = Eigen::Map<Eigen::MatrixXd>(values.data(), dae.size(), dae.size());
  for (std::size_t j = 0; sparse && j < n; ++j)
    for (auto k = pattern.column_start[j]; k < pattern.column_start[j + 1]; ++k)
      exact(pattern.row[static_cast<std::size_t>(k)], static_cast<Eigen::Index>(j)) =
          values[static_cast<std::size_t>(k)];
  Eigen::MatrixXd differences(dae.size(), dae.size());
  Eigen::VectorXd ahead(dae.size()), behind(dae.size());
  for (std::size_t j = 0; j < n; ++j) {
    const double y0 = y[j], ydot0 = ydot[j], h = 1e-5;
    y[j] = y0 + h;
    ydot[j] = ydot0 + c * h;
    ASSERT_TRUE(dae.residual(t, y.data(), ydot.data(), ahead.data()));
    y[j] = y0 - h;
    ydot[j] = ydot0 - c * h;
    ASSERT_TRUE(dae.residual(t, y.data(), ydot.data(), behind.data()));
    y[j] = y0;
    ydot[j] = ydot0;
    differences.col(static_cast<Eigen::Index>(j)) = (ahead - behind) / (2 * h);
  }
  EXPECT_LT(relative_error(exact, differences), 1e-8) << name;
}

}  // namespace momenta::equations
