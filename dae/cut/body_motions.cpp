#include <momenta/dae/cut/body_motions.h>

namespace momenta {
namespace {

std::set<std::string> all_bodies(const Mechanism& mechanism) {
  std::set<std::string> names;
  for (const BodySpec& body : mechanism.scene().bodies) names.insert(body.name);
  return names;
}

}  // namespace

BodyMotions::BodyMotions(const Mechanism& mechanism)
    : BodyMotions(mechanism, all_bodies(mechanism)) {}

BodyMotions::BodyMotions(const Mechanism& mechanism, const std::set<std::string>& wanted) {
  Scene open = mechanism.scene();
  open.loops.clear();
  open.markers.clear();
  open.forces.clear();  // which may name them, and move nothing here
  std::erase_if(open.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
  motion_["ground"] = {};
  // Of four points of a body, its origin and one along each axis, velocities give v and ω.
  for (const BodySpec& body : open.bodies) {
    if (!wanted.contains(body.name)) continue;
    wanted_.push_back(
        {&motion_[body.name], static_cast<std::size_t>(mechanism.tree().body(body.name))});
    for (int i = 0; i < 4; ++i) {
      MarkerSpec marker;
      marker.name = body.name + " " + std::to_string(i);
      marker.body = body.name;
      if (i > 0) marker.point[i - 1] = 1;
      open.markers.push_back(marker);
    }
  }
  points_.resize(6 * open.markers.size());
  poses_ = std::make_unique<Poses>(open);
  tree_ = std::make_unique<Mechanism>(std::move(open));
  e_ = tree_->evaluation<double>();
}

void BodyMotions::take(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) {
  const auto poses = (*poses_)(t, q.data());
  e_->place(t, q.data());
  e_->move(u.data());
  e_->markers(points_.data());
  const double* at = points_.data();
  for (const auto& [motion, place] : wanted_) {
    motion->pose = poses[place];
    motion->v = Eigen::Vector3d(at[3], at[4], at[5]);
    motion->omega.setZero();
    for (int k = 0; k < 3; ++k) {
      const double* rate = at + 6 * (k + 1) + 3;
      const Eigen::Vector3d axis = motion->pose.linear().col(k),
                            turned = Eigen::Vector3d(rate[0], rate[1], rate[2]) - motion->v;
      motion->omega += 0.5 * axis.cross(turned);
    }
    at += 24;
  }
}

}  // namespace momenta
