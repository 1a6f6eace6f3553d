// Where a joint has no inertia, or next to none, before its loops close: the assembled matrix of
// (7), its pivots sought among all unknowns (klu_solver.h).

#include <momenta/dae/kkt/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/klu_solver.h>

#include <algorithm>

namespace momenta {
namespace {

/// M and Φ_q, rows of Φ after those of M.
std::vector<KktPattern::Entry> assembled_entries(const KktPattern& pattern, int n) {
  std::vector<KktPattern::Entry> all = pattern.mass;
  for (const auto& e : pattern.constraint) all.push_back({n + e.row, e.column});
  return all;
}

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
        solver_(n_ + m_, m_, assembled_entries(pattern_, n_), KluSolver::Order::blocks) {}

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    for (std::size_t i = 0; i < mass_.size(); ++i) solver_.matrix().set(i, mass_[i]);
    for (std::size_t i = 0; i < constraint_.size(); ++i)
      solver_.matrix().set(mass_.size() + i, constraint_[i]);
    if (compliance_)
      epsilon_.assign(compliance_, compliance_ + m_);
    else
      axis_scale_.softness(diagonal_of_mass_.of(mass_), constraint_, fade, epsilon_);
    return solver_.factor(epsilon_);
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    std::copy(r, r + n_, x_.begin());
    std::copy(g, g + m_, x_.begin() + n_);
    if (!solver_.solve(x_.data(), centre, compliance_ != nullptr)) return false;
    std::copy(x_.begin(), x_.begin() + n_, u);
    std::copy(x_.begin() + n_, x_.end(), sigma);
    return true;
  }

 private:
  const KktPattern& pattern_;
  AxisScale axis_scale_;
  MassDiagonal diagonal_of_mass_;
  int n_, m_;
  std::vector<double> mass_, constraint_, epsilon_, x_;
  KluSolver solver_;
};

}  // namespace

std::unique_ptr<Kkt> make_klu_kkt(const Mechanism& mechanism) {
  return std::make_unique<KluKkt>(mechanism);
}

}  // namespace momenta
