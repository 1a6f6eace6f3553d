#pragma once
// Mass on the axis of a revolute joint moves with the parent as well as with the child. All the
// mass the joint carries, taken at O, and c_z and Σ_zz of its body are therefore given to the
// parent once and for all, which saves m a and their cost. A spherical joint gives all its mass, at
// O. Torques stay: mass given away has no moment about the joint.
//   parent:  c += m r + c_z z,  Σ += m r rᵀ + c_z (r zᵀ + z rᵀ) + Σ_zz z zᵀ

#include <momenta/core/kernel/revolute.h>

#include <vector>

namespace momenta {

/// c and Σ (xx xy xz yy yz zz) about O of a body with the mass given to it over revolute and
/// spherical joints.
template <class S>
struct MassMoments {
  double c[3]{}, s[6]{};
};

template <class S>
std::vector<MassMoments<S>> regrouped(const LinkTree& tree) {
  std::vector<MassMoments<S>> all(tree.links.size());
  for (std::size_t k = all.size(); k-- > 0;) {
    const Link& l = tree.links[k];
    const auto& b = tree.model->bodies[k];
    MassMoments<S>& own = all[k];
    const double half_trace = 0.5 * (l.J[0] + l.J[3] + l.J[5]);
    for (int i = 0; i < 3; ++i) own.c[i] += l.c[i];
    for (int i = 0; i < 6; ++i) own.s[i] += (i == 0 || i == 3 || i == 5 ? half_trace : 0) - l.J[i];
    if (l.kind == LinkKind::general) continue;
    double given[2] = {0, 0};
    if (l.kind == LinkKind::revolute) {
      given[0] = own.c[2];
      given[1] = own.s[5];
      own.c[2] = own.s[5] = 0;
    }
    if (l.parent < 0) continue;
    MassMoments<S>& parent = all[static_cast<std::size_t>(l.parent)];
    Spatial::Pose<S> at;
    at.axes = identity3<S>();
    Spatial::Edge<S> e;
    e.d = S(b.d0);
    at = Spatial::pose_outward(b.edge, JointKind::weld, e, at);
    double r[3], z[3];
    for (int i = 0; i < 3; ++i) {
      r[i] = value_of(at.origin[i]);
      z[i] = value_of(at.axes(i, 2));
    }
    for (int i = 0, entry = 0; i < 3; ++i) {
      parent.c[i] += b.subtree_mass * r[i] + given[0] * z[i];
      for (int j = i; j < 3; ++j)
        parent.s[entry++] += b.subtree_mass * r[i] * r[j] + given[0] * (r[i] * z[j] + z[i] * r[j]) +
                             given[1] * z[i] * z[j];
    }
  }
  return all;
}

}  // namespace momenta
