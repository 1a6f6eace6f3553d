#pragma once
// One flat array of everything a sweep computes, body by body in depth-first order. Sized once; no
// sweep allocates.

#include <momenta/core/kernel/model.h>

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
    typename Space::template Pose<S> pose;  ///< in ground axes; only where loops or forces need it
    S drive{}, drive_rate{}, drive_acceleration{};  ///< prescribed joint motion
    // velocities_outward, rates_outward
    Motion V;  ///< Ω_K
    Motion A;  ///< dΩ_K/dt: derivative in body axes; in the plane, of ground components
    Vector g;  ///< gravity in body axes
    // articulated_masses_inward
    Inertia M;      ///< M*_K, eq. (43)
    Force h;        ///< M*E M_j⁻¹ of a one-dof joint; M*E of a driven one
    int wide = -1;  ///< index into `wide` of a spherical or free joint
    // remainders_inward
    Force D;    ///< eqs. (44), (48)
    S e{};      ///< p_K − Eᵀ D of a one-dof joint
    S pivot{};  ///< M_j⁻¹ of a one-dof joint, eq. (46)
    // momenta_inward, wrenches
    Force P;    ///< P*_K, eq. (26)
    Force T;    ///< T*_K, eq. (27)
    Vector mc;  ///< first moment of the subtree about O_K
  };
  /// Pivots of spherical and free joints: M_j⁻¹ by blocks, ω after v.
  struct Wide {
    Mat3<S> h;     ///< H I⁻¹
    Sym3<S> I;     ///< I⁻¹
    Sym3<S> A;     ///< free: (A − H I⁻¹ Hᵀ)⁻¹
    Vec3<S> x, y;  ///< I⁻¹ e_ω; free: e_v − h e_ω
  };

  explicit Workspace(const Model<Space>& m) : model(&m), body(m.bodies.size()) {
    for (std::size_t k = 0; k < body.size(); ++k)
      if (m.bodies[k].nv > 1) {
        body[k].wide = static_cast<int>(wide.size());
        wide.emplace_back();
      }
  }

  const Model<Space>* model;
  std::vector<Body> body;
  std::vector<Wide> wide;
  int singular =
      -1;  ///< joint whose M_j was not positive at the last articulated_masses_inward, or −1

  /// The rigid inertia of body k in the axes the sweeps work in.
  const auto& inertia(std::size_t k) const {
    if constexpr (Space::dimension == 3)
      return body[k].inertia;
    else
      return model->bodies[k].inertia;
  }
};

}  // namespace momenta
