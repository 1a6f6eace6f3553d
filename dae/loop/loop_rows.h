#pragma once
// The loop equations at three levels, their impulses and the inertial rates of those, for one
// algebra and one scalar. u_A, u_B: velocities of the two points; ω_a, ω_b: angular velocities; s:
// the impulse σ of the row.
//
//          Φ̇                                      wrench on A          inertial rate N on A at
//          fixed σ
//   D_j    b·(u_A − u_B) + (ω_b × b)·D            force b s at x_A     force (ω_b × b) s at x_A,
//   couple u_A × b s O_ij   (a × b)·(ω_a − ω_b)                    couple (a × b) s     couple
//   [(ω_a × a) × b + a × (ω_b × b)] s L      D·(u_A − u_B)/l                        force D s/l at
//   x_A   force (u_A − u_B) s/l at x_A, couple u_A × D s/l
// On B act the exact negatives, with the same line of action. N = (d/dt Jᵀ)σ + Ω × w: it is added
// to the applied wrenches T, because Ω × P* in (35) takes the part Ω × w away again. With this, p =
// EᵀP*_aug is row 1 of (7) and (35) is (8), without M or Φ_q.

#include <momenta/core/kernel/points.h>
#include <momenta/core/scalar/dual.h>
#include <momenta/dae/loop/loop_model.h>

