#include <momenta/core/scene/kinds.h>
#include <momenta/dae/analysis/kinematics/loop_polynomials.h>
#include <momenta/dae/analysis/kinematics/pieces.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace momenta {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::string Tie::in_words() const {
  return (joint ? "joint '" + joint->name : "loop '" + loop->name) + "' of kind " +
         std::string(joint ? reading::name_of(joint->kind) : reading::name_of(loop->kind));
}

void refuse_in_space(const Mechanism& mechanism, Location at, const std::string& why) {
  throw SceneError(mechanism.scene().where(at) +
                   "its loops, in space, are not written as polynomials: " + why +
                   (why.find("expected") == why.npos ? "; expected --by search" : ""));
}

Pieces::Pieces(const Mechanism& mechanism, double t, const std::vector<Isometry3d>& poses,
               const std::vector<bool>& held)
    : mechanism_(mechanism), poses_(poses), number_(mechanism.tree().bodies.size() + 1) {
  std::iota(number_.begin(), number_.end(), 0);
  add_joints(held);
  add_loops(t);
  for (int& n : number_) n = root(n);
  for (Tie& tie : ties_) {
    tie.first = root(tie.first);
    tie.second = root(tie.second);
  }
}

int Pieces::root(int number) const {
  while (number_[static_cast<std::size_t>(number)] != number)
    number = number_[static_cast<std::size_t>(number)];
  return number;
}

void Pieces::join(int a, int b) {
  const int x = root(a), y = root(b);
  number_[static_cast<std::size_t>(std::max(x, y))] = std::min(x, y);
}

void Pieces::add_joints(const std::vector<bool>& held) {
  const Tree& tree = mechanism_.tree();
  for (const JointSpec& joint : mechanism_.scene().joints) {
    const int child = tree.body(joint.child);
    for (int k = tree.first_part(child); k <= child; ++k) {
      const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
      int loose = 0;
      for (int u = b.u; u < b.u + b.nv; ++u) loose += !held[static_cast<std::size_t>(u)];
      if (loose == 0 && b.kind != JointKind::user) {
        join(b.parent + 1, k + 1);
        continue;
      }
      if (b.kind == JointKind::free && loose == b.nv) continue;
      Tie tie;
      tie.joint = &joint;
      tie.first = b.parent + 1;
      tie.second = k + 1;
      tie.centre = poses_[static_cast<std::size_t>(k)].translation();
      tie.way = poses_[static_cast<std::size_t>(k)].linear().col(2);
      if (loose == b.nv) {
        if (b.kind == JointKind::spherical) tie.kind = Tie::Kind::ball;
        if (b.kind == JointKind::revolute) tie.kind = Tie::Kind::hinge;
        if (b.kind == JointKind::prismatic) tie.kind = Tie::Kind::slide;
      }
      ties_.push_back(tie);
    }
  }
}

void Pieces::add_loops(double t) {
  const Tree& tree = mechanism_.tree();
  for (const LoopSpec& loop : mechanism_.scene().loops) {
    Tie tie;
    tie.loop = &loop;
    tie.first = tie.second = 0;
    if (ties_bodies(loop)) {
      tie.first = tree.body(loop.parent) + 1;
      tie.second = tree.body(loop.child) + 1;
    }
    if (loop.kind == LoopKind::weld)
      join(tie.first, tie.second);
    else
      add_loop(tie, t);
  }
}

void Pieces::add_loop(Tie tie, double t) {
  const Tree& tree = mechanism_.tree();
  const Scene& scene = mechanism_.scene();
  const LoopSpec& l = *tie.loop;
  const auto point = [&](int body, const Vector3d& at) {
    const Vector3d own = tree.point(body, at);
    return body < 0 ? own : Vector3d(poses_[static_cast<std::size_t>(body)] * own);
  };
  const auto direction = [&](int body, const Vector3d& along) {
    const Vector3d own = tree.direction(body, along);
    return body < 0 ? own : Vector3d(poses_[static_cast<std::size_t>(body)].linear() * own);
  };
  const auto with = [&](Tie::Kind kind, int first, int second, const Vector3d& way) {
    tie.kind = kind;
    tie.first = first;
    tie.second = second;
    tie.way = way;
    ties_.push_back(tie);
  };
  const int parent = tie.first - 1, child = tie.second - 1;
  tie.in_part = l.kind != LoopKind::distance &&
                std::any_of(scene.drives.begin(), scene.drives.end(), [&](const DriveSpec& d) {
                  return d.loop == l.name && d.origin.empty();
                });
  if (!ties_bodies(l) || tie.in_part || has_curves(l))
    return with(Tie::Kind::other, parent + 1, child + 1, Vector3d::Zero());
  tie.centre = point(parent, origin_of_loop(scene, l, t));
  const Vector3d first = direction(parent, l.rotation * l.axis.normalized());
  switch (l.kind) {
    case LoopKind::point:
    case LoopKind::spherical:
      return with(Tie::Kind::ball, parent + 1, child + 1, Vector3d::Zero());
    case LoopKind::revolute:
      return with(Tie::Kind::hinge, parent + 1, child + 1, first);
    case LoopKind::prismatic:
      return with(Tie::Kind::slide, parent + 1, child + 1, first);
    case LoopKind::distance:
      return with(Tie::Kind::distance, parent + 1, child + 1,
                  point(child, l.origin_child) - tie.centre);
    case LoopKind::universal:
    case LoopKind::cylindrical: {
      const int between = count();
      number_.push_back(between);
      with(Tie::Kind::hinge, parent + 1, between, first);
      if (l.kind == LoopKind::cylindrical) return with(Tie::Kind::slide, between, child + 1, first);
      const Vector3d axis = l.axis.normalized(),
                     second = l.axis2.isZero() ? perpendicular_to(axis) : l.axis2.normalized();
      return with(Tie::Kind::hinge, between, child + 1, direction(child, second));
    }
    default:
      return with(Tie::Kind::other, parent + 1, child + 1, Vector3d::Zero());
  }
}

