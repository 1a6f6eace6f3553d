#pragma once
// Loops of points, axes and distances whose numbers a θ moves: Φ̇ + βΦ, and impulses σ with their
// inertial rates on the bodies (loop_rows.h), for an S whose directions are in the tables.

#include <momenta/core/kernel/points.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

#include <array>
#include <vector>

namespace momenta {

template <class Space, class S>
class MovedLoops {
  using Vector = typename Space::template Vector<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));
  static constexpr int axes = Space::dimension == 6 ? 3 : 2;

 public:
  /// @pre no loop is driven, of a curve, a wheel or an equation
  MovedLoops(const LoopModel<Space>& model, Workspace<Space, S>& w) : model_(model), w_(w) {}

  /// Fills r2 (m), and adds σ to P and its rates less κσ to T of the bodies. dn(i): the change of
  /// number i of the loops, NumberPlaces. Needs poses and velocities.
  template <class Change>
  void add(const S* sigma, double leak, double beta, Change&& dn, S* r2) {
    Eigen::Index first = 0;
    for (const auto& l : model_.loops) {
      const Eigen::Index last = first + NumberPlaces<Space>::of_loop - 4;
      if (l.is_coupler())
        r2[l.row] = -(beta * dn(last + 1));  // not in Φ̇
      else
        add(
            l, sigma, leak, beta, [&](Eigen::Index i) { return dn(first + i); }, r2);
      first = last + 4;
    }
  }

 private:
  using Loop = typename LoopModel<Space>::Loop;

  static S inner(const Vec3<S>& a, const Vec3<S>& b) { return dot(a, b); }
  static S inner(const S& a, const S& b) { return a * b; }

  template <class Change>
  void add(const Loop& l, const S* sigma, double leak, double beta, Change&& dn, S* r2) {
    Eigen::Index at = 0;
    const auto change = [&](int body) {
      Vector v;
      for (int i = 0; i < axes; ++i) v[i] = dn(at++);
      return to_ground(w_, body, v);
    };
    const Vector x_a = point_position(w_, l.a, l.at_a) + change(l.a),
                 x_b = point_position(w_, l.b, l.at_b) + change(l.b), D = x_a - x_b,
                 u_a = point_velocity(w_, l.a, x_a), u_b = point_velocity(w_, l.b, x_b),
                 apart = u_a - u_b;
    const Angular w_a = angular_velocity(w_, l.a), w_b = angular_velocity(w_, l.axes_of_b());
    std::array<Vector, 3> a, b;
    for (std::size_t j = 0; j < axes; ++j) {
      a[j] = to_ground(w_, l.a, l.axis_a[j]) + change(l.a);
      b[j] = to_ground(w_, l.axes_of_b(), l.axis_b[j]) + change(l.axes_of_b());
    }
    Vector force{}, force_rate{};
    Angular couple{}, couple_rate{};
    int row = l.row;
    if (l.is_distance()) {
      const S per = S(l.per_length) + dn(at), given = S(l.given) + dn(at + 1),
              across = S(l.across2) + dn(at + 2), scaled = per * sigma[row];
      r2[row] = per * (dot(D, apart) + (0.5 * beta) * (dot(D, D) + across - given * given));
      force = scaled * D;
      force_rate = scaled * apart;
    } else {
      for (int j = 0; j < l.n_points; ++j, ++row) {
        const Vector& along = b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])];
        const Vector turning = cross(w_b, along);
        r2[row] = dot(along, apart) + dot(turning, D) + beta * dot(along, D);
        force += sigma[row] * along;
        force_rate += sigma[row] * turning;
      }
      const S gamma = S(l.gamma) + dn(at + 3);
      for (int j = 0; j < l.n_axes; ++j, ++row) {
        const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
        const Vector &of_a = a[static_cast<std::size_t>(x)], &of_b = b[static_cast<std::size_t>(y)];
        const Angular about = cross(of_a, of_b);
        r2[row] = inner(about, w_a - w_b) + beta * (dot(of_a, of_b) - gamma);
        couple += sigma[row] * about;
        couple_rate += sigma[row] * (cross(cross(w_a, of_a), of_b) + cross(of_a, cross(w_b, of_b)));
      }
    }
    force_rate += -leak * force;
    couple_rate += -leak * couple;
    act(l.a, x_a, u_a, force, force_rate, couple, couple_rate);
    act(l.b, l.is_tie ? x_b : x_a, l.is_tie ? u_b : u_a, -force, -force_rate, Angular(-couple),
        Angular(-couple_rate));
  }
  void act(int k, const Vector& x, const Vector& u, const Vector& force, const Vector& rate,
           const Angular& couple, const Angular& couple_rate) {
    if (k < 0) return;
    auto& body = w_.body[static_cast<std::size_t>(k)];
    add_force(w_, k, x, force, body.P);
    add_couple(w_, k, couple, body.P);
    add_force(w_, k, x, rate, body.T);
    add_couple(w_, k, Angular(couple_rate + cross(u, force)), body.T);
  }

  const LoopModel<Space>& model_;
  Workspace<Space, S>& w_;
};

}  // namespace momenta
