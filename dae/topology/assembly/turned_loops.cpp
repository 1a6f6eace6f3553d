#include <momenta/core/open_chain/poses.h>
#include <momenta/core/scene/reversed.h>
#include <momenta/dae/mechanism/loop/loop_choice.h>
#include <momenta/dae/topology/assembly/closing.h>
#include <momenta/dae/topology/assembly/displacement_of_mass.h>
#include <momenta/dae/topology/assembly/turned_loops.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <unordered_map>

namespace momenta {

std::optional<Scene> with_ordered_ends(const Scene& scene) {
  std::set<std::string> driven;
  for (const DriveSpec& drive : scene.drives) driven.insert(drive.loop);
  std::unordered_map<std::string, int> place;  // the ground before all: 0
  for (const BodySpec& body : scene.bodies)
    place.emplace(body.name, static_cast<int>(place.size()) + 1);
  std::optional<Scene> ordered;
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    const LoopSpec& loop = scene.loops[i];
    if (!can_turn_round(loop) || driven.contains(loop.name)) continue;
    const auto of = [&](const std::string& body) {
      const auto found = place.find(body);
      return found == place.end() ? 0 : found->second;
    };
    if (of(loop.parent) <= of(loop.child)) continue;
    if (!ordered) ordered = scene;
    ordered->loops[i] = reversed(loop);
  }
  return ordered;
}

namespace {

// a_i · b_i is 1 for axes in one, 0 or −1 for turned ones.
constexpr double in_one = 0.5;
constexpr double first_turning = 0.25, least_turning = 1.0 / 128;  // part of the turn in a step
constexpr double longest_turning = 1;                              // [rad or lengths] of any joint
constexpr int most_turnings = 200;
constexpr double half_turn_within = 1e-6;  // [rad]
constexpr double level = 1e-6;             // between components that count as equal
constexpr int most_ways_round = 8;         // choices of the loops' ways round

/// First axis that rows of axes hold in one: three rows hold all, two the third; the one of a
/// universal joint holds none.
int first_axis_held(const LoopChoice& choice) {
  return choice.axes.size() == 3 ? 0 : choice.axes.size() == 2 ? 2 : 3;
}

double value_of(const DriveSpec& drive, double t) {
  double value, rate, second;
  MotionLaw(drive).evaluate(t, value, rate, second);
  return value;
}
/// R₁(f₁) R₂(f₂) … at time t.
Eigen::Matrix3d prescribed(const std::vector<LoopChoice::Along>& turns, double t) {
  Eigen::Matrix3d all = Eigen::Matrix3d::Identity();
  for (const LoopChoice::Along& turn : turns)
    all = all * Eigen::AngleAxisd(value_of(*turn.drive, t), turn.axis);
  return all;
}

/// Direction of a line, the first of its largest components positive.
Eigen::Vector3d with_sense(const Eigen::Vector3d& way) {
  const double largest = way.cwiseAbs().maxCoeff();
  int k = 0;
  while (std::abs(way[k]) < largest - level) ++k;
  return way[k] < 0 ? Eigen::Vector3d(-way) : way;
}

bool is_half_turn(const TurnedLoop& loop) {
  return loop.angle > std::numbers::pi - half_turn_within;
}

/// At half a turn both ways round are as short, and a hinge may turn about any axis across it: the
/// axes of the ground decide, not rounding or the loop frame. `frame`: the loop frame in axes of
/// the ground.
void decide_half_turn(TurnedLoop& loop, const Eigen::Matrix3d& frame, bool of_hinge,
                      const Eigen::Vector3d& hinge) {
  if (!is_half_turn(loop)) return;
  if (of_hinge) {
    const Eigen::Vector3d line = with_sense(frame * hinge), across = perpendicular_to(line);
    loop.axis = frame.transpose() * across;
    loop.other = frame.transpose() * line.cross(across);
  } else {
    loop.axis = loop.other = frame.transpose() * with_sense(frame * loop.axis);
  }
}

/// The turn between axes of the loop, in the loop frame; nothing where they are in one.
std::optional<TurnedLoop> turn_between(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b,
                                       int first) {
  bool turned = false;
  for (int i = first; i < 3; ++i) turned = turned || !(a.col(i).dot(b.col(i)) > in_one);
  if (!turned) return {};
  TurnedLoop loop;
  if (first > 0) {  // a hinge: about any axis across it
    loop.angle = std::acos(std::clamp(a.col(2).dot(b.col(2)), -1.0, 1.0));
    const Eigen::Vector3d across = b.col(2).cross(a.col(2));
    loop.axis = across.norm() > 1e-6 ? Eigen::Vector3d(across.normalized()) : b.col(0);
    loop.other = b.col(2).cross(loop.axis);
    return loop;
  }
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(a * b.transpose()));
  loop.angle = turn.angle();
  loop.axis = loop.other = turn.axis();
  return loop;
}

