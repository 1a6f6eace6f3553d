// y' = f(t, y, z), 0 = g(t, y) of index 2 by the half-explicit method of tableau_hem5.h: order 5,
// no Jacobian, g at rounding after every step.
//
// One step: k_1 = f(t, y_0, Z_1) from the step before; for i = 1 … 5 the stage Y_{i+1} by a, and
// its Z by ā_{i+1}, which gives k_{i+1}; then y_1 = Ȳ_6, and k_7 = f(t_1, y_1, Z_7). Where g is not
// linear in z, the equations of a stage are linearised once, about what the stages before foresee
// of k_{i+1}: Z is then off by O(h⁵) (of the second stage, by O(h³), as harmless as its order), and
// y_1 by O(h⁶). The last stage alone is solved to rounding, so that g(y_1) = 0 is.
//
// Gauge reset: σ leaves p before each step, which is a step from another y_0 of the same motion.
// Local error: h Σ (b_j − b̂_j) k_j, over y, in the norm of WeightedNorm. Quaternions return to unit
// length after a step; inside it they move as the equations move them, and |q| = 1 + O(h⁶). z at a
// step's end is Z_7, of the order of y. A sample inside a step is a step of its own from the step's
// start, of full order and on the constraint; where that fails, Hermite's cubic. Step:
// options.step, without error control, where given; else PI control as in dp5. Source:
// tableau_hem5.h.

#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/solver/fixed_grid.h>
#include <momenta/dae/solver/gauge_symmetry.h>
#include <momenta/dae/solver/half_explicit.h>
#include <momenta/dae/solver/implicit_methods.h>
#include <momenta/dae/solver/ode_restart.h>
#include <momenta/dae/solver/step_control.h>
#include <momenta/dae/solver/tableau_hem5.h>
#include <momenta/dae/solver/weighted_norm.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

using explicit_rk::TableauDp5;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double first_step_fraction = 1e-4;  ///< of the span, as with IDA

class Hem5 {
 public:
  Hem5(DaeSystem& system, HalfExplicit& parts, double t0, double span,
       const IntegrationOptions& options)
      : system_(system),
        parts_(parts),
        gauge_(dynamic_cast<GaugeSymmetry*>(&system)),
        options_(options),
        norm_(system, options.rtol, options.atol),
        grid_(t0, options.step),
        n_(static_cast<std::size_t>(parts.differential_unknowns())),
        m_(static_cast<std::size_t>(parts.multipliers())),
        span_(span),
        t0_(t0),
        t1_(t0) {
    for (State* s : {&old_, &now_, &look_}) {
      s->y.assign(n_ + m_, 0.0);
      s->ydot.assign(n_ + m_, 0.0);
    }
    for (auto* v : {&stage_, &base_, &error_}) v->assign(n_ + m_, 0.0);
    for (auto& k : k_) k.resize(n_);
  }

  static const char* name() { return "hem5"; }
  double* y() { return now_.y.data(); }
  double* ydot() { return now_.ydot.data(); }
  const Counters& counters() const { return counters_; }
  const std::string& failure() const { return cause_; }

  bool start() {
    if (!system_.start(t0_, now_.y.data(), now_.ydot.data())) {
      cause_ = system_.failure();
      return false;
    }
    ++counters_.evaluations;
    if (!parts_.consistent(t0_, now_.y.data(), now_.y.data() + n_, now_.ydot.data())) {
      cause_ = parts_.half_explicit_failure();
      return false;
    }
    old_ = now_;
    const double longest = options_.max_step > 0 ? options_.max_step : span_;
    h_ = options_.step > 0           ? options_.step
         : options_.initial_step > 0 ? options_.initial_step
                                     : first_step_fraction * span_;
    h_ = options_.step > 0 ? h_ : std::min(h_, longest);
    return finite(now_);
  }

  /// From y, z and y' as they stand; the step is what it was before.
  bool restart(double) {
    control_ = {};
    return true;
  }

  bool step(double& t, double end, std::string& cause) {
    const bool fixed = options_.step > 0;
    if (gauge_ != nullptr && gauge_->resets()) gauge_->reset(t, now_.y.data(), now_.ydot.data());
    std::swap(old_, now_);
    while (true) {
      const double t1 = step_end(t, end);
      const double h = fixed ? h_ : t1 - t;
      double squares = 0;
      bool good = advance(t, h, t1, old_, now_, counters_) && finite(now_);
      if (good && !fixed) {
        for (std::size_t i = 0; i < n_; ++i) {
          error_[i] = 0;
          for (std::size_t j = 0; j < k_.size(); ++j)
            error_[i] += h * TableauDp5::e[0][j] * k_[j][i];
        }
        norm_.set(old_.y.data(), h);
        squares = norm_.squares(error_.data()) / norm_.count();
        good = std::isfinite(squares);
      }
      if (good && squares <= 1) {
        ++counters_.steps;
        if (!fixed) {
          h_ = h * control_.accepted(squares);
          if (options_.max_step > 0) h_ = std::min(h_, options_.max_step);
        }
        t0_ = t, t1_ = t1;
        t = t1;
        return true;
      }
      ++counters_.rejected;
      if (good) cause_ = "the local error stayed above its tolerance";
      if (!fixed) h_ = h * (good ? control_.rejected(squares) : control_.failed());
      if (fixed || h_ < 16 * epsilon * std::max(std::abs(t), 1e-6 * span_)) {
        std::swap(old_, now_);
        cause =
            cause_ + (fixed ? ", with a step of " : ", also with a step of ") + in_words(h_) + " s";
        if (const std::string why = parts_.dependent(t, now_.y.data()); !why.empty())
          cause += ": " + why;
        return false;
      }
    }
  }

