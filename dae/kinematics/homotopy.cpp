#include <momenta/dae/kinematics/homotopy.h>
#include <momenta/dae/sample/sample.h>

#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>

namespace momenta {
namespace {

using Eigen::MatrixXcd;
using Eigen::VectorXcd;

constexpr double t_end = 1e-8;
constexpr double newton_size = 1e-10;   // of a step that ends Newton's method
constexpr double beside = 1e-5;         // how far a path may lie from where it was expected
constexpr double regular = 1e-11;       // smallest pivot over the largest of a regular end
constexpr double proper_size = 1e-6;    // of the proper variables of a finite end
constexpr double smallest_step = 1e-9;  // of t
constexpr double same_end = 1e-8;       // apart, of ends, beside length one

enum class End { finite, infinite, singular, lost };

/// Random numbers on the unit circle, one after the other.
class Circle {
 public:
  explicit Circle(std::uint64_t seed) : seed_(seed) {}
  Complex next() {
    return std::polar(1.0, 2 * std::numbers::pi * in_unit_interval(noise(seed_, 71, count_++)));
  }

 private:
  std::uint64_t seed_, count_ = 0;
};

/// G: products of linear forms.
class StartSystem {
 public:
  StartSystem(const PolynomialSystem& f, Circle& circle) : f_(f) {
    for (int i = 0; i < f.equations(); ++i) {
      forms_.emplace_back();
      for (std::size_t g = 0; g < f.groups().size(); ++g)
        for (int k = 0; k < f.degree(i, static_cast<int>(g)); ++k) {
          VectorXcd c = VectorXcd::Zero(f.variables());
          for (const int x : f.groups()[g].variables) c[x] = circle.next();
          forms_.back().push_back({static_cast<int>(g), std::move(c)});
        }
    }
    choose(0, std::vector<int>(f.groups().size(), 0), {});
  }

  std::size_t solutions() const { return choices_.size(); }

  VectorXcd solution(std::size_t number) const {
    VectorXcd x = VectorXcd::Zero(f_.variables());
    for (std::size_t g = 0; g < f_.groups().size(); ++g) {
      const auto& own = f_.groups()[g].variables;
      const auto n = static_cast<Eigen::Index>(own.size());
      MatrixXcd a(n - 1, n);
      Eigen::Index row = 0;
      for (std::size_t i = 0; i < forms_.size(); ++i) {
        const Form& form = forms_[i][choices_[number][i]];
        if (form.group != static_cast<int>(g)) continue;
        for (Eigen::Index k = 0; k < n; ++k) a(row, k) = form.c[own[static_cast<std::size_t>(k)]];
        ++row;
      }
      // The last variable is one.
      VectorXcd part(n);
      part[n - 1] = 1;
      if (n > 1) {
        const VectorXcd right = -a.col(n - 1);
        const MatrixXcd left = a.leftCols(n - 1);
        part.head(n - 1) = Eigen::PartialPivLU<MatrixXcd>(left).solve(right);
      }
      part.normalize();
      for (Eigen::Index k = 0; k < n; ++k) x[own[static_cast<std::size_t>(k)]] = part[k];
    }
    return x;
  }

  void evaluate(const VectorXcd& x, VectorXcd& values, MatrixXcd& slopes) const {
    values.setZero(f_.equations());
    slopes.setZero(f_.equations(), f_.variables());
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      std::vector<Complex> factors;
      for (const Form& form : forms_[i]) factors.push_back((form.c.transpose() * x)(0));
      Complex product = 1;
      for (const Complex& factor : factors) product *= factor;
      values[row] = product;
      for (std::size_t k = 0; k < factors.size(); ++k) {
        Complex others = 1;
        for (std::size_t j = 0; j < factors.size(); ++j)
          if (j != k) others *= factors[j];
        slopes.row(row) += others * forms_[i][k].c.transpose();
      }
    }
  }

 private:
  struct Form {
    int group;
    VectorXcd c;
  };

  void choose(std::size_t equation, const std::vector<int>& taken,
              std::vector<std::size_t> chosen) {
    if (equation == forms_.size()) {
      choices_.push_back(std::move(chosen));
      return;
    }
    chosen.push_back(0);
    for (std::size_t k = 0; k < forms_[equation].size(); ++k) {
      const auto g = static_cast<std::size_t>(forms_[equation][k].group);
      if (taken[g] + 1 >= static_cast<int>(f_.groups()[g].variables.size())) continue;
      std::vector<int> more = taken;
      ++more[g];
      chosen.back() = k;
      choose(equation + 1, more, chosen);
    }
  }

