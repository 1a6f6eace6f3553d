#pragma once
// One driven loop at one time: its prescribed motion and the rates of that relative to the bodies,
// in their axes, by the formulas of loops_in_time.h; l or c = given + Σ factor_k f_k. T is the
// scalar of time: double, or a series where the equations are wanted as series in t.

#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

namespace momenta {

/// The scalar of time for states of scalar S: a series for series along a curve in time, else
/// double.
template <class S>
struct TimeOf {
  using type = double;
};
template <int K>
struct TimeOf<PowerSeries<K>> {
  using type = PowerSeries<K>;
};
template <int K, int N>
struct TimeOf<Dual<PowerSeries<K>, N>> {
  using type = Dual<PowerSeries<K>, N>;
};

template <class T>
Vec2<T> turned_about(const T& axis, const T& angle, const Vec2<T>& v) {
  using std::cos, std::sin;
  const T c = cos(angle), s = axis * sin(angle);
  return {{c * v[0] - s * v[1], s * v[0] + c * v[1]}};
}
template <class T>
T turned_about(const T&, const T&, const T& w) {
  return w;
}
/// v + sin θ a × v + (1 − cos θ) a × (a × v)
template <class T>
Vec3<T> turned_about(const Vec3<T>& axis, const T& angle, const Vec3<T>& v) {
  using std::cos, std::sin;
  const Vec3<T> across = cross(axis, v);
  return v + sin(angle) * across + (T(1.0) - cos(angle)) * cross(axis, across);
}

template <class Space, class T>
struct DrivenLoop {
  using Vector = typename Space::template Vector<T>;
  using Angular = decltype(cross(Vector{}, Vector{}));
  using Motion = typename LoopModel<Space>::Motion;

  Vector at_b{}, v{}, a{};
  std::array<Vector, 3> axis_a{}, axis_b{};
  Angular turning_a{}, turning_a_rate{}, turning_b{}, turning_b_rate{};
  T given{}, given_rate{}, given_second{};

  void move(const Motion& m, const T& t) {
    T f{}, rate{}, second{};
    at_b = of(m.at_b);
    v = a = {};
    for (const auto& translation : m.translations) {
      translation.law.evaluate(t, f, rate, second);
      const Vector along = of(translation.along);
      at_b += f * along;
      v += rate * along;
      a += second * along;
    }
    turn(m.turns_a, t, m.axis_a, axis_a, turning_a, turning_a_rate);
    turn(m.turns_b, t, m.axis_b, axis_b, turning_b, turning_b_rate);
    given = T(m.given);
    given_rate = given_second = T(0.0);
    for (const auto& [factor, law] : m.numbers) {
      law.evaluate(t, f, rate, second);
      given += factor * f;
      given_rate += factor * rate;
      given_second += factor * second;
    }
  }

 private:
  static T of(double x) { return T(x); }
  template <class V>
  static auto of(const V& x) {
    Vector r;
    for (int i = 0; i < static_cast<int>(std::size(x.x)); ++i) r[i] = T(x[i]);
    return r;
  }
  template <class Axes>
  static void turn(const std::vector<typename Motion::Turn>& turns, const T& t, const Axes& from,
                   std::array<Vector, 3>& to, Angular& w, Angular& dw) {
    for (std::size_t j = 0; j < to.size(); ++j) to[j] = of(from[j]);
    w = dw = {};
    T angle[3];
    for (std::size_t k = 0; k < turns.size(); ++k) {
      T rate, second;
      turns[k].law.evaluate(t, angle[k], rate, second);
      Angular axis = of(turns[k].axis);
      for (std::size_t j = k; j-- > 0;) axis = turned_about(of(turns[j].axis), angle[j], axis);
      dw += second * axis;
      if constexpr (Space::dimension == 6) dw += rate * cross(w, axis);
      w += rate * axis;
    }
    for (auto& x : to)
      for (std::size_t j = turns.size(); j-- > 0;) x = turned_about(of(turns[j].axis), angle[j], x);
  }
};

}  // namespace momenta
