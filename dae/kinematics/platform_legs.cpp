#include <momenta/dae/kinematics/loop_polynomials.h>
#include <momenta/dae/kinematics/platform_legs.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double within_rounding = 1e-9;  // of squared lengths, beside a leg's

class LegReader {
 public:
  LegReader(const Mechanism& mechanism, double t, const std::vector<Isometry3d>& poses,
            const std::vector<bool>& held)
      : mechanism_(mechanism), t_(t), poses_(poses), legs_{Pieces(mechanism, held), -1, {}} {}

  PlatformLegs read() {
    const Pieces& pieces = legs_.pieces;
    std::map<int, std::vector<const Tie*>> by_piece;
    for (const Tie& tie : pieces.ties()) {
      expect_known(tie);
      for (const int body : {tie.parent, tie.child})
        if (pieces.of(body) != pieces.base()) by_piece[pieces.of(body)].push_back(&tie);
    }
    if (by_piece.empty()) refuse({}, "no body moves; expected a platform");
    legs_.platform = std::max_element(by_piece.begin(), by_piece.end(), [](auto& a, auto& b) {
                       return a.second.size() < b.second.size();
                     })->first;
    for (const Tie& tie : pieces.ties()) add_direct(tie);
    for (const auto& [piece, ties] : by_piece)
      if (piece != legs_.platform) add_leg(piece, ties);
    if (legs_.rods.size() != 6)
      refuse({}, std::to_string(legs_.rods.size()) + " rods and legs hold " +
                     body_of(legs_.platform) + "; expected six");
    return std::move(legs_);
  }

 private:
  [[noreturn]] void refuse(Location at, const std::string& why) const {
    throw SceneError(mechanism_.scene().where(at) +
                     "its loops, in space, are not written as polynomials: " + why);
  }

  /// "body 'platform'", the first of a piece.
  std::string body_of(int piece) const {
    const auto& bodies = mechanism_.tree().bodies;
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (!bodies[k].name.empty() && legs_.pieces.of(static_cast<int>(k)) == piece)
        return "body '" + bodies[k].name + "'";
    return "the ground";
  }

  void expect_known(const Tie& tie) const {
    const bool within = legs_.pieces.of(tie.parent) == legs_.pieces.of(tie.child);
    if (tie.in_part)
      refuse(tie.at(), tie.in_words() + (tie.joint ? " has coordinates that are held or driven "
                                                     "beside others that are not; expected all of "
                                                     "them, or none"
                                                   : " has driven coordinates; expected none"));
    if (tie.kind == Tie::Kind::other)
      refuse(tie.at(), tie.joint
                           ? tie.in_words() +
                                 " moves; expected it held or driven, or spherical or "
                                 "universal at the end of a leg of a platform"
                           : tie.in_words() +
                                 "; expected kind distance, spherical, point, universal or weld");
    if (within)
      refuse(tie.at(), tie.in_words() +
                           " ties bodies between which nothing moves; expected others, or none of "
                           "it");
  }

  /// Between the base and the platform.
  void add_direct(const Tie& tie) {
    const auto& pieces = legs_.pieces;
    const int a = pieces.of(tie.parent), b = pieces.of(tie.child);
    const auto is_end = [&](int piece) {
      return piece == pieces.base() || piece == legs_.platform;
    };
    if (is_end(a) && is_end(b)) {
      if (tie.kind != Tie::Kind::distance)
        refuse(tie.at(), tie.in_words() + " ties " + body_of(legs_.platform) +
                             " to what stands; expected legs and loops of kind distance between "
                             "them");
      PlatformRod rod;
      rod.on_platform = point(tie, a == legs_.platform);
      rod.on_base = point(tie, a != legs_.platform);
      legs_.rods.push_back(rod);
    } else if (tie.kind == Tie::Kind::distance) {
      refuse(tie.at(), tie.in_words() + " ends at " + body_of(is_end(a) ? b : a) +
                           "; expected its ends on what stands and on " + body_of(legs_.platform));
    }
  }

  void add_leg(int piece, const std::vector<const Tie*>& ties) {
    const auto& pieces = legs_.pieces;
    const auto other_end = [&](const Tie& tie) {
      return pieces.of(tie.parent) == piece ? pieces.of(tie.child) : pieces.of(tie.parent);
    };
    for (const Tie* tie : ties) {
      const int end = other_end(*tie);
      if (end != pieces.base() && end != legs_.platform)
        refuse(tie->at(), tie->in_words() + " ties " + body_of(piece) + " to " + body_of(end) +
                              "; expected a leg between what stands and " +
                              body_of(legs_.platform));
    }
    if (ties.size() != 2 || other_end(*ties[0]) == other_end(*ties[1]))
      refuse(ties[0]->at(), body_of(piece) + " with " + ties[0]->in_words() +
                                " is no leg; expected two such ties, one to what stands and one "
                                "to " +
                                body_of(legs_.platform));
    if (ties[0]->kind == Tie::Kind::universal && ties[1]->kind == Tie::Kind::universal)
      refuse(ties[0]->at(), ties[0]->in_words() + " and " + ties[1]->in_words() +
                                " stand at the ends of one leg; expected a ball at one of them");
    PlatformRod rod;
    rod.leg = piece;
    for (const Tie* tie : ties) {
      const bool on_platform = other_end(*tie) == legs_.platform;
      (on_platform ? rod.on_platform : rod.on_base) = point(*tie, true);
      if (tie->kind != Tie::Kind::universal) continue;
      Vector3d a = axis(*tie, true), b = axis(*tie, false);
      if (pieces.of(tie->parent) == piece) std::swap(a, b);
      rod.universal = PlatformRod::Universal{on_platform, a, b};
    }
    legs_.rods.push_back(rod);
  }