  const PolynomialSystem& f_;
  std::vector<std::vector<Form>> forms_;
  std::vector<std::vector<std::size_t>> choices_;  ///< of each solution, the factors that vanish
};

/// Follows one path after the other.
class PathFollower {
 public:
  PathFollower(const PolynomialSystem& f, const StartSystem& g, Complex gamma, double longest)
      : f_(f), g_(g), gamma_(gamma), longest_(longest) {}

  std::pair<End, VectorXcd> follow(VectorXcd x) {
    double t = 1, step = 0.02 * longest_;
    int good = 0;
    double checked_at = 0;  // t where the proper variables were kept
    std::vector<double> kept;
    while (t > t_end) {
      // At the most 30 % of what is left, and of the short way near t = 1 as well.
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
      if (*std::min_element(sizes.begin(), sizes.end()) > proper_size) return {End::finite, end};
      return {End::infinite, end};
    }
    const End told = seems_infinite(x, t, kept, checked_at);
    return {told == End::lost ? End::singular : told, x};
  }

 private:
  /// |x_proper| of each group; x has length one there.
  std::vector<double> proper(const VectorXcd& x) const {
    std::vector<double> sizes;
    for (const VariableGroup& g : f_.groups()) {
      double sum = 0;
      for (const int v : g.proper) sum += std::norm(x[v]);
      sizes.push_back(std::sqrt(sum));
    }
    return sizes;
  }

  /// Infinite where the proper variables fell like t^a, a > 0.05, since they were kept; else lost.
  End seems_infinite(const VectorXcd& x, double t, const std::vector<double>& kept,
                     double since) const {
    if (kept.empty() || t > 0.1 * since) return End::lost;
    const std::vector<double> now = proper(x);
    for (std::size_t g = 0; g < now.size(); ++g)
      if (now[g] < 0.1 && std::log(now[g] / kept[g]) / std::log(t / since) > 0.05)
        return End::infinite;
    return End::lost;
  }

  void normalise(VectorXcd& x) const {
    for (const VariableGroup& g : f_.groups()) {
      double sum = 0;
      for (const int v : g.variables) sum += std::norm(x[v]);
      for (const int v : g.variables) x[v] /= std::sqrt(sum);
    }
  }

  /// H, H_t (n) and H_x with the rows of the patch below it.
  void evaluate(const VectorXcd& x, double t) {
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
  VectorXcd slope(const VectorXcd& x, double t) {
    evaluate(x, t);
    lu_.compute(matrix_);
    return -lu_.solve(by_t_);
  }

  bool predict(VectorXcd& x, double t, double h) {
    patch_ = x;
    const VectorXcd k1 = slope(x, t), k2 = slope(x - h / 2 * k1, t - h / 2),
                    k3 = slope(x - h / 2 * k2, t - h / 2), k4 = slope(x - h * k3, t - h);
    x -= h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
    return x.allFinite();
  }

  bool correct(VectorXcd& x, double t) {
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

  /// Newton's method on F; smallest pivot over largest at its end, 0 where there is none.
  double polish(VectorXcd& x) {
    patch_ = x;
    double pivots = 0, before = 1e-3;
    for (int k = 0; k < 8; ++k) {
      evaluate(x, 0);
      lu_.compute(matrix_);
      const VectorXcd step = lu_.solve(value_);
      const double size = step.norm();
      const Eigen::VectorXd diagonal = lu_.matrixLU().diagonal().cwiseAbs();
      pivots = diagonal.minCoeff() / diagonal.maxCoeff();
      if (!(size < before)) return size < 1e-11 ? pivots : 0;  // what rounding leaves
      x -= step;
      normalise(x);
      patch_ = x;
      if (size < 1e-15) break;
      before = k == 0 ? 0.1 * size + 1e-12 : std::max(0.5 * size, 1e-12);
    }
    return pivots;
  }

  const PolynomialSystem& f_;
  const StartSystem& g_;
  Complex gamma_;
  double longest_;
  VectorXcd of_f_, of_g_, value_, by_t_, patch_;
  MatrixXcd slopes_f_, slopes_g_, matrix_;
  Eigen::PartialPivLU<MatrixXcd> lu_;
};

/// Whether two ends are one point: in every group parallel.
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
  Circle circle(seed);
  const StartSystem start(system, circle);
  const Complex gamma = circle.next();
  std::vector<std::pair<End, VectorXcd>> ends(start.solutions());
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
      met[i] = met[i] || ends[i].first == End::lost;
      if (ends[i].first != End::finite) continue;
      for (std::size_t j = 0; j < i; ++j)
        if (ends[j].first == End::finite && is_same(system, ends[i].second, ends[j].second))
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
  for (const std::size_t i : again) ends[i].first = End::lost;
  for (auto& [end, x] : ends) {
    if (end == End::finite) found.finite.push_back(std::move(x));
    found.infinite += end == End::infinite;
    found.singular += end == End::singular;
    found.lost += end == End::lost;
  }
  return found;
}

}  // namespace momenta
