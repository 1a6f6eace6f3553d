#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/quadratic_forms.h>
#include <momenta/dae/topology/assembly/second_order.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rounding = 3e-6;  // forms, relative to their terms and to one
// Rows that depend on others to δ turn V and ω by δ over the least singular value that counts, and
// leave as much in a zero form.
constexpr double beside_dependence = 30, too_close = 0.1;
constexpr double at_rest = 1e-12;  // Φ, Φ̇ and Φ̈ in units
constexpr double most_entries = 1e5;
constexpr Eigen::Index most_free = 60, most_curved = 12;

class SecondOrderForms {
 public:
  SecondOrderForms(ScaledLoops& loops, double t, const VectorXd& q)
      : loops_(loops), mechanism_(loops.mechanism()), e_(loops.evaluation()), t_(t), q_(q) {}

  Rigidity find(int rank) {
    Rigidity found;
    const auto m = mechanism_.m(), n = mechanism_.nv();
    if (static_cast<double>(m) * n > most_entries || n - rank > most_free) return found;
    e_.place(t_, q_.data());
    const MatrixXd a = scaled_jacobian(mechanism_, e_).a;
    if (!a.allFinite()) return found;
    const RankAndIdle columns = rank_and_idle(a.transpose(), 0, rank);
    const double open = loops_.gap(t_, q_).cwiseAbs().maxCoeff();
    const double depends = std::max(columns.dropped, open);
    least_form_ = std::max(rounding, beside_dependence * depends / (rank > 0 ? columns.kept : 1));
    if (!(least_form_ < too_close)) return found;
    free_ = columns.left;
    idle_ = idle(a, rank);
    leave_out_time(a);
    if (idle_.cols() == 0 || free_.cols() == 0 || !keep_curved()) return found;
    QuadraticForms forms = all_forms();
    // Null vectors of Σ F² are the y on which no form depends.
    MatrixXd squares = MatrixXd::Zero(free_.cols(), free_.cols());
    for (const MatrixXd& form : forms.all) squares += form * form;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(squares);
    const double least = least_form_ * least_form_;
    found.flat = (eigen.eigenvalues().array() <= least).count();
    if (free_.cols() - found.flat > most_curved) return found;
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

  /// Φ̈ in units at rates u = C x, no accelerations.
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
    moving_ = !parts.isZero(at_rest) || !rate.isZero(at_rest) || !still_.isZero(at_rest);
    if (!moving_ || idle_.cols() == 0) return;
    // Φ̈ at u₀ + V y, u₀ the prescribed rates: the part without y, and that linear in y.
    DenseLeastSquares steps;
    steps.compute(a, rank_tolerance);
    const VectorXd start = -steps.solve(VectorXd(rate.cwiseQuotient(loops_.units().equations)));
    add(bend(start));
    for (Eigen::Index i = 0; i < free_.cols(); ++i)
      add(0.5 * (bend(start + free_.col(i)) - bend(start - free_.col(i))));
    const MatrixXd seen = idle_.transpose() * parts;
    const double terms = (idle_.cwiseAbs().transpose() * parts.cwiseAbs()).maxCoeff();
    const double least = least_form_ * std::max(terms, 1.0);
    if (seen.cwiseAbs().maxCoeff() > least)
      idle_ = idle_ * rank_and_idle(seen, least / rank_tolerance).left;
  }

  /// Keeps the combinations of ω whose form is not zero; false: there is none.
  bool keep_curved() {
    RandomDirections random;
    const Eigen::Index f = free_.cols();
    const Eigen::Index samples = std::min(idle_.cols(), f * (f + 1) / 2) + 2;
    MatrixXd values(idle_.cols(), samples);
    double terms = 0;
    for (Eigen::Index i = 0; i < samples; ++i) {
      const VectorXd g = curvature(random.next(f));
      if (!g.allFinite()) return false;
      values.col(i) = idle_.transpose() * g;
      terms = std::max(terms, (idle_.cwiseAbs().transpose() * g.cwiseAbs()).maxCoeff());
    }
    const double least = least_form_ * std::max(terms, 1.0);
    if (!(values.cwiseAbs().maxCoeff() > least)) return false;
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(values * values.transpose());
    const auto flat = (eigen.eigenvalues().array() <= least * least).count();
    idle_ = idle_ * eigen.eigenvectors().rightCols(idle_.cols() - flat);
    return idle_.cols() > 0;
  }

  QuadraticForms all_forms() {
    const Eigen::Index f = free_.cols(), p = idle_.cols();
    QuadraticForms forms;
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
    least_form_ /= largest;
    return forms;
  }

  void judge(const QuadraticForms& forms, const MatrixXd& curved, Rigidity& found) {
    const MatrixXd zeros = common_zeros(forms);
    const Eigen::Index n = forms.size(), rest = n - zeros.cols();
    if (rest == 0) return;
    const MatrixXd others = zeros.cols() == 0 ? MatrixXd::Identity(n, n)
                                              : MatrixXd(orthogonal_factor(zeros).rightCols(rest));
    // Zeros of a form that is nowhere negative are minima: F y = 0 there.
    MatrixXd combinations = MatrixXd::Identity(idle_.cols(), idle_.cols());
    if (zeros.cols() > 0) {
      MatrixXd slopes(idle_.cols(), n * zeros.cols());
      for (std::size_t i = 0; i < forms.all.size(); ++i)
        slopes.row(static_cast<Eigen::Index>(i)) = (forms.all[i] * zeros).reshaped().transpose();
      combinations = left_null_space(slopes, least_form_);
    }
    VectorXd c;
    if (combinations.cols() > 0) {
      QuadraticForms positive;
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
  MatrixXd free_, idle_;   ///< V and the ω, columns, in units
  VectorXd still_;         ///< Φ̈ without rates, in units
  bool moving_ = false;    ///< loops move with time
  double least_form_ = 0;  ///< least form above rounding and nearly dependent rows
};

}  // namespace

Rigidity second_order(ScaledLoops& loops, double t, const VectorXd& q, int rank) {
  return SecondOrderForms(loops, t, q).find(rank);
}

std::string in_words(const Mechanism& mechanism, const Rigidity& found) {
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
