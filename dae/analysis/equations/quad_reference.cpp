// Total derivatives in quadruple precision: F_i of a curve is the coefficient of e₁ … e_i in F on
// numbers with i directions nested in each other, divided by i!, where the curve is taken at s = e₁
// + … + e_i with e_k² = 0.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/dae/analysis/equations/quad_reference.h>
#include <momenta/dae/integrator/radau_collocation.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

using QuadCurve = std::vector<std::vector<Quad>>;  // y_0, y_1, …

template <int depth>
struct Nested {
  using Type = Dual<typename Nested<depth - 1>::Type, 1>;
};
template <>
struct Nested<0> {
  using Type = Quad;
};

/// e₁ + … + e_depth, and the coefficient of e₁ … e_depth.
template <int depth>
typename Nested<depth>::Type all_directions() {
  if constexpr (depth == 0) {
    return Quad(0.0);
  } else {
    typename Nested<depth>::Type x;
    x.a = all_directions<depth - 1>();
    x.b[0] = typename Nested<depth - 1>::Type(1.0);
    return x;
  }
}
template <int depth>
Quad last_coefficient(const typename Nested<depth>::Type& x) {
  if constexpr (depth == 0)
    return x;
  else
    return last_coefficient<depth - 1>(x.b[0]);
}
template <int depth>
typename Nested<depth>::Type constant(const Quad& value) {
  if constexpr (depth == 0) {
    return value;
  } else {
    typename Nested<depth>::Type x(0.0);
    x.a = constant<depth - 1>(value);
    return x;
  }
}

template <int depth>
std::vector<Quad> derivative(const EquationFile& file, const QuadCurve& curve) {
  using S = typename Nested<depth>::Type;
  const auto n = static_cast<std::size_t>(file.size());
  const S s = all_directions<depth>();
  std::vector<S> y(n), ydot(n), r(n);
  for (std::size_t i = 0; i < n; ++i) {
    S value(0.0), rate(0.0);
    for (std::size_t k = curve.size(); k-- > 0;) {
      value = value * s + constant<depth>(curve[k][i]);
      if (k > 0) rate = rate * s + constant<depth>(Quad(static_cast<double>(k)) * curve[k][i]);
    }
    y[i] = value, ydot[i] = rate;
  }
  Residual<S> residual(file);
  residual(S(file.start) + s, y.data(), ydot.data(), r.data());
  double factorial = 1;
  for (int k = 2; k <= depth; ++k) factorial *= k;
  std::vector<Quad> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = last_coefficient<depth>(r[i]) / Quad(factorial);
  return values;
}

std::vector<Quad> derivative(const EquationFile& file, const QuadCurve& curve, int order) {
  switch (order) {
    case 0:
      return derivative<0>(file, curve);
    case 1:
      return derivative<1>(file, curve);
    case 2:
      return derivative<2>(file, curve);
    case 3:
      return derivative<3>(file, curve);
    default:
      return derivative<4>(file, curve);
  }
}

/// F and its derivatives, as the collocation takes them.
class QuadSystem {
 public:
  explicit QuadSystem(const EquationFile& file)
      : n_(static_cast<std::size_t>(file.size())), residual_(file), slopes_(file) {}

  bool residual(const Quad& t, const Quad* y, const Quad* ydot, Quad* r) {
    residual_(t, y, ydot, r);
    for (std::size_t i = 0; i < n_; ++i)
      if (!std::isfinite(value_of(r[i]))) return false;
    return true;
  }
  bool slopes(double t, const double* y, const double* ydot, double* by_y, double* by_rate) {
    std::fill_n(by_y, n_ * n_, 0.0);
    std::fill_n(by_rate, n_ * n_, 0.0);
    slopes_.evaluate_at(t, y, ydot);
    bool finite = true;
    for (std::size_t k = 0; k < slopes_.entries().size(); ++k) {
      const auto& e = slopes_.entries()[k];
      const std::size_t place =
          static_cast<std::size_t>(e.variable) * n_ + static_cast<std::size_t>(e.equation);
      (e.of_rate ? by_rate : by_y)[place] = slopes_.values()[k];
      finite &= std::isfinite(slopes_.values()[k]);
    }
    return finite;
  }

 private:
  std::size_t n_;
  Residual<Quad> residual_;
  Slopes<double> slopes_;
};

constexpr double tight = 1e-18, loose = 1e-16;  // tolerances of the estimate, of order s

