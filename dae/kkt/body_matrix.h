#pragma once
// (7) with the bodies' velocities and momenta kept as unknowns, nothing eliminated:
//
//   (  M   0  −𝒦ᵀ  Jᵀ ) ( Ω  )   ( 0 )     M_k Ω_k + J_kᵀσ + Σ_children 𝒯ᶠ_c P*_c = P*_k    (26)
//   (  0   I_r Eᵀ  Rᵀ ) ( u  ) = ( r )     E_kᵀ P*_k + I_r u_k + (R σ)_k = r_k                (34)
//   ( −𝒦   E   0   0  ) ( P* )   ( 0 )     Ω_k = 𝒯ⱽ_k Ω_parent + E_k u_k                      (23)
//   (  J   R   0   −ε ) ( σ  )   ( g )     Σ J_k Ω_k + R u = g
//
// 𝒦 = 1 − 𝒯ⱽ, R the ratios of couplers. Eliminating P*, Ω leaves (7). A row of Φ stands at its two
// bodies alone, whatever the way between them, so the number of entries is O(bodies + loops), where
// M and Φ_q of a deep tree have Σ depth. In the axes of the sweeps: of the bodies in space, of the
// ground in the plane.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/kkt/factor/body_fronts.h>
#include <momenta/dae/mechanism/loop/loop_rows.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <vector>

namespace momenta {

template <class Space>
class BodyMatrix {
 public:
  static constexpr int d = Space::dimension;

  BodyMatrix(const Mechanism& mechanism, Model<Space> model)
      : model_(std::move(model)),
        loop_model_(build_loops(mechanism.scene(), mechanism.tree(), model_)),
        w_(model_),
        rows_(loop_model_, w_) {
    place(0, mechanism.tree().q0.data());
    each_entry([&](int i, int j, double) { entries_.push_back({i, j}); });
  }
  BodyMatrix(const BodyMatrix&) = delete;
  BodyMatrix& operator=(const BodyMatrix&) = delete;

  /// Structural nonzeros, one of each symmetric pair.
  const std::vector<KktPattern::Entry>& entries() const { return entries_; }
  int size() const { return impulse(loop_model_.rows); }
  /// Tree of the bodies, for BodyFronts.
  BodyFronts::Bodies tree() const {
    BodyFronts::Bodies tree;
    tree.d = d;
    tree.nv = model_.nv;
    for (const auto& b : model_.bodies) {
      tree.parent.push_back(b.parent);
      tree.rate.push_back(b.u);
      tree.rates.push_back(b.nv);
    }
    return tree;
  }
  /// Places of u_j and σ_i.
  int rate(int j) const { return 2 * d * bodies() + j; }
  int impulse(int i) const { return rate(model_.nv) + i; }
  /// Place in u of an unknown's joint; −1: it has none of its own.
  int joint_of(int unknown) const {
    if (unknown >= rate(0)) return unknown < impulse(0) ? unknown - rate(0) : -1;
    const auto& b = model_.bodies[static_cast<std::size_t>(unknown / d % bodies())];
    return b.nv > 0 ? b.u : -1;
  }

  void place(double t, const double* q) {
    poses_outward(w_, t, q, true);
    rows_.place(t, q);
  }
  /// Calls entry(i, j, value) in the order of entries(). O(entries). After place().
  template <class Entry>
  void each_entry(Entry&& entry) const {
    for (int k = 0; k < bodies(); ++k) of_body(k, entry);
    for (std::size_t l = 0; l < loop_model_.loops.size(); ++l) {
      const auto& loop = loop_model_.loops[l];
      for (const auto& c : loop.joints) entry(impulse(loop.row), rate(c.u), rows_.ratio(c));
      rows_.each_point_wrench(loop, [&](int k, const auto& f) {
        for (int c = 0; c < d; ++c) entry(impulse(loop.row), velocity(k, c), f[c]);
      });
      for (int i = 0; i < loop.rows && !loop.is_coupler(); ++i) {
        typename Space::template Force<double> on_a{}, on_b{};
        rows_.unit_wrench(l, i, on_a, on_b);
        // rows of axes act on ω alone
        const int first = i < loop.first_rows() ? 0 : d - (d == 3 ? 1 : 3);
        for (int c = first; c < d; ++c) {
          if (loop.a >= 0) entry(impulse(loop.row + i), velocity(loop.a, c), on_a[c]);
          if (loop.b >= 0) entry(impulse(loop.row + i), velocity(loop.b, c), on_b[c]);
        }
      }
    }
  }