  Vector3d in_ground(int body, const Vector3d& at) const {
    return body < 0 ? at : Vector3d(poses_[static_cast<std::size_t>(body)] * at);
  }
  Vector3d turned(int body, const Vector3d& way) const {
    return body < 0 ? way : Vector3d(poses_[static_cast<std::size_t>(body)].linear() * way);
  }

  /// The centre of a tie, or the end of a distance; of a loop its point on the parent or the child.
  Vector3d point(const Tie& tie, bool on_parent) const {
    if (tie.joint) return poses_[static_cast<std::size_t>(tie.child)].translation();
    const int body = on_parent ? tie.parent : tie.child;
    return in_ground(body, mechanism_.tree().point(
                               body, on_parent ? origin_of_loop(mechanism_.scene(), *tie.loop, t_)
                                               : tie.loop->origin_child));
  }

  /// Of a universal joint or loop the axis that its parent holds, or its child.
  Vector3d axis(const Tie& tie, bool of_parent) const {
    const Tree& tree = mechanism_.tree();
    if (tie.joint) {
      const int part = of_parent ? tree.first_part(tie.child) : tie.child;
      return poses_[static_cast<std::size_t>(part)].linear().col(2);
    }
    const LoopSpec& l = *tie.loop;
    const Vector3d first = l.axis.normalized(),
                   second = l.axis2.isZero() ? perpendicular_to(first) : l.axis2.normalized();
    return of_parent ? turned(tie.parent, tree.direction(tie.parent, l.rotation * first))
                     : turned(tie.child, tree.direction(tie.child, second));
  }

  const Mechanism& mechanism_;
  double t_;
  const std::vector<Isometry3d>& poses_;
  PlatformLegs legs_;
};

/// From u to v about an axis.
double angle_about(const Vector3d& axis, const Vector3d& u, const Vector3d& v) {
  return std::atan2(axis.dot(u.cross(v)), u.dot(v) - axis.dot(u) * axis.dot(v));
}

/// Q of R(a, α) R(b, β) v = v', the smaller of the two.
std::optional<Quaterniond> turn_of_universal(const Vector3d& a, const Vector3d& b,
                                             const Vector3d& v, const Vector3d& now) {
  const double c = a.dot(b), across = 1 - c * c, on_a = now.dot(a), on_b = v.dot(b),
               x = (on_a - c * on_b) / across, y = (on_b - c * on_a) / across,
               left = v.squaredNorm() - x * x - y * y - 2 * c * x * y;
  if (left < -within_rounding * v.squaredNorm()) return std::nullopt;
  const double z = std::sqrt(std::max(left, 0.0) / across);
  std::optional<Quaterniond> found;
  double least = 0;
  for (const double side : {z, -z}) {
    const Vector3d w = x * a + y * b + side * a.cross(b);
    const double alpha = angle_about(a, w, now), beta = angle_about(b, v, w),
                 size = std::abs(alpha) + std::abs(beta);
    if (found && size >= least) continue;
    found = AngleAxisd(alpha, a) * AngleAxisd(beta, b);
    least = size;
  }
  return found;
}

}  // namespace

std::optional<Isometry3d> PlatformRod::displaced(const Isometry3d& platform) const {
  const Vector3d seat = platform * on_platform;
  Vector3d centre = on_base, now = on_base;
  Quaterniond rotation;
  if (!universal) {
    rotation = Quaterniond::FromTwoVectors(on_platform - on_base, seat - on_base);
  } else {
    const bool above = universal->on_platform;
    const Quaterniond outer =
        above ? Quaterniond(platform.linear()) : Quaterniond(Quaterniond::Identity());
    if (above) {
      centre = on_platform;
      now = seat;
    }
    const Vector3d way = above ? on_base - on_platform : on_platform - on_base,
                   other = above ? on_base - seat : seat - on_base;
    const auto own = turn_of_universal(universal->a, universal->b, way, outer.conjugate() * other);
    if (!own) return std::nullopt;
    rotation = outer * *own;
  }
  Isometry3d found = Isometry3d::Identity();
  found.translate(now);
  found.rotate(rotation);
  found.translate(-centre);
  return found;
}

PlatformLegs platform_legs(const Mechanism& mechanism, double t,
                           const std::vector<Isometry3d>& poses, const std::vector<bool>& held) {
  return LegReader(mechanism, t, poses, held).read();
}

}  // namespace momenta
