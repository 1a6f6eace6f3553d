#pragma once
// The loop equations at three levels, Φ, Φ̇ and Φ̈, for one algebra and one scalar: the table of
// loop_rows.h read by rows.

#include <momenta/dae/mechanism/loop/loop_places.h>

namespace momenta {

template <class Space, class S>
class LoopLevels : public LoopPlaces<Space, S> {
 public:
  using Places = LoopPlaces<Space, S>;
  using Places::Places;
  using typename Places::Angular;
  using typename Places::Loop;
  using typename Places::Vector;

  /// Φ (m)
  void positions(S* phi) const {
    each_row([&](int row, const auto&, const At& s, const Vector& b) { phi[row] = dot(b, s.D); },
             [&](int row, const auto& l, const At&, const Vector& a, const Vector& b) {
               phi[row] = dot(a, b) - l.gamma;
             },
             [&](int row, const auto& l, const At& s) {
               phi[row] = (dot(s.D, s.D) + (l.across2 - this->given(l) * this->given(l))) *
                          (0.5 * l.per_length);
             },
             [&](int row, const At& s) { phi[row] = s.position; },
             [&](int row, const auto& l, const At&) { phi[row] = this->pair(l).terms.value; },
             [&](int row, std::size_t k, const auto& l) {
               phi[row] = k == 0 ? this->wheel(l).gap : S(0.0);
             });
  }

  /// Φ̇ (m) for the velocities of the last move().
  void velocities(S* rate) const {
    each_row([&](int row, const auto&, const At& s,
                 const Vector& b) { rate[row] = this->point_rate(s, b); },
             [&](int row, const auto&, const At& s, const Vector& a, const Vector& b) {
               rate[row] = this->axes_rate(s, a, b);
             },
             [&](int row, const auto& l, const At& s) {
               rate[row] =
                   (dot(s.D, s.u_a - s.u_b) - this->given(l) * this->given_rate(l)) * l.per_length;
             },
             [&](int row, const At& s) { rate[row] = s.rate; },
             [&](int row, const auto& l, const At&) {
               const Pair& p = this->pair(l);
               rate[row] = S(0.0);
               for (std::size_t k = 0; k < p.measures; ++k)
                 rate[row] += p.terms.slope[k] * p.rate[k];
             },
             [&](int row, std::size_t k, const auto& l) { rate[row] = this->wheel(l).rate(k); });
  }

  /// Φ̈ (m) for the accelerations body[k].A and of accelerate(): with u̇ = 0 the bias (d/dt Φ_q) u +
  /// d/dt Φ_t.
  void accelerations(S* rate) const {
    each_row([&](int row, const auto& l, const At& s,
                 const Vector& b) { rate[row] = point_second(l, s, b); },
             [&](int row, const auto& l, const At& s, const Vector& a, const Vector& b) {
               rate[row] = axes_second(l, s, a, b);
             },
             [&](int row, const auto& l, const At& s) {
               const Vector rel = s.u_a - s.u_b;
               S second = dot(s.D, acceleration_apart(l, s)) + dot(rel, rel);
               if (l.motion >= 0) {
                 const auto& m = this->motion(l);
                 second -= S(m.given_rate * m.given_rate + m.given * m.given_second);
               }
               rate[row] = second * l.per_length;
             },
             [&](int row, const At& s) { rate[row] = s.second; },
             [&](int row, const auto& l, const At& s) {
               const Pair& p = this->pair(l);
               S second = p.terms.slope[0] * point_second(l, s, s.b[0]) +
                          p.terms.slope[1] * point_second(l, s, s.b[1]);
               if (p.measures == 4)
                 second += p.terms.slope[2] * axes_second(l, s, s.a[0], s.b[0]) +
                           p.terms.slope[3] * axes_second(l, s, s.a[0], s.b[1]);
               for (std::size_t k = 0; k < p.measures; ++k) second += p.slope_rate[k] * p.rate[k];
               rate[row] = second;
             },
             [&](int row, std::size_t k, const auto& l) {
               const auto& rolls = this->wheel(l);
               rate[row] = rolls.second(k, point_acceleration(this->w_, l.a, rolls.at),
                                        point_acceleration(this->w_, l.b, rolls.at));
             });
  }