/// The loops turned by part s of what they are turned by, from s = 1 to s = 0.
class LeadingBack {
 public:
  LeadingBack(const Mechanism& mechanism, double t, const std::vector<TurnedLoop>& turned,
              const std::vector<bool>& columns)
      : mechanism_(mechanism), t_(t), turned_(turned), columns_(columns) {}

  /// From q, the k-th loop turning back the shorter way round where bit k mod 3 of `way` is 0.
  std::optional<Eigen::VectorXd> follow(Eigen::VectorXd q, int way) {
    double s = 1, part = first_turning;
    for (int count = 0; count < most_turnings && part >= least_turning; ++count) {
      const double next = s > part + least_turning ? s - part : 0;
      if (std::optional<Eigen::VectorXd> reached = turned_by(q, next, way)) {
        q = std::move(*reached);
        if ((s = next) == 0) return q;
        part = std::min(first_turning, 1.5 * part);
      } else {
        part *= 0.5;
      }
    }
    return {};
  }

  int iterations() const { return iterations_; }

  /// Whether `way` repeats one of smaller number, as there are few loops and one axis of each.
  bool is_another(int way) const {
    const bool one_axis = std::all_of(turned_.begin(), turned_.end(), [](const TurnedLoop& loop) {
      return loop.axis == loop.other;
    });
    const int loops = static_cast<int>(turned_.size());
    return (loops < 2 && (way & 2)) || (loops < 3 && one_axis && (way & 4));
  }

 private:
  std::optional<Eigen::VectorXd> turned_by(const Eigen::VectorXd& q, double s, int way) {
    Scene scene = mechanism_.scene();
    for (std::size_t k = 0; k < turned_.size(); ++k) {
      const TurnedLoop& turned = turned_[k];
      const bool longer = (way >> (k % 3) & 1) != 0;
      const double angle = longer ? turned.angle - 2 * std::numbers::pi : turned.angle;
      const Eigen::Vector3d& axis = way >= 4 ? turned.other : turned.axis;
      LoopSpec& loop = scene.loops[turned.loop];
      if (loop.kind == LoopKind::rack) {
        loop.offset += s * angle;
        continue;
      }
      const Eigen::Quaterniond whole = loop.rotation;
      loop.rotation = whole * Eigen::Quaterniond(Eigen::AngleAxisd(s * angle, axis));
      loop.origin_parent +=
          s * turned.apart + whole * turned.driven - loop.rotation * turned.driven;
    }
    const Mechanism mechanism(std::move(scene), mechanism_.options());
    ScaledLoops loops(mechanism);
    loops.columns = columns_;
    LeastNorm steps(loops.pattern(), mechanism.m(), mechanism.nv());
    Closing closing(loops, steps, t_);
    const Closing::Pose pose = closing.beside(q);
    iterations_ += closing.iterations();
    if (!pose.is_closed || loops.apart(pose.q, q) > longest_turning ||
        !turned_loops(mechanism, t_, pose.q).empty())
      return {};
    return pose.q;
  }

  const Mechanism& mechanism_;
  double t_;
  const std::vector<TurnedLoop>& turned_;
  const std::vector<bool>& columns_;
  int iterations_ = 0;
};

}  // namespace

