#include <momenta/dae/assembly/second_order.h>
#include <momenta/dae/dense/decompositions.h>
#include <momenta/dae/dense/least_squares.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/loop_word.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double no_form = 1e-6;       // of what a form is summed from: redundant, or rounding
constexpr double no_curvature = 1e-9;  // of Φ in units: rows that say nothing
constexpr double most_entries = 1e5;
constexpr Eigen::Index most_free = 60;

class Random {
 public:
  VectorXd direction(Eigen::Index n) {
    VectorXd y(n);
    for (double& x : y)
      x = 2 * static_cast<double>(random_()) / static_cast<double>(std::mt19937::max()) - 1;
    return y.normalized();
  }

 private:
  std::mt19937 random_{1};  // the same directions every time
};

/// Symmetric forms F_i of z unknowns.
struct Forms {
  std::vector<MatrixXd> all;
  Eigen::Index size() const { return all.front().rows(); }
  VectorXd at(const VectorXd& y) const {
    VectorXd values(static_cast<Eigen::Index>(all.size()));
    for (std::size_t i = 0; i < all.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = y.dot(all[i] * y);
    return values;
  }
  MatrixXd sum(const VectorXd& c) const {
    MatrixXd m = MatrixXd::Zero(size(), size());
    for (std::size_t i = 0; i < all.size(); ++i) m += c[static_cast<Eigen::Index>(i)] * all[i];
    return m;
  }
  /// In the unknowns x, y = basis x.
  Forms in(const MatrixXd& basis) const {
    Forms f;
    for (const MatrixXd& form : all) f.all.push_back(basis.transpose() * form * basis);
    return f;
  }
};

/// Orthonormal columns spanning directions y with F_i(y) = 0: by Gauss-Newton from many starts.
MatrixXd zeros_of(const Forms& f) {
  constexpr int iterations = 80;
  constexpr double reached = 1e-14, another = 1e-3;  // rounding of y F y leaves 1e-16
  const Eigen::Index n = f.size();
  Random random;
  MatrixXd span(n, 0);
  const int starts = 20 + 4 * static_cast<int>(n);
  for (int start = 0; start < starts && span.cols() < n; ++start) {
    VectorXd y = random.direction(n);
    VectorXd values = f.at(y);
    for (int i = 0; i < iterations && values.norm() > reached; ++i) {
      MatrixXd slopes(values.size(), n);
      for (std::size_t k = 0; k < f.all.size(); ++k)
        slopes.row(static_cast<Eigen::Index>(k)) = 2 * (f.all[k] * y).transpose();
      MatrixXd normal = slopes * slopes.transpose();
      normal.diagonal().array() += 1e-3 * values.squaredNorm() + 1e-300;
      y = (y - slopes.transpose() * normal.ldlt().solve(values)).normalized();
      if (!y.allFinite()) break;
      values = f.at(y);
    }
    if (!(values.norm() <= reached)) continue;
    y -= span * (span.transpose() * y);
    if (!(y.norm() > another)) continue;
    span.conservativeResize(n, span.cols() + 1);
    span.rightCols(1) = y.normalized();
  }
  return span;
}

/// Σ c_i F_i that is positive definite, c by the rule of perceptrons: each y where it is not adds
/// F_i(y). Empty where none was found.
VectorXd positive_sum(const Forms& f) {
  constexpr int most = 500;
  constexpr double positive = 1e-6;
  VectorXd c = f.at(VectorXd::Ones(f.size()).normalized());
  for (int i = 0; i < most; ++i) {
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(f.sum(c));
    const VectorXd& values = eigen.eigenvalues();
    if (values[0] > positive * values.cwiseAbs().maxCoeff()) return c;
    const VectorXd there = f.at(eigen.eigenvectors().col(0));
    if (!(there.norm() > 0)) break;
    c += there.normalized();
  }
  return {};
}

class SecondOrderForms {
 public:
  SecondOrderForms(ScaledLoops& loops, double t, const VectorXd& q)
      : loops_(loops), mechanism_(loops.mechanism()), e_(loops.evaluation()), t_(t), q_(q) {}

  SecondOrder find(int rank) {
    SecondOrder found;
    const auto m = mechanism_.m(), n = mechanism_.nv();
    if (static_cast<double>(m) * n > most_entries || n - rank > most_free) return found;
    e_.place(t_, q_.data());
    const MatrixXd a = scaled_jacobian(mechanism_, e_).a;
    if (!a.allFinite()) return found;
    free_ = rank_and_idle(a.transpose(), 0, rank).left;
    idle_ = idle(a, rank);
    leave_out_time(a);
    if (idle_.cols() == 0 || free_.cols() == 0 || !keep_curved()) return found;
    Forms forms = all_forms();
    // Where no form depends on y all forms are zero.
    MatrixXd squares = MatrixXd::Zero(free_.cols(), free_.cols());
    for (const MatrixXd& form : forms.all) squares += form * form;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(squares);
    const double least = no_form * no_form * eigen.eigenvalues().maxCoeff();
    found.flat = (eigen.eigenvalues().array() <= least).count();
    const MatrixXd curved = eigen.eigenvectors().rightCols(free_.cols() - found.flat);
    judge(forms.in(curved), curved, found);
    return found;
  }