 private:
  int bodies() const { return static_cast<int>(model_.bodies.size()); }
  int velocity(int k, int c) const { return d * k + c; }
  int momentum(int k, int c) const { return d * (bodies() + k) + c; }

  template <class Entry>
  void of_body(int k, Entry&& entry) const {
    const auto at = static_cast<std::size_t>(k);
    const auto& b = model_.bodies[at];
    const auto& edge = w_.body[at].edge;
    const auto& inertia = w_.inertia(at);
    if constexpr (d == 3) {
      entry(velocity(k, 0), velocity(k, 0), inertia.m);
      entry(velocity(k, 1), velocity(k, 1), inertia.m);
      entry(velocity(k, 2), velocity(k, 0), -inertia.mc[1]);
      entry(velocity(k, 2), velocity(k, 1), inertia.mc[0]);
      entry(velocity(k, 2), velocity(k, 2), inertia.J);
    } else {
      for (int c = 0; c < 3; ++c) {
        entry(velocity(k, c), velocity(k, c), inertia.m);
        for (int e = 0; e <= c; ++e) entry(velocity(k, 3 + c), velocity(k, 3 + e), inertia.J(c, e));
      }
      // p_a = mc × v: rows of the cross product
      entry(velocity(k, 3), velocity(k, 1), -inertia.mc[2]);
      entry(velocity(k, 3), velocity(k, 2), inertia.mc[1]);
      entry(velocity(k, 4), velocity(k, 0), inertia.mc[2]);
      entry(velocity(k, 4), velocity(k, 2), -inertia.mc[0]);
      entry(velocity(k, 5), velocity(k, 0), -inertia.mc[1]);
      entry(velocity(k, 5), velocity(k, 1), inertia.mc[0]);
    }
    for (int c = 0; c < d; ++c) entry(momentum(k, c), velocity(k, c), -1.0);
    if (b.parent >= 0)
      for (int c = 0; c < d; ++c) {
        typename Space::template Motion<double> unit{};
        unit[c] = 1;
        const auto carried = Space::to_child(b.edge, b.kind, edge, unit);
        for (int e = 0; e < d; ++e)
          if (reaches(e, c)) entry(momentum(k, e), velocity(b.parent, c), carried[e]);
      }
    for (int j = 0; b.has_rotor() && j < b.nv; ++j) entry(rate(b.u + j), rate(b.u + j), b.rotor);
    for (int j = 0; j < b.nv; ++j) {
      double one[6] = {};
      one[j] = 1;
      typename Space::template Motion<double> along{};
      Joint<Space>::add_motion(b, edge, one, along);
      for (int c = 0; c < d; ++c)
        if (moves(b.kind, j, c)) entry(momentum(k, c), rate(b.u + j), along[c]);
    }
  }
  /// Whether component e of 𝒯ⱽ Ω may hang on component c of Ω: in the plane nothing is turned.
  static bool reaches(int e, int c) {
    if constexpr (d == 3)
      return e == c || c == 2;
    else
      return e < 3 || c >= 3;
  }
  /// Whether column j of E may have component c.
  static bool moves(JointKind kind, int j, int c) {
    switch (kind) {
      case JointKind::revolute:
        return c == d - 1;
      case JointKind::prismatic:
        return d == 3 ? c < 2 : c == 2;
      case JointKind::helical:
        return c == 2 || c == 5;
      case JointKind::spherical:
        return c == 3 + j;
      case JointKind::user:
        return true;
      default:
        return c == j;  // free
    }
  }

  Model<Space> model_;
  LoopModel<Space> loop_model_;
  Workspace<Space, double> w_;
  LoopRows<Space, double> rows_;
  std::vector<KktPattern::Entry> entries_;
};

/// Calls f with the mechanism's BodyMatrix as a unique_ptr.
template <class F>
auto with_body_matrix(const Mechanism& mechanism, F&& f) {
  const auto& plan = mechanism.plan();
  if (plan.planar)
    return f(std::make_unique<BodyMatrix<Planar>>(
        mechanism, build_planar_model(mechanism.tree(), mechanism.scene(), plan.basis)));
  return f(std::make_unique<BodyMatrix<Spatial>>(
      mechanism, build_spatial_model(mechanism.tree(), mechanism.scene())));
}

// The blocks of (7) as whole matrices, for what asks for all of them at once: singular values,
// ranks, users. After place() of the evaluation; O(n²) memory.

/// M, nv × nv.
Eigen::MatrixXd dense_mass(const Mechanism& mechanism, Evaluation<double>& e);
/// Φ_q, m × nv.
Eigen::MatrixXd dense_constraints(const Mechanism& mechanism, Evaluation<double>& e);

}  // namespace momenta
