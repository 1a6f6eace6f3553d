// y' = f(t, y, z), 0 = g(t, y) of index 2 by the half-explicit method of tableau_hem5.h: order 5,
// no Jacobian, g at rounding after every step.
//
// One step: k_1 = f(t, y_0, Z_1) from the step before; for i = 1 … 5 the stage Y_{i+1} by a, and
// its Z by ā_{i+1}, which gives k_{i+1}; then y_1 = Ȳ_6, and k_7 = f(t_1, y_1, Z_7). Where g is not
// linear in z, the equations of a stage are linearised once, about what the stages before foresee
// of k_{i+1}: Z is then off by O(h⁵) (of the second stage, by O(h³), as harmless as its order), and
// y_1 by O(h⁶). The last stage alone is solved to rounding, so that g(y_1) = 0 is. |q| = 1 + O(h⁶)
// of quaternions inside a step.
//
// Local error: h Σ (b_j − b̂_j) k_j, over y, in the norm of WeightedNorm. Source: tableau_hem5.h.

#include <momenta/dae/integrator/half_explicit_run.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/tableau_hem5.h>

#include <vector>

namespace momenta {
namespace {

using explicit_rk::TableauDp5;

class Hem5 {
 public:
  using Control = TableauDp5;
  static constexpr const char* name = "hem5";
  static constexpr double first_step = 1e-4;  ///< as with IDA

  explicit Hem5(HalfExplicit& parts)
      : parts_(parts),
        n_(static_cast<std::size_t>(parts.differential_unknowns())),
        m_(static_cast<std::size_t>(parts.multipliers())),
        stage_(n_),
        base_(n_),
        error_(n_ + m_) {
    for (auto& k : k_) k.resize(n_);
  }

  bool step(double t, double h, double t1, const HalfExplicitState& from, HalfExplicitState& to,
            Counters& counters) {
    std::copy_n(from.ydot.data(), n_, k_[0].data());
    double* z = to.y.data() + n_;
    std::copy_n(from.y.data() + n_, m_, z);
    for (std::size_t i = 1; i < TableauHem5::stages; ++i) {
      const auto& row = TableauHem5::a_bar[i];
      const bool last = i + 1 == TableauHem5::stages;
      combine(from, h, TableauDp5::a[i], i, stage_.data());
      combine(from, h, row, i, base_.data());
      foresee(i);
      ++counters.evaluations;
      ++counters.factorizations;
      if (!parts_.advance(t + TableauDp5::c[i] * h, stage_.data(),
                          last ? t1 : t + TableauHem5::c_bar[i] * h, base_.data(), h * row[i], last,
                          z, k_[i].data()))
        return false;
    }
    const auto& b = TableauHem5::a_bar[TableauHem5::stages - 1];
    combine(from, h, b, b.size(), to.y.data());
    return true;
  }

  double error(const HalfExplicitState&, const HalfExplicitState& to, double h,
               const HalfExplicitError& measure) {
    const auto& e = TableauDp5::e[0];
    for (std::size_t i = 0; i < n_; ++i) {
      error_[i] = h * e[k_.size()] * to.ydot[i];
      for (std::size_t j = 0; j < k_.size(); ++j) error_[i] += h * e[j] * k_[j][i];
    }
    return measure(error_.data());
  }

 private:
  /// y + h Σ_j row_j k_j over the first `terms` stages.
  template <class Row>
  void combine(const HalfExplicitState& from, double h, const Row& row, std::size_t terms,
               double* out) const {
    std::copy_n(from.y.data(), n_, out);
    for (std::size_t j = 0; j < terms; ++j)
      if (row[j] != 0)
        for (std::size_t i = 0; i < n_; ++i) out[i] += h * row[j] * k_[j][i];
  }

  /// Foresees k_i by the polynomial through stages before it, off by O(h), O(h²), O(h²), O(h³),
  /// O(h⁴).
  void foresee(std::size_t i) {
    std::fill(k_[i].begin(), k_[i].end(), 0.0);
    for (std::size_t j = 0; j < i; ++j)
      if (const double share = TableauHem5::foreseen[i][j]; share != 0)
        for (std::size_t n = 0; n < n_; ++n) k_[i][n] += share * k_[j][n];
  }

  HalfExplicit& parts_;
  std::size_t n_, m_;
  std::vector<double> stage_, base_, error_;
  std::array<std::vector<double>, TableauHem5::stages> k_;
};

}  // namespace

IntegrationResult integrate_hem5(DaeSystem& system, double t0,
                                 const std::vector<double>& output_times,
                                 const IntegrationOptions& options, const Observer& observer) {
  return integrate_half_explicit<Hem5>(system, t0, output_times, options, observer);
}

Integrator hem5_integrator() {
  return {.name = "hem5",
          .takes = Integrator::Takes::dae,
          .step = Integrator::Step::adaptive,
          .method = "half-explicit Runge-Kutta, order 5",
          .forms = {"acceleration-index2", "momentum-index2"},
          .resets = true,
          .gauge = Integrator::Preferred::reset_of_independent,
          .closes = {"momentum-index2"},
          .dae_run = integrate_hem5};
}

}  // namespace momenta
