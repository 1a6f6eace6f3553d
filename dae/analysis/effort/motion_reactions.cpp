#include <momenta/dae/analysis/effort/motion_reactions.h>
#include <momenta/dae/mechanism/joint_places.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr std::array<const char*, 8> parts{".force",  ".force_x",  ".force_y",  ".force_z",
                                           ".torque", ".torque_x", ".torque_y", ".torque_z"};
constexpr auto width = static_cast<Index>(parts.size());

/// 1: ground is the parent of the joint or loop, −1: the child, 0: neither.
template <class Specs>
int on_ground(const Specs& specs, const std::string& name) {
  const auto found =
      std::find_if(specs.begin(), specs.end(), [&](const auto& spec) { return spec.name == name; });
  if (found == specs.end()) return 0;
  return found->parent == "ground" ? 1 : found->child == "ground" ? -1 : 0;
}

/// Sizes from components, NaN included.
void take_sizes(VectorXd& values) {
  for (Index at = 0; at < values.size(); at += 4) values[at] = values.segment<3>(at + 1).norm();
}

}  // namespace

std::vector<std::string> MotionReactions::names(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian) return {};
  std::vector<std::string> all;
  for (const JointPlace& joint : joint_places(mechanism)) all.push_back(joint.name);
  for (const LoopSpec& loop : mechanism.scene().loops) all.push_back(loop.name);
  all.emplace_back("ground");
  std::vector<std::string> names;
  for (const std::string& name : all)
    for (const char* part : parts) names.push_back(name + part);
  return names;
}

MotionReactions::MotionReactions(const Mechanism& mechanism, int rate)
    : mechanism_(mechanism),
      loops_(mechanism),
      islands_(mechanism),
      actuation_(mechanism, {rate}, {0}),
      sweep_(make_wrench_sweep(mechanism)) {
  loops_.rows.assign(loops_.rows.size(), true);
}

VectorXd MotionReactions::transmitted(const VectorXd& q, const VectorXd& u, const VectorXd& udot,
                                      const VectorXd& lambda) {
  sweep_->move(0, q.data(), u.data(), udot.data(), lambda.data());
  const Reactions all = sweep_->reactions();
  VectorXd values =
      VectorXd::Zero(static_cast<Index>(all.joints.size() + all.loops.size() + 1) * width);
  Index next = 0;
  auto ground = values.tail(width);
  const auto take = [&](const Transmitted& t, int sign) {
    values.segment<3>(next + 1) = t.force;
    values.segment<3>(next + 5) = t.torque;
    next += width;
    ground.segment<3>(1) += sign * t.force;
    ground.segment<3>(5) += sign * (t.torque + t.at.cross(t.force));
  };
  for (const Transmitted& t : all.joints) take(t, on_ground(mechanism_.scene().joints, t.name));
  for (const Transmitted& t : all.loops) take(t, on_ground(mechanism_.scene().loops, t.name));
  return values;
}

VectorXd MotionReactions::at(const VectorXd& q, const VectorXd& u, const VectorXd& udot) {
  if (!contradiction_) contradiction_ = contradiction(loops_, 0, q, independent_pivot);
  (void)loops_.gap(0, q);
  islands_.factor(loops_, contradiction_->pivot);
  VectorXd tau;
  (void)actuation_.efforts(loops_, islands_, 0, q, u, udot, tau);
  const VectorXd lambda = actuation_.multipliers(loops_, islands_, tau);
  VectorXd values = transmitted(q, u, udot, lambda);
  // Wrenches are affine in λ: change by multipliers without effect on the motion.
  const VectorXd rest = VectorXd::Zero(u.size()), none = VectorXd::Zero(lambda.size());
  constexpr double rounding = 1e-9;
  for (const LoopIsland& island : islands_.all()) {
    if (island.rank() == static_cast<int>(island.rows.size())) continue;
    const MatrixXd idle = island.idle();
    for (Index k = 0; k < idle.cols(); ++k) {
      VectorXd along = none;
      LoopIsland::put(island.rows, idle.col(k), along);
      along = along.cwiseQuotient(loops_.units().equations);
      const VectorXd change = transmitted(q, rest, rest, along) - transmitted(q, rest, rest, none);
      const double most = change.cwiseAbs().maxCoeff();
      for (Index i = 0; i < values.size(); ++i)
        if (std::abs(change[i]) > rounding * most)
          values[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  take_sizes(values);
  return values;
}

}  // namespace momenta