 private:
  /// ω of equations of positions, columns.
  MatrixXd idle(const MatrixXd& a, int rank) const {
    if (!mechanism_.has_nonholonomic()) return rank_and_idle(a, 0, rank).left;
    std::vector<int> rows;
    for (int i = 0; i < mechanism_.m(); ++i)
      if (!mechanism_.nonholonomic()[static_cast<std::size_t>(i)]) rows.push_back(i);
    const MatrixXd of_positions = a(rows, Eigen::all);
    const MatrixXd left = rank_and_idle(of_positions).left;
    MatrixXd whole = MatrixXd::Zero(a.rows(), left.cols());
    whole(rows, Eigen::all) = left;
    return whole;
  }

  /// Φ̈ in units at rates u = C x, no accelerations; x null: none.
  VectorXd bend(const VectorXd& x) {
    const VectorXd u = x.cwiseProduct(loops_.units().rates);
    VectorXd g(mechanism_.m()), force(mechanism_.nv());
    e_.move(u.data());
    e_.joint_forces(q_.data(), u.data(), nullptr, nullptr, force.data());
    e_.accelerations(g.data());
    return g.cwiseQuotient(loops_.units().equations);
  }
  /// Φ_qq[V y, V y]
  VectorXd curvature(const VectorXd& y) {
    const VectorXd x = free_ * y;
    if (!moving_) return bend(x);
    return 0.5 * (bend(x) + bend(-x)) - still_;
  }

  /// Keeps the ω of loops that do not move with time.
  void leave_out_time(const MatrixXd& a) {
    const VectorXd none = VectorXd::Zero(mechanism_.nv());
    still_ = bend(none);
    VectorXd rate(mechanism_.m());
    e_.velocities(rate.data());
    const VectorXd here = loops_.gap(t_, q_);
    MatrixXd parts(mechanism_.m(), 0);
    const auto add = [&](const VectorXd& part) {
      parts.conservativeResize(mechanism_.m(), parts.cols() + 1);
      parts.rightCols(1) = part;
    };
    for (const double later : {0.1, 1.0, 10.0}) add(loops_.gap(t_ + later, q_) - here);
    e_.place(t_, q_.data());
    moving_ = !parts.isZero(1e-12) || !rate.isZero(0) || !still_.isZero(0);
    if (!moving_ || idle_.cols() == 0) return;
    // Φ̈ at u₀ + V y, u₀ what the time asks for: its part without y, and that linear in y.
    DenseLeastSquares least;
    least.compute(a, rank_tolerance);
    const VectorXd start = -least.solve(VectorXd(rate.cwiseQuotient(loops_.units().equations)));
    add(bend(start));
    for (Eigen::Index i = 0; i < free_.cols(); ++i)
      add(0.5 * (bend(start + free_.col(i)) - bend(start - free_.col(i))));
    const MatrixXd seen = idle_.transpose() * parts;
    const double terms = (idle_.cwiseAbs().transpose() * parts.cwiseAbs()).maxCoeff();
    idle_ = idle_ * (seen.cwiseAbs().maxCoeff() > no_form * terms
                         ? rank_and_idle(seen, terms).left
                         : MatrixXd::Identity(seen.rows(), seen.rows()));
  }

  /// Keeps of the ω combinations whose form is not zero; false: there is none.
  bool keep_curved() {
    Random random;
    const Eigen::Index f = free_.cols();
    const Eigen::Index samples = std::min(idle_.cols(), f * (f + 1) / 2) + 2;
    MatrixXd values(idle_.cols(), samples);
    double terms = 0;
    for (Eigen::Index i = 0; i < samples; ++i) {
      const VectorXd g = curvature(random.direction(f));
      if (!g.allFinite()) return false;
      values.col(i) = idle_.transpose() * g;
      terms = std::max(terms, (idle_.cwiseAbs().transpose() * g.cwiseAbs()).maxCoeff());
    }
    const double least = std::max(no_form * terms, no_curvature);
    if (!(values.cwiseAbs().maxCoeff() > least)) return false;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(values * values.transpose());
    const auto flat = (eigen.eigenvalues().array() <= least * least).count();
    idle_ = idle_ * eigen.eigenvectors().rightCols(idle_.cols() - flat);
    return idle_.cols() > 0;
  }