 protected:
  using Places::at_;
  using Places::in_space;
  using Places::model_;
  using Places::motion;
  using Places::turning_in_ground;
  using Places::w_;
  using typename Places::At;
  using typename Places::Driven;
  using typename Places::Pair;

 private:
  /// Angular acceleration of axes on body k that turn by `w` relative to it, ẇ in body axes.
  Angular turning(int k, const typename Driven::Angular& w,
                  const typename Driven::Angular& rate) const {
    Angular sum = angular_acceleration(w_, k) + turning_in_ground(k, rate);
    if constexpr (Space::dimension == 6)
      sum += cross(angular_velocity(w_, k), turning_in_ground(k, w));
    return sum;
  }
  Angular turning_a(const Loop& l) const {
    if (l.motion < 0) return angular_acceleration(w_, l.a);
    return turning(l.a, motion(l).turning_a, motion(l).turning_a_rate);
  }
  Angular turning_b(const Loop& l) const {
    if (l.motion < 0) return angular_acceleration(w_, l.axes_of_b());
    return turning(l.b, motion(l).turning_b, motion(l).turning_b_rate);
  }
  /// d/dt (u_A − u_B); x_B moves on B with v and a: its own + 2 ω × v + a.
  Vector acceleration_apart(const Loop& l, const At& s) const {
    Vector apart = point_acceleration(w_, l.a, s.x_a) - point_acceleration(w_, l.b, s.x_b);
    if (l.motion < 0) return apart;
    const auto& m = motion(l);
    apart -=
        2.0 * cross(angular_velocity(w_, l.b), to_ground(w_, l.b, m.v)) + to_ground(w_, l.b, m.a);
    return apart;
  }

  /// Φ̈ of D_j and O_ij.
  S point_second(const Loop& l, const At& s, const Vector& b) const {
    const Vector bdot = cross(s.w_b, b);
    const Vector bddot = cross(s.w_b, bdot) + cross(turning_b(l), b);
    return dot(b, acceleration_apart(l, s)) + 2.0 * dot(bdot, s.u_a - s.u_b) + dot(bddot, s.D);
  }
  S axes_second(const Loop& l, const At& s, const Vector& a, const Vector& b) const {
    const Vector adot = cross(s.w_a, a), bdot = cross(s.w_b, b);
    return inner(cross(a, b), turning_a(l) - turning_b(l)) + dot(cross(s.w_a, adot), b) +
           2.0 * dot(adot, bdot) + dot(a, cross(s.w_b, bdot));
  }

  template <class Point, class Axes, class Distance, class Coupling, class Higher, class Rolling>
  void each_row(Point&& point, Axes&& axes, Distance&& distance, Coupling&& coupling,
                Higher&& higher, Rolling&& rolling) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_->loops[i];
      const At& s = at_[i];
      int row = l.row;
      if (l.is_distance()) {
        distance(row, l, s);
        continue;
      }
      if (l.is_coupler()) {
        coupling(row, s);
        continue;
      }
      if constexpr (in_space)
        if (l.is_wheel()) {
          for (std::size_t k = 0; k < 3; ++k) rolling(row++, k, l);
          continue;
        }
      for (int j = 0; j < l.n_points; ++j)
        point(row++, l, s, s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
      if (l.is_pair()) higher(row++, l, s);
      for (int j = 0; j < l.n_axes; ++j) {
        const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
        axes(row++, l, s, s.a[static_cast<std::size_t>(x)], s.b[static_cast<std::size_t>(y)]);
      }
    }
  }
};

}  // namespace momenta
