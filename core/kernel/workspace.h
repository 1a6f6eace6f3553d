#pragma once
// Results of all sweeps in one flat array, body by body in depth-first order. Sized once; no sweep
// allocates.

#include <momenta/core/kernel/forced_bodies.h>
#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/user_motion.h>

#include <algorithm>
#include <vector>

namespace momenta {

template <class Space, class S>
struct Workspace {
  using Motion = typename Space::template Motion<S>;
  using Force = typename Space::template Force<S>;
  using Vector = typename Space::template Vector<S>;
  using Inertia = typename Space::template ArticulatedInertia<S>;

  struct Body {
    // poses_outward
    typename Space::template Edge<S> edge;  ///< way from the parent at this configuration
    typename Space::template RigidInertia<S> inertia;  ///< planar only: turned to ground axes
    typename Space::template Pose<S> pose;             ///< ground axes; only for loops or forces
    Vector step;  ///< in space, with poses: from the parent's O to its own, ground axes
    S drive{}, drive_rate{}, drive_acceleration{};  ///< prescribed joint motion
    // velocities_outward, accelerations_outward
    Motion V;                                ///< Ω_K
    Vec3<S> rotor_rate, rotor_acceleration;  ///< u and u̇ of a joint with a rotor
    Motion A;  ///< dΩ_K/dt: derivative in body axes; in the plane, of ground components
    Vector g;  ///< gravity in body axes
    // composite_inertias_inward
    Inertia M;  ///< composite inertia of the subtree: mass_matrix_inward
    // momenta_inward, wrenches
    Force P;  ///< P*_K, eq. (26)
    Force T;  ///< T*_K, eq. (27)
  };
  /// State of a joint under a coordinate spring or signal.
  struct Sprung {
    S coordinate{}, rate{};
  };
  explicit Workspace(const Model<Space>& m)
      : model(&m),
        body(m.bodies.size()),
        generalised(static_cast<std::size_t>(m.nv)),
        sprung(static_cast<std::size_t>(m.sprung)),
        users(m.laws.size()),
        formulas(room_of(m)),
        forced(forced_bodies(m)) {}

  const Model<Space>* model;
  std::vector<Body> body;
  std::vector<S> generalised;        ///< scratch, nv: generalised forces
  std::vector<Sprung> sprung;        ///< poses_outward, velocities_outward
  std::vector<UserMotion<S>> users;  ///< motions of user joints, pointed to by edges
  mutable std::vector<S> formulas;   ///< scratch of formula_force.h
  std::vector<ForcedBody> forced;    ///< bodies placed by body_force_rates()
  S time{};                          ///< poses_outward

  /// The rigid inertia of body k in the axes the sweeps work in.
  const auto& inertia(std::size_t k) const {
    if constexpr (Space::dimension == 3)
      return body[k].inertia;
    else
      return model->bodies[k].inertia;
  }

 private:
  /// Room for the longest formula: variables, values, tape.
  static std::size_t room_of(const Model<Space>& m) {
    std::size_t most = 0;
    for (const auto& force : m.formula_forces)
      most = std::max(
          most, force.inputs.size() + force.formula.outputs().size() + force.formula.tape().size());
    return most;
  }
};

/// Right-hand sides X during a solve with M by the recursion: M_j⁻¹ e of revolute joints, and D
/// inward and Ω outward at bodies with several children.
template <class Space, class X>
struct MassSolution {
  template <class Tree>
  explicit MassSolution(const Tree& tree)
      : y0(tree.links.size()),
        inward(static_cast<std::size_t>(tree.slots)),
        outward(static_cast<std::size_t>(tree.slots)) {}
  std::vector<X> y0;
  std::vector<typename Space::template Force<X>> inward;
  std::vector<typename Space::template Motion<X>> outward;
};

}  // namespace momenta