  Forms all_forms() {
    const Eigen::Index f = free_.cols(), p = idle_.cols();
    Forms forms;
    forms.all.assign(static_cast<std::size_t>(p), MatrixXd::Zero(f, f));
    const auto fill = [&](Eigen::Index i, Eigen::Index j, const VectorXd& g) {
      const VectorXd value = idle_.transpose() * g;
      for (Eigen::Index k = 0; k < p; ++k) {
        MatrixXd& form = forms.all[static_cast<std::size_t>(k)];
        form(i, j) = form(j, i) = value[k];
      }
    };
    for (Eigen::Index i = 0; i < f; ++i) {
      const VectorXd y = VectorXd::Unit(f, i);
      fill(i, i, curvature(y));
      for (Eigen::Index j = 0; j < i; ++j) {
        const VectorXd other = VectorXd::Unit(f, j);
        fill(i, j, 0.25 * (curvature(y + other) - curvature(y - other)));
      }
    }
    double largest = 0;
    for (const MatrixXd& form : forms.all) largest = std::max(largest, form.norm());
    for (MatrixXd& form : forms.all) form /= largest;
    return forms;
  }

  void judge(const Forms& forms, const MatrixXd& curved, SecondOrder& found) {
    const MatrixXd zeros = zeros_of(forms);
    const Eigen::Index n = forms.size(), rest = n - zeros.cols();
    if (rest == 0) return;
    const MatrixXd others = zeros.cols() == 0 ? MatrixXd::Identity(n, n)
                                              : MatrixXd(orthogonal_factor(zeros).rightCols(rest));
    // Of a form that is nowhere negative zeros are minima: F y = 0 there.
    MatrixXd combinations = MatrixXd::Identity(idle_.cols(), idle_.cols());
    if (zeros.cols() > 0) {
      MatrixXd slopes(idle_.cols(), n * zeros.cols());
      for (std::size_t i = 0; i < forms.all.size(); ++i)
        slopes.row(static_cast<Eigen::Index>(i)) = (forms.all[i] * zeros).reshaped().transpose();
      combinations = left_null_space(slopes, no_form);
    }
    VectorXd c;
    if (combinations.cols() > 0) {
      Forms positive;
      for (Eigen::Index k = 0; k < combinations.cols(); ++k)
        positive.all.push_back(others.transpose() * forms.sum(combinations.col(k)) * others);
      c = positive_sum(positive);
    }
    found.certain = c.size() > 0;
    found.all = zeros.cols() == 0;
    const VectorXd y = curved * others.col(0);
    found.stuck = (free_ * y).cwiseProduct(loops_.units().rates);
    const VectorXd force = idle_ * (c.size() > 0 ? VectorXd(combinations * c)
                                                 : VectorXd(VectorXd::Ones(idle_.cols())));
    Eigen::Index worst = 0;
    force.cwiseProduct(curvature(y)).cwiseAbs().maxCoeff(&worst);
    found.row = static_cast<int>(worst);
  }

  ScaledLoops& loops_;
  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  double t_;
  const VectorXd& q_;
  MatrixXd free_, idle_;  ///< V and the ω, columns, in units
  VectorXd still_;        ///< Φ̈ without rates, in units
  bool moving_ = false;   ///< with time
};

}  // namespace

SecondOrder second_order(ScaledLoops& loops, double t, const VectorXd& q, int rank) {
  return SecondOrderForms(loops, t, q).find(rank);
}

std::string in_words(const Mechanism& mechanism, const SecondOrder& found) {
  constexpr double takes_part = 1e-6;
  constexpr int most_named = 6;
  Eigen::Index first = 0;
  found.stuck.cwiseAbs().maxCoeff(&first);
  const VectorXd rates = found.stuck / found.stuck[first];
  const std::vector<Column> names = mechanism.rate_columns();
  std::string words;
  int named = 0;
  for (Eigen::Index i = 0; i < rates.size(); ++i) {
    if (!(std::abs(rates[i]) > takes_part)) continue;
    if (++named > most_named) {
      words += ", …";
      break;
    }
    char value[32];
    std::snprintf(value, sizeof value, " = %.3g", rates[i]);
    words += (named > 1 ? ", " : "") + names[static_cast<std::size_t>(i)].name + value;
  }
  const std::string loop = loop_word(mechanism);
  return "at the rates " + words + " the " + loop + "s stay closed to first order, but " + loop +
         " '" + mechanism.rows()[static_cast<std::size_t>(found.row)].loop +
         "' opens with the square of the way, " +
         (found.certain ? "whichever way it goes" : "and no way was found on which it does not") +
         "; expected a pose that is not stretched or flattened, other lengths, or these "
         "freedoms fixed";
}

}  // namespace momenta