namespace momenta {

// In the plane angular quantities are numbers; products read alike in both algebras.
template <class S>
S inner(const Vec3<S>& a, const Vec3<S>& b) {
  return dot(a, b);
}
template <class S>
S inner(const S& a, const S& b) {
  return a * b;
}

template <class Space, class S>
class LoopRows {
 public:
  using Vector = typename Space::template Vector<S>;
  using Force = typename Space::template Force<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));  ///< Vec3 in space, S in the plane

  LoopRows(const LoopModel<Space>& model, Workspace<Space, S>& w)
      : model_(model), w_(w), at_(model.loops.size()) {}

  /// Points and axes in ground components; needs poses.
  void place() {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      auto& s = at_[i];
      s.x_a = point_position(w_, l.a, l.at_a);
      s.x_b = point_position(w_, l.b, l.at_b);
      s.D = s.x_a - s.x_b;
      for (std::size_t j = 0; j < (Space::dimension == 3 ? 2u : 3u); ++j) {
        s.a[j] = to_ground(w_, l.a, l.axis_a[j]);
        s.b[j] = to_ground(w_, l.b, l.axis_b[j]);
      }
    }
  }

  /// Point and angular velocities; needs velocities.
  void move() {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      auto& s = at_[i];
      s.u_a = point_velocity(w_, l.a, s.x_a);
      s.u_b = point_velocity(w_, l.b, s.x_b);
      s.w_a = angular_velocity(w_, l.a);
      s.w_b = angular_velocity(w_, l.b);
    }
  }

  /// Φ (m)
  void positions(S* phi) const {
    each_row([&](int row, const auto&, const At& s, const Vector& b) { phi[row] = dot(b, s.D); },
             [&](int row, const auto& l, const At&, const Vector& a, const Vector& b) {
               phi[row] = dot(a, b) - l.gamma;
             },
             [&](int row, const auto& l, const At& s) {
               phi[row] = (dot(s.D, s.D) + (l.across2 - l.length * l.length)) * (0.5 / l.length);
             });
  }

  /// Φ̇ (m) for the velocities of the last move().
  void velocities(S* rate) const {
    each_row(
        [&](int row, const auto&, const At& s, const Vector& b) {
          rate[row] = dot(b, s.u_a - s.u_b) + dot(cross(s.w_b, b), s.D);
        },
        [&](int row, const auto&, const At& s, const Vector& a, const Vector& b) {
          rate[row] = inner(cross(a, b), s.w_a - s.w_b);
        },
        [&](int row, const auto& l, const At& s) {
          rate[row] = dot(s.D, s.u_a - s.u_b) * (1.0 / l.length);
        });
  }

  /// Φ̈ (m) for the accelerations body[k].A: with u̇ = 0 the bias (d/dt Φ_q) u + d/dt Φ_t.
  void accelerations(S* rate) const {
    const auto accelerate = [&](const auto& l, const At& s) -> Vector {
      return point_acceleration(w_, l.a, s.x_a) - point_acceleration(w_, l.b, s.x_b);
    };
    each_row(
        [&](int row, const auto& l, const At& s, const Vector& b) {
          const Vector bdot = cross(s.w_b, b);
          const Vector bddot = cross(s.w_b, bdot) + cross(angular_acceleration(w_, l.b), b);
          rate[row] = dot(b, accelerate(l, s)) + 2.0 * dot(bdot, s.u_a - s.u_b) + dot(bddot, s.D);
        },
        [&](int row, const auto& l, const At& s, const Vector& a, const Vector& b) {
          const Vector adot = cross(s.w_a, a), bdot = cross(s.w_b, b);
          rate[row] =
              inner(cross(a, b), angular_acceleration(w_, l.a) - angular_acceleration(w_, l.b)) +
              dot(cross(s.w_a, adot), b) + 2.0 * dot(adot, bdot) + dot(a, cross(s.w_b, bdot));
        },
        [&](int row, const auto& l, const At& s) {
          const Vector rel = s.u_a - s.u_b;
          rate[row] = (dot(s.D, accelerate(l, s)) + dot(rel, rel)) * (1.0 / l.length);
        });
  }

  /// Adds the wrenches of the impulses `sigma`, times `factor`, to the bodies' forces chosen by
  /// `field`.
  template <class Field>
  void add_wrenches(const S* sigma, double factor, Field field) {
    each_loop_wrench(
        sigma, factor, field,
        [](const At&, const Vector& b) {
          return std::pair<Vector, Vector>{b, Vector{}};
        },
        [](const At&, const Vector& a, const Vector& b) { return cross(a, b); }, false);
  }

  /// Adds the inertial rates N of the impulses to body[k].T; needs move().
  void add_inertial_rates(const S* sigma) {
    each_loop_wrench(
        sigma, 1.0, [](auto& body) -> Force& { return body.T; },
        [](const At& s, const Vector& b) {
          return std::pair<Vector, Vector>{cross(s.w_b, b), b};
        },
        [](const At& s, const Vector& a, const Vector& b) {
          return cross(cross(s.w_a, a), b) + cross(a, cross(s.w_b, b));
        },
        true);
  }

  /// Unit wrench of a row on its bodies, in the axes of the sweeps: the start of a row of Φ_q.
  void unit_wrench(std::size_t loop, int row_of_loop, Force& on_a, Force& on_b) const {
    const auto& l = model_.loops[loop];
    const At& s = at_[loop];
    on_a = {};
    on_b = {};
    const auto push = [&](const Vector& f) {
      if (l.a >= 0) add_force(w_, l.a, s.x_a, f, on_a);
      if (l.b >= 0) add_force(w_, l.b, s.x_a, -f, on_b);
    };
    if (l.length > 0) {
      push(S(1.0 / l.length) * s.D);
    } else if (row_of_loop < l.n_points) {
      push(s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(row_of_loop)])]);
    } else {
      const auto [i, j] = l.axes[static_cast<std::size_t>(row_of_loop - l.n_points)];
      const Angular c = cross(s.a[static_cast<std::size_t>(i)], s.b[static_cast<std::size_t>(j)]);
      if (l.a >= 0) add_couple(w_, l.a, c, on_a);
      if (l.b >= 0) add_couple(w_, l.b, Angular(-c), on_b);
    }
  }

  const LoopModel<Space>& model() const { return model_; }

 private:
  struct At {
    Vector x_a, x_b, D, u_a, u_b;
    Angular w_a{}, w_b{};
    std::array<Vector, 3> a, b;
  };

  template <class Point, class Axes, class Distance>
  void each_row(Point&& point, Axes&& axes, Distance&& distance) const {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      const At& s = at_[i];
      int row = l.row;
      if (l.length > 0) {
        distance(row, l, s);
        continue;
      }
      for (int j = 0; j < l.n_points; ++j)
        point(row++, l, s, s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
      for (int j = 0; j < l.n_axes; ++j) {
        const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
        axes(row++, l, s, s.a[static_cast<std::size_t>(x)], s.b[static_cast<std::size_t>(y)]);
      }
    }
  }

  /// Sums the rows of each loop into one force at x_A and one couple, then acts on A and, negated,
  /// on B.
  template <class Field, class Point, class Axes>
  void each_loop_wrench(const S* sigma, double factor, Field field, Point&& point, Axes&& axes,
                        bool rate) {
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const auto& l = model_.loops[i];
      const At& s = at_[i];
      Vector force{}, impulse{};
      Angular couple{};
      int row = l.row;
      if (l.length > 0) {
        const S scaled = sigma[row] * (factor / l.length);
        if (rate) {
          force = scaled * (s.u_a - s.u_b);
          impulse = scaled * s.D;
        } else {
          force = scaled * s.D;
        }
      } else {
        for (int j = 0; j < l.n_points; ++j, ++row) {
          const auto [f, w] =
              point(s, s.b[static_cast<std::size_t>(l.points[static_cast<std::size_t>(j)])]);
          const S scaled = factor * sigma[row];
          force += scaled * f;
          if (rate) impulse += scaled * w;
        }
        for (int j = 0; j < l.n_axes; ++j, ++row) {
          const auto [x, y] = l.axes[static_cast<std::size_t>(j)];
          couple += S(factor * sigma[row]) *
                    axes(s, s.a[static_cast<std::size_t>(x)], s.b[static_cast<std::size_t>(y)]);
        }
      }
      if (rate) couple += cross(s.u_a, impulse);
      if (l.a >= 0) {
        Force& on = field(w_.body[static_cast<std::size_t>(l.a)]);
        add_force(w_, l.a, s.x_a, force, on);
        add_couple(w_, l.a, couple, on);
      }
      if (l.b >= 0) {
        Force& on = field(w_.body[static_cast<std::size_t>(l.b)]);
        add_force(w_, l.b, s.x_a, Vector(-force), on);
        add_couple(w_, l.b, Angular(-couple), on);
      }
    }
  }

  const LoopModel<Space>& model_;
  Workspace<Space, S>& w_;
  std::vector<At> at_;
};

}  // namespace momenta
