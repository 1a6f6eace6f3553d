#pragma once
// Coordinates and rates of the scene as written, from those of the scene that is swept. A joint
// that is one in both scenes has the same numbers there, in other places. A joint that was cut has
// those of the motion of its two bodies (relative_motion.h); what its equations leave open, the
// drift of the swept scene, then shows at the loops of the scene as written. Angles are known but
// for whole turns: of them that one is taken which is nearest to
//
//   q(t₀) + (t − t₀) (u(t₀) + u(t)) / 2
//
// with t₀ the time before at which rates were read; of unit quaternions the sign nearest to the one
// before.

#include <momenta/dae/cut/body_motions.h>
#include <momenta/dae/solver/memory.h>

#include <memory>
#include <vector>

namespace momenta {

/// One object serves one thread and one run.
class WrittenMotion {
 public:
  /// `start` of the mechanism as written, from which angles are counted. The mechanisms need not
  /// outlive it.
  WrittenMotion(const Mechanism& written, const Start& start, const Mechanism& swept);

  /// q (nq), u (nv) of the scene as written, from those of the swept scene. O(bodies)
  void read(double t, const Eigen::VectorXd& swept_q, const Eigen::VectorXd& swept_u,
            Eigen::VectorXd& q, Eigen::VectorXd& u);
  /// q alone.
  void read_coordinates(double t, const Eigen::VectorXd& swept_q, Eigen::VectorXd& q);
  /// The time before.
  void carry(Memory& memory);

 private:
  struct Copied {
    int from, to, count;
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
  static void take_coordinates(const Part& part, const JointMotion& motion, Eigen::VectorXd& q);
  /// Whole turns and signs; `rates`: by which q changed since the time before.
  void take_turns(const Part& part, const Eigen::VectorXd& rates, double t,
                  Eigen::VectorXd& q) const;

  std::vector<Copied> copied_q_, copied_u_;
  std::vector<Cut> cut_;
  std::unique_ptr<BodyMotions> bodies_;  ///< null: no joint was cut
  double last_t_;
  Eigen::VectorXd last_q_, last_u_;
  Eigen::VectorXd at_rest_;  ///< rates of the swept scene, all zero
};

}  // namespace momenta
