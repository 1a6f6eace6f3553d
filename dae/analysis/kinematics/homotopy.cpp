#include <momenta/dae/analysis/kinematics/homotopy.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

namespace momenta {

using Eigen::MatrixXcd;
using Eigen::VectorXcd;

namespace {

constexpr double t_end = 1e-8;
constexpr double newton_size = 1e-10;   // step that ends Newton's method
constexpr double beside = 1e-5;         // distance from the prediction
constexpr double regular = 1e-11;       // relative pivot of a regular end
constexpr double proper_size = 1e-6;    // least proper variables of a finite end
constexpr double smallest_step = 1e-9;  // step of t

}  // namespace

std::pair<PathEnd, VectorXcd> PathFollower::follow(VectorXcd x) {
  double t = 1, step = 0.02 * longest_;
  int good = 0;
  double checked_at = 0;  // t where the proper variables were kept
  std::vector<double> kept;
  while (t > t_end) {
    // At most 30 % of the rest, and of the way from t = 1.
    const double h = std::min({step, 0.3 * longest_ * t, t - t_end});
    VectorXcd next = x;
    if (predict(next, t, h) && correct(next, t - h)) {
      x = std::move(next);
      normalise(x);
      t = h >= t - t_end ? t_end : t - h;
      if (kept.empty() && t < 1e-4) {
        kept = proper(x);
        checked_at = t;
      }
      if (++good >= 4) {
        step *= 2;
        good = 0;
      }
      step = std::min(step, 0.1 * longest_);
    } else {
      step = h / 2;
      good = 0;
      if (step < smallest_step * t) return {seems_infinite(x, t, kept, checked_at), x};
    }
  }
  VectorXcd end = x;
  const double pivots = polish(end);
  if (pivots > regular) {
    const std::vector<double> sizes = proper(end);
    if (*std::min_element(sizes.begin(), sizes.end()) > proper_size) return {PathEnd::finite, end};
    return {PathEnd::infinite, end};
  }
  const PathEnd told = seems_infinite(x, t, kept, checked_at);
  return {told == PathEnd::lost ? PathEnd::singular : told, x};
}

/// |x_proper| by set; x has length one in each group.
std::vector<double> PathFollower::proper(const VectorXcd& x) const {
  std::vector<double> sizes;
  for (const VariableGroup& g : f_.groups())
    for (const std::vector<int>& set : g.proper) {
      double sum = 0;
      for (const int v : set) sum += std::norm(x[v]);
      sizes.push_back(std::sqrt(sum));
    }
  return sizes;
}

/// Infinite if the proper variables fell like t^a, a > 0.05, since `kept`; else lost.
PathEnd PathFollower::seems_infinite(const VectorXcd& x, double t, const std::vector<double>& kept,
                                     double since) const {
  if (kept.empty() || t > 0.1 * since) return PathEnd::lost;
  const std::vector<double> now = proper(x);
  for (std::size_t g = 0; g < now.size(); ++g)
    if (now[g] < 0.1 && std::log(now[g] / kept[g]) / std::log(t / since) > 0.05)
      return PathEnd::infinite;
  return PathEnd::lost;
}

void PathFollower::normalise(VectorXcd& x) const {
  for (const VariableGroup& g : f_.groups()) {
    double sum = 0;
    for (const int v : g.variables) sum += std::norm(x[v]);
    for (const int v : g.variables) x[v] /= std::sqrt(sum);
  }
}

/// H, H_t (n) and H_x, with the rows of the patch below.
void PathFollower::evaluate(const VectorXcd& x, double t) {
  f_.evaluate(x, of_f_, slopes_f_);
  g_.evaluate(x, of_g_, slopes_g_);
  const Eigen::Index n = of_f_.size();
  matrix_.setZero(f_.variables(), f_.variables());
  matrix_.topRows(n) = gamma_ * t * slopes_g_ + (1 - t) * slopes_f_;
  value_.setZero(f_.variables());
  value_.head(n) = gamma_ * t * of_g_ + (1 - t) * of_f_;
  by_t_.setZero(f_.variables());
  by_t_.head(n) = gamma_ * of_g_ - of_f_;
  for (std::size_t g = 0; g < f_.groups().size(); ++g)
    for (const int v : f_.groups()[g].variables)
      matrix_(n + static_cast<Eigen::Index>(g), v) = std::conj(patch_[v]);
}

/// dx/dt
VectorXcd PathFollower::slope(const VectorXcd& x, double t) {
  evaluate(x, t);
  lu_.compute(matrix_);
  return -lu_.solve(by_t_);
}

bool PathFollower::predict(VectorXcd& x, double t, double h) {
  patch_ = x;
  const VectorXcd k1 = slope(x, t), k2 = slope(x - h / 2 * k1, t - h / 2),
                  k3 = slope(x - h / 2 * k2, t - h / 2), k4 = slope(x - h * k3, t - h);
  x -= h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  return x.allFinite();
}

bool PathFollower::correct(VectorXcd& x, double t) {
  double before = beside * longest_;  // a larger step may lead to another path
  for (int k = 0; k < 3; ++k) {
    evaluate(x, t);
    lu_.compute(matrix_);
    const VectorXcd step = lu_.solve(value_);
    const double size = step.norm();
    if (!(size < before)) return size < 1e-3 * newton_size;
    x -= step;
    if (size < newton_size) return true;
    before = std::max(0.3 * size, newton_size);
  }
  return false;
}

/// Newton's method on F; returns smallest over largest pivot at its end, 0 without one.
double PathFollower::polish(VectorXcd& x) {
  patch_ = x;
  double pivots = 0, before = 1e-3;
  for (int k = 0; k < 8; ++k) {
    evaluate(x, 0);
    lu_.compute(matrix_);
    const VectorXcd step = lu_.solve(value_);
    const double size = step.norm();
    const Eigen::VectorXd diagonal = lu_.matrixLU().diagonal().cwiseAbs();
    pivots = diagonal.minCoeff() / diagonal.maxCoeff();
    if (!(size < before)) return size < 1e-11 ? pivots : 0;  // rounding
    x -= step;
    normalise(x);
    patch_ = x;
    if (size < 1e-15) break;
    before = k == 0 ? 0.1 * size + 1e-12 : std::max(0.5 * size, 1e-12);
  }
  return pivots;
}

namespace {

using Eigen::VectorXcd;

constexpr double same_end = 1e-8;  // distance between equal ends of length one

/// Whether ends are parallel in every group.
bool is_same(const PolynomialSystem& f, const VectorXcd& a, const VectorXcd& b) {
  for (const VariableGroup& g : f.groups()) {
    Complex product = 0;
    for (const int v : g.variables) product += std::conj(a[v]) * b[v];
    if (std::abs(product) < 1e-3) return false;
    double gap = 0;
    for (const int v : g.variables) gap += std::norm(b[v] - product / std::abs(product) * a[v]);
    if (std::sqrt(gap) > same_end) return false;
  }
  return true;
}

}  // namespace

HomotopyEnds solve_by_homotopy(const PolynomialSystem& system, std::uint64_t seed, int threads) {
  UnitCircle circle(seed);
  const StartSystem start(system, circle);
  const Complex gamma = circle.next();
  std::vector<std::pair<PathEnd, VectorXcd>> ends(start.solutions());
  const auto follow_all = [&](const std::vector<std::size_t>& which, double longest) {
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> workers;
    for (int k = 0; k < std::max(1, threads); ++k)
      workers.emplace_back([&] {
        PathFollower follower(system, start, gamma, longest);
        for (std::size_t i; (i = next++) < which.size();)
          ends[which[i]] = follower.follow(start.solution(which[i]));
      });
  };
  const auto doubtful = [&] {
    std::vector<std::size_t> some;
    std::vector<bool> met(ends.size(), false);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      met[i] = met[i] || ends[i].first == PathEnd::lost;
      if (ends[i].first != PathEnd::finite) continue;
      for (std::size_t j = 0; j < i; ++j)
        if (ends[j].first == PathEnd::finite && is_same(system, ends[i].second, ends[j].second))
          met[i] = met[j] = true;
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (met[i]) some.push_back(i);
    return some;
  };
  std::vector<std::size_t> again(ends.size());
  for (std::size_t i = 0; i < again.size(); ++i) again[i] = i;
  double longest = 1;
  for (int round = 0; round < 3 && !again.empty(); ++round, longest /= 10) {
    follow_all(again, longest);
    again = doubtful();
  }
  HomotopyEnds found;
  found.paths = static_cast<long>(ends.size());
  for (const std::size_t i : again) ends[i].first = PathEnd::lost;
  for (auto& [end, x] : ends) {
    if (end == PathEnd::finite) found.finite.push_back(std::move(x));
    found.infinite += end == PathEnd::infinite;
    found.singular += end == PathEnd::singular;
    found.lost += end == PathEnd::lost;
  }
  return found;
}

}  // namespace momenta
