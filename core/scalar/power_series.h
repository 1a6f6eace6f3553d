#pragma once
// Truncated power series Σ c_k s^k, k = 0 … K: a function evaluated on them gives its Taylor
// coefficients along a curve, exact to rounding. The recurrences are those of Taylor arithmetic
// (Moore 1966; Griewank and Walther, Evaluating Derivatives, section 13.2):
//
//   (x y)_k = Σ x_i y_(k−i)                    q = x/y:  q_k = (x_k − Σ_(i<k) q_i y_(k−i)) / y_0
//   r = √x:   r_k = (x_k − Σ_(0<i<k) r_i r_(k−i)) / (2 r_0)
//   S = sin x, C = cos x:   k S_k = Σ i x_i C_(k−i),   k C_k = −Σ i x_i S_(k−i)
//
// Dual<PowerSeries<K>, N> has the coefficients of N directional derivatives as well.

#include <momenta/core/scalar/dual.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace momenta {

template <int K>
struct PowerSeries {
  static constexpr std::size_t terms = K + 1;
  std::array<double, terms> c{};

  PowerSeries() = default;
  PowerSeries(double value) { c[0] = value; }  // NOLINT: constants mix freely with series

  PowerSeries& operator+=(const PowerSeries& y) {
    for (std::size_t k = 0; k < terms; ++k) c[k] += y.c[k];
    return *this;
  }
  PowerSeries& operator-=(const PowerSeries& y) {
    for (std::size_t k = 0; k < terms; ++k) c[k] -= y.c[k];
    return *this;
  }
  PowerSeries& operator*=(const PowerSeries& y) { return *this = *this * y; }
  PowerSeries& operator/=(const PowerSeries& y) { return *this = *this / y; }

  friend PowerSeries operator+(PowerSeries x, const PowerSeries& y) { return x += y; }
  friend PowerSeries operator-(PowerSeries x, const PowerSeries& y) { return x -= y; }
  friend PowerSeries operator-(const PowerSeries& x) {
    PowerSeries r;
    for (std::size_t k = 0; k < terms; ++k) r.c[k] = -x.c[k];
    return r;
  }
  friend PowerSeries operator*(const PowerSeries& x, const PowerSeries& y) {
    PowerSeries r;
    for (std::size_t k = 0; k < terms; ++k)
      for (std::size_t i = 0; i <= k; ++i) r.c[k] += x.c[i] * y.c[k - i];
    return r;
  }
  friend PowerSeries operator/(const PowerSeries& x, const PowerSeries& y) {
    PowerSeries q;
    for (std::size_t k = 0; k < terms; ++k) {
      double rest = x.c[k];
      for (std::size_t i = 0; i < k; ++i) rest -= q.c[i] * y.c[k - i];
      q.c[k] = rest / y.c[0];
    }
    return q;
  }
  friend bool operator<(const PowerSeries& x, const PowerSeries& y) { return x.c[0] < y.c[0]; }
  friend bool operator>(const PowerSeries& x, const PowerSeries& y) { return x.c[0] > y.c[0]; }

  friend PowerSeries sqrt(const PowerSeries& x) {
    PowerSeries r;
    r.c[0] = std::sqrt(x.c[0]);
    for (std::size_t k = 1; k < terms; ++k) {
      double rest = x.c[k];
      for (std::size_t i = 1; i < k; ++i) rest -= r.c[i] * r.c[k - i];
      r.c[k] = rest / (2 * r.c[0]);
    }
    return r;
  }
  friend PowerSeries sin(const PowerSeries& x) { return turned(x).sine; }
  friend PowerSeries cos(const PowerSeries& x) { return turned(x).cosine; }

 private:
  struct Turned {
    PowerSeries sine, cosine;
  };
  static Turned turned(const PowerSeries& x) {
    Turned t;
    t.sine.c[0] = std::sin(x.c[0]);
    t.cosine.c[0] = std::cos(x.c[0]);
    for (std::size_t k = 1; k < terms; ++k) {
      for (std::size_t i = 1; i <= k; ++i) {
        const double slope = static_cast<double>(i) * x.c[i];
        t.sine.c[k] += slope * t.cosine.c[k - i];
        t.cosine.c[k] -= slope * t.sine.c[k - i];
      }
      t.sine.c[k] /= static_cast<double>(k);
      t.cosine.c[k] /= static_cast<double>(k);
    }
    return t;
  }
};

template <int K>
double value_of(const PowerSeries<K>& x) {
  return x.c[0];
}

/// The time t as a number of S: a constant, but t + s on series along a curve in time.
template <class S>
struct Moment {
  static S at(double t) { return S(t); }
};
template <int K>
struct Moment<PowerSeries<K>> {
  static PowerSeries<K> at(double t) {
    PowerSeries<K> x(t);
    x.c[1] = 1;
    return x;
  }
};
template <int K, int N>
struct Moment<Dual<PowerSeries<K>, N>> {
  static Dual<PowerSeries<K>, N> at(double t) {
    Dual<PowerSeries<K>, N> x;
    x.a = Moment<PowerSeries<K>>::at(t);
    return x;
  }
};

/// A curve y_0 + y_1 s + … + y_5 s⁵ with two directions: for derivative arrays of up to four
/// differentiations.
constexpr int jet_order = 5;
using Jet = Dual<PowerSeries<jet_order>, 2>;

}  // namespace momenta
