// The index of a variable says how many derivatives of data its value takes: errors of its value
// grow like h^(1−index). With offsets c, d and a regular system Jacobian x_j is found by equations
// that were differentiated max c − d_j times more often than there are derivatives of it, so
//
//   index of x_j = 1 + max c_i − d_j, at least 1,
//
// c of the equations connected with x_j. In the pendulum with Φ = 0: positions 1, velocities 2, λ
// 3. With a singular Jacobian: the differentiations after which x_j' is determined, a little behind
// the start, which may have zeros by chance.

#include <momenta/core/scene/scene.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/analysis/equations/equation_start.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

namespace momenta {
namespace {

using structure::at;

/// Rough time scale of the motion: geometric mean of ∂F/∂y' over ∂F/∂y at the guess, of the
/// equations that have both.
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
  const SingularValues svd(j);
  found.rank = rank_by_gap(svd.values, svd.values[0]);
  for (int k = found.rank.rank; k < n; ++k) {
    Eigen::VectorXd combination = svd.u.col(k).cwiseProduct(rows);
    // The first entry that is the largest but for rounding becomes 1.
    const double most = (1 - 1e-9) * combination.cwiseAbs().maxCoeff();
    Eigen::Index first = 0;
    while (std::abs(combination[first]) < most) ++first;
    combination /= combination[first];
    found.cancelling.push_back(std::move(combination));
  }
  return found;
}

/// By variable: representative of its part, connected by equations.
std::vector<int> parts_of(const structure::Signature& s, const structure::Offsets& offsets) {
  const int n = s.size();
  std::vector<int> part(at(n));
  std::iota(part.begin(), part.end(), 0);
  const auto root = [&](int j) {
    while (part[at(j)] != j) j = part[at(j)] = part[at(part[at(j)])];
    return j;
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      if (s.has(i, j)) part[at(root(j))] = root(offsets.transversal[at(i)]);
  for (int j = 0; j < n; ++j) part[at(j)] = root(j);
  return part;
}

/// By variable: whether no equation that it follows from, one after the other, is assigned to a
/// derivative. σ summed over the assignments of such a closed set is its number of freedoms.
std::vector<char> prescribed_in(const structure::Signature& s, const structure::Offsets& offsets) {
  const int n = s.size();
  std::vector<char> prescribed(at(n));
  for (int i = 0; i < n; ++i) {
    const int j = offsets.transversal[at(i)];
    prescribed[at(j)] = s(i, j) == 0;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (int i = 0; i < n; ++i) {
      char& own = prescribed[at(offsets.transversal[at(i)])];
      for (int j = 0; own && j < n; ++j)
        if (s.has(i, j) && !prescribed[at(j)]) own = 0, changed = true;
    }
  }
  return prescribed;
}

/// max c over the equations connected with each variable.
std::vector<int> differentiations_around(const EquationStart& start) {
  const std::vector<int>&equation = start.offsets.equation,
        &transversal = start.offsets.transversal;
  std::vector<int> most(equation.size()), around(equation.size());
  for (std::size_t i = 0; i < equation.size(); ++i) {
    int& m = most[at(start.part[at(transversal[i])])];
    m = std::max(m, equation[i]);
  }
  for (std::size_t j = 0; j < around.size(); ++j) around[j] = most[at(start.part[j])];
  return around;
}

std::vector<int> indices_of(const EquationFile& file, const EquationStart& start) {
  const int n = file.size(), index = std::max(start.point.found.index, 1);
  std::vector<int> of(at(n), 1);
  if (start.jacobian.regular(n)) {
    const std::vector<int> around = differentiations_around(start);
    for (int j = 0; j < n; ++j)
      of[at(j)] = std::clamp(1 + around[at(j)] - start.offsets.variable[at(j)], 1, index);
    return of;
  }
  constexpr double behind = 0.01;
  const double step = behind * std::min(start.time_scale, file.end - file.start);
  const ConsistentPoint near = consistent_point(
      curve_system(file), file.start + step, start.point.y + step * start.point.ydot,
      start.point.ydot, start_scales(file, start.appears), start.time_scale);
  const auto& levels = (near.found.index == index ? near : start.point).found.levels;
  for (int j = 0; j < n; ++j) {
    const auto level = std::find_if(levels.begin(), levels.end(), [&](const ArrayLevel& l) {
      return !l.determined.empty() && l.determined[at(j)];
    });
    of[at(j)] = std::clamp(static_cast<int>(level - levels.begin()), 1, index);
  }
  return of;
}

/// Largest change from guess to start, over size, of variables with a derivative.
double moved_by(const EquationFile& file, const EquationStart& start,
                const ConsistentPoint& point) {
  double most = 0;
  for (int j = 0; j < file.size(); ++j)
    if (start.appears[at(j)])
      most = std::max(most, std::abs(point.y[j] - file.values[at(j)]) /
                                (std::abs(file.values[at(j)]) + file.scales[at(j)]));
  return most;
}

/// Whether ∂F/∂y' is the same at the point and with all rates reversed.
bool is_linear_in_rates(const EquationFile& file, const ConsistentPoint& point) {
  constexpr double same = 1e-9;
  const Eigen::VectorXd turned = -point.ydot;
  Slopes<double> here(file), there(file);
  here.evaluate_at(file.start, point.y.data(), point.ydot.data());
  there.evaluate_at(file.start, point.y.data(), turned.data());
  for (std::size_t k = 0; k < here.entries().size(); ++k) {
    const double a = here.values()[k], b = there.values()[k];
    if (here.entries()[k].of_rate && !(std::abs(a - b) <= same * (std::abs(a) + std::abs(b))))
      return false;
  }
  return true;
}

/// A guess of rates on which the equations do not depend there, y'² = y at y' = 0, changes values
/// instead, or has no start. Returns the start that other rates lead to with the values kept; if
/// there are two, `why` asks for a guess of one of the rates.
ConsistentPoint with_other_rates(const EquationFile& file, const EquationStart& start,
                                 const Eigen::VectorXd& y, ConsistentPoint found) {
  constexpr double moved = 1e-6;
  const bool stays = found.why.empty() && moved_by(file, start, found) < moved;
  if (stays && is_linear_in_rates(file, found)) return found;
  std::vector<ConsistentPoint> others;
  for (const double sign : {1.0, -1.0}) {
    if (stays && others.empty()) {
      others.push_back(found);
      continue;
    }
    Eigen::VectorXd rates(file.size());
    bool changed = false;
    for (int j = 0; j < file.size(); ++j) {
      const bool open = start.appears[at(j)] && file.rates[at(j)] == 0;
      const double size = (std::abs(y[j]) + file.scales[at(j)]) / (file.end - file.start);
      rates[j] = !open ? file.rates[at(j)] : stays ? -found.ydot[j] : sign * size;
      changed |= open;
    }
    if (!changed) return found;
    ConsistentPoint other = consistent_point(curve_system(file), file.start, y, rates,
                                             start_scales(file, start.appears), start.time_scale);
    if (other.why.empty() && (!found.why.empty() || moved_by(file, start, other) < moved))
      others.push_back(other);
  }
  if (others.empty()) return found;
  for (int j = 0; j < file.size(); ++j) {
    const double a = others.front().ydot[j], b = others.back().ydot[j];
    if (!start.appears[at(j)] || std::abs(a - b) <= moved * (std::abs(a) + std::abs(b))) continue;
    const auto rate = [&](double x) { return compact(x, 6); };
    found.why = "the equations leave the rate of " + file.variables[at(j)] + " undetermined, " +
                rate(a) + " or " + rate(b) + ": expected one of them as its guess, rates = { " +
                file.variables[at(j)] + " = " + rate(a) + " }";
    return found;
  }
  return others.front();
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
  start.offsets = *structure::sigma_method(signature);  // the reader ensures an assignment
  start.pantelides = structure::pantelides(signature);
  start.part = parts_of(signature, start.offsets);
  start.prescribed = prescribed_in(signature, start.offsets);
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
  start.point = with_other_rates(file, start, vector(file.values), std::move(start.point));
  if (!start.point.why.empty()) {
    start.index_of.assign(at(n), 1);
    return start;
  }
  start.jacobian =
      system_jacobian(file, start.offsets, file.start, start.point.y, start.point.ydot);
  start.index_of = indices_of(file, start);
  return start;
}

}  // namespace momenta
