#include <momenta/dae/cut/written_motion.h>

#include <cmath>
#include <numbers>
#include <set>

namespace momenta {
namespace {

/// The part of a joint that moves a coordinate; −1: none.
int part_of(const Tree& tree, const std::string& joint, int coordinate) {
  const int last = tree.carried_by(joint);
  for (int k = last; k >= 0 && k >= tree.first_part(last); --k)
    if (tree.bodies[static_cast<std::size_t>(k)].coordinate == coordinate) return k;
  return -1;
}

}  // namespace

WrittenMotion::WrittenMotion(const Mechanism& written, const Start& start, const Mechanism& swept)
    : last_t_(start.t),
      last_q_(start.q),
      last_u_(start.u),
      at_rest_(Eigen::VectorXd::Zero(swept.nv())) {
  std::unordered_map<std::string, const JointSpec*> swept_joints, written_joints;
  for (const JointSpec& joint : swept.scene().joints) swept_joints[joint.name] = &joint;
  for (const JointSpec& joint : written.scene().joints) written_joints[joint.name] = &joint;
  std::set<std::string> bodies;
  for (const Tree::Body& b : written.tree().bodies) {
    const JointSpec& joint = *written_joints.at(b.joint);
    const auto found = swept_joints.find(b.joint);
    const bool turned = found != swept_joints.end() && found->second->parent != joint.parent;
    if (found != swept_joints.end() && (!turned || keeps_coordinates(joint.kind))) {
      const bool places_changed = turned && joint.kind == JointKind::universal;
      const int part =
          part_of(swept.tree(), b.joint, places_changed ? 1 - b.coordinate : b.coordinate);
      const Tree::Body& from = swept.tree().bodies[static_cast<std::size_t>(part)];
      copied_q_.push_back({from.q, b.q, b.nq});
      copied_u_.push_back({from.u, b.u, b.nv});
      continue;
    }
    if (b.part == 0) cut_.push_back({joint, {}});
    cut_.back().parts.push_back({b.q, b.nq, b.u, b.nv, b.parts > 1 ? b.coordinate : 0, b.kind});
    bodies.insert({joint.parent, joint.child});
  }
  if (!cut_.empty()) bodies_ = std::make_unique<BodyMotions>(swept, bodies);
}

void WrittenMotion::read(double t, const Eigen::VectorXd& swept_q, const Eigen::VectorXd& swept_u,
                         Eigen::VectorXd& q, Eigen::VectorXd& u) {
  q.resize(last_q_.size());
  u.resize(last_u_.size());
  for (const Copied& c : copied_q_) q.segment(c.to, c.count) = swept_q.segment(c.from, c.count);
  for (const Copied& c : copied_u_) u.segment(c.to, c.count) = swept_u.segment(c.from, c.count);
  if (!bodies_) return;
  bodies_->take(t, swept_q, swept_u);
  for (const Cut& cut : cut_) {
    const JointMotion motion =
        joint_motion(cut.joint, bodies_->of(cut.joint.parent), bodies_->of(cut.joint.child));
    for (const Part& part : cut.parts) {
      take_coordinates(part, motion, q);
      for (int i = 0; i < part.nv; ++i)
        u[part.u + i] = motion.u[static_cast<std::size_t>(part.coordinate + i)];
      take_turns(part, 0.5 * (last_u_ + u), t, q);
    }
  }
  if (!q.allFinite() || !u.allFinite()) return;
  last_t_ = t;
  last_q_ = q;
  last_u_ = u;
}

void WrittenMotion::read_coordinates(double t, const Eigen::VectorXd& swept_q, Eigen::VectorXd& q) {
  q.resize(last_q_.size());
  for (const Copied& c : copied_q_) q.segment(c.to, c.count) = swept_q.segment(c.from, c.count);
  if (!bodies_) return;
  bodies_->take(t, swept_q, at_rest_);
  for (const Cut& cut : cut_) {
    const JointMotion motion =
        joint_motion(cut.joint, bodies_->of(cut.joint.parent), bodies_->of(cut.joint.child));
    for (const Part& part : cut.parts) {
      take_coordinates(part, motion, q);
      take_turns(part, last_u_, t, q);
    }
  }
}

void WrittenMotion::take_coordinates(const Part& part, const JointMotion& motion,
                                     Eigen::VectorXd& q) {
  for (int i = 0; i < part.nq; ++i)
    q[part.q + i] = motion.q[static_cast<std::size_t>(part.coordinate + i)];
}

void WrittenMotion::take_turns(const Part& part, const Eigen::VectorXd& rates, double t,
                               Eigen::VectorXd& q) const {
  if (part.nq >= 4) {
    auto quaternion = q.segment<4>(part.q + part.nq - 4);
    if (quaternion.dot(last_q_.segment<4>(part.q + part.nq - 4)) < 0) quaternion *= -1;
  } else if (part.kind == JointKind::revolute && part.nq == 1) {
    constexpr double whole = 2 * std::numbers::pi;
    const double near = last_q_[part.q] + (t - last_t_) * rates[part.u];
    q[part.q] += whole * std::round((near - q[part.q]) / whole);
  }
}

void WrittenMotion::carry(Memory& memory) {
  memory(last_t_);
  memory(last_q_.data(), static_cast<std::size_t>(last_q_.size()));
  memory(last_u_.data(), static_cast<std::size_t>(last_u_.size()));
}

}  // namespace momenta
