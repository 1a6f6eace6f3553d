#pragma once
// Bushings: a point and axes of one body held to those of another, alike in all directions. With x
// the point of the child, D = x − x_parent, u the velocity of x and ω the angular velocity of the
// child relative to the parent, and θ the rotation vector of the child's axes from their place
// without couple (its direction the axis of the turn, its length the angle, at most π),
//
//   on the child   force f = −k D − c u at x,   couple n = −k_r θ − c_r ω
//   on the parent  −f at x, −n
//   V = ½ k |D|² + ½ k_r |θ|²,   V̇ = −(f + c u)·u − (n + c_r ω)·ω
//
// The second holds because D turns with the parent and θ·θ̇ = θ·ω: θ̇ − ω is perpendicular to θ.
// Couples depend on relative motion alone, so linear and angular momentum are kept. At |θ| = π the
// couple turns over.
//
// A stop at the largest angle of a spherical joint (joint_stop.h) is the couple −F(x, ẋ) θ/|θ| on
// the child, x = |θ| − largest, ẋ = θ·ω/|θ|.
//
// θ from the quaternion (w, v) of the turn, w ≥ 0: θ = 2 v f(w), f(w) = acos w / √(1 − w²), and
//   f(x) = f(y)/y,  y = √((1 + x)/2)                    half the angle
//   f(x) = Σ a_k z^k,  z = (1 − x)/2,  a_0 = 1, a_{k+1}/a_k = (2k + 2)/(2k + 3)
// Four halvings leave z ≤ 0.0024: thirteen terms are good to 34 digits for any scalar, derivatives
// included, at θ = 0 too.

#include <momenta/core/kernel/points.h>
#include <momenta/core/scalar/dual.h>

#include <cmath>

namespace momenta {

/// acos x / √(1 − x²) for 0 ≤ x ≤ 1.
template <class S>
S angle_by_sine(S x) {
  using std::sqrt;
  constexpr int halvings = 4, terms = 13;
  S product(1.0);
  for (int i = 0; i < halvings; ++i) {
    x = sqrt(0.5 * (S(1.0) + x));
    product = product * x;
  }
  const S z = 0.5 * (S(1.0) - x);
  S sum(1.0);
  for (int k = terms; k-- > 0;) {
    const S ratio = S(2.0 * k + 2.0) / S(2.0 * k + 3.0);
    sum = S(1.0) + ratio * (z * sum);
  }
  return sum / product;
}

/// Rotation vector of a rotation matrix, |θ| ≤ π.
template <class S>
Vec3<S> rotation_vector(const Mat3<S>& r) {
  using std::sqrt;
  // Quaternion: the largest component by its square, the others by products.
  const S trace = r(0, 0) + r(1, 1) + r(2, 2);
  int largest = 3;
  for (int i = 0; i < 3; ++i)
    if (value_of(r(i, i)) > (largest == 3 ? value_of(trace) : value_of(r(largest, largest))))
      largest = i;
  Vec3<S> v;
  S w;
  if (largest == 3) {
    const S root = sqrt(S(1.0) + trace);
    const S half = S(0.5) / root;
    w = 0.5 * root;
    for (int i = 0; i < 3; ++i)
      v[i] = half * (r((i + 2) % 3, (i + 1) % 3) - r((i + 1) % 3, (i + 2) % 3));
  } else {
    const int i = largest, j = (i + 1) % 3, k = (i + 2) % 3;
    const S root = sqrt(S(1.0) + r(i, i) - r(j, j) - r(k, k));
    const S half = S(0.5) / root;
    v[i] = 0.5 * root;
    v[j] = half * (r(i, j) + r(j, i));
    v[k] = half * (r(i, k) + r(k, i));
    w = half * (r(k, j) - r(j, k));
  }
  if (value_of(w) < 0) {
    w = -w;
    for (int i = 0; i < 3; ++i) v[i] = -v[i];
  }
  return (2.0 * angle_by_sine(w)) * v;
}

/// Relative motion at a bushing, ground axes. Needs poses; rates need velocities.
template <class Space, class S>
class BushingMotion {
 public:
  using Vector = typename Space::template Vector<S>;
  using Angular = decltype(cross(Vector{}, Vector{}));
  using Bushing = typename Model<Space>::Bushing;

  BushingMotion(const Workspace<Space, S>& w, const Bushing& b)
      : w_(w),
        b_(b),
        x(point_position(w, b.child, b.at_child)),
        D(x - point_position(w, b.parent, b.at_parent)) {}

