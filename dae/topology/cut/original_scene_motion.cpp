#include <momenta/dae/topology/cut/original_scene_motion.h>
#include <momenta/dae/topology/cut/relative_motion.h>

#include <cmath>
#include <numbers>
#include <set>

namespace momenta {
namespace {

/// The part of a joint that moves a coordinate.
const Tree::Body& part(const Tree& tree, const std::string& joint, int coordinate) {
  return tree.bodies[static_cast<std::size_t>(tree.part_of(joint, coordinate))];
}

}  // namespace

OriginalSceneMotion::OriginalSceneMotion(const Mechanism& written, const Start& start,
                                         const FoldedScene& folded, const Mechanism& integrated)
    : last_t_(start.t),
      last_q_(start.q),
      last_u_(start.u),
      at_rest_(Eigen::VectorXd::Zero(integrated.nv())) {
  std::unordered_map<std::string, const JointSpec*> in_integrated, in_folded;
  for (const JointSpec& joint : integrated.scene().joints) in_integrated[joint.name] = &joint;
  for (const JointSpec& joint : folded.scene.joints) in_folded[joint.name] = &joint;
  std::set<std::string> bodies;
  for (const Tree::Body& b : written.tree().bodies) {
    const auto before = in_folded.find(b.joint);
    if (before == in_folded.end()) continue;  // folded away: a weld, or it follows another
    const JointSpec& joint = *before->second;
    const auto found = in_integrated.find(b.joint);
    const bool turned = found != in_integrated.end() && found->second->parent != joint.parent;
    if (found != in_integrated.end() && (!turned || keeps_coordinates(joint.kind))) {
      const bool places_changed = turned && joint.kind == JointKind::universal;
      const Tree::Body& from =
          part(integrated.tree(), b.joint, places_changed ? 1 - b.coordinate : b.coordinate);
      copied_q_.push_back({from.q, b.q, b.nq});
      copied_u_.push_back({from.u, b.u, b.nv});
      continue;
    }
    if (b.part == 0) cut_.push_back({joint, {}});
    cut_.back().parts.push_back({b.q, b.nq, b.u, b.nv, b.parts > 1 ? b.coordinate : 0, b.kind});
    bodies.insert({joint.parent, joint.child});
  }
  for (const FollowingJoint& f : folded.following) {
    const Tree::Body &own = part(written.tree(), f.joint, 0),
                     &leader = part(written.tree(), f.leader, f.coordinate);
    following_.push_back({own.q, own.u, leader.q, leader.u, f.ratio, f.offset, {}});
    if (leader.drive >= 0)
      following_.back().drive = written.tree().drives[static_cast<std::size_t>(leader.drive)];
  }
  if (!cut_.empty()) bodies_ = std::make_unique<BodyMotions>(integrated, bodies);
}

void OriginalSceneMotion::read(double t, const Eigen::VectorXd& integrated_q,
                               const Eigen::VectorXd& integrated_u, Eigen::VectorXd& q,
                               Eigen::VectorXd& u) {
  u.resize(last_u_.size());
  for (const Copied& c : copied_u_)
    u.segment(c.to, c.count) = integrated_u.segment(c.from, c.count);
  if (bodies_) bodies_->take(t, integrated_q, integrated_u);
  take_all(t, integrated_q, &u, q);
  if (!q.allFinite() || !u.allFinite()) return;
  last_t_ = t;
  last_q_ = q;
  last_u_ = u;
}

void OriginalSceneMotion::read_coordinates(double t, const Eigen::VectorXd& integrated_q,
                                           Eigen::VectorXd& q) {
  if (bodies_) bodies_->take(t, integrated_q, at_rest_);
  take_all(t, integrated_q, nullptr, q);
}

void OriginalSceneMotion::take_all(double t, const Eigen::VectorXd& integrated_q,
                                   Eigen::VectorXd* u, Eigen::VectorXd& q) const {
  q.resize(last_q_.size());
  for (const Copied& c : copied_q_)
    q.segment(c.to, c.count) = integrated_q.segment(c.from, c.count);
  for (const Cut& cut : cut_) {
    const JointMotion motion =
        joint_motion(cut.joint, bodies_->of(cut.joint.parent), bodies_->of(cut.joint.child));
    for (const Part& part : cut.parts) {
      const auto first = static_cast<std::size_t>(part.coordinate);
      for (std::size_t i = 0; i < static_cast<std::size_t>(part.nq); ++i)
        q[part.q + static_cast<int>(i)] = motion.q[first + i];
      for (std::size_t i = 0; u && i < static_cast<std::size_t>(part.nv); ++i)
        (*u)[part.u + static_cast<int>(i)] = motion.u[first + i];
      if (part.nv > 0) {
        const double last = last_u_[part.u];
        take_turns(part, t, u ? 0.5 * (last + (*u)[part.u]) : last, q);
      }
    }
  }
  follow(t, q, u);
}

void OriginalSceneMotion::follow(double t, Eigen::VectorXd& q, Eigen::VectorXd* u) const {
  for (const Following& f : following_) {
    double value = 0, rate = 0, second = 0;
    if (f.drive) f.drive->evaluate(t, value, rate, second);
    q[f.q] = f.ratio * (f.drive ? value : q[f.leader_q]) + f.offset;
    if (u) (*u)[f.u] = f.ratio * (f.drive ? rate : (*u)[f.leader_u]);
  }
}

void OriginalSceneMotion::take_turns(const Part& part, double t, double rate,
                                     Eigen::VectorXd& q) const {
  if (part.nq >= 4) {
    auto quaternion = q.segment<4>(part.q + part.nq - 4);
    if (quaternion.dot(last_q_.segment<4>(part.q + part.nq - 4)) < 0) quaternion *= -1;
  } else if (part.kind == JointKind::revolute && part.nq == 1) {
    constexpr double whole = 2 * std::numbers::pi;
    const double near = last_q_[part.q] + (t - last_t_) * rate;
    q[part.q] += whole * std::round((near - q[part.q]) / whole);
  }
}

void OriginalSceneMotion::carry(Memory& memory) {
  memory(last_t_);
  memory(last_q_.data(), static_cast<std::size_t>(last_q_.size()));
  memory(last_u_.data(), static_cast<std::size_t>(last_u_.size()));
}

}  // namespace momenta
