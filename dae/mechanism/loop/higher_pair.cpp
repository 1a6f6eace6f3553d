// Where two curves touch, in doubles: Newton's method from the last place; where that does not
// serve, from the best of their samples. Best of a curve: nearest to the point. Of a contact: with
// the least |g|² + L² |n_A + n_B|², L their reach, which is zero where outlines touch from outside.

#include <momenta/dae/mechanism/loop/higher_pair.h>

#include <algorithm>

namespace momenta {
namespace {

using Measures = std::array<double, 4>;
using Two = std::array<double, 2>;
using Lost = PairPlace::Lost;

constexpr int most_steps = 50;
constexpr double found = 1e-12;      // last step, relative to the range of the parameter
constexpr double near_by = 0.02;     // gap over reach that keeps the last branch
constexpr double least_bend = 1e-9;  // least curvature · reach
constexpr int grid = 24;             // digits kept of the parameter

double dot(const Two& x, const Two& y) {
  return x[0] * y[0] + x[1] * y[1];
}
Two left(const Two& x) {
  return {-x[1], x[0]};
}
Two turned(const Measures& y, const Two& x) {
  return {y[2] * x[0] - y[3] * x[1], y[3] * x[0] + y[2] * x[1]};
}
double norm(const Two& x) {
  return std::hypot(x[0], x[1]);
}

/// Range of a curve's parameter; of a line, `reach` of the curve that touches it.
double range_of(const PlaneCurve& curve, double reach) {
  if (curve.is_straight()) return reach;
  return curve.period() > 0 ? curve.period() : curve.samples().back() - curve.samples().front();
}
double within(const PlaneCurve& curve, double s) {
  if (!(curve.period() > 0)) return s;
  return s - curve.period() * std::floor(s / curve.period());
}
double on_grid(double s, double range) {
  const double unit = std::ldexp(1.0, std::ilogb(range) - grid);
  return std::nearbyint(s / unit) * unit;
}

/// The foot of a point on a curve.
struct Foot {
  const PlaneCurve& curve;
  Two point;

  struct At {
    double gap, r, slope, speed2;
  };
  At at(double s) const {
    const auto c = curve.at(s);
    const Two e{point[0] - c.p[0], point[1] - c.p[1]};
    const double speed2 = dot(c.d, c.d);
    return {norm(e), dot(c.d, e), dot(c.dd, e) - speed2, speed2};
  }
  /// Newton's method, to a point of least distance alone.
  bool from(double& s) const {
    const double range = range_of(curve, 0);
    for (int k = 0; k < most_steps; ++k) {
      const At here = at(s);
      if (!(here.slope < 0)) return false;
      const double step = std::clamp(-here.r / here.slope, -0.1 * range, 0.1 * range);
      s += step;
      if (std::abs(step) <= found * range) return true;
    }
    return false;
  }
  /// Between the neighbours of the nearest sample r falls through zero.
  bool nearest(double& s) const {
    const auto& samples = curve.samples();
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t k = 0; k < samples.size(); ++k)
      if (const double gap = at(samples[k]).gap; gap < least) least = gap, best = k;
    const std::size_t last = samples.size() - 1;
    const bool closed = curve.period() > 0;
    const double way = 2 * least / std::sqrt(at(samples[best]).speed2);  // along a straight end
    double low = best > 0 ? samples[best - 1] : closed ? samples[last] - curve.period() : -way;
    double high = best < last ? samples[best + 1]
                  : closed    ? samples[0] + curve.period()
                              : samples[last] + way;
    s = samples[best];
    for (int k = 0; k < 2 * most_steps; ++k) {
      const At here = at(s);
      (here.r > 0 ? low : high) = s;
      double next = s - here.r / here.slope;
      if (!(here.slope < 0 && next >= low && next <= high)) next = 0.5 * (low + high);
      const bool done = std::abs(next - s) <= found * range_of(curve, 0);
      s = next;
      if (done) return true;
    }
    return false;
  }
};

/// The common normal of two outlines.
struct Touch {
  const HigherPair& pair;
  const Measures& y;
  double reach = std::max(pair.of_a.reach(), pair.of_b.reach());

