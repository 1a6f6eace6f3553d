// Where a joint has no inertia, or next to none, before its loops close: the assembled matrix of
// (7), factorised by KLU on a pattern analysed once; its pivots are sought among all unknowns, σ
// may go before u. So there is no single pivot of a row of Φ to fade. The loops' block is −ε
// instead of 0, with ε about fade times the scale of Φ_q M⁻¹ Φ_qᵀ, and the right-hand side
// recentred,
//   Φ_q u − ε (σ − centre) = g,
// so that a regular row is off by ε (σ − centre) only, and a redundant or vanishing row keeps its
// impulse. KLU chooses its pivots once and then refactorises; when the residual of a solution tells
// that they no longer fit, it chooses anew.

#include <momenta/dae/kkt/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <suitesparse/klu.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {
namespace {

// Fading by an added block, once refined, costs (ε/W)² on every row, so it must be weaker than the
// filter of the dense form, which costs (τ/W)⁴.
constexpr double weaker = 1e-2;
constexpr int refinements = 3;      // one does, two where a pivot is as small as ε
constexpr double rounding = 1e-11;  // of the residual, row by row

class KluKkt final : public Kkt {
 public:
  explicit KluKkt(const Mechanism& mechanism)
      : pattern_(mechanism.kkt_pattern()),
        axis_scale_(mechanism),
        diagonal_of_mass_(pattern_, mechanism.nv()),
        n_(mechanism.nv()),
        m_(mechanism.m()),
        mass_(pattern_.mass.size()),
        constraint_(pattern_.constraint.size()),
        epsilon_(static_cast<std::size_t>(m_)),
        x_(static_cast<std::size_t>(n_ + m_)),
        b_(x_.size()),
        r_(x_.size()) {
    klu_defaults(&common_);
    build_pattern();
    symbolic_ = klu_analyze(n_ + m_, start_.data(), row_.data(), &common_);
  }
  ~KluKkt() override {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  KluKkt(const KluKkt&) = delete;
  KluKkt& operator=(const KluKkt&) = delete;

  bool factor(Evaluation<double>& e, double fade) override {
    ++factorizations_;
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    for (std::size_t i = 0; i < mass_.size(); ++i) {
      value_[mass_at_[i].first] = mass_[i];
      value_[mass_at_[i].second] = mass_[i];
    }
    for (std::size_t i = 0; i < constraint_.size(); ++i) {
      value_[constraint_at_[i].first] = constraint_[i];
      value_[constraint_at_[i].second] = constraint_[i];
    }
    regularise(fade);
    for (double v : value_)
      if (!std::isfinite(v)) return false;
    if (numeric_ &&
        klu_refactor(start_.data(), row_.data(), value_.data(), symbolic_, numeric_, &common_) ==
            1 &&
        common_.status == KLU_OK)
      return true;
    return factor_anew();
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    const auto attempt = [&] {
      std::copy(r, r + n_, b_.begin());
      for (int i = 0; i < m_; ++i)
        b_[static_cast<std::size_t>(n_ + i)] =
            g[i] - (centre ? epsilon_[static_cast<std::size_t>(i)] * centre[i] : 0.0);
      return solve_refined(centre);
    };
    if (!attempt() && !(factor_anew() && attempt())) return false;
    std::copy(x_.begin(), x_.begin() + n_, u);
    std::copy(x_.begin() + n_, x_.end(), sigma);
    return true;
  }

 private:
  bool factor_anew() {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    numeric_ = symbolic_
                   ? klu_factor(start_.data(), row_.data(), value_.data(), symbolic_, &common_)
                   : nullptr;
    return numeric_ && common_.status == KLU_OK;
  }

  /// x = A⁻¹ b, then refinement against the same equations centred on the σ just found: it removes
  /// rounding and takes the block's bias from ε/W to (ε/W)². False when the residual does not reach
  /// rounding level.
  bool solve_refined(const double* centre) {
    x_ = b_;
    if (klu_solve(symbolic_, numeric_, n_ + m_, 1, x_.data(), &common_) != 1) return false;
    for (std::size_t i = 0; i < epsilon_.size() && !compliance_; ++i) {
      const std::size_t row = static_cast<std::size_t>(n_) + i;
      b_[row] -= epsilon_[i] * (x_[row] - (centre ? centre[i] : 0.0));
    }
    residual();
    for (int step = 0; step < refinements; ++step) {
      if (klu_solve(symbolic_, numeric_, n_ + m_, 1, r_.data(), &common_) != 1) return false;
      for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += r_[i];
      if (residual() < rounding) return true;
    }
    return false;
  }

  /// r = b − A x; returns its largest entry relative to Σ |A| |x| + |b| of its row.
  double residual() {
    std::fill(size_.begin(), size_.end(), 0.0);
    r_ = b_;
    for (int j = 0; j < n_ + m_; ++j)
      for (int k = start_[static_cast<std::size_t>(j)]; k < start_[static_cast<std::size_t>(j) + 1];
           ++k) {
        const auto i = static_cast<std::size_t>(row_[static_cast<std::size_t>(k)]);
        const double term = value_[static_cast<std::size_t>(k)] * x_[static_cast<std::size_t>(j)];
        r_[i] -= term;
        size_[i] += std::abs(term);
      }
    double largest = 0;
    for (std::size_t i = 0; i < r_.size(); ++i) {
      if (!std::isfinite(r_[i])) return HUGE_VAL;
      const double scale = size_[i] + std::abs(b_[i]);
      if (scale > 0) largest = std::max(largest, std::abs(r_[i]) / scale);
    }
    return largest;
  }

  /// ε of each row: fade times the mean of Σ_j Φ_ij²/M_jj over the rows of its group, no less than
  /// is natural for axes.
  void regularise(double fade) {
    if (compliance_) {
      for (std::size_t i = 0; i < epsilon_.size(); ++i) {
        epsilon_[i] = compliance_[i];
        value_[diagonal_[static_cast<std::size_t>(n_) + i]] = -compliance_[i];
      }
      return;
    }
    axis_scale_.of_groups(diagonal_of_mass_.of(mass_), constraint_, epsilon_);
    for (std::size_t i = 0; i < epsilon_.size(); ++i) {
      epsilon_[i] *= weaker * fade;
      value_[diagonal_[static_cast<std::size_t>(n_) + i]] = -epsilon_[i];
    }
  }

  void build_pattern() {
    std::map<std::pair<int, int>, std::size_t> place;  // (column, row)
    const auto both = [&](int i, int j) {
      place[{j, i}];
      place[{i, j}];
    };
    for (const auto& e : pattern_.mass) both(e.row, e.column);
    for (const auto& e : pattern_.constraint) both(n_ + e.row, e.column);
    for (int i = 0; i < n_ + m_; ++i) both(i, i);
    start_.assign(static_cast<std::size_t>(n_ + m_) + 1, 0);
    for (auto& [key, at] : place) {
      at = row_.size();
      row_.push_back(key.second);
      ++start_[static_cast<std::size_t>(key.first) + 1];
    }
    for (std::size_t j = 1; j < start_.size(); ++j) start_[j] += start_[j - 1];
    value_.assign(row_.size(), 0.0);
    size_.assign(static_cast<std::size_t>(n_ + m_), 0.0);
    for (const auto& e : pattern_.mass)
      mass_at_.push_back({place.at({e.column, e.row}), place.at({e.row, e.column})});
    for (const auto& e : pattern_.constraint)
      constraint_at_.push_back(
          {place.at({e.column, n_ + e.row}), place.at({n_ + e.row, e.column})});
    for (int i = 0; i < n_ + m_; ++i) diagonal_.push_back(place.at({i, i}));
  }

  const KktPattern& pattern_;
  AxisScale axis_scale_;
  MassDiagonal diagonal_of_mass_;
  int n_, m_;
  std::vector<double> mass_, constraint_, epsilon_;
  std::vector<double> x_, b_, r_, size_;
  std::vector<int> start_, row_;
  std::vector<double> value_;
  std::vector<std::pair<std::size_t, std::size_t>> mass_at_, constraint_at_;
  std::vector<std::size_t> diagonal_;
  klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

}  // namespace

std::unique_ptr<Kkt> make_klu_kkt(const Mechanism& mechanism) {
  return std::make_unique<KluKkt>(mechanism);
}

}  // namespace momenta
