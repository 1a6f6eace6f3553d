#include <momenta/dae/run/event/bracketed_root.h>
#include <momenta/dae/run/event/crossings.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

constexpr int most_halvings = 6;
constexpr std::size_t last = Crossings::points - 1;
constexpr std::size_t fine = 4;              ///< places of p per point of g
constexpr std::size_t places = fine * last;  ///< intervals between places of p
constexpr double resolved_to = 1e-3;         ///< trailing coefficients over the largest
constexpr double rounding = 1e-13;           ///< error of g over its size
constexpr double near_zero = 0.02;           ///< minima of |p| over its range
constexpr double start_is_zero = 1e-12;      ///< g at the start over its size in the first step

int sign_of(double x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

/// −cos(πj/32), from −1 to 1.
double place(std::size_t j) {
  return -std::cos(std::numbers::pi * static_cast<double>(j) / places);
}

/// The largest |c_k|, k ≥ 1, and |c₇| + |c₈|.
struct Spectrum {
  double range = 0, tail = 0, size = 0;
  explicit Spectrum(const Crossings::Values& g) {
    for (const double x : g) size = std::max(size, std::abs(x));
    for (std::size_t k = 1; k <= last; ++k) {
      double c = 0;
      for (std::size_t i = 0; i <= last; ++i)
        c += (i == 0 || i == last ? 0.5 : 1) * g[i] * place(fine * ((i * k) % (2 * last)));
      c = std::abs(c) * (k == last ? 0.125 : 0.25);
      range = std::max(range, c);
      if (k >= last - 1) tail += c;
    }
  }
  bool resolved() const { return tail <= resolved_to * range || range <= rounding * size; }
};

/// p at one of the places, by the second barycentric formula.
double polynomial(const Crossings::Values& g, std::size_t j) {
  if (j % fine == 0) return g[j / fine];
  double above = 0, below = 0;
  for (std::size_t i = 0; i <= last; ++i) {
    const double weight =
        (i % 2 == 0 ? 1 : -1) * (i == 0 || i == last ? 0.5 : 1) / (place(j) - place(fine * i));
    above += weight * g[i];
    below += weight;
  }
  return above / below;
}

bool all_numbers(const Crossings::Values& g) {
  return std::all_of(g.begin(), g.end(), [](double x) { return std::isfinite(x); });
}

}  // namespace

double Crossings::point(double t0, double t1, std::size_t i) {
  if (i == 0) return t0;
  if (i == last) return t1;
  return 0.5 * (t0 + t1) + 0.5 * (t1 - t0) * place(fine * i);
}

void Crossings::step(double t0, double t1, const Values& at_points,
                     const std::function<double(double)>& g, std::vector<Crossing>& found) {
  g_ = &g;
  found_ = &found;
  last_.reset();
  Values values = at_points;
  const int first = sign_of(values[0]);
  double size = 0;
  for (const double x : values) size = std::max(size, std::abs(x));
  // The start, or a correction that moved g through zero.
  if (begun_ ? sign_ != 0 && first != 0 && first != sign_
             : std::abs(values[0]) <= start_is_zero * size)
    values[0] = 0;
  begun_ = true;
  interval(t0, t1, values, 0);
}

void Crossings::interval(double t0, double t1, const Values& values, int halvings) {
  if (!all_numbers(values) || halvings == most_halvings || Spectrum(values).resolved())
    return look_at(t0, t1, values);
  const double middle = point(t0, t1, last / 2);
  const auto half = [&](double from, double to, double first, double end) {
    Values g;
    g[0] = first;
    for (std::size_t i = 1; i < last; ++i) g[i] = (*g_)(point(from, to, i));
    g[last] = end;
    interval(from, to, g, halvings + 1);
  };
  half(t0, middle, values[0], values[last / 2]);
  half(middle, t1, values[last / 2], values[last]);
}

