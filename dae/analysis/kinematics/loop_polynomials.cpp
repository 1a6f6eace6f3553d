#include <momenta/core/scene/drive.h>
#include <momenta/dae/analysis/kinematics/loop_polynomials.h>
#include <momenta/dae/analysis/kinematics/loop_screws.h>
#include <momenta/dae/analysis/kinematics/planar_polynomials.h>
#include <momenta/dae/analysis/kinematics/platform_polynomials.h>
#include <momenta/dae/analysis/kinematics/platform_rod.h>
#include <momenta/dae/analysis/kinematics/space_loop_polynomials.h>

#include <algorithm>
#include <string>

namespace momenta {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::vector<Isometry3d> poses_of_polynomials(const Mechanism& mechanism, double t,
                                             const Eigen::VectorXd& q) {
  const Tree& tree = mechanism.tree();
  std::vector<Isometry3d> poses;
  for (const Tree::Body& b : tree.bodies) {
    Isometry3d moved = Isometry3d::Identity();
    double value = 0, rate, second;
    if (b.drive >= 0)
      tree.drives[static_cast<std::size_t>(b.drive)].evaluate(t, value, rate, second);
    else if (b.nq == 1)
      value = q[b.q];
    if (b.kind == JointKind::helical) moved.translate(b.pitch * value * Vector3d::UnitZ());
    if (b.kind == JointKind::revolute || b.kind == JointKind::helical)
      moved.rotate(Eigen::AngleAxisd(value, Vector3d::UnitZ()));
    if (b.kind == JointKind::prismatic) moved.translate(value * Vector3d::UnitZ());
    if (b.kind == JointKind::free && b.nq == 7) moved.translate(q.segment<3>(b.q));
    if (b.nq >= 4) {
      const int at = b.q + b.nq - 4;
      moved.rotate(Eigen::Quaterniond(q[at], q[at + 1], q[at + 2], q[at + 3]));
    }
    const Isometry3d placed = b.placement * moved;
    poses.push_back(b.parent < 0 ? placed : poses[static_cast<std::size_t>(b.parent)] * placed);
  }
  return poses;
}

Vector3d origin_of_loop(const Scene& scene, const LoopSpec& loop, double t) {
  Vector3d origin = loop.origin_parent;
  for (const DriveSpec& drive : scene.drives) {
    if (drive.loop != loop.name || drive.origin.empty()) continue;
    double rate, second;
    MotionLaw(drive).evaluate(t, origin[drive.origin[0] - 'x'], rate, second);
  }
  return origin;
}

namespace {

/// Whether moving pieces form one ring with the base.
bool is_one_loop(const Pieces& pieces) {
  const std::vector<TieChain> chains = tie_chains(pieces);
  return chains.size() == 1 && chains[0].from == pieces.base() && chains[0].to == pieces.base();
}

std::unique_ptr<LoopPolynomials> polynomials_in_space(const Mechanism& mechanism, double t,
                                                      const Eigen::VectorXd& own,
                                                      const std::vector<bool>& held) {
  const std::vector<Isometry3d> poses = poses_of_polynomials(mechanism, t, own);
  return is_one_loop(Pieces(mechanism, t, poses, held))
             ? space_loop_polynomials(mechanism, t, own, held)
             : platform_polynomials(mechanism, t, own, held);
}

}  // namespace

std::unique_ptr<LoopPolynomials> loop_polynomials(const Mechanism& mechanism, double t,
                                                  const Eigen::VectorXd& own,
                                                  const std::vector<bool>& held) {
  std::unique_ptr<LoopPolynomials> found;
  if (!mechanism.scene().lagrangian && mechanism.plan().planar)
    found = planar_polynomials(mechanism, t, own, held);
  else if (!mechanism.scene().lagrangian)
    found = polynomials_in_space(mechanism, t, own, held);
  else
    throw SceneError(mechanism.scene().where({}) +
                     "its loops are not written as polynomials; expected joints, not a Lagrangian");
  if (found->system().bezout(most_paths) > most_paths)
    throw SceneError(mechanism.scene().where({}) + "more than " + std::to_string(most_paths) +
                     " paths would have to be followed; expected fewer loops");
  return found;
}

int idle_spins(const Mechanism& mechanism, double t, const Eigen::VectorXd& own,
               const std::vector<bool>& held) {
  if (mechanism.scene().lagrangian || mechanism.plan().planar) return 0;
  const std::vector<Isometry3d> poses = poses_of_polynomials(mechanism, t, own);
  const Pieces pieces(mechanism, t, poses, held);
  const double length = length_of(mechanism.scene());
  if (is_one_loop(pieces)) return LoopScrews(tie_chains(pieces).front(), length).idle();
  int idle = 0;
  for (const TieChain& chain : tie_chains(pieces))
    if (const auto rod = PlatformRod::of(chain, length)) idle += rod->idle();
  return idle;
}

}  // namespace momenta