  struct At {
    Two g;
    double gap, facing;  ///< facing: |n_A + n_B|², 0 where the normals are opposite
    double r1, r2, r11, r12, r21, r22;
    double bend;  ///< κ_A + κ_B, times the reach
  };
  At at(double s_a, double s_b) const {
    const auto a = pair.of_a.at(s_a), b = pair.of_b.at(s_b);
    const Two p = turned(y, a.p), d = turned(y, a.d), dd = turned(y, a.dd);
    At now;
    now.g = {y[0] + p[0] - b.p[0], y[1] + p[1] - b.p[1]};
    const Two n_a = left(d), n_b = left(b.d);
    const double speed_a = norm(d), speed_b = norm(b.d);
    const double out_a = pair.of_a.outward() / speed_a, out_b = pair.of_b.outward() / speed_b;
    now.gap = std::abs(dot(n_b, now.g)) / speed_b;
    now.facing = 2 + 2 * out_a * out_b * dot(n_a, n_b);
    now.r1 = dot(b.d, now.g);
    now.r2 = dot(n_b, d);
    now.r11 = dot(b.d, d);
    now.r12 = dot(b.dd, now.g) - speed_b * speed_b;
    now.r21 = dot(n_b, dd);
    now.r22 = dot(left(b.dd), d);
    now.bend = reach * (now.r11 * now.r22 - now.r12 * now.r21) /
               (speed_a * speed_a * speed_b * speed_b * speed_b);
    return now;
  }
  bool from(double& s_a, double& s_b) const {
    const double range_a = range_of(pair.of_a, reach), range_b = range_of(pair.of_b, reach);
    for (int k = 0; k < most_steps; ++k) {
      const At now = at(s_a, s_b);
      const double det = now.r11 * now.r22 - now.r12 * now.r21;
      double da = -(now.r22 * now.r1 - now.r12 * now.r2) / det;
      double db = -(now.r11 * now.r2 - now.r21 * now.r1) / det;
      if (!std::isfinite(da) || !std::isfinite(db)) return false;
      // one step meets a line, however long
      const double most_a = pair.of_a.is_straight() ? HUGE_VAL : 0.05 * range_a;
      const double most_b = pair.of_b.is_straight() ? HUGE_VAL : 0.05 * range_b;
      const double cut = std::min({1.0, most_a / std::abs(da), most_b / std::abs(db)});
      s_a += cut * da;
      s_b += cut * db;
      if (std::abs(da) <= found * range_a && std::abs(db) <= found * range_b) return now.facing < 2;
    }
    return false;
  }
  bool nearest(double& s_a, double& s_b) const {
    double least = HUGE_VAL;
    const auto take = [&](double a, double b) {
      const At now = at(a, b);
      const double misfit = dot(now.g, now.g) + reach * reach * now.facing;
      if (misfit < least) least = misfit, s_a = a, s_b = b;
    };
    if (pair.of_b.is_straight()) {
      const Two e = pair.of_b.at(0.0).d;
      for (const double a : pair.of_a.samples()) {
        const Two p = turned(y, pair.of_a.at(a).p);
        take(a, dot(e, {y[0] + p[0], y[1] + p[1]}));
      }
    } else if (pair.of_a.is_straight()) {
      const Two e = turned(y, pair.of_a.at(0.0).d);
      for (const double b : pair.of_b.samples()) {
        const Two p = pair.of_b.at(b).p;
        take(dot(e, {p[0] - y[0], p[1] - y[1]}), b);
      }
    } else {
      const auto& of_a = pair.of_a.sampled();
      const auto& of_b = pair.of_b.sampled();
      for (std::size_t i = 0; i < of_a.size(); ++i) {
        const Two p = turned(y, of_a[i].p), d = turned(y, of_a[i].d);
        const double out_a = pair.of_a.outward() / norm(d);
        for (std::size_t k = 0; k < of_b.size(); ++k) {
          const Two g{y[0] + p[0] - of_b[k].p[0], y[1] + p[1] - of_b[k].p[1]};
          const double out_b = pair.of_b.outward() / std::sqrt(dot(of_b[k].d, of_b[k].d));
          const double misfit =
              dot(g, g) + reach * reach * (2 + 2 * out_a * out_b * dot(d, of_b[k].d));
          if (misfit < least)
            least = misfit, s_a = pair.of_a.samples()[i], s_b = pair.of_b.samples()[k];
        }
      }
    }
    return from(s_a, s_b);
  }
};

}  // namespace

