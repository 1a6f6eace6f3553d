#include <momenta/dae/analysis/kinematics/pose_space.h>
#include <momenta/dae/analysis/sample/sample.h>
#include <momenta/dae/mechanism/joint_places.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {

using Eigen::VectorXd;

namespace {

constexpr double full_turn = 2 * std::numbers::pi;
constexpr double start_width = 1.5;  // range of starts [lengths]
constexpr double turned_gap = 1e-9;  // largest |Φ| after a full turn, in units

}  // namespace

PoseSpace::PoseSpace(const Mechanism& mechanism, double t, const VectorXd& own, ScaledLoops& loops)
    : own_(own) {
  const auto nq = static_cast<std::size_t>(mechanism.nq());
  places_.assign(nq, Place::length);
  turns_.assign(nq, false);
  lengths_ = VectorXd::Ones(mechanism.nq());
  const std::vector<Column> columns = mechanism.coordinate_columns();
  for (const JointPlace& joint : joint_places(mechanism))
    for (const int at : joint.quaternions) {
      quaternions_.push_back(at);
      for (int k = 0; k < 4; ++k) places_[static_cast<std::size_t>(at + k)] = Place::quaternion;
    }
  const double length = length_of(mechanism.scene());
  for (std::size_t i = 0; i < nq; ++i) {
    if (places_[i] == Place::quaternion) continue;
    const auto k = static_cast<Eigen::Index>(i);
    if (columns[i].unit != "rad") {
      lengths_[k] = length;
      continue;
    }
    places_[i] = Place::angle;
    VectorXd round = own_;
    round[k] += full_turn;
    turns_[i] = mechanism.m() == 0 ||
                (loops.gap(t, round) - loops.gap(t, own_)).cwiseAbs().maxCoeff() < turned_gap;
  }
}

VectorXd PoseSpace::start(std::uint64_t seed, std::size_t i, const std::vector<bool>& held) const {
  VectorXd q = own_;
  const auto drawn = [&](std::size_t k) { return in_unit_interval(noise(seed, k, i)); };
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (held[k] || places_[k] == Place::quaternion) continue;
    const double wide = places_[k] == Place::length ? start_width * lengths_[at]
                        : turns_[k]                 ? full_turn / 2
                                                    : full_turn;
    q[at] += wide * (2 * drawn(k) - 1);
  }
  for (const int at : quaternions_) {  // evenly over rotations: Shoemake, Graphics Gems III, 1992
    const auto k = static_cast<std::size_t>(at);
    const double a = drawn(k), b = full_turn * drawn(k + 1), c = full_turn * drawn(k + 2);
    q.segment<4>(at) << std::sqrt(1 - a) * std::sin(b), std::sqrt(1 - a) * std::cos(b),
        std::sqrt(a) * std::sin(c), std::sqrt(a) * std::cos(c);
  }
  return q;
}

VectorXd PoseSpace::nearest(VectorXd q) const {
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (turns_[k]) q[at] = own_[at] + std::remainder(q[at] - own_[at], full_turn);
  }
  for (const int at : quaternions_)
    if (q.segment<4>(at).dot(own_.segment<4>(at)) < 0) q.segment<4>(at) *= -1;
  return q;
}

double PoseSpace::apart(const VectorXd& a, const VectorXd& b) const {
  double most = 0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(k);
    if (places_[k] == Place::quaternion) continue;
    const double way = (a[at] - b[at]) / lengths_[at];
    most = std::max(most, std::abs(turns_[k] ? std::remainder(way, full_turn) : way));
  }
  for (const int at : quaternions_) {
    const auto x = a.segment<4>(at), y = b.segment<4>(at);
    most = std::max(most, 2 * std::min((x - y).norm(), (x + y).norm()));
  }
  return most;
}

}  // namespace momenta