  /// Hermite's cubic for y; z along a line.
  bool at(double t, double* y, double*) {
    const double h = t1_ - t0_, x = (t - t0_) / h;
    for (std::size_t i = 0; i < n_ + m_; ++i) {
      const double from = old_.y[i], to = now_.y[i];
      y[i] = from + x * (to - from);
      if (i < n_)
        y[i] += x * (x - 1) *
                ((1 - 2 * x) * (to - from) + h * ((x - 1) * old_.ydot[i] + x * now_.ydot[i]));
    }
    return true;
  }

  bool sample(double t, double* y, double* ydot) {
    const double apart = options_.step > 0 ? grid_.tolerance() : 4 * epsilon * std::abs(t1_);
    const State* found = &look_;
    Counters uncounted;
    if (t1_ - t <= apart)
      found = &now_;
    else if (t - t0_ <= apart)
      found = &old_;
    else if (!advance(t0_, t - t0_, t, old_, look_, uncounted) || !finite(look_)) {
      at(t, look_.y.data(), nullptr);
      look_.ydot = old_.ydot;
    }
    std::copy(found->y.begin(), found->y.end(), y);
    std::copy(found->ydot.begin(), found->ydot.end(), ydot);
    return true;
  }

 private:
  struct State {
    std::vector<double> y, ydot;  ///< (y, z) and its rate; that of z is left at zero
  };

  double step_end(double t, double end) {
    if (options_.step > 0) {
      const double t1 = grid_.next(counters_.steps, end);
      h_ = grid_.length(t, t1);
      return t1;
    }
    return t + 1.01 * h_ >= end ? end : t + h_;
  }

  bool finite(const State& state) {
    if (all_finite(state.y.data(), n_ + m_) && all_finite(state.ydot.data(), n_ + m_)) return true;
    cause_ = "a value that is not a finite number came up";
    return false;
  }

  /// y + h Σ_j row_j k_j over the first `terms` stages.
  template <class Row>
  void combine(const State& from, double h, const Row& row, std::size_t terms, double* out) const {
    std::copy_n(from.y.data(), n_, out);
    for (std::size_t j = 0; j < terms; ++j)
      if (row[j] != 0)
        for (std::size_t i = 0; i < n_; ++i) out[i] += h * row[j] * k_[j][i];
  }

  /// k_i by the polynomial through stages before it, off by O(h), O(h²), O(h²), O(h³), O(h⁴).
  void foresee(std::size_t i) {
    std::fill(k_[i].begin(), k_[i].end(), 0.0);
    for (std::size_t j = 0; j < i; ++j)
      if (const double share = TableauHem5::foreseen[i][j]; share != 0)
        for (std::size_t n = 0; n < n_; ++n) k_[i][n] += share * k_[j][n];
  }

  /// One step from `from` at t over h to t1; k_ are its seven stages.
  bool advance(double t, double h, double t1, const State& from, State& to, Counters& counters) {
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
        return cause_ = parts_.half_explicit_failure(), false;
    }
    const auto& b = TableauHem5::a_bar[TableauHem5::stages - 1];
    combine(from, h, b, b.size(), to.y.data());
    parts_.normalise(to.y.data());
    ++counters.evaluations;
    if (!parts_.consistent(t1, to.y.data(), z, to.ydot.data()))
      return cause_ = parts_.half_explicit_failure(), false;
    std::copy_n(to.ydot.data(), n_, k_[6].data());
    return true;
  }

  DaeSystem& system_;
  HalfExplicit& parts_;
  GaugeSymmetry* gauge_;  ///< null: there is none
  const IntegrationOptions& options_;
  WeightedNorm norm_;
  FixedGrid grid_;
  explicit_rk::StepControl<TableauDp5> control_;
  std::size_t n_, m_;
  State old_, now_, look_;
  std::vector<double> stage_, base_, error_;
  std::array<std::vector<double>, 7> k_;
  double span_, h_ = 0;
  double t0_, t1_;  ///< the last step [s]
  std::string cause_;
  Counters counters_;
};

}  // namespace

IntegrationResult integrate_hem5(DaeSystem& system, double t0,
                                 const std::vector<double>& output_times,
                                 const IntegrationOptions& options, const Observer& observer) {
  auto* parts = dynamic_cast<HalfExplicit*>(&system);
  if (parts == nullptr)
    throw std::invalid_argument(
        "hem5 takes equations of index 2: expected form acceleration-index2 or momentum-index2");
  if (!(options.step >= 0) || !std::isfinite(options.step))
    throw std::invalid_argument("a fixed step must be positive");
  if (!(options.rtol > 0) || !(options.atol > 0))
    throw std::invalid_argument("rtol and atol of hem5 must be positive");
  const OutputCursor outputs(t0, output_times);
  Hem5 method(system, *parts, t0, outputs.end() - t0, options);
  IntegrationResult result;
  result.end_time = t0;
  if (!method.start()) {
    result.reason = stop_sentence(method.name(), t0, evaluation_cause(method.failure()));
    result.y.assign(method.y(), method.y() + system.size());
    return result;
  }
  run_with_ode_restarts(method, system, t0, output_times, options, observer, result);
  result.counters += method.counters();
  return result;
}

}  // namespace momenta