  Vector velocity() const {
    return point_velocity(w_, b_.child, x) - point_velocity(w_, b_.parent, x);
  }
  Angular spin() const { return angular_velocity(w_, b_.child) - angular_velocity(w_, b_.parent); }
  /// θ; zero in a plane, where no bushing has a rotational stiffness.
  Angular turn() const {
    Angular theta{};
    if constexpr (Space::dimension == 6) {
      if (b_.rotational_stiffness == 0 && !b_.stop.acts()) return theta;
      Mat3<S> rest, turned;  // axes of the child without couple, and now
      for (int j = 0; j < 3; ++j) {
        const Vec3<S> without = to_ground(w_, b_.parent, b_.rest_axes[static_cast<std::size_t>(j)]);
        Vec3<double> unit{};
        unit[j] = 1;
        const Vec3<S> with = to_ground(w_, b_.child, unit);
        for (int i = 0; i < 3; ++i) {
          rest(i, j) = without[i];
          turned(i, j) = with[i];
        }
      }
      Mat3<S> r;  // from the axes at rest to the turned ones, components along the former
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          r(i, j) =
              rest(0, i) * turned(0, j) + rest(1, i) * turned(1, j) + rest(2, i) * turned(2, j);
      const Vec3<S> own = rotation_vector(r);
      for (int i = 0; i < 3; ++i)
        theta[i] = rest(i, 0) * own[0] + rest(i, 1) * own[1] + rest(i, 2) * own[2];
    }
    return theta;
  }

  /// Calls with(θ/|θ|, x, ẋ) where θ is beyond the stop.
  template <class With>
  void at_stop(const Angular& theta, With&& with) const {
    if constexpr (Space::dimension == 6) {
      using std::sqrt;
      const S square = dot(theta, theta);
      const double largest = b_.stop.largest;
      if (!b_.stop.acts() || !(value_of(square) > largest * largest)) return;
      const S angle = sqrt(square);
      const Vec3<S> along = (S(1.0) / angle) * theta;
      with(along, S(angle - S(largest)), dot(along, spin()));
    }
  }

 private:
  const Workspace<Space, S>& w_;
  const Bushing& b_;

 public:
  Vector x;  ///< the point of the child
  Vector D;  ///< from the parent's point to it
};

/// Adds wrenches of bushings to body[k].T. Needs poses and velocities.
template <class Space, class S>
void add_bushings(Workspace<Space, S>& w) {
  for (const auto& b : w.model->bushings) {
    const BushingMotion<Space, S> motion(w, b);
    const bool pulls = b.stiffness != 0 || b.damping != 0;
    auto f = S(-b.stiffness) * motion.D;
    if (pulls) f = f - S(b.damping) * motion.velocity();
    auto n = S(-b.rotational_damping) * motion.spin();
    if (b.rotational_stiffness != 0 || b.stop.acts()) {
      const auto theta = motion.turn();
      n = n - S(b.rotational_stiffness) * theta;
      motion.at_stop(theta, [&](const auto& along, const S& x, const S& rate) {
        n = n - stop_push(b.stop, x, rate) * along;
      });
    }
    const auto act = [&](int k, const auto& force, const auto& couple) {
      if (k < 0) return;
      auto& T = w.body[static_cast<std::size_t>(k)].T;
      if (pulls) add_force(w, k, motion.x, force, T);
      add_couple(w, k, couple, T);
    };
    act(b.child, f, n);
    act(b.parent, decltype(f)(-f), decltype(n)(-n));
  }
}

// Products of angular quantities: vectors in space, numbers in a plane.
template <class S>
S bushing_square(const Vec3<S>& a) {
  return dot(a, a);
}
template <class S>
S bushing_square(const S& a) {
  return a * a;
}

/// ½ k |D|² + ½ k_r |θ|² of all bushings [J].
template <class Space, class S>
S bushing_energy(const Workspace<Space, S>& w) {
  S twice{};
  for (const auto& b : w.model->bushings) {
    const BushingMotion<Space, S> motion(w, b);
    twice += b.stiffness * (dot(motion.D, motion.D) + S(b.offset2));
    if (b.rotational_stiffness == 0 && !b.stop.acts()) continue;
    const auto theta = motion.turn();
    twice += b.rotational_stiffness * bushing_square(theta);
    motion.at_stop(
        theta, [&](const auto&, const S& x, const S&) { twice += 2.0 * stop_energy(b.stop, x); });
  }
  return 0.5 * twice;
}

/// −c |u|² − c_r |ω|² of all bushings, less the loss of dampers of stops [W].
template <class Space, class S>
S bushing_power(const Workspace<Space, S>& w) {
  S power{};
  for (const auto& b : w.model->bushings) {
    const BushingMotion<Space, S> motion(w, b);
    const auto u = motion.velocity();
    power -= b.damping * dot(u, u) + b.rotational_damping * bushing_square(motion.spin());
    if (!b.stop.acts()) continue;
    JointStop damper = b.stop;
    damper.stiffness = 0;
    motion.at_stop(motion.turn(), [&](const auto&, const S& x, const S& rate) {
      power -= stop_push(damper, x, rate) * rate;
    });
  }
  return power;
}

}  // namespace momenta
