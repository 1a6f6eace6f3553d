// y' = f(t, y, z), 0 = g(t, y) of index 2 by a half-explicit method of order 8 on the stages of
// DOP853, no Jacobian:
//
//   Y_i = y_0 + h Σ_{j<i} a_ij f(Y_j, Z_j),  g_t + g_y f(Y_i, Z_i) = 0      i = 1 … s
//   ŷ_1 = y_0 + h Σ_j b_j f(Y_j, Z_j)
//   y_1 = ŷ_1 + P μ,  g(t_1, y_1) = 0
//
// P μ the change of q (or of v) that is least in the mass metric. The hidden constraint is what
// g(Ȳ_i) = 0 of a half-explicit stage (tableau_hem5.h) becomes as c̄_i tends to c_i, a derivative in
// place of its difference quotient: M and Φ_q of one place, which is what the ODE form of the same
// unknowns evaluates, and no condition of order beyond those of a. Faded rows are centred on z of
// the step's start.
//
// Order. ŷ_1 is a step of the explicit method on y' = f(t, y, ζ(t, y)), ζ from the hidden
// constraint, and this ODE keeps g: ŷ_1 is off by O(h⁹), and so is g(t_1, ŷ_1). g_y P is regular:
// μ = O(h⁹), whatever P is. z at the end is ζ(t_1, y_1), of order 8 too. The same holds of any
// explicit method; that g_y f_z is regular, index 2, is what makes ζ.
//
// Dense output is that of DOP853, of order 7, taken onto g; z and f there by the hidden constraint.
// Local error: that of DOP853, |e_5|² / √(|e_5|² + |e_3|²/100), of ŷ_1, in the norm of
// HalfExplicitError; near singular poses, where one stage may have an error of its own and this
// combination hides it, no less than |e_5|/10, as in explicit_step.h.
//
// Equations of rates alone (nonholonomic rows) determine their z in every f, are no part of g, and
// are met by P μ being a motion that they allow.
//
// Source: Hairer, Lubich, Roche, The Numerical Solution of Differential-Algebraic Systems by
// Runge-Kutta Methods, Lecture Notes in Mathematics 1409 (1989), for half-explicit methods; Ascher,
// Petzold, SIAM J. Numer. Anal. 28 (1991) 1097-1120, for projected ones.

#include <momenta/dae/integrator/dense_output.h>
#include <momenta/dae/integrator/half_explicit_run.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stage_sum.h>
#include <momenta/dae/integrator/tableau_dop853.h>

#include <utility>

namespace momenta {
namespace {

using explicit_rk::stage_state;
using explicit_rk::TableauDop853;

class Hem8 {
 public:
  using Control = TableauDop853;
  static constexpr const char* name = "hem8";
  static constexpr double first_step = 1e-3;  ///< steps are ten times those of IDA

  explicit Hem8(HalfExplicit& parts)
      : parts_(parts),
        n_(static_cast<std::size_t>(parts.differential_unknowns())),
        m_(static_cast<std::size_t>(parts.multipliers())),
        stride_(explicit_rk::padded(n_)),
        stage_(stride_),
        z_(m_),
        error_(n_ + m_),
        k_((s + 1 + TableauDop853::dense_stages) * stride_),
        dense_(n_) {}

  bool step(double t, double h, double t1, const HalfExplicitState& from, HalfExplicitState& to,
            Counters& counters) {
    have_dense_ = false;
    std::copy_n(from.ydot.data(), n_, k_.data());
    if (!stages<1>(t, h, t1, from, to.y.data() + n_, counters, std::make_index_sequence<s - 1>{}))
      return false;
    stage_state<TableauDop853::a, s>(from.y.data(), h, k_.data(), stride_, stage_.data());
    std::copy_n(stage_.data(), n_, to.y.data());
    std::copy_n(from.y.data() + n_, m_, to.y.data() + n_);
    return parts_.meet(t1, to.y.data());
  }

  /// y at a fraction of the last step, from t over h to t1. Evaluates three further stages at the
  /// first call. Off g by as much as it errs.
  bool between(double t, double h, double t1, double fraction, const HalfExplicitState& from,
               const HalfExplicitState& to, double* y) {
    if (!have_dense_) {
      Counters uncounted;
      std::copy_n(to.ydot.data(), n_, k(s));
      if (!stages<s + 1>(t, h, t1, from, z_.data(), uncounted,
                         std::make_index_sequence<TableauDop853::dense_stages>{}))
        return false;
      std::copy_n(to.y.data(), n_, stage_.data());
      dense_.set(from.y.data(), stage_.data(), h, k_.data());
      have_dense_ = true;
    }
    dense_.at(fraction, y);
    return true;
  }

  double error(const HalfExplicitState&, const HalfExplicitState&, double h,
               const HalfExplicitError& measure) {
    const double high = estimate<0>(h, measure), both = high + 0.01 * estimate<1>(h, measure);
    const double combined = both == 0 ? 0 : high * high / both;
    return measure.by_motion() ? std::max(combined, 0.01 * high) : combined;
  }

 private:
  static constexpr std::size_t s = TableauDop853::stages;

  double* k(std::size_t i) { return k_.data() + i * stride_; }

  template <std::size_t first, std::size_t... i>
  bool stages(double t, double h, double t1, const HalfExplicitState& from, double* z,
              Counters& counters, std::index_sequence<i...>) {
    return (stage<first + i>(t, h, t1, from, z, counters) && ...);
  }
  template <std::size_t i>
  bool stage(double t, double h, double t1, const HalfExplicitState& from, double* z,
             Counters& counters) {
    stage_state<TableauDop853::a, i>(from.y.data(), h, k_.data(), stride_, stage_.data());
    std::copy_n(from.y.data() + n_, m_, z);
    ++counters.evaluations;
    ++counters.factorizations;
    return parts_.consistent(TableauDop853::c[i] == 1 ? t1 : t + TableauDop853::c[i] * h,
                             stage_.data(), z, k(i));
  }

  template <std::size_t row>
  double estimate(double h, const HalfExplicitError& measure) {
    for (std::size_t i = 0; i < n_; ++i) error_[i] = 0;
    for (std::size_t j = 0; j < s; ++j)
      if (const double e = h * TableauDop853::e[row][j]; e != 0)
        for (std::size_t i = 0; i < n_; ++i) error_[i] += e * k(j)[i];
    return measure(error_.data());
  }

  HalfExplicit& parts_;
  std::size_t n_, m_, stride_;  ///< sizes of y and z; n in whole cache lines
  explicit_rk::AlignedArray stage_, z_, error_;
  explicit_rk::AlignedArray k_;  ///< f of the stages, stride_ apart
  explicit_rk::DenseOutput<TableauDop853> dense_;
  bool have_dense_ = false;  ///< dense stages of the last step are there
};

}  // namespace

IntegrationResult integrate_hem8(DaeSystem& system, double t0,
                                 const std::vector<double>& output_times,
                                 const IntegrationOptions& options, const Observer& observer) {
  return integrate_half_explicit<Hem8>(system, t0, output_times, options, observer);
}

Integrator hem8_integrator() {
  return {.name = "hem8",
          .takes = Integrator::Takes::dae,
          .step = Integrator::Step::adaptive,
          .method = "half-explicit Runge-Kutta on the hidden constraint, order 8",
          .forms = {"acceleration-index2", "momentum-index2"},
          .resets = true,
          .gauge = Integrator::Preferred::reset,
          .dae_run = integrate_hem8};
}

}  // namespace momenta
