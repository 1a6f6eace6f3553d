// Large systems: L D Lᵀ of the assembled matrix of (7), every pivot of σ filtered as in the dense
// form and in the sweeps, on a pattern analysed once.

#include <momenta/dae/kkt/axis_scale.h>
#include <momenta/dae/kkt/filtered_factor.h>
#include <momenta/dae/kkt/kkt.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

class SparseKkt final : public Kkt {
 public:
  explicit SparseKkt(const Mechanism& mechanism)
      : pattern_(mechanism.kkt_pattern()),
        axis_scale_(mechanism),
        diagonal_of_mass_(pattern_, mechanism.nv()),
        factor_(mechanism),
        n_(static_cast<std::size_t>(mechanism.nv())),
        m_(static_cast<std::size_t>(mechanism.m())),
        mass_(pattern_.mass.size()),
        constraint_(pattern_.constraint.size()),
        tau_(m_),
        x_(n_ + m_) {
    faded_rows_.reserve(m_);
  }

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    axis_scale_.of_groups(diagonal_of_mass_.of(mass_), constraint_, tau_);
    for (double& tau : tau_) {
      tau = compliance_ ? 0 : tau * fade;
      if (!std::isfinite(tau)) return false;
    }
    const bool ok = factor_.factor(mass_, constraint_, compliance_, tau_.data());
    singular_joint_ = factor_.singular_joint();
    if (!ok) return false;
    faded_rows_.clear();
    weakest_ = 1;
    for (std::size_t i = 0; i < m_; ++i) {
      const double w = factor_.pivots()[i];
      if (!(w > 10 * tau_[i]))
        faded_rows_.push_back(static_cast<int>(i));
      else if (tau_[i] > 0)
        weakest_ = std::min(weakest_, w * fade / tau_[i]);
    }
    return true;
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::copy_n(r, n_, x_.begin());
    std::copy_n(g, m_, x_.begin() + static_cast<std::ptrdiff_t>(n_));
    if (centre)
      for (std::size_t i = 0; i < constraint_.size(); ++i)
        x_[static_cast<std::size_t>(pattern_.constraint[i].column)] -=
            constraint_[i] * centre[pattern_.constraint[i].row];
    factor_.solve(x_.data());
    bool finite = true;
    for (const double x : x_) finite = finite && std::isfinite(x);
    std::copy_n(x_.begin(), n_, u);
    for (std::size_t i = 0; i < m_; ++i) sigma[i] = x_[n_ + i] + (centre ? centre[i] : 0.0);
    return finite;
  }

 private:
  const KktPattern& pattern_;
  AxisScale axis_scale_;
  MassDiagonal diagonal_of_mass_;
  FilteredFactor factor_;
  std::size_t n_, m_;
  std::vector<double> mass_, constraint_, tau_, x_;
};

}  // namespace

std::unique_ptr<Kkt> make_sparse_kkt(const Mechanism& mechanism) {
  return std::make_unique<SparseKkt>(mechanism);
}

}  // namespace momenta
