#pragma once
// Motion laws: a number f of a joint or loop as a function of time, with two derivatives.
//
// polynomial
//   f = Σ cᵢ tⁱ;  f, ḟ, f̈ by one Horner scheme
//
// harmonic
//   f = o + a sin(ω t + φ),  ḟ = a ω cos(ω t + φ),  f̈ = −ω² (f − o)
//
// step
//   f = f₀ + (f₁ − f₀) s(x) with x = (t − t₀)/T in [0, 1], constant outside
//   s = 10 x³ − 15 x⁴ + 6 x⁵,  s' = 30 x² (1 − x)²,  s" = 60 x (1 − x) (1 − 2x)
//   s' and s" vanish at both ends: f is twice continuously differentiable.
//
// table
//   The natural cubic spline through (tᵢ, yᵢ): core/expression/spline.h.
//
// formula
//   f by the instructions of its tape, ḟ and f̈ by those of its derivatives (core/expression).
//
// Within each piece of a step, a table or a formula with corners the derivatives are exact; a dual
// number takes the piece of its value.

#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/spline.h>
#include <momenta/core/scene/scene.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Why a DriveSpec is no valid motion law, in words; empty: it is.
std::string law_fault(const DriveSpec& spec);
/// The function in a drive's formula with corners or jumps, so that ḟ or f̈ has them; empty: none.
/// @pre no fault
std::string law_corner(const DriveSpec& spec);

/// Whether the scene has a drive whose law is more than a polynomial's constant.
bool has_running_drive(const Scene& scene);

/// The motion law of a DriveSpec: f(t) and its first two derivatives. Immutable.
class MotionLaw {
 public:
  /// Solves the spline of a table. @throws SceneError with the sentence of law_fault
  explicit MotionLaw(const DriveSpec& spec);

  /// f [rad or m], ḟ [rad/s or m/s] and f̈ [rad/s² or m/s²] at time t [s]. No allocation after a
  /// thread's first call. O(coefficients); table O(log points), formula O(its length). S needs + −
  /// ×, a constructor from double, S < double, sin and cos in its namespace, and
  /// formula::Functions.
  template <class S>
  void evaluate(S t, S& f, S& fdot, S& fddot) const {
    switch (kind_) {
      case Kind::polynomial:
        return horner(coefficients_.data(), coefficients_.size(), t, f, fdot, fddot);
      case Kind::harmonic:
        return harmonic(t, f, fdot, fddot);
      case Kind::step:
        return step(t, f, fdot, fddot);
      case Kind::table:
        return spline_.evaluate(t, f, fdot, fddot);
      case Kind::formula:
        return by_tape(t, f, fdot, fddot);
    }
  }

 private:
  enum class Kind { polynomial, harmonic, step, table, formula };

  template <class S>
  void harmonic(const S& t, S& f, S& fdot, S& fddot) const {
    using std::cos;
    using std::sin;
    const S angle = S(frequency_) * t + S(phase_);
    const S wave = S(amplitude_) * sin(angle);
    f = S(offset_) + wave;
    fdot = S(amplitude_ * frequency_) * cos(angle);
    fddot = S(-frequency_ * frequency_) * wave;
  }

  template <class S>
  void step(const S& t, S& f, S& fdot, S& fddot) const {
    const bool early = t < start_, running = t < start_ + duration_;
    if (early || !running) {
      f = S(early ? from_ : to_);
      fdot = S(0.0);
      fddot = S(0.0);
      return;
    }
    const double rise = to_ - from_;
    const S x = (t - S(start_)) * S(1 / duration_);
    const S rest = S(1.0) - x;
    f = S(from_) + S(rise) * x * x * x * (S(10.0) - x * (S(15.0) - S(6.0) * x));
    fdot = S(30 * rise / duration_) * x * x * rest * rest;
    fddot = S(60 * rise / (duration_ * duration_)) * x * rest * (rest - x);
  }

  /// Evaluates the tape of a formula; its line is kept from call to call, one a thread.
  template <class S>
  void by_tape(const S& t, S& f, S& fdot, S& fddot) const {
    thread_local std::vector<S> line;
    if (line.size() < formula_->tape().size()) line.resize(formula_->tape().size());
    S values[3];
    momenta::evaluate(*formula_, &t, line.data(), values);
    f = values[0];
    fdot = values[1];
    fddot = values[2];
  }

  Kind kind_ = Kind::polynomial;
  std::vector<double> coefficients_;
  double offset_ = 0, amplitude_ = 0, frequency_ = 0, phase_ = 0;
  double from_ = 0, to_ = 0, start_ = 0, duration_ = 1;
  CubicSpline spline_;
  std::optional<Expression> formula_;  ///< f, ḟ, f̈
};

}  // namespace momenta
