#include <momenta/dae/analysis/kinematics/platform_rod.h>
#include <momenta/dae/analysis/kinematics/turns.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double parallel = 1e-6;  // |a × b| of parallel lines
constexpr double off = 1e-8;       // largest distance of lines from a centre [lengths of the scene]

bool is_ball(const Tie* tie) {
  return tie->kind == Tie::Kind::ball;
}
bool has_ball(const std::vector<const Tie*>& ties) {
  return std::any_of(ties.begin(), ties.end(), is_ball);
}
int freedoms(const std::vector<const Tie*>& ties) {
  int sum = 0;
  for (const Tie* tie : ties) sum += is_ball(tie) ? 3 : 1;
  return sum;
}

double distance_to(const Vector3d& point, const Tie& hinge) {
  return (point - hinge.centre).cross(hinge.way).norm();
}

/// The point midway between two lines that are not parallel.
Vector3d crossing(const Tie& s, const Tie& t) {
  const Vector3d across = s.way.cross(t.way), between = t.centre - s.centre;
  const double size = across.squaredNorm();
  const Vector3d on_s = s.centre + between.cross(t.way).dot(across) / size * s.way,
                 on_t = t.centre + between.cross(s.way).dot(across) / size * t.way;
  return (on_s + on_t) / 2;
}

/// The centre of ties that make all rotations, or of two hinges across each other.
std::optional<Vector3d> centre_of(const std::vector<const Tie*>& ties, double length) {
  std::optional<Vector3d> centre;
  const auto ball = std::find_if(ties.begin(), ties.end(), is_ball);
  if (ball != ties.end())
    centre = (*ball)->centre;
  else if (ties.size() != 2 && ties.size() != 3)
    return std::nullopt;
  for (std::size_t k = 0; !centre && k + 1 < ties.size(); ++k)
    if (ties[k]->way.cross(ties[k + 1]->way).norm() > parallel)
      centre = crossing(*ties[k], *ties[k + 1]);
  if (!centre) return std::nullopt;
  for (std::size_t k = 0; k < ties.size(); ++k) {
    if (is_ball(ties[k]) ? (ties[k]->centre - *centre).norm() > off * length
                         : distance_to(*centre, *ties[k]) > off * length)
      return std::nullopt;
    if (ball == ties.end() && k > 0 && ties[k - 1]->way.cross(ties[k]->way).norm() <= parallel)
      return std::nullopt;
  }
  return centre;
}

}  // namespace

std::vector<const Tie*> PlatformRod::part(bool first) const {
  const auto middle = chain_.ties.begin() + static_cast<std::ptrdiff_t>(split_);
  return first ? std::vector<const Tie*>(chain_.ties.begin(), middle)
               : std::vector<const Tie*>(middle, chain_.ties.end());
}

bool PlatformRod::split_at(std::size_t place, double length) {
  split_ = place;
  const std::vector<const Tie*> below = part(true), above = part(false);
  const int all = freedoms(below) + freedoms(above);
  if (freedoms(below) < 2 || freedoms(above) < 2 || all < 5) return false;
  const auto b = centre_of(below, length), p = centre_of(above, length);
  if (!b || !p || (*b - *p).norm() <= off * length) return false;
  // Turns about the leg itself do not move its ends.
  const Vector3d leg = (*p - *b).normalized();
  const auto along = [&](const Tie* tie) { return tie->way.cross(leg).norm() <= parallel; };
  if (freedoms(below) == 2 && along(below[1])) return false;
  if (freedoms(above) == 2 && along(above[0])) return false;
  b_ = *b;
  p_ = *p;
  idle_ = all - 5;
  return true;
}

std::optional<PlatformRod> PlatformRod::of(const TieChain& chain, double length) {
  PlatformRod rod;
  rod.chain_ = chain;
  if (chain.ties.size() == 1 && chain.ties[0]->kind == Tie::Kind::distance) {
    const Tie& tie = *chain.ties[0];
    rod.b_ = tie.centre;
    rod.p_ = tie.centre + tie.way;
    if (tie.first != chain.from) std::swap(rod.b_, rod.p_);
    return rod;
  }
  for (const Tie* tie : chain.ties)
    if (tie->kind != Tie::Kind::ball && tie->kind != Tie::Kind::hinge) return std::nullopt;
  for (std::size_t place = 1; place < chain.ties.size(); ++place)
    if (rod.split_at(place, length)) return rod;
  return std::nullopt;
}

/// Turns of ties that together make one rotation; a ball makes it alone.
PlatformRod::Turns PlatformRod::turned(const std::vector<const Tie*>& ties,
                                       const Quaterniond& whole) {
  if (!has_ball(ties)) return turns_that_make(ties[0]->way, ties[1]->way, ties[2]->way, whole);
  std::vector<Quaterniond> turns(ties.size(), Quaterniond::Identity());
  turns[static_cast<std::size_t>(std::find_if(ties.begin(), ties.end(), is_ball) - ties.begin())] =
      whole;
  return turns;
}

std::optional<std::vector<Isometry3d>> PlatformRod::displaced(const Isometry3d& platform) const {
  if (chain_.pieces.empty()) return std::vector<Isometry3d>{};
  const std::vector<const Tie*> below = part(true), above = part(false);
  const auto product = [](const std::vector<Quaterniond>& turns) {
    Quaterniond q = Quaterniond::Identity();
    for (const Quaterniond& turn : turns) q = q * turn;
    return q;
  };
  const Quaterniond rotation(platform.linear());
  Turns low, high;
  if (freedoms(above) == 2) {
    high = turns_that_take(above[1]->way, above[0]->way, b_ - p_, platform.inverse() * b_ - p_);
    if (!high) return std::nullopt;
    std::reverse(high->begin(), high->end());
    for (Quaterniond& turn : *high) turn = turn.conjugate();
    low = turned(below, rotation * product(*high).conjugate());
  } else {
    low = freedoms(below) == 2
              ? turns_that_take(below[0]->way, below[1]->way, p_ - b_, platform * p_ - b_)
              : turned(below, Quaterniond::FromTwoVectors(p_ - b_, platform * p_ - b_));
    if (low) high = turned(above, product(*low).conjugate() * rotation);
  }
  if (!low || !high) return std::nullopt;
  std::vector<Isometry3d> pieces;
  Isometry3d d = Isometry3d::Identity();
  for (std::size_t k = 0; k + 1 < chain_.ties.size(); ++k) {
    d = k < split_ ? d * turned_about(b_, (*low)[k]) : d * turned_about(p_, (*high)[k - split_]);
    pieces.push_back(d);
  }
  return pieces;
}

}  // namespace momenta