std::string Pieces::in_words(int piece) const {
  const auto& bodies = mechanism_.tree().bodies;
  for (std::size_t k = 0; k < bodies.size(); ++k)
    if (!bodies[k].name.empty() && of(static_cast<int>(k)) == piece)
      return "body '" + bodies[k].name + "'";
  return piece == base() ? "the ground" : "the piece inside of a joint or loop";
}

VectorXd Pieces::coordinates(const std::vector<Isometry3d>& displaced, VectorXd q) const {
  const auto& bodies = mechanism_.tree().bodies;
  const auto now = [&](int body) {
    const Isometry3d& by = displaced[static_cast<std::size_t>(of(body))];
    return body < 0 ? by : by * poses_[static_cast<std::size_t>(body)];
  };
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Tree::Body& b = bodies[k];
    const int body = static_cast<int>(k);
    if (b.nv == 0 || of(body) == of(b.parent)) continue;
    const Isometry3d in_joint = b.placement.inverse() * (now(b.parent).inverse() * now(body));
    if (b.kind == JointKind::revolute) {
      const Eigen::Matrix3d r = in_joint.linear();
      q[b.q] = std::atan2(r(1, 0), r(0, 0));
    } else if (b.kind == JointKind::prismatic) {
      q[b.q] = in_joint.translation().z();
    } else {
      const Eigen::Quaterniond rotation(in_joint.linear());
      if (b.kind == JointKind::free) q.segment<3>(b.q) = in_joint.translation();
      q.segment<4>(b.q + b.nq - 4) << rotation.w(), rotation.vec();
    }
  }
  return q;
}

std::vector<TieChain> tie_chains(const Pieces& pieces) {
  const auto n = static_cast<std::size_t>(pieces.count());
  std::vector<std::vector<const Tie*>> at(n);
  for (const Tie& tie : pieces.ties())
    for (const int piece : {tie.first, tie.second})
      at[static_cast<std::size_t>(piece)].push_back(&tie);
  const auto is_end = [&](int piece) {
    return piece == pieces.base() || at[static_cast<std::size_t>(piece)].size() != 2;
  };
  std::vector<const Tie*> taken;
  const auto is_taken = [&](const Tie* tie) {
    return std::find(taken.begin(), taken.end(), tie) != taken.end();
  };
  std::vector<TieChain> chains;
  const auto walk = [&](int from) {
    for (const Tie* next : at[static_cast<std::size_t>(from)]) {
      if (is_taken(next)) continue;
      TieChain chain;
      chain.from = chain.to = from;
      while (next) {
        taken.push_back(next);
        chain.ties.push_back(next);
        chain.to = next->first == chain.to ? next->second : next->first;
        if (is_end(chain.to)) break;
        chain.pieces.push_back(chain.to);
        const auto& both = at[static_cast<std::size_t>(chain.to)];
        next = both[0] == next ? both[1] : both[0];
        if (is_taken(next)) break;
      }
      chains.push_back(std::move(chain));
    }
  };
  std::vector<int> starts(n);
  std::iota(starts.begin(), starts.end(), 0);
  std::stable_sort(starts.begin(), starts.end(), [&](int a, int b) {
    const auto size = [&](int piece) { return at[static_cast<std::size_t>(piece)].size(); };
    if ((a == pieces.base()) != (b == pieces.base())) return a == pieces.base();
    return size(a) > size(b);
  });
  for (const int piece : starts)
    if (is_end(piece)) walk(piece);
  for (const int piece : starts) walk(piece);  // rings apart
  return chains;
}

}  // namespace momenta
