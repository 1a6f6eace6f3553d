// The frames of a film: poses of bodies against their parents, and the gaps of loops.

#include <momenta/core/open_chain/poses.h>
#include <momenta/dae/mechanism/loop/loop_choice.h>
#include <momenta/dae/mechanism/loop/pair_of_loop.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/run/picture_order.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Gap between a loop's points, less what it leaves free or drives prescribe.
class LoopGap {
 public:
  LoopGap(const Scene& scene, const LoopSpec& loop) : loop_(loop) {
    for (const DriveSpec& drive : scene.drives)
      if (drive.loop == loop.name) drives_.push_back({MotionLaw(drive), drive});
    const Vector3d axis = loop.axis.normalized();
    const Eigen::Matrix3d frame = frame_across(loop);
    switch (loop.kind) {
      case LoopKind::slot:
      case LoopKind::cam:
      case LoopKind::rack:
        if (has_curves(loop))
          pair_ = pair_of(loop);
        else
          free_ = {axis};
        break;
      case LoopKind::prismatic:
      case LoopKind::cylindrical:
        free_ = {axis};
        break;
      case LoopKind::planar:
        free_ = {frame.col(0), frame.col(1)};
        break;
      default:
        break;
    }
  }

  Vector3d gap(double t, const Isometry3d& parent, const Isometry3d& child) {
    Vector3d at_parent = loop_.origin_parent;
    double length = loop_.length;
    std::vector<double> given(free_.size(), std::nan(""));
    for (const auto& [law, drive] : drives_) {
      double f = 0, unused = 0;
      law.evaluate(t, f, unused, unused);
      const auto coordinate = static_cast<std::size_t>(drive.coordinate);
      if (!drive.origin.empty())
        at_parent[drive.origin[0] - 'x'] = f;
      else if (loop_.kind == LoopKind::distance)
        length = f;
      else if (coordinate < given.size())
        given[coordinate] = f;
    }
    Vector3d apart = child * loop_.origin_child - parent * at_parent;
    if (loop_.kind == LoopKind::distance)
      return apart.norm() > 0 ? Vector3d(apart * (1 - length / apart.norm())) : apart;
    const Eigen::Matrix3d frame = parent.linear() * loop_.rotation.toRotationMatrix();
    if (loop_.kind == LoopKind::rolling) return of_wheel(frame * loop_.normal, child, apart);
    if (pair_) return of_pair(frame * frame_across(loop_), child, apart);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      const Vector3d way = frame * free_[i];
      apart -= (std::isnan(given[i]) ? apart.dot(way) : given[i]) * way;
    }
    return apart;
  }

 private:
  /// Gap between the wheel and its plane.
  Vector3d of_wheel(const Vector3d& normal, const Isometry3d& child, const Vector3d& apart) const {
    const Vector3d axle = child.linear() * loop_.axis.normalized();
    const double circle = loop_.radius - loop_.crown_radius;
    return (normal.dot(apart) - loop_.crown_radius - circle * normal.cross(axle).norm()) * normal;
  }
  /// F along its gradient in the plane; for a slot also the part out of it. `axes`: columns e₁, e₂
  /// and the normal.
  Vector3d of_pair(const Eigen::Matrix3d& axes, const Isometry3d& child, const Vector3d& apart) {
    const Vector3d in_axes = axes.transpose() * apart;
    const Vector3d turned = axes.transpose() * (child.linear() * frame_across(loop_).col(0));
    PairTerms<double> terms;
    pair_->evaluate({in_axes[0], in_axes[1], turned[0], turned[1]}, place_, terms);
    const double square = terms.slope[0] * terms.slope[0] + terms.slope[1] * terms.slope[1];
    Vector3d gap = terms.value / square * Vector3d(terms.slope[0], terms.slope[1], 0);
    if (loop_.kind == LoopKind::slot) gap[2] = in_axes[2];
    return gap.allFinite() ? Vector3d(axes * gap) : Vector3d(Vector3d::Zero());
  }
  struct Prescribed {
    MotionLaw law;
    DriveSpec drive;
  };
  const LoopSpec& loop_;
  std::vector<Prescribed> drives_;
  std::vector<Vector3d> free_;  ///< directions in the joint frame, by coordinate
  std::optional<HigherPair> pair_;
  PairPlace place_;
};

}  // namespace