std::vector<TurnedLoop> turned_loops(const Mechanism& mechanism, double t,
                                     const Eigen::VectorXd& q) {
  const Scene& scene = mechanism.scene();
  const Tree& tree = mechanism.tree();
  std::vector<TurnedLoop> all;
  std::vector<Eigen::Isometry3d> poses;
  DrivesOfLoops drives = drives_of_loops(scene);
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    const LoopSpec& spec = scene.loops[i];
    if (!ties_bodies(spec)) continue;
    const LoopChoice choice = choose_rows(spec, drives[spec.name], false);
    const bool rack = spec.kind == LoopKind::rack;
    const int first = first_axis_held(choice);
    if (first == 3 && !rack) continue;
    if (poses.empty()) poses = Poses(tree, scene)(t, q.data());
    const auto pose = [&](const std::string& name) {
      const int body = tree.body(name);
      return body < 0 ? Eigen::Isometry3d::Identity() : poses[static_cast<std::size_t>(body)];
    };
    const Eigen::Isometry3d parent = pose(spec.parent);
    const Eigen::Isometry3d in_parent = parent.inverse() * pose(spec.child);
    const Eigen::Matrix3d a = spec.rotation.toRotationMatrix().transpose() * in_parent.linear() *
                              prescribed(choice.turns_a, t) * choice.frame;
    const Eigen::Matrix3d b = prescribed(choice.turns_b, t) * choice.frame;
    if (rack) {
      const Eigen::Vector3d D =
          spec.rotation.conjugate() * (in_parent * spec.origin_child - spec.origin_parent);
      const double phi = b.col(0).dot(D) / spec.radius - spec.offset;
      if (a.col(0).dot(b.col(0)) * std::cos(phi) < a.col(0).dot(b.col(1)) * std::sin(phi))
        all.push_back({i, b.col(2), b.col(2), std::numbers::pi});
      continue;
    }
    if (std::optional<TurnedLoop> turned = turn_between(a, b, first)) {
      turned->loop = i;
      decide_half_turn(*turned, parent.linear() * spec.rotation.toRotationMatrix(), first > 0,
                       b.col(2));
      for (const LoopChoice::Along& way : choice.translations)
        turned->driven += value_of(*way.drive, t) * way.axis;
      turned->apart =
          in_parent * spec.origin_child - spec.origin_parent - spec.rotation * turned->driven;
      for (int k = 0; k < 3; ++k)  // a driven component is not the loop's
        if (drives[spec.name].origin[static_cast<std::size_t>(k)]) turned->apart[k] = 0;
      all.push_back(*turned);
    }
  }
  return all;
}

std::optional<Eigen::VectorXd> led_back(const Mechanism& mechanism, double t,
                                        const Eigen::VectorXd& q,
                                        const std::vector<TurnedLoop>& turned,
                                        const std::vector<bool>& columns, int& iterations) {
  const bool undecided = std::any_of(turned.begin(), turned.end(), is_half_turn);
  LeadingBack leading(mechanism, t, turned, columns);
  std::optional<Eigen::VectorXd> found;
  double least = 0;
  for (int way = 0; way < most_ways_round && (undecided || !found); ++way) {
    if (leading.is_another(way)) continue;
    const std::optional<Eigen::VectorXd> reached = leading.follow(q, way);
    if (!reached) continue;
    const double moved = displacement_of_mass(mechanism, t, q, *reached);
    if (found && !(moved < (1 - level) * least)) continue;
    found = reached;
    least = moved;
  }
  iterations += leading.iterations();
  return found;
}

std::string in_words(const Mechanism& mechanism, const std::vector<TurnedLoop>& turned) {
  constexpr std::size_t most_named = 6;
  const bool one = turned.size() == 1;
  std::string sentence = one ? "loop" : "loops";
  double largest = 0;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    largest = std::max(largest, turned[i].angle);
    if (i < most_named)
      sentence += (i == 0 ? " '" : ", '") + mechanism.scene().loops[turned[i].loop].name + "'";
  }
  if (turned.size() > most_named) sentence += ", …";
  const auto degrees = std::lround(largest * 180 / std::numbers::pi);
  return sentence + (one ? " closes with its axes" : " close with their axes") + " turned by " +
         std::to_string(degrees) + "°";
}

}  // namespace momenta
