#pragma once
// One step of an explicit Runge-Kutta method, its error and its dense output, for any tableau:
//
//   k_i = f(t + c_i h, y + h Σ_{j<i} a_ij k_j),   y_new = y + h Σ_j b_j k_j.
//
// Stages 0 … s-1 make y_new; stage s is f at the end (t + h, y_new); further ones serve dense
// output alone (dense_output.h) and are evaluated only when somebody interpolates. Source: Hairer,
// Norsett, Wanner, Solving Ordinary Differential Equations I, II.4 (error norm), II.10 (the norm of
// DOP853).

#include <momenta/dae/integrator/aligned_array.h>
#include <momenta/dae/integrator/dense_output.h>
#include <momenta/dae/integrator/integration.h>
#include <momenta/dae/integrator/stage_sum.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace momenta::explicit_rk {

enum class StageFailure { none, rhs, not_finite };

template <class Tableau>
class ExplicitStep {
  static constexpr std::size_t s = Tableau::stages;
  static constexpr std::size_t stored = s + 1 + Tableau::dense_stages;

 public:
  ExplicitStep(OdeSystem& system, double rtol, double atol, const double* y0)
      : system_(system),
        n_(static_cast<std::size_t>(system.size())),
        stride_(padded(n_)),
        rtol_(rtol),
        atol_(stride_),
        y_(stride_),
        y_new_(stride_),
        lost_(stride_),
        lost_new_(stride_),
        argument_(stride_),
        error_(stride_),
        k_(stored * stride_),
        dense_(n_),
        last_argument_(n_),
        last_stage_(n_),
        relative_(atol) {
    std::copy_n(y0, n_, y_.data());
    // Padding weighs 1, and no weight is zero: a component at rest at 0 with atol 0 then passes.
    std::fill_n(atol_.data(), stride_, 1.0);
    for (std::size_t i = 0; i < n_; ++i) {
      const double scale = system.scale(static_cast<int>(i));
      atol_[i] =
          std::isinf(scale) ? scale : std::max(atol * scale, std::numeric_limits<double>::min());
    }
  }

  double* y() { return y_.data(); }
  double* y_new() { return y_new_.data(); }
  const double* first_derivative() const { return stage(0); }
  const double* absolute_tolerance() const { return atol_.data(); }
  double* workspace() { return argument_.data(); }
  long evaluations() const { return evaluations_; }

  /// Begins from y anew, with nothing carried over.
  void restart(const double* y) {
    std::copy_n(y, n_, y_.data());
    std::fill_n(lost_.data(), stride_, 0.0);
  }
  /// Carries y, its lost rounding, and f there between two steps.
  void carry(Memory& memory) {
    memory(y_.data(), n_), memory(lost_.data(), n_), memory(stage(0), n_), memory(evaluations_);
  }
  /// k_0 = f(t, y).
  bool begin(double t) { return evaluate(t, y_.data(), stage(0)); }

  /// f at any (t, y), counted.
  bool evaluate(double t, const double* y, double* ydot) {
    ++evaluations_;
    return system_.rhs(t, y, ydot);
  }

  /// Stages, y_new, and the end derivative where the method always has it. t1 is t + h.
  StageFailure attempt(double t, double t1, double h) {
    t_ = t, t1_ = t1, h_ = h;
    have_end_ = have_dense_ = false;
    if (!stages(std::make_index_sequence<s - 1>{})) return StageFailure::rhs;
    update(h);
    if constexpr (Tableau::end_derivative_always)
      if (!have_end_derivative()) return StageFailure::rhs;
    const bool good = finite(y_new_.data(), stride_) &&
                      (!Tableau::end_derivative_always || finite(stage(s), stride_));
    return good ? StageFailure::none : StageFailure::not_finite;
  }

  /// Evaluates f at the step's end, unless it is there.
  bool have_end_derivative() {
    if (!have_end_) have_end_ = evaluate(t1_, y_new_.data(), stage(s));
    return have_end_;
  }

