#pragma once
// All bodies as one. With R_K, r_K the pose of body K's frame, m_K, c_K its mass and centre of mass
// and (p_l, p_a) = M_K Ω_K its own momentum about O_K, eq. (11),
//
//   m = Σ m_K             m c = Σ m_K (r_K + R_K c_K)
//   L = Σ R_K p_l         H = Σ (R_K p_a + r_K × R_K p_l)     about the ground's origin
//
// Ω has the prescribed motion in it (23), so L = d/dt (m c) whatever drives do.

#include <momenta/core/kernel/points.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/open_chain/centroidal.h>

namespace momenta {

template <class S>
struct CentroidalSums {
  double mass = 0;
  Vec3<S> moment, linear, angular;  ///< m c, L, H; ground axes
};

/// The sums at (t, q, u): two outward sweeps, O(bodies).
template <class S>
CentroidalSums<S> centroidal_sums(Workspace<Spatial, S>& w, const S& t, const S* q, const S* u) {
  poses_outward(w, t, q, true);
  velocities_outward(w, u);
  CentroidalSums<S> all;
  for (std::size_t k = 0; k < w.body.size(); ++k) {
    const int body = static_cast<int>(k);
    const auto& inertia = w.inertia(k);
    const auto momentum = Spatial::momentum(inertia, w.body[k].V);
    const Vec3<S> at = origin(w, body), linear = to_ground(w, body, momentum.f);
    all.mass += inertia.m;
    all.moment += S(inertia.m) * at + to_ground(w, body, inertia.mc);
    all.linear += linear;
    all.angular += to_ground(w, body, momentum.n) + cross(at, linear);
  }
  return all;
}

inline Centroidal centroidal_of(const CentroidalSums<double>& sums) {
  const auto eigen = [](const Vec3<double>& v) { return Eigen::Vector3d(v[0], v[1], v[2]); };
  return {sums.mass, eigen(sums.moment) / sums.mass, eigen(sums.linear), eigen(sums.angular)};
}

}  // namespace momenta
