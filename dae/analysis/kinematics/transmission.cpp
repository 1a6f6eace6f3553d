#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/transmission.h>
#include <momenta/dae/mechanism/joint_places.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::VectorXd;
constexpr double no_value = std::numeric_limits<double>::quiet_NaN();
constexpr double balanced = 1e-9;  // largest rest of the unit effort, in units
constexpr double whole = 1e-6;     // part of the power that may bypass B
/// Relative singular values of the balance at redundant equations and dead points.
constexpr double balance_pivots = 1e-11;

/// The joint with this rate.
const JointSpec& joint_with(const Mechanism& mechanism, int u, const std::string& output) {
  for (const JointPlace& place : joint_places(mechanism))
    if (std::find(place.u.begin(), place.u.end(), u) != place.u.end())
      for (const JointSpec& joint : mechanism.scene().joints)
        if (joint.name == place.name) return joint;
  throw SceneError("output '" + output +
                   "' is the coordinate of no joint; expected one with a body, whose forces are "
                   "told");
}

}  // namespace

Scene Transmission::with_contacts(Scene scene, const std::string& link, const std::string& joint,
                                  std::vector<Contact>& contacts) {
  scene.markers.clear();
  const auto add = [&](const std::string& name, bool is_loop, std::size_t place,
                       const Eigen::Vector3d& point) {
    contacts.push_back({name, is_loop, place, scene.markers.size()});
    MarkerSpec marker;
    marker.name = "contact " + std::to_string(scene.markers.size());
    marker.body = link;
    marker.point = point;
    scene.markers.push_back(marker);
  };
  for (std::size_t i = 0; i < scene.joints.size(); ++i)
    if (scene.joints[i].parent == link && scene.joints[i].name != joint)
      add(scene.joints[i].name, false, i, scene.joints[i].origin_parent);
  for (std::size_t i = 0; i < scene.loops.size(); ++i) {
    const LoopSpec& loop = scene.loops[i];
    if (loop.kind == LoopKind::coupler) continue;
    if (loop.child == link) add(loop.name, true, i, loop.origin_child);
    if (loop.parent == link) add(loop.name, true, i, loop.origin_parent);
  }
  return scene;
}

Transmission::Transmission(const Mechanism& mechanism, double t, const std::string& output,
                           const std::vector<int>& inputs, std::vector<HeldCoordinate> held)
    : t_(t), inputs_(inputs), held_(std::move(held)) {
  std::tie(output_q_, output_u_) = coordinate_named(mechanism, output);
  const bool is_held = std::any_of(held_.begin(), held_.end(), [&](const HeldCoordinate& h) {
    return h.rates == std::vector<int>{output_u_};
  });
  if (is_held || std::find(inputs.begin(), inputs.end(), output_u_) != inputs.end())
    throw SceneError("output '" + output +
                     "' is swept or held; expected a coordinate that follows the swept one");
  const JointSpec& joint = joint_with(mechanism, output_u_, output);
  joint_ = joint.name;
  mechanism_ = std::make_unique<Mechanism>(
      with_contacts(mechanism.scene(), joint.child, joint.name, contacts_), mechanism.options());
  // Reactions list joints in tree order, by name.
  const std::vector<JointPlace> places = joint_places(*mechanism_);
  for (Contact& contact : contacts_)
    for (std::size_t i = 0; i < places.size() && !contact.is_loop; ++i)
      if (places[i].name == contact.name) contact.place = i;
  loops_ = std::make_unique<ScaledLoops>(*mechanism_);
  wrenches_ = make_wrench_sweep(*mechanism_);
  balance_ = Eigen::MatrixXd::Zero(
      mechanism_->nv(), mechanism_->m() + static_cast<int>(inputs_.size() + held_.size()));
}

/// λ (m); empty where the inputs cannot hold the output.
VectorXd Transmission::multipliers(const VectorXd& q) {
  const int m = mechanism_->m();
  balance_.setZero();
  loops_->gap(t_, q);  // places the loops at q
  const std::vector<double> entries = loops_->jacobian();
  for (std::size_t k = 0; k < entries.size(); ++k)
    balance_(loops_->pattern()[k].column, loops_->pattern()[k].row) = entries[k];
  for (std::size_t i = 0; i < inputs_.size(); ++i)
    balance_(inputs_[i], m + static_cast<int>(i)) = 1;
  auto column = m + static_cast<int>(inputs_.size());
  for (const HeldCoordinate& held : held_)
    balance_.col(column++) = held.row(loops_->evaluation(), q, mechanism_->nv()).transpose();
  VectorXd effort = VectorXd::Zero(mechanism_->nv());
  effort[output_u_] = loops_->units().rates[output_u_];
  solver_.compute(balance_, balance_pivots);
  const VectorXd held = solver_.solve(effort);
  const double left = (balance_ * held - effort).cwiseAbs().maxCoeff();
  if (!(left <= balanced * effort[output_u_])) return {};
  return loops_->in_units(held.head(m));
}

Transmitting Transmission::at(const VectorXd& q) {
  Transmitting found{no_value, no_value, ""};
  const VectorXd lambda = multipliers(q);
  if (lambda.size() == 0) return found;
  const VectorXd rest = VectorXd::Zero(mechanism_->nv());
  const VectorXd no_lambda = VectorXd::Zero(lambda.size());
  // Wrenches are linear in λ: a difference removes the weights and springs of the scene.
  wrenches_->move(t_, q.data(), rest.data(), rest.data(), no_lambda.data());
  const Reactions without = wrenches_->reactions();
  wrenches_->move(t_, q.data(), rest.data(), rest.data(), lambda.data());
  const Reactions with = wrenches_->reactions();
  found.joint_force = 0;
  const auto look = [&](const std::vector<Transmitted>& a, const std::vector<Transmitted>& b) {
    for (std::size_t i = 0; i < a.size(); ++i) {
      const double force = (a[i].force - b[i].force).norm();
      if (force > found.joint_force) {
        found.joint_force = force;
        found.where = a[i].name;
      }
    }
  };
  look(with.joints, without.joints);
  look(with.loops, without.loops);

  // Positions and velocities of the contacts, x y z and ẋ ẏ ż each, while the output has rate 1.
  Evaluation<double>& e = loops_->evaluation();
  VectorXd rate = rest;
  rate[output_u_] = 1;
  std::vector<double> markers(6 * mechanism_->scene().markers.size());
  e.place(t_, q.data());
  e.move(rate.data());
  e.markers(markers.data());
  for (const Contact& contact : contacts_) {
    const auto& a = (contact.is_loop ? with.loops : with.joints)[contact.place];
    const auto& b = (contact.is_loop ? without.loops : without.joints)[contact.place];
    const Eigen::Vector3d force = a.force - b.force;
    const Eigen::Vector3d velocity(markers[6 * contact.marker + 3], markers[6 * contact.marker + 4],
                                   markers[6 * contact.marker + 5]);
    const double power = std::abs(force.dot(velocity));  // part of the output's power 1
    if (std::abs(power - 1) > whole) continue;
    found.angle = std::asin(std::min(1.0, power / (force.norm() * velocity.norm())));
  }
  return found;
}

}  // namespace momenta
