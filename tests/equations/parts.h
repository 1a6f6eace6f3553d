#pragma once
// Parts of scenes that tests write by hand: what every joint, loop and body of them has, in one
// call each. What is left out is as the specs have it.

#include <momenta/core/scene/scene.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta::equations {

inline JointSpec make_joint(JointKind kind, const std::string& name, const std::string& parent,
                            const std::string& child,
                            const Eigen::Vector3d& on_parent = Eigen::Vector3d::Zero(),
                            const Eigen::Vector3d& axis = Eigen::Vector3d::UnitZ(),
                            std::vector<double> position = {}) {
  JointSpec joint;
  joint.name = name;
  joint.kind = kind;
  joint.parent = parent;
  joint.child = child;
  joint.origin_parent = on_parent;
  joint.axis = axis;
  joint.position = std::move(position);
  return joint;
}

inline LoopSpec make_loop(LoopKind kind, const std::string& name, const std::string& parent,
                          const std::string& child,
                          const Eigen::Vector3d& on_parent = Eigen::Vector3d::Zero(),
                          const Eigen::Vector3d& on_child = Eigen::Vector3d::Zero()) {
  LoopSpec loop;
  loop.name = name;
  loop.kind = kind;
  loop.parent = parent;
  loop.child = child;
  loop.origin_parent = on_parent;
  loop.origin_child = on_child;
  return loop;
}

/// Σ ratio · coordinate = offset over the first coordinates of these joints.
inline LoopSpec make_coupler(const std::string& name, std::vector<std::string> joints,
                             std::vector<double> ratios, double offset = 0) {
  LoopSpec loop;
  loop.name = name;
  loop.kind = LoopKind::coupler;
  loop.joints = std::move(joints);
  loop.ratios = std::move(ratios);
  loop.offset = offset;
  return loop;
}

/// With its principal moments along the body's axes.
inline BodySpec make_body(const std::string& name, double mass,
                          const Eigen::Vector3d& moments = Eigen::Vector3d::Zero(),
                          const Eigen::Vector3d& com = Eigen::Vector3d::Zero()) {
  BodySpec body;
  body.name = name;
  body.mass = mass;
  body.inertia = moments.asDiagonal();
  body.com = com;
  return body;
}

inline MarkerSpec make_marker(const std::string& name, const std::string& body,
                              const Eigen::Vector3d& point = Eigen::Vector3d::Zero()) {
  MarkerSpec marker;
  marker.name = name;
  marker.body = body;
  marker.point = point;
  return marker;
}

/// A joint that moves by Σ coefficient · t^power.
inline DriveSpec polynomial(const std::string& joint, std::vector<double> coefficients) {
  DriveSpec drive;
  drive.joint = joint;
  drive.kind = "polynomial";
  drive.coefficients = std::move(coefficients);
  return drive;
}

/// A joint that moves by offset + amplitude sin(frequency t + phase).
inline DriveSpec harmonic(const std::string& joint, double offset, double amplitude,
                          double frequency, double phase = 0) {
  DriveSpec drive;
  drive.joint = joint;
  drive.kind = "harmonic";
  drive.offset = offset;
  drive.amplitude = amplitude;
  drive.frequency = frequency;
  drive.phase = phase;
  return drive;
}

/// A constant torque [N m], or force [N] of a slide, on a joint.
inline ForceSpec torque_on(const std::string& joint, double value) {
  ForceSpec force;
  force.kind = "torque";
  force.joint = joint;
  force.value = value;
  return force;
}

}  // namespace momenta::equations
