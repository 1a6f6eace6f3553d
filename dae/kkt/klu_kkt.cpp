// Where a joint has no inertia, or next to none, before its loops close: the assembled matrix of
// (7), its pivots sought among all unknowns (klu_solver.h), the heaviest joint's inertia as the
// unit of M and of σ:
//
//   ( M/μ  Φ_qᵀ ) ( u   )   ( r/μ )
//   ( Φ_q  0    ) ( σ/μ ) = ( g   )
//
// Beside entries of Φ_q what is light then is small, and goes after the loop that holds it; with M
// as it is, a row of 1 kg would go before its loop, and take the digits of one of 10⁹ kg.

#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/klu_solver.h>

#include <algorithm>
#include <cmath>

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
        centre_(static_cast<std::size_t>(m_)),
        x_(static_cast<std::size_t>(n_ + m_)),
        solver_(n_ + m_, m_, assembled_entries(pattern_, n_), KluSolver::Order::blocks) {}

  bool factor(Evaluation<double>& e, double t, const double* q, double fade) override {
    ++factorizations_;
    e.place(t, q);
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    const auto& inertia = diagonal_of_mass_.of(mass_);
    int exponent = 0;  // a power of two: nothing is rounded
    std::frexp(*std::max_element(inertia.begin(), inertia.end()), &exponent);
    per_unit_ = std::ldexp(1.0, -exponent);
    for (std::size_t i = 0; i < mass_.size(); ++i) solver_.matrix().set(i, mass_[i] * per_unit_);
    for (std::size_t i = 0; i < constraint_.size(); ++i)
      solver_.matrix().set(mass_.size() + i, constraint_[i]);
    if (compliance_)
      epsilon_.assign(compliance_, compliance_ + m_);
    else
      axis_scale_.softness(inertia, constraint_, fade, epsilon_);
    for (double& epsilon : epsilon_) epsilon /= per_unit_;
    return solver_.factor(epsilon_);
  }

  bool solve(const double* r, const double* g, const double* centre, double* u,
             double* sigma) override {
    const auto scaled = [this](double x) { return x * per_unit_; };
    std::transform(r, r + n_, x_.begin(), scaled);
    std::copy(g, g + m_, x_.begin() + n_);
    if (centre) std::transform(centre, centre + m_, centre_.begin(), scaled);
    if (!solver_.solve(x_.data(), centre ? centre_.data() : nullptr, compliance_ != nullptr))
      return false;
    std::copy(x_.begin(), x_.begin() + n_, u);
    std::transform(x_.begin() + n_, x_.end(), sigma, [this](double x) { return x / per_unit_; });
    return true;
  }

 private:
  const KktPattern& pattern_;
  AxisScale axis_scale_;
  MassDiagonal diagonal_of_mass_;
  int n_, m_;
  std::vector<double> mass_, constraint_, epsilon_, centre_, x_;
  double per_unit_ = 1;  ///< 1/μ
  KluSolver solver_;
};

}  // namespace

std::unique_ptr<Kkt> make_klu_kkt(const Mechanism& mechanism) {
  return std::make_unique<KluKkt>(mechanism);
}

}  // namespace momenta
