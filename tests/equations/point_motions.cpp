#include "equations/point_motions.h"
#include "equations/parts.h"

namespace momenta::equations {

PointMotions::PointMotions(const Mechanism& mechanism) {
  Scene tied = mechanism.scene();
  tied.loops.clear();
  std::erase_if(tied.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
  for (const MarkerSpec& m : tied.markers) {
    tied.loops.push_back(make_loop(LoopKind::point, "tie " + std::to_string(tied.loops.size()),
                                   "ground", m.body, {0, 0, 0}, m.point));
  }
  // in a plane two rows are left of three
  tied_ = std::make_unique<Mechanism>(
      std::move(tied), MechanismOptions{.algebra = Algebra::spatial, .kkt = KktChoice::dense});
  e_ = tied_->evaluation<double>();
}

PointMotion PointMotions::operator()(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                     const Eigen::VectorXd* udot) {
  const Eigen::Index markers = tied_->m() / 3;
  PointMotion m{Eigen::Matrix3Xd(3, markers), Eigen::Matrix3Xd(3, markers),
                Eigen::Matrix3Xd::Zero(3, markers)};
  Eigen::VectorXd tau(tied_->nv());
  e_->place(t, q.data());
  e_->positions(m.place.data());
  e_->move(u.data());
  e_->velocities(m.velocity.data());
  if (!udot) return m;
  e_->joint_forces(q.data(), u.data(), udot->data(), nullptr, tau.data());
  e_->accelerations(m.acceleration.data());
  return m;
}

void mark_bodies(Scene& scene) {
  scene.markers.clear();
  for (const BodySpec& body : scene.bodies)
    for (int i = 0; i < 3; ++i) {
      MarkerSpec m = make_marker(body.name + " " + std::to_string(i), body.name, {0.1, -0.2, 0.15});
      m.point[i] += 0.7;
      scene.markers.push_back(m);
    }
}

Scene marked(Scene scene) {
  mark_bodies(scene);
  return scene;
}

}  // namespace momenta::equations
