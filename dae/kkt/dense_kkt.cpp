// Small systems. u is eliminated before σ: M = Lᵀ D L along the tree, G = L⁻ᵀΦ_qᵀ, W = Gᵀ D⁻¹ G =
// Φ_q M⁻¹ Φ_qᵀ, then W by pivots that fade (loop_matrix.h).
// In this order and form the error of u is about ε/δ near a pose where a singular value δ of Φ_q
// M^(−1/2) vanishes, as small as any algorithm can make it: W squares the condition of σ, not of u.

#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/loop_matrix.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/mechanism/tree_factor.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

class DenseKkt final : public Kkt {
 public:
  explicit DenseKkt(const Mechanism& mechanism)
      : pattern_(mechanism.kkt_pattern()),
        axis_scale_(mechanism),
        diagonal_of_mass_(pattern_, mechanism.nv()),
        n_(mechanism.nv()),
        m_(mechanism.m()),
        mass_(pattern_.mass.size()),
        constraint_(pattern_.constraint.size()),
        factor_(pattern_, n_),
        g_(size(m_, n_)),
        scaled_(size(m_, n_)),
        loops_(mechanism),
        y_(size(n_, 1)),
        d_(size(m_, 1)),
        natural_(size(m_, 1)) {
    faded_rows_.reserve(static_cast<std::size_t>(m_));
  }

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    singular_joint_ = factor_.factor(mass_);
    if (singular_joint_ >= 0) return false;
    std::fill(g_.begin(), g_.end(), 0.0);
    for (std::size_t i = 0; i < constraint_.size(); ++i)
      g_[at(pattern_.constraint[i].row, pattern_.constraint[i].column, n_)] = constraint_[i];
    const double* inverse_pivot = factor_.inverse_pivots().data();
    for (int i = 0; i < m_; ++i) {
      double *g = &g_[at(i, 0, n_)], *scaled = &scaled_[at(i, 0, n_)];
      factor_.inward(g);
      for (int j = 0; j < n_; ++j) scaled[j] = inverse_pivot[j] * g[j];
    }
    return eliminate_loops(fade);
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::copy(r, r + n_, y_.begin());
    factor_.inward(y_.data());
    if (centre)
      for (int i = 0; i < m_; ++i)
        for (int j = 0; j < n_; ++j) y_[idx(j)] -= g_[at(i, j, n_)] * centre[i];
    for (int i = 0; i < m_; ++i) {
      double d = -g[i];
      for (int j = 0; j < n_; ++j) d += scaled_[at(i, j, n_)] * y_[idx(j)];
      d_[idx(i)] = d;
    }
    loops_.solve(d_.data(), sigma);
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j < n_; ++j) y_[idx(j)] -= g_[at(i, j, n_)] * sigma[i];
    for (int j = 0; j < n_; ++j) u[j] = factor_.inverse_pivots()[idx(j)] * y_[idx(j)];
    factor_.outward(u);
    bool finite = true;
    for (int j = 0; j < n_; ++j) finite &= std::isfinite(u[j]);
    for (int i = 0; i < m_; ++i) {
      if (centre) sigma[i] += centre[i];
      finite &= std::isfinite(sigma[i]);
    }
    return finite;
  }

 private:
  static std::size_t size(int a, int b) {
    return static_cast<std::size_t>(a) * static_cast<std::size_t>(b);
  }
  static std::size_t idx(int i) { return static_cast<std::size_t>(i); }
  static std::size_t at(int i, int j, int columns) { return size(i, columns) + idx(j); }

  bool eliminate_loops(double fade) {
    axis_scale_.measure(diagonal_of_mass_.of(mass_), natural_);
    for (int i = 0; i < m_; ++i)
      for (int j = 0; j <= i; ++j) {
        double s = 0;
        for (int k = 0; k < n_; ++k) s += g_[at(i, k, n_)] * scaled_[at(j, k, n_)];
        loops_.at(i, j) = s;
      }
    const double fading = axis_scale_.fading(fade);
    const bool finite = loops_.eliminate(fading, natural_.data(), compliance_);
    faded_rows_ = loops_.faded_rows();
    weakest_ = std::min(1.0, loops_.weakest() * fade / fading);
    return finite;
  }

  const KktPattern& pattern_;
  AxisScale axis_scale_;
  MassDiagonal diagonal_of_mass_;
  int n_, m_;
  std::vector<double> mass_, constraint_;
  TreeFactor factor_;
  std::vector<double> g_;       ///< m × n: row i is L⁻ᵀ times column i of Φ_qᵀ
  std::vector<double> scaled_;  ///< m × n: the same times D⁻¹
  LoopMatrix loops_;
  std::vector<double> y_, d_, natural_;
};

}  // namespace

std::unique_ptr<Kkt> make_dense_kkt(const Mechanism& mechanism) {
  return std::make_unique<DenseKkt>(mechanism);
}

std::unique_ptr<Kkt> make_kkt(const Mechanism& mechanism) {
  if (mechanism.solver().dense()) return make_dense_kkt(mechanism);
  if (solved_by_bodies(mechanism))
    return mechanism.solver().leaves_first() ? make_front_kkt(mechanism) : make_body_kkt(mechanism);
  return mechanism.solver().leaves_first() ? make_sparse_kkt(mechanism) : make_klu_kkt(mechanism);
}

}  // namespace momenta
