// The index of a variable says how many derivatives of data its value takes: errors of its value
// grow like h^(1−index). With offsets c, d and a regular system Jacobian x_j is found by equations
// that were differentiated max c − d_j times more often than there are derivatives of it, so
//
//   index of x_j = 1 + max c_i − d_j, at least 1,
//
// c of the equations that hang together with x_j. A variable of the pendulum with Φ = 0: positions
// 1, velocities 2, λ 3. Where the Jacobian is singular: the differentiations after which x_j' is
// determined.

#include <momenta/core/scene/scene.h>
#include <momenta/dae/dense/singular_values.h>
#include <momenta/dae/equations/equation_start.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace momenta {
namespace {

using structure::at;

/// About the time of the motion: of an equation that has both, ∂F/∂y' over ∂F/∂y at the guess; the
/// geometric mean over equations.
double time_scale(const EquationFile& file) {
  Slopes<double> slopes(file);
  slopes.evaluate_at(file.start, file.values.data(), file.rates.data());
  std::vector<double> by_y(at(file.size())), by_rate(at(file.size()));
  for (std::size_t k = 0; k < slopes.entries().size(); ++k) {
    const auto& e = slopes.entries()[k];
    double& largest = (e.of_rate ? by_rate : by_y)[at(e.equation)];
    largest = std::max(largest, std::abs(slopes.values()[k]) * file.scales[at(e.variable)]);
  }
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < by_y.size(); ++i)
    if (const double ratio = by_rate[i] / by_y[i]; std::isfinite(ratio) && ratio > 0)
      sum += std::log(ratio), ++count;
  return count > 0 ? std::exp(sum / count) : (file.end - file.start) / 100;
}

SystemJacobian system_jacobian(const EquationFile& file, const structure::Offsets& offsets,
                               double t, const Eigen::VectorXd& y, const Eigen::VectorXd& ydot) {
  const int n = file.size();
  const structure::Signature signature = file.signature();
  Slopes<double> slopes(file);
  slopes.evaluate_at(t, y.data(), ydot.data());
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t k = 0; k < slopes.entries().size(); ++k) {
    const auto& e = slopes.entries()[k];
    if (offsets.tight(signature, e.equation, e.variable) &&
        e.of_rate == (signature(e.equation, e.variable) == 1))
      j(e.equation, e.variable) = slopes.values()[k];
  }
  SystemJacobian found;
  found.determinant = j.determinant();
  Eigen::VectorXd rows = Eigen::VectorXd::Ones(n);
  equilibrate(j, rows);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(j, Eigen::ComputeFullU | Eigen::ComputeFullV);
  found.rank = rank_by_gap(svd.singularValues(), svd.singularValues()[0]);
  for (int k = found.rank.rank; k < n; ++k) {
    Eigen::VectorXd combination = svd.matrixU().col(k).cwiseProduct(rows);
    Eigen::Index largest = 0;
    combination.cwiseAbs().maxCoeff(&largest);
    combination /= combination[largest];
    found.cancelling.push_back(std::move(combination));
  }
  return found;
}

/// max c over the equations that hang together with each variable.
std::vector<int> differentiations_around(const structure::Signature& s,
                                         const structure::Offsets& offsets) {
  const int n = s.size();
  std::vector<int> part(at(n));  // of variables
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](int j) {
    while (part[at(j)] != j) j = part[at(j)] = part[at(part[at(j)])];
    return j;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (s.has(i, j)) part[at(root(j))] = root(offsets.transversal[at(i)]);
  std::vector<int> most(at(n)), around(at(n));
  for (int i = 0; i < n; ++i) {
    int& m = most[at(root(offsets.transversal[at(i)]))];
    m = std::max(m, offsets.equation[at(i)]);
  }
  for (int j = 0; j < n; ++j) around[at(j)] = most[at(root(j))];
  return around;
}

std::vector<int> indices_of(const structure::Signature& s, const EquationStart& start) {
  const int n = s.size(), index = std::max(start.point.found.index, 1);
  std::vector<int> of(at(n), 1);
  if (start.jacobian.regular(n)) {
    const std::vector<int> around = differentiations_around(s, start.offsets);
    for (int j = 0; j < n; ++j)
      of[at(j)] = std::clamp(1 + around[at(j)] - start.offsets.variable[at(j)], 1, index);
    return of;
  }
  const auto& levels = start.point.found.levels;
  for (int j = 0; j < n; ++j) {
    const auto level = std::find_if(levels.begin(), levels.end(), [&](const ArrayLevel& l) {
      return !l.determined.empty() && l.determined[at(j)];
    });
    of[at(j)] = std::clamp(static_cast<int>(level - levels.begin()), 1, index);
  }
  return of;
}

}  // namespace

CurveSystem curve_system(const EquationFile& file) {
  const auto residual = std::make_shared<Residual<Jet>>(file);
  return {file.size(), [residual](double t, const Jet* y, const Jet* ydot, Jet* r) {
            (*residual)(Moment<Jet>::at(t), y, ydot, r);
          }};
}

Eigen::VectorXd start_scales(const EquationFile& file, const std::vector<char>& appears) {
  Eigen::VectorXd scale(file.size());
  for (int j = 0; j < file.size(); ++j)
    scale[j] = file.held[at(j)]  ? 0
               : !appears[at(j)] ? std::numeric_limits<double>::infinity()
                                 : file.scales[at(j)];
  return scale;
}

EquationStart equation_start(const EquationFile& file) {
  const int n = file.size();
  EquationStart start;
  start.time_scale = time_scale(file);
  const structure::Signature signature = file.signature();
  start.offsets = *structure::sigma_method(signature);  // the reader saw to an assignment
  start.pantelides = structure::pantelides(signature);
  start.appears.assign(at(n), 0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (signature.has(i, j) && signature(i, j) == 1) start.appears[at(j)] = 1;
  std::vector<double> r(at(n));
  Residual<double> residual(file);
  residual(file.start, file.values.data(), file.rates.data(), r.data());
  for (int i = 0; i < n; ++i)
    if (!std::isfinite(r[at(i)]))
      throw SceneError(file.where(file.equations[at(i)].at) + file.name_of(i) +
                       ": not a finite "
                       "number at the guess of the start, expected dae.values where it is one");
  const auto vector = [](const std::vector<double>& x) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())));
  };
  start.point =
      consistent_point(curve_system(file), file.start, vector(file.values), vector(file.rates),
                       start_scales(file, start.appears), start.time_scale);
  if (!start.point.why.empty()) {
    start.index_of.assign(at(n), 1);
    return start;
  }
  start.jacobian =
      system_jacobian(file, start.offsets, file.start, start.point.y, start.point.ydot);
  start.index_of = indices_of(signature, start);
  return start;
}

}  // namespace momenta
