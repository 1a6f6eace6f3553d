#pragma once
// A user joint in a scene: number and units of its coordinates, and its pose. The recursions take
// derivatives of the same formula (core/kernel/user_motion.h).

namespace momenta {

/// The formula of a user joint, immutable; made as a UserJoint (core/open_chain/user_joint.h).
class JointFormula {
 public:
  virtual ~JointFormula() = default;

  /// n, from 1 to 6.
  virtual int coordinates() const = 0;

  /// Whether coordinate i is a length [m]; else it is an angle [rad].
  virtual bool is_length(int i) const = 0;

  /// The pose of the child's joint frame in the parent's at (t, q): the rotation, nine numbers by
  /// columns, and the position, three numbers.
  virtual void pose(double t, const double* q, double* rotation, double* position) const = 0;

 private:
  friend class UserFormula;  // the recursions cast every formula to it
  JointFormula() = default;
  JointFormula(const JointFormula&) = default;
  JointFormula& operator=(const JointFormula&) = default;
};

}  // namespace momenta