Motion motion_of(const Mechanism& mechanism, const Film& film) {
  Poses poses_at(mechanism.tree(), mechanism.scene());
  const PictureOrder order(mechanism);
  std::vector<std::size_t> in_tree;
  for (const JointSpec* joint : order.joints)
    in_tree.push_back(static_cast<std::size_t>(mechanism.tree().body(joint->child)));
  std::vector<LoopGap> gaps;
  std::vector<std::pair<int, int>> sides;
  for (const LoopSpec& loop : mechanism.scene().loops)
    if (ties_bodies(loop)) {
      gaps.emplace_back(mechanism.scene(), loop);
      sides.push_back({order.place.at(loop.parent), order.place.at(loop.child)});
    }

  Motion motion;
  motion.start = film.start;
  motion.every = film.every;
  for (const std::vector<double>& q : film.frames) {
    const double t = film.start + film.every * static_cast<double>(motion.frames.size());
    const auto poses = poses_at(t, q.data());
    const auto of = [&](int k) -> Isometry3d {
      return k < 0 ? Isometry3d::Identity() : poses[in_tree[static_cast<std::size_t>(k)]];
    };
    Motion::Frame frame;
    for (std::size_t k = 0; k < order.joints.size(); ++k) {
      const JointSpec& joint = *order.joints[k];
      const Isometry3d relative =
          of(order.place.at(joint.parent)).inverse() * of(static_cast<int>(k));
      frame.turn.push_back(Quaterniond(relative.linear()).normalized());
      frame.translation.push_back(relative * joint.origin_child);
    }
    for (std::size_t i = 0; i < gaps.size(); ++i)
      frame.gap.push_back(gaps[i].gap(t, of(sides[i].first), of(sides[i].second)));
    motion.frames.push_back(std::move(frame));
  }
  return motion;
}

std::vector<Isometry3d> places(const Picture& picture, const Motion::Frame& frame) {
  std::vector<Isometry3d> all;
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    const Isometry3d parent =
        body.parent < 0 ? Isometry3d::Identity() : all[static_cast<std::size_t>(body.parent)];
    Isometry3d place = Isometry3d::Identity();
    place.linear() = parent.linear() * frame.turn[k].toRotationMatrix();
    place.translation() = parent * frame.translation[k] - place.linear() * body.at_child;
    all.push_back(place);
  }
  return all;
}

namespace {

/// Largest turn and shift of bodies against their parents between frames that lie `stride` apart.
std::pair<double, double> largest_change(const Motion& motion, std::size_t stride) {
  double turn = 0, shift = 0;
  for (std::size_t i = stride; i < motion.frames.size(); i += stride)
    for (std::size_t k = 0; k < motion.frames[i].turn.size(); ++k) {
      const auto &a = motion.frames[i - stride], &b = motion.frames[i];
      turn = std::max(turn, a.turn[k].angularDistance(b.turn[k]));
      shift = std::max(shift, (a.translation[k] - b.translation[k]).norm());
    }
  return {turn, shift};
}

}  // namespace

void thin(Motion& motion, const Picture& picture) {
  constexpr double fine_turn = 0.2, fine_shift = 0.1;
  constexpr std::size_t enough = 200;
  std::size_t stride = 1;
  while ((motion.frames.size() - 1) % (2 * stride) == 0 && motion.frames.size() / stride > enough) {
    const auto [turn, shift] = largest_change(motion, 2 * stride);
    if (turn > fine_turn || shift > fine_shift * picture.length) break;
    stride *= 2;
  }
  if (stride == 1) return;
  std::vector<Motion::Frame> kept;
  for (std::size_t i = 0; i < motion.frames.size(); i += stride)
    kept.push_back(std::move(motion.frames[i]));
  motion.frames = std::move(kept);
  motion.every *= static_cast<double>(stride);
}

double largest_turn(const Motion& motion) {
  return largest_change(motion, 1).first;
}

}  // namespace momenta