std::vector<Quad> solution(const EquationFile& file, const EquationStart& start,
                           std::vector<Quad> y, std::vector<Quad> ydot, double end,
                           double tolerance, long& steps,
                           const std::function<bool(double)>& going_on) {
  QuadSystem system(file);
  std::vector<char> estimated(y.size(), 1);
  for (std::size_t i = 0; i < y.size(); ++i)
    estimated[i] = start.index_of[i] == 1 || start.appears[i] ? 1 : 0;
  RadauCollocation<Quad> radau(start.index_of, std::move(estimated));
  const double span = end - file.start;
  double t = file.start, h = 1e-6 * span;
  for (steps = 0; t < end;) {
    if (going_on && !going_on(t)) throw std::runtime_error("interrupted");
    const double next = t + 1.01 * h >= end ? end : t + h;
    if (next - t <= 1e-13 * span)
      throw std::runtime_error("no reference: steps of quadruple precision became as short as " +
                               std::to_string(next - t) + " at t = " + std::to_string(t));
    const Quad length = Quad(next) - Quad(t);
    if (!radau.step(Quad(t), length, y, ydot, file.scales, tolerance, system)) {
      h = 0.5 * (next - t);
      continue;
    }
    ++steps;
    const double room = tolerance / std::max(radau.last_estimate(), 1e-300);
    h = (next - t) * std::clamp(0.9 * std::pow(room, 1.0 / 10), 0.3, 3.0);
    t = next;
  }
  return y;
}

}  // namespace

void refine_start(const EquationFile& file, const EquationStart& start, std::vector<Quad>& y,
                  std::vector<Quad>& ydot) {
  const auto n = static_cast<std::size_t>(file.size());
  const int nu = std::max(start.point.found.index, 1);
  QuadCurve curve(static_cast<std::size_t>(jet_order + 1), std::vector<Quad>(n));
  for (std::size_t i = 0; i < n; ++i) {
    curve[0][i] = Quad(start.point.y[static_cast<Eigen::Index>(i)]);
    curve[1][i] = Quad(start.point.ydot[static_cast<Eigen::Index>(i)]);
  }
  const CurveSystem system = curve_system(file);
  const Eigen::VectorXd scale = start_scales(file, start.appears);
  double before = std::numeric_limits<double>::infinity();
  constexpr int most = 60;
  for (int count = 0; count < most; ++count) {
    Eigen::MatrixXd at(file.size(), jet_order + 1), f(file.size(), nu + 1);
    for (int k = 0; k <= jet_order; ++k)
      for (int i = 0; i < file.size(); ++i)
        at(i, k) = value_of(curve[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)]);
    for (int k = 0; k <= nu; ++k) {
      const std::vector<Quad> values = derivative(file, curve, k);
      for (int i = 0; i < file.size(); ++i) f(i, k) = value_of(values[static_cast<std::size_t>(i)]);
    }
    const CurveCorrection correction(CurveBlocks(system, file.start, at), nu, start.time_scale,
                                     scale);
    const double size = correction.size(f);
    if (!std::isfinite(size)) break;
    if (size <= 1e-31 || (size <= 1e-26 && size > 0.5 * before)) {
      y = curve[0];
      ydot = curve[1];
      return;
    }
    before = size;
    const Eigen::MatrixXd change = correction.of(f);
    for (int k = 0; k <= nu + 1; ++k)
      for (int i = 0; i < file.size(); ++i)
        curve[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)] += Quad(change(i, k));
  }
  throw std::runtime_error(
      "no reference: the start could not be made consistent in quadruple "
      "precision");
}

QuadReference quad_reference(const EquationFile& file, const EquationStart& start, double t,
                             const std::function<bool(double)>& going_on) {
  std::vector<Quad> y, ydot;
  refine_start(file, start, y, ydot);
  QuadReference found;
  found.t = t;
  long loose_steps = 0;
  const std::vector<Quad> rough = solution(file, start, y, ydot, t, loose, loose_steps, going_on);
  found.values = solution(file, start, y, ydot, t, tight, found.steps, going_on);
  for (std::size_t i = 0; i < rough.size(); ++i) {
    const double apart = std::abs(value_of(found.values[i] - rough[i]));
    found.apart.push_back(apart / (file.scales[i] + std::abs(value_of(found.values[i]))));
    if (!file.reference || file.reference->judged[i])
      found.accuracy = std::max(found.accuracy, found.apart.back());
  }
  return found;
}

std::string decimals_of(const Quad& x, int digits) {
  std::array<char, 96> text{};
  quadmath_snprintf(text.data(), text.size(), "%.*Qe", digits - 1, x.v);
  return text.data();
}

}  // namespace momenta
