#pragma once
// The bearings of a mechanism's joints: the forces that press their surfaces together, and the
// friction of these (docs/theory/friction.md). From F_K, the wrench of joint K on its child about
// the joint's point O_K, with a the joint's axis:
//
//   one bearing                   f₁ = F_⊥,  f₂ = 0
//   two, the length ℓ apart       f₁ = F_⊥/2 + M × a/ℓ,  f₂ = F_⊥/2 − M × a/ℓ
//                                 (f₁ + f₂ = F_⊥ and ℓ/2 a × (f₁ − f₂) = M_⊥)
//   N = |f₁| + |f₂|,   τ = −r μ(r u) N,   of a prismatic joint with r = 1
//
// The force along a pin's axis and the moment about a slide's are carried elsewhere, without
// friction. Where a force is zero |f| has no slope, and zero is taken for it.

#include <momenta/core/expression/functions.h>
#include <momenta/core/kernel/points.h>
#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/scene.h>

#include <array>
#include <cmath>
#include <vector>

namespace momenta {

/// μ(v), BearingSpec.
template <class S>
S friction_coefficient(const BearingSpec& bearing, const S& v) {
  const S x = (1 / bearing.transition_velocity) * v;
  const S width = S(0.75) + 0.25 * (x * x);
  return bearing.dynamic_friction * formula::function(formula::Operation::tanh, S(4.0 * x)) +
         (bearing.static_friction - bearing.dynamic_friction) * (x / (width * width));
}

template <class Space>
class Bearings {
 public:
  /// f₁ and f₂, each by its two components across the axis.
  template <class S>
  using Pressed = std::array<S, 4>;

  Bearings(const Scene& scene, const Tree& tree) {
    for (const JointSpec& joint : scene.joints)
      if (joint.bearing) {
        const int k = tree.part_of(joint.name, 0);
        all_.push_back({k, tree.bodies[static_cast<std::size_t>(k)].u,
                        joint.kind == JointKind::revolute ? joint.bearing->radius : 1.0,
                        *joint.bearing});
      }
  }

  bool empty() const { return all_.empty(); }

  /// Adds r μ(r u) N to the joints' residuals `tau` (nv); body[k].P holds F_K.
  template <class S>
  void add_friction(const Workspace<Space, S>& w, const S* u, S* tau) const {
    for (const Bearing& b : all_) {
      const Pressed<S> f = pressed(w, b);
      const S load = size(f[0], f[1]) + size(f[2], f[3]);
      tau[b.u] += b.arm * (friction_coefficient(b.spec, S(b.arm * u[b.u])) * load);
    }
  }

  /// f₁ and f₂ of each, four numbers, in the order of the scene.
  void loads(const Workspace<Space, double>& w, double* forces) const {
    for (const Bearing& b : all_)
      for (const double x : pressed(w, b)) *forces++ = x;
  }

 private:
  struct Bearing {
    int body, u;
    double arm;  ///< r, or 1
    BearingSpec spec;
  };

  /// |(x, y)|; as a sum of both where it is zero, so that patterns of derivatives hold.
  template <class S>
  static S size(const S& x, const S& y) {
    using std::sqrt;
    const S square = x * x + y * y;
    return value_of(square) > 0 ? S(sqrt(square)) : S(0.0 * (x + y));
  }

  template <class S>
  static Pressed<S> pressed(const Workspace<Space, S>& w, const Bearing& b) {
    const auto k = static_cast<std::size_t>(b.body);
    const auto& F = w.body[k].P;
    // O_K in the model's frame, whose origin may lie elsewhere on the axis.
    const auto arm = from_ground(
        w, b.body, to_ground(w, b.body, w.model->point(b.body, Eigen::Vector3d::Zero())));
    auto M = F.n;
    M -= cross(arm, F.f);
    std::array<S, 2> across, turned{};  // F_⊥, M × a
    if constexpr (Space::dimension == 3) {
      if (w.model->bodies[k].kind == JointKind::prismatic) {
        across = {cross(w.body[k].edge.prismatic, F.f), S(0.0)};
        turned = {M, S(0.0)};
      } else {
        across = {F.f[0], F.f[1]};
      }
    } else {
      across = {F.f[0], F.f[1]};
      turned = {M[1], -M[0]};
    }
    if (b.spec.length == 0) return {across[0], across[1], S(0.0), S(0.0)};
    Pressed<S> f;
    for (std::size_t i = 0; i < 2; ++i) {
      f[i] = 0.5 * across[i] + (1 / b.spec.length) * turned[i];
      f[2 + i] = 0.5 * across[i] - (1 / b.spec.length) * turned[i];
    }
    return f;
  }

  std::vector<Bearing> all_;
};

}  // namespace momenta
