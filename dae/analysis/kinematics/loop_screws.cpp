#include <momenta/dae/analysis/kinematics/loop_screws.h>
#include <momenta/dae/analysis/kinematics/turns.h>
#include <momenta/dae/analysis/sample/sample.h>

#include <cmath>

namespace momenta {
namespace {

using Eigen::AngleAxisd;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Vector3d any_vector(std::uint64_t number) {
  Vector3d v;
  for (int k = 0; k < 3; ++k)
    v[k] = 2 * in_unit_interval(noise(6, static_cast<std::uint64_t>(k), number)) - 1;
  return v;
}

}  // namespace

DualQuaternion LoopScrew::line(double length) const {
  DualQuaternion l = DualQuaternion::Zero();
  if (slides)
    l.tail<4>() = pure(way);
  else
    l << pure(way), pure((centre / length).cross(way));
  return l;
}

Isometry3d LoopScrew::displacement(double tangent, double length) const {
  if (!slides) return turned_about(centre, Quaterniond(AngleAxisd(2 * std::atan(tangent), way)));
  Isometry3d d = Isometry3d::Identity();
  d.translate(2 * tangent * length * way);
  return d;
}

LoopScrews::LoopScrews(TieChain chain, double length) : chain_(std::move(chain)), length_(length) {
  int at = chain_.from;
  for (std::size_t i = 0; i < chain_.ties.size(); ++i) {
    const Tie& tie = *chain_.ties[i];
    const int number = static_cast<int>(i);
    if (tie.kind == Tie::Kind::hinge || tie.kind == Tie::Kind::slide) {
      add(number, tie.centre, tie.way, tie.kind == Tie::Kind::slide);
    } else if (tie.kind == Tie::Kind::distance) {
      const bool along = tie.first == at;
      const Vector3d end = tie.centre + tie.way;
      add_half_ball(number, along ? tie.centre : end, along ? tie.way : Vector3d(-tie.way));
      add_ball(number, along ? end : tie.centre);
    } else if (is_rod(i)) {
      add_half_ball(number, tie.centre, chain_.ties[i + 1]->centre - tie.centre);
      ++idle_;
    } else {
      add_ball(number, tie.centre);
    }
    at = tie.first == at ? tie.second : tie.first;
  }
  freedoms_ = static_cast<int>(screws_.size());
  if (freedoms_ < 6) fill_up();
}

/// Whether a tie is the first ball of a rod.
bool LoopScrews::is_rod(std::size_t tie) const {
  const auto is_ball = [&](std::size_t k) { return chain_.ties[k]->kind == Tie::Kind::ball; };
  if (tie + 1 >= chain_.ties.size() || !is_ball(tie) || !is_ball(tie + 1)) return false;
  return tie == 0 || !is_rod(tie - 1);
}

void LoopScrews::add(int tie, const Vector3d& centre, const Vector3d& way, bool slides) {
  screws_.push_back({centre, way, slides, tie});
}

void LoopScrews::add_ball(int tie, const Vector3d& centre) {
  const Eigen::Matrix3d axes = Quaterniond(1, 0.3, -0.5, 0.7).normalized().toRotationMatrix();
  for (int k = 0; k < 3; ++k) add(tie, centre, axes.col(k));
  copies_ *= 2;
}

void LoopScrews::add_half_ball(int tie, const Vector3d& centre, const Vector3d& rod) {
  const Vector3d second = rod.cross(any_vector(0)).normalized(),
                 first = AngleAxisd(1, second) * rod.normalized();
  add(tie, centre, first);
  add(tie, centre, second);
  copies_ *= 2;
}

void LoopScrews::fill_up() {
  std::vector<LoopScrew> all;
  const std::size_t own = screws_.size();
  for (std::size_t k = 0; all.size() < 6; ++k) {
    if (k < own) all.push_back(screws_[k]);
    const bool full = all.size() + (k < own ? own - k - 1 : 0) >= 6;
    if (!full)
      all.push_back(
          {length_ * any_vector(2 * k + 1), any_vector(2 * k + 2).normalized(), false, -1});
  }
  screws_ = std::move(all);
}

std::vector<Isometry3d> LoopScrews::displaced(const std::array<double, 6>& tangents) const {
  std::vector<Isometry3d> pieces(chain_.pieces.size(), Isometry3d::Identity());
  Isometry3d d = Isometry3d::Identity();
  for (std::size_t k = 0; k < 6; ++k) {
    const LoopScrew& screw = screws_[k];
    if (screw.fills()) continue;
    d = d * screw.displacement(tangents[k], length_);
    const auto tie = static_cast<std::size_t>(screw.tie);
    if (tie < pieces.size()) pieces[tie] = d;
  }
  for (std::size_t i = 0; i < chain_.ties.size(); ++i) {
    if (!is_rod(i)) continue;
    const Vector3d b = chain_.ties[i]->centre, p = chain_.ties[i + 1]->centre;
    const Isometry3d before = i > 0 ? pieces[i - 1] : Isometry3d::Identity(),
                     after = i + 1 < pieces.size() ? pieces[i + 1] : Isometry3d::Identity();
    pieces[i] = before * turned_about(b, Quaterniond::FromTwoVectors(
                                             p - b, before.inverse() * (after * p) - b));
  }
  return pieces;
}

}  // namespace momenta
