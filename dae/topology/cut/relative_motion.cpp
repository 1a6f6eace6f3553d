#include <momenta/dae/topology/cut/relative_motion.h>

#include <Eigen/Geometry>
#include <cmath>

namespace momenta {

BodyMotions::BodyMotions(const Mechanism& mechanism, const std::set<std::string>* wanted)
    : poses_(mechanism.tree(), mechanism.scene()) {
  motion_["ground"] = {};
  for (const BodySpec& body : mechanism.scene().bodies)
    if (!wanted || wanted->contains(body.name))
      wanted_.push_back({&motion_[body.name], mechanism.tree().body(body.name)});
}

void BodyMotions::take(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  poses_.move(t, q.data(), u.data());
  for (const auto& [motion, body] : wanted_) *motion = poses_.motion(body);
}

namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Matrix3d turn(const Vector3d& axis, double angle) {
  return AngleAxisd(angle, axis).toRotationMatrix();
}

/// Angle about `axis` from `from` to `to`, both taken across it.
double angle_about(const Vector3d& axis, const Vector3d& from, const Vector3d& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to) - axis.dot(from) * axis.dot(to));
}

}  // namespace

JointMotion joint_motion(const JointSpec& joint, const BodyMotion& parent,
                         const BodyMotion& child) {
  // The child's frame in the joint frame, which rides on the parent.
  const Matrix3d frame = parent.pose.linear() * joint.rotation.toRotationMatrix();
  const Vector3d point = child.pose * joint.origin_child;
  const Matrix3d C = frame.transpose() * child.pose.linear();
  const Vector3d d = frame.transpose() * (point - parent.pose * joint.origin_parent);
  const Vector3d point_rate =
      child.v + child.omega.cross(Vector3d(child.pose.linear() * joint.origin_child));
  const Vector3d carried =
      parent.v + parent.omega.cross(Vector3d(point - parent.pose.translation()));
  const Vector3d v = frame.transpose() * (point_rate - carried);
  const Vector3d omega = frame.transpose() * (child.omega - parent.omega);

  const Vector3d axis = joint.axis.normalized(), side = perpendicular_to(axis);
  const double angle = angle_about(axis, side, C * side);
  JointMotion m;
  Vector3d slid = Vector3d::Zero();
  Matrix3d turned = Matrix3d::Identity();
  switch (joint.kind) {
    case JointKind::revolute:
    case JointKind::helical:
      m.q = {angle}, m.u = {axis.dot(omega)};
      turned = turn(axis, angle);
      slid = joint.kind == JointKind::helical ? Vector3d(joint.pitch * angle * axis) : slid;
      break;
    case JointKind::prismatic:
      m.q = {axis.dot(d)}, m.u = {axis.dot(v)};
      slid = m.q[0] * axis;
      break;
    case JointKind::cylindrical:
      m.q = {axis.dot(d), angle}, m.u = {axis.dot(v), axis.dot(omega)};
      slid = m.q[0] * axis;
      turned = turn(axis, angle);
      break;
    case JointKind::universal: {
      const Vector3d second = joint.axis2.isZero() ? side : joint.axis2.normalized();
      const double first = angle_about(axis, second, C * second);
      const Vector3d across = perpendicular_to(second);
      const Matrix3d rest = turn(axis, -first) * C;
      m.q = {first, angle_about(second, across, rest * across)};
      turned = turn(axis, m.q[0]) * turn(second, m.q[1]);
      // ω = u₁ a + u₂ b in the least-squares sense: the two normal equations of unit axes.
      const Vector3d b = turn(axis, first) * second;
      const double cosine = axis.dot(b), along_a = axis.dot(omega), along_b = b.dot(omega);
      const double sine2 = axis.cross(b).squaredNorm();
      m.u = {(along_a - cosine * along_b) / sine2, (along_b - cosine * along_a) / sine2};
      break;
    }
    case JointKind::planar: {
      Vector3d first = joint.direction.isZero() ? side : joint.direction;
      first = (first - first.dot(axis) * axis).normalized();
      const Vector3d second = axis.cross(first);
      m.q = {first.dot(d), second.dot(d), angle};
      m.u = {first.dot(v), second.dot(v), axis.dot(omega)};
      slid = m.q[0] * first + m.q[1] * second;
      turned = turn(axis, angle);
      break;
    }
    case JointKind::spherical:
    case JointKind::free: {
      const Quaterniond q(C);
      turned = C;
      const Vector3d rate = C.transpose() * omega;
      if (joint.kind == JointKind::free) {
        const Vector3d w = C.transpose() * v;
        m.q = {d[0], d[1], d[2]}, m.u = {w[0], w[1], w[2]};
        slid = d;
      }
      for (const double x : {q.w(), q.x(), q.y(), q.z()}) m.q.push_back(x);
      for (int i = 0; i < 3; ++i) m.u.push_back(rate[i]);
      break;
    }
    case JointKind::weld:
    case JointKind::user:
      break;
  }
  m.shift = (d - slid).norm();
  m.tilt = (C - turned).cwiseAbs().maxCoeff();
  return m;
}

}  // namespace momenta
