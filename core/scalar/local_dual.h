#pragma once
// Sparse dual numbers that stay short: a value with its derivatives by at most `most` unknowns,
//
//   x = a + Σ_i b_i dy_i.
//
// A sum that depends on more is cut: it becomes a new unknown z with the row
//
//   dz − Σ_i b_i dy_i = 0,
//
// and x goes on as a + 1 dz. Residuals r evaluated so give the rows of a matrix that is local,
//
//   ( A  B ) ( dy )   ( dr )
//   ( C  T ) ( dz ) = (  0 ),     T unit lower triangular,  ∂r/∂y = A − B T⁻¹ C:
//
// the sweeps of a chain of n bodies give O(n) entries, where ∂r/∂y itself is full. Cuts depend on
// the number of unknowns in a sum, never on values; zeros of the model are folded, unless Cuts is
// told that constants change with time.
// Source: Griewank and Walther, Evaluating Derivatives, section 10.3, the linearised computational
// graph, intermediates of few arguments eliminated.

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace momenta {

/// The rows of z during an evaluation; one object a thread at a time, in `now`.
class Cuts {
 public:
  /// `unknowns`: number of dy; z are numbered behind them. `folds`: zeros of the model are folded.
  void begin(int unknowns, bool folds) {
    unknowns_ = unknowns;
    folds_ = folds;
    end_.clear();
    at_.clear();
    b_.clear();
    now = this;
  }
  void stop() { now = nullptr; }

  int cut(const int* at, const double* b, int count) {
    at_.insert(at_.end(), at, at + count);
    b_.insert(b_.end(), b, b + count);
    end_.push_back(at_.size());
    return unknowns_ + static_cast<int>(end_.size()) - 1;
  }
  bool folds() const { return folds_; }
  int size() const { return static_cast<int>(end_.size()); }
  /// Terms of row i: [first(i), last(i)) of columns() and values(); without dz.
  std::size_t first(int i) const { return i == 0 ? 0 : end_[static_cast<std::size_t>(i) - 1]; }
  std::size_t last(int i) const { return end_[static_cast<std::size_t>(i)]; }
  const std::vector<int>& columns() const { return at_; }
  const std::vector<double>& values() const { return b_; }

  static inline thread_local Cuts* now = nullptr;

 private:
  int unknowns_ = 0;
  bool folds_ = true;
  std::vector<std::size_t> end_;
  std::vector<int> at_;
  std::vector<double> b_;
};

struct LocalDual {
  static constexpr int most = 6;
  double a = 0;                ///< value
  int terms = 0;               ///< 0: a constant
  std::array<int, most> at{};  ///< unknowns, ascending
  std::array<double, most> b{};

  LocalDual() = default;
  LocalDual(double value) : a(value) {}  // NOLINT: constants mix freely, as with dual numbers
  static LocalDual variable(double value, int unknown, double slope = 1) {
    LocalDual x(value);
    x.terms = 1;
    x.at[0] = unknown;
    x.b[0] = slope;
    return x;
  }

  LocalDual& operator+=(const LocalDual& y) { return *this = *this + y; }
  LocalDual& operator-=(const LocalDual& y) { return *this = *this - y; }
  LocalDual& operator*=(const LocalDual& y) { return *this = *this * y; }
  LocalDual& operator/=(const LocalDual& y) { return *this = *this / y; }

  friend LocalDual operator+(const LocalDual& x, const LocalDual& y) {
    return sum(x.a + y.a, x, 1, y, 1);
  }
  friend LocalDual operator-(const LocalDual& x, const LocalDual& y) {
    return sum(x.a - y.a, x, 1, y, -1);
  }
  friend LocalDual operator-(const LocalDual& x) { return chain(x, -x.a, -1); }
  friend LocalDual operator+(const LocalDual& x) { return x; }
  friend LocalDual operator*(const LocalDual& x, const LocalDual& y) {
    if (x.folds() || y.folds()) return {};
    return sum(x.a * y.a, x, y.a, y, x.a);
  }
  friend LocalDual operator/(const LocalDual& x, const LocalDual& y) {
    const double inverse = 1 / y.a, ratio = x.a * inverse;
    return sum(ratio, x, inverse, y, -ratio * inverse);
  }
  friend bool operator<(const LocalDual& x, const LocalDual& y) { return x.a < y.a; }
  friend bool operator>(const LocalDual& x, const LocalDual& y) { return x.a > y.a; }
  friend bool operator<=(const LocalDual& x, const LocalDual& y) { return x.a <= y.a; }
  friend bool operator>=(const LocalDual& x, const LocalDual& y) { return x.a >= y.a; }

  friend LocalDual sin(const LocalDual& x) { return chain(x, std::sin(x.a), std::cos(x.a)); }
  friend LocalDual cos(const LocalDual& x) { return chain(x, std::cos(x.a), -std::sin(x.a)); }
  friend LocalDual sqrt(const LocalDual& x) {
    const double root = std::sqrt(x.a);
    return chain(x, root, 0.5 / root);
  }

  /// f(x) with f' at x.
  static LocalDual chain(const LocalDual& x, double value, double slope) {
    LocalDual r(value);
    r.terms = x.terms;
    for (int i = 0; i < x.terms; ++i) {
      r.at[place(i)] = x.at[place(i)];
      r.b[place(i)] = slope * x.b[place(i)];
    }
    return r;
  }
  /// value + s dx + t dy, cut where it has too many terms.
  static LocalDual sum(double value, const LocalDual& x, double s, const LocalDual& y, double t) {
    if (y.terms == 0) return chain(x, value, s);
    if (x.terms == 0) return chain(y, value, t);
    int at[2 * most];
    double b[2 * most];
    int i = 0, j = 0, n = 0;
    while (i < x.terms || j < y.terms) {
      const bool of_x = i < x.terms && (j >= y.terms || x.at[place(i)] <= y.at[place(j)]);
      const bool of_y = j < y.terms && (i >= x.terms || y.at[place(j)] <= x.at[place(i)]);
      at[n] = of_x ? x.at[place(i)] : y.at[place(j)];
      b[n++] = (of_x ? s * x.b[place(i)] : 0) + (of_y ? t * y.b[place(j)] : 0);
      i += of_x;
      j += of_y;
    }
    if (n > most) return variable(value, Cuts::now->cut(at, b, n));
    LocalDual r(value);
    r.terms = n;
    for (int k = 0; k < n; ++k) {
      r.at[place(k)] = at[k];
      r.b[place(k)] = b[k];
    }
    return r;
  }

 private:
  bool folds() const {
    return terms == 0 && a == 0 && (Cuts::now == nullptr || Cuts::now->folds());
  }
  static std::size_t place(int i) { return static_cast<std::size_t>(i); }
};

inline double value_of(const LocalDual& x) {
  return x.a;
}

}  // namespace momenta