  /// Keeps the last stage and its argument, both at t1, for rate_of_change(). To be called after
  /// attempt() and estimates of its error, before anything else is evaluated.
  void keep_last_stage() {
    std::copy_n(argument_.data(), n_, last_argument_.data());
    std::copy_n(stage(s - 1), n_, last_stage_.data());
  }
  /// |f(y) − f(g)| / |y − g| [1/s] of the state and the last stage, in units of the tolerance; zero
  /// where they are the same.
  double rate_of_change() const { return rate_of_change(y_.data(), stage(0)); }
  /// The same of other y and f = f(y) at that time.
  double rate_of_change(const double* y, const double* f) const {
    double rates = 0, ways = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double weight = 1 / (atol_[i] + rtol_ * std::abs(y[i]));
      const double rate = weight * (f[i] - last_stage_[i]);
      const double way = weight * (y[i] - last_argument_[i]);
      rates += rate * rate;
      ways += way * way;
    }
    return ways > 0 ? std::sqrt(rates / ways) : 0;
  }

  /// Square of the local error over its tolerance, RMS over the unknowns; at most 1 passes. Not
  /// finite when a stage was not.
  double error_squared() const {
    const double* k = k_.data();
    Pack sum{}, sum_low{};
    for (std::size_t i = 0; i < stride_; i += width) {
      const Pack size = max(abs(load(y_.data() + i)), abs(load(y_new_.data() + i)));
      const Pack weight = 1 / (load(atol_.data() + i) + rtol_ * size);
      const Pack e = weight * stage_sum<Tableau::e, 0>(k + i, stride_);
      sum += e * e;
      if constexpr (Tableau::estimates == 2) {
        const Pack low = weight * stage_sum<Tableau::e, 1>(k + i, stride_);
        sum_low += low * low;
      }
    }
    const double n = static_cast<double>(std::max<std::size_t>(n_, 1));
    const double high = total(sum);
    if constexpr (Tableau::estimates == 1) return h_ * h_ * high / n;
    // |e_5|⁴ / (|e_5|² + |e_3|²/100): DOP853's combination, squared.
    const double both = high + 0.01 * total(sum_low);
    return both == 0 ? 0 : h_ * h_ * high * high / (both * n);
  }

  /// The same in the system's own norm, of changes of the motion alone. Near singular poses, where
  /// it is used, one stage may have an error of its own, which DOP853's combination hides, far
  /// below |e_5| for smooth stages: there it is no less than a tenth of that.
  double motion_error_squared() {
    const auto measured = [&]<std::size_t row>() {
      for (std::size_t i = 0; i < stride_; i += width)
        store(error_.data() + i, stage_sum<Tableau::e, row>(k_.data() + i, stride_));
      return system_.motion_error_squared(t1_, y_new_.data(), error_.data(), rtol_, relative_);
    };
    const double high = measured.template operator()<0>();
    if constexpr (Tableau::estimates == 1) return h_ * h_ * high;
    const double both = high + 0.01 * measured.template operator()<Tableau::estimates - 1>();
    return both == 0 ? 0 : h_ * h_ * std::max(high * high / both, 0.01 * high);
  }

  /// Subtracts another step's stages: estimates are then of the difference.
  void subtract_stages(const ExplicitStep& other) {
    for (std::size_t i = 0; i < (s + 1) * stride_; ++i) k_[i] -= other.k_[i];
  }

  /// y at t in [t, t1] into out, n values; all NaN when a stage for it cannot be evaluated.
  bool interpolate(double t, double* out) {
    if (!have_dense_ && !prepare_dense()) {
      std::fill_n(out, n_, std::numeric_limits<double>::quiet_NaN());
      return false;
    }
    dense_.at((t - t_) / h_, out);
    return true;
  }
  bool interpolation_failed() const { return interpolation_failed_; }

  /// Takes f at the step's new start, where the system has it.
  bool take_first_derivative() { return system_.first_derivative(stage(0)); }

  /// Takes the step. With `keep_end` f at its end, if there, becomes the next first stage; returns
  /// whether it did.
  bool advance(bool keep_end) {
    y_.swap(y_new_);
    lost_.swap(lost_new_);
    if (!keep_end || !have_end_) return false;
    std::memcpy(stage(0), stage(s), n_ * sizeof(double));
    return true;
  }

 private:
  double* stage(std::size_t i) { return k_.data() + i * stride_; }
  const double* stage(std::size_t i) const { return k_.data() + i * stride_; }

  /// y_new = y + h Σ b_j k_j, compensated (Kahan 1965): over many steps rounding would be the whole
  /// error at tight tolerances.
  void update(double h) {
    for (std::size_t i = 0; i < stride_; i += width) {
      const Pack y = load(y_.data() + i);
      const Pack change =
          h * stage_sum<Tableau::a, s>(k_.data() + i, stride_) + load(lost_.data() + i);
      const Pack sum = y + change;
      store(y_new_.data() + i, sum);
      store(lost_new_.data() + i, change - (sum - y));
    }
  }

  /// Stage `row` by its own abscissa; c = 1 means the step's end to the last bit.
  template <std::size_t row>
  bool run_stage() {
    stage_state<Tableau::a, row>(y_.data(), h_, k_.data(), stride_, argument_.data());
    const double t = Tableau::c[row] == 1 ? t1_ : t_ + Tableau::c[row] * h_;
    return evaluate(t, argument_.data(), stage(row));
  }
  template <std::size_t... i>
  bool stages(std::index_sequence<i...>) {
    return (run_stage<i + 1>() && ...);
  }
  template <std::size_t... i>
  bool dense_stages(std::index_sequence<i...>) {
    return (run_stage<s + 1 + i>() && ...);
  }

  bool prepare_dense() {
    if (interpolation_failed_) return false;
    if (!have_end_derivative() ||
        !dense_stages(std::make_index_sequence<Tableau::dense_stages>{})) {
      interpolation_failed_ = true;
      return false;
    }
    dense_.set(y_.data(), y_new_.data(), h_, k_.data());
    have_dense_ = finite(dense_.entries(), dense_.size());
    interpolation_failed_ = !have_dense_;
    return have_dense_;
  }

  static double total(Pack v) {
    double sum = 0;
    for (std::size_t lane = 0; lane < width; ++lane) sum += v[lane];
    return sum;
  }

  /// 0 · x is 0 for a finite x and NaN for any other.
  static bool finite(const double* x, std::size_t size) {
    Pack probe{};
    for (std::size_t i = 0; i < size; i += width) probe += 0 * load(x + i);
    return total(probe) == 0;
  }

  OdeSystem& system_;
  std::size_t n_, stride_;  ///< unknowns; rounded up to whole cache lines, the padding always zero
  double rtol_;
  AlignedArray atol_, y_, y_new_, lost_, lost_new_, argument_, error_;  ///< stride_ each
  AlignedArray k_;  ///< stages, stored × stride_
  DenseOutput<Tableau> dense_;
  std::vector<double> last_argument_, last_stage_;  ///< n_ each, once kept
  double relative_;                                 ///< atol of an unknown of scale 1
  double t_ = 0, t1_ = 0, h_ = 0;
  long evaluations_ = 0;
  bool have_end_ = false, have_dense_ = false, interpolation_failed_ = false;
};

}  // namespace momenta::explicit_rk