void HigherPair::locate(const std::array<double, 4>& y, PairPlace& place) const {
  place.lost = Lost::no;
  double sum = 0;
  for (const double x : y) sum += 0 * x;
  if (sum != 0) {
    place = {false, 0, 0, Lost::no_normal};
    return;
  }
  PairPlace best{false, 0, 0, Lost::no};
  double gap = HUGE_VAL;
  const auto take = [&](bool there, double s_a, double s_b, double its) {
    if (there && its < gap) best = {true, s_a, s_b, Lost::no}, gap = its;
  };
  if (kind == Kind::curve) {
    const Foot foot{of_b, {y[0], y[1]}};
    double s = place.of_b;
    if (place.known && foot.from(s)) take(true, 0, s, foot.at(s).gap);
    if (!(gap <= near_by * of_b.reach()) && foot.nearest(s)) take(true, 0, s, foot.at(s).gap);
    if (best.known) {
      const auto at = foot.at(best.of_b);
      if (!(-at.slope > least_bend * at.speed2)) best.lost = Lost::curvature;
      best.of_b = on_grid(within(of_b, best.of_b), range_of(of_b, 0));
    }
  } else {
    const Touch touch{*this, y};
    double s_a = place.of_a, s_b = place.of_b;
    if (place.known && touch.from(s_a, s_b)) take(true, s_a, s_b, touch.at(s_a, s_b).gap);
    if (!(gap <= near_by * touch.reach) && touch.nearest(s_a, s_b))
      take(true, s_a, s_b, touch.at(s_a, s_b).gap);
    if (best.known) {
      if (!(std::abs(touch.at(best.of_a, best.of_b).bend) > least_bend))
        best.lost = Lost::curvature;
      best.of_a = on_grid(within(of_a, best.of_a), range_of(of_a, touch.reach));
      best.of_b = on_grid(within(of_b, best.of_b), range_of(of_b, touch.reach));
    }
  }
  place = best;
  if (!best.known) place.lost = Lost::no_normal;
}

void HigherPair::by_chain_rule(const std::array<LocalDual, 4>& y, PairPlace& place,
                               PairTerms<LocalDual>& out) const {
  using D = Dual<double, 4>;
  std::array<D, 4> at;
  for (int i = 0; i < 4; ++i)
    at[static_cast<std::size_t>(i)] = D::variable(y[static_cast<std::size_t>(i)].a, i);
  PairTerms<D> terms;
  evaluate(at, place, terms);
  const std::size_t n = turns() ? 4 : 2;
  const auto along = [&](const D& x) {
    LocalDual r(x.a);
    for (std::size_t i = 0; i < n; ++i) r = LocalDual::sum(x.a, r, 1, y[i], x.b[i]);
    return r;
  };
  out.value = along(terms.value);
  for (std::size_t i = 0; i < n; ++i) {
    out.slope[i] = along(terms.slope[i]);
    for (std::size_t j = 0; j <= i; ++j) out.bend[i][j] = out.bend[j][i] = along(terms.bend[i][j]);
  }
}

}  // namespace momenta
