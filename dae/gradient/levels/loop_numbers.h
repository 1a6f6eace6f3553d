#pragma once
// Slopes of σᵀΦ̇ and σᵀΦ by the numbers of the loops, and the loops' forces on the bodies.

#include <momenta/core/kernel/points.h>
#include <momenta/dae/gradient/levels/placed_along.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

#include <array>
#include <vector>

namespace momenta {

/// The impulses σ of points, axes and distances (loop_rows.h) that are not driven, and the slopes
/// of σᵀΦ̇ and σᵀΦ by the numbers of these loops.
template <class Space, class S>
class LoopNumbers {
  using Vector = typename Space::template Vector<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));
  static constexpr int axes = Space::dimension == 3 ? 2 : 3;

 public:
  LoopNumbers(const LoopModel<Space>& model, Workspace<Space, S>& w)
      : model_(model), w_(w), at_(model.loops.size()) {}

  /// Places points and axes, and sums up rows by loop; needs poses and velocities.
  void place(const S* sigma) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      At& s = at_[i];
      s.force = s.force_rate = {};
      s.couple = s.couple_rate = {};
      if (l.is_coupler()) continue;
      s.x_a = point_position(w_, l.a, l.at_a);
      s.x_b = point_position(w_, l.b, l.at_b);
      s.u_a = point_velocity(w_, l.a, s.x_a);
      s.u_b = point_velocity(w_, l.b, s.x_b);
      const Vector D = s.x_a - s.x_b;
      int row = l.row;
      if (l.is_distance()) {
        const S scaled = l.per_length * sigma[row];
        s.force = scaled * D;
        s.force_rate = scaled * (s.u_a - s.u_b);
        continue;
      }
      s.w_a = angular_velocity(w_, l.a);
      s.w_b = angular_velocity(w_, l.axes_of_b());
      for (std::size_t j = 0; j < static_cast<std::size_t>(axes); ++j) {
        if (l.n_axes > 0) s.a[j] = to_ground(w_, l.a, l.axis_a[j]);
        s.b[j] = to_ground(w_, l.axes_of_b(), l.axis_b[j]);
      }
      for (int j = 0; j < l.n_points; ++j, ++row) {
        const Vector& b = s.b[place_of(l.points, j)];
        s.force += sigma[row] * b;
        s.force_rate += sigma[row] * cross(s.w_b, b);
      }
      for (int j = 0; j < l.n_axes; ++j, ++row) {
        const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
        const Vector &a = s.a[static_cast<std::size_t>(x)], &b = s.b[static_cast<std::size_t>(y)];
        s.couple += sigma[row] * cross(a, b);
        s.couple_rate += sigma[row] * (cross(cross(s.w_a, a), b) + cross(a, cross(s.w_b, b)));
      }
    }
  }

  /// Adds impulses to body[k].P and their inertial rates to body[k].T.
  void hand_to_bodies() {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      if (l.is_coupler()) continue;
      const At& s = at_[i];
      hand(l.a, s.x_a, s.u_a, s.force, s.force_rate, s.couple, s.couple_rate);
      const bool at_b = l.is_tie;
      hand(l.b, at_b ? s.x_b : s.x_a, at_b ? s.u_b : s.u_a, -s.force, -s.force_rate,
           Angular(-s.couple), Angular(-s.couple_rate));
    }
  }

  /// Calls put(∂(σᵀΦ̇)/∂number), or of σᵀΦ, for all loops' numbers. With f = Σ σ b the slope by x_A
  /// is ḟ − ω_A × f, or f.
  template <class Put>
  void each(const S* sigma, bool of_rates, Put&& put) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      const At& s = at_[i];
      std::array<Vector, 3> by_a{}, by_b{};
      S per_length(0.0), given(0.0), across(0.0), gamma(0.0);
      const Vector apart = s.u_a - s.u_b, D = s.x_a - s.x_b;
      int row = l.row;
      if (l.is_coupler()) {
        given = -sigma[row];
      } else if (l.is_distance()) {
        per_length =
            sigma[row] *
            (of_rates ? dot(D, apart) : S(0.5 * (dot(D, D) + S(l.across2 - l.given * l.given))));
        given = (-l.per_length * l.given) * sigma[row];
        across = (0.5 * l.per_length) * sigma[row];
      } else {
        for (int j = 0; j < l.n_points && !l.is_tie; ++j)
          by_b[place_of(l.points, j)] +=
              sigma[row + j] * (of_rates ? Vector(apart - cross(s.w_b, D)) : D);
        row += l.n_points;
        for (int j = 0; j < l.n_axes; ++j, ++row) {
          const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
          const auto at_x = static_cast<std::size_t>(x), at_y = static_cast<std::size_t>(y);
          const Angular turning = s.w_a - s.w_b;
          by_a[at_x] += sigma[row] * (of_rates ? Vector(-cross(turning, s.b[at_y])) : s.b[at_y]);
          by_b[at_y] += sigma[row] * (of_rates ? Vector(cross(turning, s.a[at_x])) : s.a[at_x]);
          gamma -= sigma[row];
        }
      }
      const auto put_in = [&](int body, const Vector& v) {
        const Vector in = in_body_axes(w_, body, v);
        for (const S& x : in.x) put(x);
      };
      const auto end = [&](int body) {
        return of_rates ? Vector(s.force_rate - cross(angular_velocity(w_, body), s.force))
                        : s.force;
      };
      if (l.is_coupler()) {
        put.skip(2 * axes * (1 + axes));
      } else {
        put_in(l.a, end(l.a));
        put_in(l.b, -end(l.b));
        for (std::size_t j = 0; j < static_cast<std::size_t>(axes); ++j) {
          if (l.n_axes > 0)
            put_in(l.a, by_a[j]);
          else
            put.skip(axes);
          if (l.n_axes > 0 || !l.is_tie)  // axes of the ground stay
            put_in(l.axes_of_b(), by_b[j]);
          else
            put.skip(axes);
        }
      }
      put(per_length);
      if (of_rates) {
        put.skip(3);
        continue;
      }
      for (const S* x : {&given, &across, &gamma}) put(*x);
    }
  }

 private:
  struct At {
    Vector x_a{}, x_b{}, u_a{}, u_b{}, force{}, force_rate{};
    Angular w_a{}, w_b{}, couple{}, couple_rate{};
    std::array<Vector, 3> a{}, b{};
  };
  static std::size_t place_of(const std::array<int, 3>& points, int j) {
    return static_cast<std::size_t>(points[static_cast<std::size_t>(j)]);
  }
  void hand(int k, const Vector& x, const Vector& u, const Vector& force, const Vector& rate,
            const Angular& couple, const Angular& couple_rate) {
    if (k < 0) return;
    hand_over(w_, k, x, u, force, rate);
    auto& body = w_.body[static_cast<std::size_t>(k)];
    add_couple(w_, k, couple, body.P);
    add_couple(w_, k, couple_rate, body.T);
  }

  const LoopModel<Space>& model_;
  Workspace<Space, S>& w_;
  std::vector<At> at_;
};

}  // namespace momenta
