#pragma once
// Coordinates and rates of the scene as written, from those of the scene that is integrated. A
// joint that is one in both scenes has the same numbers there, in other places. A joint that was
// cut has those of the motion of its two bodies (relative_motion.h), and one that was folded away
// those of the joint it follows (folded_scene.h); what its equations leave open then shows at
// the loops of the scene as written. Angles are known but for whole turns: of them that one is
// taken which is nearest to
//
//   q(t₀) + (t − t₀) (u(t₀) + u(t)) / 2
//
// with t₀ the time before at which rates were read; of unit quaternions the sign nearest to the one
// before.

#include <momenta/core/scene/drive.h>
#include <momenta/dae/integrator/memory.h>
#include <momenta/dae/topology/cut/folded_scene.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <memory>
#include <optional>
#include <vector>

namespace momenta {

/// One object serves one thread and one run.
class OriginalSceneMotion {
 public:
  /// `start` of the mechanism as written, from which angles are counted. `folded`: its scene, with
  /// the joints as they were before others were cut. None of these need outlive it.
  OriginalSceneMotion(const Mechanism& written, const Start& start, const FoldedScene& folded,
                      const Mechanism& integrated);

  /// q (nq), u (nv) of the scene as written, from those of the integrated scene. O(bodies)
  void read(double t, const Eigen::VectorXd& integrated_q, const Eigen::VectorXd& integrated_u,
            Eigen::VectorXd& q, Eigen::VectorXd& u);
  void read_coordinates(double t, const Eigen::VectorXd& integrated_q, Eigen::VectorXd& q);
  /// The last reading: t, q and u.
  void carry(Memory& memory);

 private:
  struct Copied {
    int from, to, count;
  };
  /// q = ratio q' + offset, of a joint that may be driven.
  struct Following {
    int q, u, leader_q, leader_u;
    double ratio, offset;
    std::optional<MotionLaw> drive;
  };
  /// A part of a joint, with its places in q and u and in JointMotion.
  struct Part {
    int q, nq, u, nv, coordinate;
    JointKind kind;
  };
  struct Cut {
    JointSpec joint;
    std::vector<Part> parts;
  };
  /// Sets all q, and rates of joints cut or folded away. @pre bodies are placed at t
  void take_all(double t, const Eigen::VectorXd& integrated_q, Eigen::VectorXd* u,
                Eigen::VectorXd& q) const;
  /// Sets q and, unless null, u of joints folded away.
  void follow(double t, Eigen::VectorXd& q, Eigen::VectorXd* u) const;
  /// Chooses whole turns and signs; `rate`: mean rate of an angle since the last reading.
  void take_turns(const Part& part, double t, double rate, Eigen::VectorXd& q) const;

  std::vector<Copied> copied_q_, copied_u_;
  std::vector<Cut> cut_;
  std::vector<Following> following_;
  std::unique_ptr<BodyMotions> bodies_;  ///< null: no joint was cut
  double last_t_;
  Eigen::VectorXd last_q_, last_u_;
  Eigen::VectorXd at_rest_;  ///< rates of the integrated scene, all zero
};

}  // namespace momenta
