#pragma once
// Springs and wrenches at points of planar bodies, from angles, ways and velocities that a sweep
// has at hand: no sine is taken twice.

#include <momenta/core/kernel/forces.h>
#include <momenta/core/kernel/planar_joint.h>

#include <cmath>

namespace momenta {

template <class S>
class PlanarBodyForces {
 public:
  explicit PlanarBodyForces(const PlanarTree& tree) : w_(*tree.model) {
    for (const ForcedBody& at : w_.forced) {
      const double turn = tree.frame_turn[static_cast<std::size_t>(at.body)];
      turns_.push_back({{std::cos(turn), std::sin(turn)}});
    }
  }

  /// State of a body in a sweep: frame of its link, O_K − O_L and Ω, in ground axes.
  struct Known {
    S cosine, sine, rx, ry, vx, vy, omega;
  };
  /// The wrenches T_K of (17), weights left out, from known(k) of every body under forces and of
  /// those below it. O(these bodies and their springs).
  template <class Sweep>
  void gather(Sweep&& known) {
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const auto k = static_cast<std::size_t>(w_.forced[i].body);
      const Known x = known(k);
      const double c = turns_[i][0], s = turns_[i][1];
      auto& body = w_.body[k];
      // The model's frame, in which points are given, is turned back from the link's by turns_.
      body.pose.c = c * x.cosine + s * x.sine;
      body.pose.s = c * x.sine - s * x.cosine;
      body.pose.origin = origin(w_, w_.model->bodies[k].parent) + Vec2<S>{{x.rx, x.ry}};
      body.V = {{{x.vx, x.vy}}, x.omega};
      body.T = {};
    }
    add_body_forces(w_);
  }
  /// T_K about O_K, ground axes; for bodies under forces.
  const Planar::Force<S>& on(std::size_t k) const { return w_.body[k].T; }

 private:
  Workspace<Planar, S> w_;
  std::vector<Vec2<double>> turns_;  ///< cosine and sine, in the order of w_.forced
};

}  // namespace momenta