void Crossings::look_at(double t0, double t1, const Values& values) {
  places_.clear();
  for (std::size_t i = 0; i <= last; ++i) places_.push_back({point(t0, t1, i), values[i]});
  if (all_numbers(values)) {
    const auto time = [&](std::size_t j) {
      return j == 0 ? t0 : j == places ? t1 : 0.5 * (t0 + t1) + 0.5 * (t1 - t0) * place(j);
    };
    std::array<double, places + 1> p;
    for (std::size_t j = 0; j <= places; ++j) p[j] = polynomial(values, j);
    const double low = near_zero * Spectrum(values).range;
    for (std::size_t j = 0; j <= places; ++j) {
      const double before = p[j == 0 ? 0 : j - 1], after = p[j == places ? j : j + 1];
      const int sign = sign_of(p[j]);
      if (sign == 0) continue;
      const bool turns = j % fine != 0 && (sign_of(before) == -sign || sign_of(after) == -sign);
      const double from = time(j == 0 ? 0 : j - 1), to = time(std::min(j + 1, places));
      if (turns) places_.push_back({time(j), (*g_)(time(j))});
      // A p beyond zero where g is not comes no nearer to g.
      if (turns && sign * places_.back().g < 0)
        places_.push_back(lowest(from, to, -sign));
      else if (!turns && sign * p[j] <= std::min({low, sign * before, sign * after}))
        places_.push_back(lowest(from, to, sign));
    }
  } else {
    for (std::size_t i = 0; i < last; ++i)
      if (std::isnan(values[i]) != std::isnan(values[i + 1])) {
        const double a = point(t0, t1, i), b = point(t0, t1, i + 1);
        places_.push_back(std::isnan(values[i]) ? first_value(a, b) : first_value(b, a));
      }
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.t < b.t; });
  for (const Place& x : places_) take(x.t, x.g);
}

void Crossings::take(double t, double g) {
  if (std::isnan(g)) {
    sign_ = 0;
    at_zero_ = false;
    last_.reset();
    return;
  }
  const int sign = sign_of(g);
  if (sign == 0) {
    zero_ = t;
    at_zero_ = true;
    return;
  }
  if (sign_ == -sign) {
    if (at_zero_)
      found_->push_back({end_of_zero(zero_, t), sign > 0});
    else
      cross(last_->t, last_->g, t, g, sign > 0);  // in this step: its first place is none or zero
  }
  sign_ = sign;
  at_zero_ = false;
  last_ = {t, g};
}

double Crossings::end_of_zero(double zero, double after) const {
  while (after - zero > tolerance_) {
    const double middle = 0.5 * (zero + after);
    if (!(zero < middle && middle < after)) break;
    ((*g_)(middle) == 0 ? zero : after) = middle;
  }
  return zero;
}

void Crossings::cross(double t0, double g0, double t1, double g1, bool up) {
  const BracketedRoot root = bracketed_root(*g_, t0, g0, t1, g1, tolerance_);
  const double most = std::max(std::abs(g0), std::abs(g1));
  const bool pole = !(std::abs(root.before) <= most) && !(std::abs(root.after) <= most);
  if (!std::isnan(root.at) && !pole) found_->push_back({root.at, up});
}

Crossings::Place Crossings::first_value(double none, double some) const {
  while (std::abs(some - none) > tolerance_) {
    const double middle = 0.5 * (none + some);
    if (middle == none || middle == some) break;
    (std::isnan((*g_)(middle)) ? none : some) = middle;
  }
  return {some, (*g_)(some)};
}

Crossings::Place Crossings::lowest(double t0, double t1, double sign) const {
  constexpr double golden = 0.6180339887498949;
  constexpr int trials = 40;  // to the root of rounding, where a minimum is flat
  double a = t0, b = t1, left = b - golden * (b - a), right = a + golden * (b - a);
  double at_left = sign * (*g_)(left), at_right = sign * (*g_)(right);
  for (int k = 0; k < trials && at_left > 0 && at_right > 0; ++k) {
    if (at_left < at_right) {
      b = right, right = left, at_right = at_left;
      left = b - golden * (b - a);
      at_left = sign * (*g_)(left);
    } else {
      a = left, left = right, at_left = at_right;
      right = a + golden * (b - a);
      at_right = sign * (*g_)(right);
    }
  }
  return at_left < at_right ? Place{left, sign * at_left} : Place{right, sign * at_right};
}

void Crossings::carry(Memory& memory) {
  memory(begun_), memory(sign_), memory(at_zero_), memory(zero_);
}

}  // namespace momenta
