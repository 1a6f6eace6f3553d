#pragma once
// Formulas as users type them, and the same written in C++ by hand, for any scalar.

#include <cmath>
#include <string>
#include <vector>

namespace momenta::by_hand {

/// One formula: its text, its variables, where it is evaluated.
struct Typed {
  const char* name;
  std::string text;
  std::vector<std::string> variables;
  std::vector<double> at;
};

inline std::vector<Typed> all() {
  return {
      {"motor", "12.5 * (1 - u / 300) - 0.02 * u", {"u"}, {41.3}},
      {"duffing", "-(400 * x + 9000 * x^3) - 3.5 * v", {"x", "v"}, {0.21, -0.7}},
      {"stribeck", "-(0.2 + 0.15 * exp(-(u / 0.1)^2)) * tanh(u / 0.01) - 0.05 * u", {"u"}, {0.013}},
      {"impact", "if(x < 0, 1e5 * (-x)^1.5 * (1 - 0.3 * v), 0)", {"x", "v"}, {-0.012, 0.4}},
      {"magic_tyre",
       "0.9 * sin(1.4 * atan(10 * s - 0.97 * (10 * s - atan(10 * s))))",
       {"s"},
       {0.08}},
      {"lennard_jones", "4 * 0.2 * ((0.3 / r)^12 - (0.3 / r)^6)", {"r"}, {0.34}},
      {"loop_closure",
       "0.5 * cos(a) + 2 * cos(b) - 1.5 * cos(c) - 2",
       {"a", "b", "c"},
       {1.1, 0.3, 1.9}},
      {"double_pendulum",
       "0.5 * 2 * 0.7^2 * u^2 + 0.5 * 0.5^2 * v^2 + 0.7 * 0.5 * u * v * cos(a - b) + "
       "2 * 9.81 * 0.7 * cos(a) + 9.81 * 0.5 * cos(b)",
       {"a", "b", "u", "v"},
       {0.4, -1.1, 2.0, 0.3}},
      {"magnets",
       "-1 / sqrt((x - 0.5)^2 + y^2 + 0.04) - 1 / sqrt((x + 0.25)^2 + (y - 0.433)^2 + 0.04) - "
       "1 / sqrt((x + 0.25)^2 + (y + 0.433)^2 + 0.04) + 0.1 * (x^2 + y^2)",
       {"x", "y"},
       {0.13, 0.22}},
      {"car_axis",
       "(1 - sqrt(x^2 + y^2)) * x / sqrt(x^2 + y^2) + (1 - sqrt((x - c)^2 + (y - d)^2)) * "
       "(x - c) / sqrt((x - c)^2 + (y - d)^2)",
       {"x", "y", "c", "d"},
       {0.3, 0.45, 1.01, 0.1}},
  };
}

template <class S>
S square(const S& x) {
  return x * x;
}

/// What the formulas take beside + − * /, of one scalar: `F` has sin, cos, atan, exp, tanh, sqrt,
/// power, and chosen(a < 0, b, c).
template <class S, class F>
struct Traced {
  using Function = S (*)(const S*);
  static S motor(const S* x) { return S(12.5) * (S(1) - x[0] / S(300)) - S(0.02) * x[0]; }
  static S duffing(const S* x) {
    return -(S(400) * x[0] + S(9000) * (x[0] * x[0] * x[0])) - S(3.5) * x[1];
  }
  static S stribeck(const S* x) {
    return -(S(0.2) + S(0.15) * F::exp(-square(S(x[0] / S(0.1))))) * F::tanh(x[0] / S(0.01)) -
           S(0.05) * x[0];
  }
  static S impact(const S* x) {
    return F::below_zero(x[0],
                         [&] { return S(1e5) * F::power(-x[0], 1.5) * (S(1) - S(0.3) * x[1]); });
  }
  static S magic_tyre(const S* x) {
    const S b = S(10) * x[0];
    return S(0.9) * F::sin(S(1.4) * F::atan(b - S(0.97) * (b - F::atan(b))));
  }
  static S lennard_jones(const S* x) {
    const S ratio = S(0.3) / x[0], cube = ratio * ratio * ratio, six = cube * cube;
    return S(4 * 0.2) * (six * six - six);
  }
  static S loop_closure(const S* x) {
    return S(0.5) * F::cos(x[0]) + S(2) * F::cos(x[1]) - S(1.5) * F::cos(x[2]) - S(2);
  }
  static S double_pendulum(const S* x) {
    return S(0.5 * 2 * 0.49) * square(x[2]) + S(0.5 * 0.25) * square(x[3]) +
           S(0.7 * 0.5) * x[2] * x[3] * F::cos(x[0] - x[1]) + S(2 * 9.81 * 0.7) * F::cos(x[0]) +
           S(9.81 * 0.5) * F::cos(x[1]);
  }
  static S magnets(const S* x) {
    const S left = square(S(x[0] + S(0.25))), h(0.04);
    return S(-1) / F::sqrt(square(S(x[0] - S(0.5))) + square(x[1]) + h) -
           S(1) / F::sqrt(left + square(S(x[1] - S(0.433))) + h) -
           S(1) / F::sqrt(left + square(S(x[1] + S(0.433))) + h) +
           S(0.1) * (square(x[0]) + square(x[1]));
  }
  static S car_axis(const S* x) {
    const S left = F::sqrt(square(x[0]) + square(x[1])), dx = x[0] - x[2], dy = x[1] - x[3];
    const S right = F::sqrt(square(dx) + square(dy));
    return (S(1) - left) * x[0] / left + (S(1) - right) * dx / right;
  }
  static std::vector<Function> all() {
    return {motor,         duffing,      stribeck,        impact,  magic_tyre,
            lennard_jones, loop_closure, double_pendulum, magnets, car_axis};
  }
};

struct InDoubles {
  static double sin(double x) { return std::sin(x); }
  static double cos(double x) { return std::cos(x); }
  static double atan(double x) { return std::atan(x); }
  static double exp(double x) { return std::exp(x); }
  static double tanh(double x) { return std::tanh(x); }
  static double sqrt(double x) { return std::sqrt(x); }
  static double power(double x, double n) { return std::pow(x, n); }
  template <class Act>
  static double below_zero(double x, Act&& act) {
    return x < 0 ? act() : 0.0;
  }
};

/// Value and slopes of the four where they are short, in doubles.
using Gradient = void (*)(const double* x, double* values);
inline void motor_slopes(const double* x, double* v) {
  v[0] = 12.5 * (1 - x[0] / 300) - 0.02 * x[0];
  v[1] = -12.5 / 300 - 0.02;
}
inline void duffing_slopes(const double* x, double* v) {
  const double s = x[0] * x[0];
  v[0] = -(400 * x[0] + 9000 * (s * x[0])) - 3.5 * x[1];
  v[1] = -(400 + 27000 * s);
  v[2] = -3.5;
}
inline void loop_closure_slopes(const double* x, double* v) {
  v[0] = 0.5 * std::cos(x[0]) + 2 * std::cos(x[1]) - 1.5 * std::cos(x[2]) - 2;
  v[1] = -0.5 * std::sin(x[0]);
  v[2] = -2 * std::sin(x[1]);
  v[3] = 1.5 * std::sin(x[2]);
}
inline void double_pendulum_slopes(const double* x, double* v) {
  const double c = std::cos(x[0] - x[1]), s = std::sin(x[0] - x[1]), uv = 0.35 * x[2] * x[3];
  v[0] = 0.49 * x[2] * x[2] + 0.125 * x[3] * x[3] + uv * c + 2 * 9.81 * 0.7 * std::cos(x[0]) +
         9.81 * 0.5 * std::cos(x[1]);
  v[1] = -uv * s - 2 * 9.81 * 0.7 * std::sin(x[0]);
  v[2] = uv * s - 9.81 * 0.5 * std::sin(x[1]);
  v[3] = 0.98 * x[2] + 0.35 * x[3] * c;
  v[4] = 0.25 * x[3] + 0.35 * x[2] * c;
}
inline void magnets_slopes(const double* x, double* v) {
  const double l = x[0] + 0.25, r = x[0] - 0.5, u = x[1] - 0.433, d = x[1] + 0.433;
  const double a = 1 / std::sqrt(r * r + x[1] * x[1] + 0.04),
               b = 1 / std::sqrt(l * l + u * u + 0.04), c = 1 / std::sqrt(l * l + d * d + 0.04);
  const double a3 = a * a * a, b3 = b * b * b, c3 = c * c * c;
  v[0] = -a - b - c + 0.1 * (x[0] * x[0] + x[1] * x[1]);
  v[1] = a3 * r + (b3 + c3) * l + 0.2 * x[0];
  v[2] = a3 * x[1] + b3 * u + c3 * d + 0.2 * x[1];
}
/// Null: none is written.
inline std::vector<Gradient> gradients() {
  return {motor_slopes,        duffing_slopes,         nullptr,        nullptr, nullptr, nullptr,
          loop_closure_slopes, double_pendulum_slopes, magnets_slopes, nullptr};
}

}  // namespace momenta::by_hand
