#include <momenta/core/open_chain/poses.h>
#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/actuation.h>
#include <momenta/dae/analysis/effort/closed_motion.h>
#include <momenta/dae/analysis/effort/effort.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace momenta {
namespace {

using Eigen::VectorXd;
constexpr double rounding = 1e-6;  // relative
constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

/// O(bodies)
std::vector<Actuator> at_all_rates(const Mechanism& mechanism) {
  const LoopUnits units(mechanism);
  std::vector<Actuator> all;
  for (const Column& rate : mechanism.rate_columns()) {
    Actuator a;
    a.name = rate.name;
    a.rate = static_cast<int>(all.size());
    a.effort.unit = rate.unit == "rad/s" ? "N m"
                    : rate.unit == "m/s" ? "N"
                                         : "J/" + rate.unit.substr(0, rate.unit.find("/s"));
    a.weight = units.rates[a.rate] * units.rates[a.rate];
    all.push_back(a);
  }
  if (mechanism.scene().lagrangian) {
    const std::vector<Column> coordinates = mechanism.coordinate_columns();
    for (Actuator& a : all) a.name = coordinates[static_cast<std::size_t>(a.rate)].name;
  }
  for (const auto& body : mechanism.tree().bodies) {
    if (body.nv != 1) continue;
    Actuator& a = all[static_cast<std::size_t>(body.u)];
    const std::string number = body.parts == 1 ? "" : std::to_string(body.coordinate);
    a.name = body.joint + (body.parts == 1 ? "" : ".q" + number);
    a.effort.name = body.joint + ".effort" + number;
  }
  for (Actuator& a : all)
    if (a.effort.name.empty()) a.effort.name = a.name + ".effort";
  const std::vector<JointPlace> joints = joint_places(mechanism);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].body < 0) continue;
    const auto& body = mechanism.tree().bodies[static_cast<std::size_t>(joints[i].body)];
    if (body.kind == JointKind::helical && body.nv == 1)
      all[static_cast<std::size_t>(body.u)].helical = static_cast<int>(i);
  }
  return all;
}

int rate_named(const std::vector<Actuator>& all, const std::vector<Column>& rates,
               const std::string& name) {
  std::vector<std::string> known;
  for (const Actuator& a : all) {
    if (name == a.name || name == rates[static_cast<std::size_t>(a.rate)].name ||
        name == a.name + ".q")
      return a.rate;
    known.push_back(a.name);
  }
  throw SceneError("actuator '" + name + "' is not known; expected " +
                   reading::all_in_quotes(known));
}

std::vector<int> actuated_rates(const Mechanism& mechanism, const EffortRequest& request,
                                const std::vector<Actuator>& all,
                                const std::vector<Column>& columns) {
  std::vector<int> rates;
  for (const std::string& name : request.actuated) rates.push_back(rate_named(all, columns, name));
  if (request.actuated.empty()) {
    const Tree& tree = mechanism.tree();
    for (const DriveSpec& drive : request.motion.drives)
      if (!drive.joint.empty())
        rates.push_back(
            tree.bodies[static_cast<std::size_t>(tree.part_of(drive.joint, drive.coordinate))].u);
    if (rates.empty() && mechanism.m() > 0)
      throw SceneError(
          "no coordinate is actuated: the scene has no drives, and loops; expected "
          "actuators" +
          (all.empty() ? std::string() : ", say '" + all.front().name + "'"));
    if (rates.empty()) {
      rates.resize(all.size());
      std::iota(rates.begin(), rates.end(), 0);
    }
  }
  std::vector<int> sorted = rates;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end())
    throw SceneError("actuator '" + all[static_cast<std::size_t>(*twice)].name +
                     "' is named twice; expected each once");
  return rates;
}

class Thrusts {
 public:
  Thrusts(const Mechanism& mechanism, const std::vector<Actuator>& actuators)
      : mechanism_(mechanism),
        actuators_(actuators),
        joints_(joint_places(mechanism)),
        sweep_(make_wrench_sweep(mechanism)),
        poses_(mechanism.tree(), mechanism.scene()) {}

  VectorXd at(const EffortRow& row, const VectorXd& lambda, const LoopIslands& islands,
              const VectorXd& row_units) {
    const std::vector<Eigen::Isometry3d> frames = poses_(row.t, row.q.data());
    const auto through = [&](const VectorXd& u, const VectorXd& udot, const VectorXd& multipliers) {
      sweep_->move(row.t, row.q.data(), u.data(), udot.data(), multipliers.data());
      const Reactions all = sweep_->reactions();
      VectorXd thrust = VectorXd::Constant(row.effort.size(), not_there);
      for (std::size_t i = 0; i < actuators_.size(); ++i) {
        if (actuators_[i].helical < 0) continue;
        const auto joint = static_cast<std::size_t>(actuators_[i].helical);
        const auto k = static_cast<std::size_t>(joints_[joint].body);
        const Eigen::Vector3d axis =
            frames[k].linear() * mechanism_.tree().bodies[k].scene_axes.linear().transpose().col(2);
        thrust[static_cast<Eigen::Index>(i)] = axis.dot(all.joints[joint].force);
      }
      return thrust;
    };
    VectorXd thrust = through(row.u, row.udot, lambda);
    // Thrusts are affine in λ: change by multipliers without effect on the motion.
    VectorXd idle = VectorXd::Zero(lambda.size());
    for (const LoopIsland& island : islands.all()) {
      if (island.rank() == static_cast<int>(island.rows.size())) continue;
      const Eigen::MatrixXd all = island.idle();
      const VectorXd parts = VectorXd::LinSpaced(all.cols(), 1, 1.7);
      LoopIsland::put(island.rows, all * parts, idle);
    }
    if (idle.isZero(0)) return thrust;
    idle = idle.cwiseQuotient(row_units);
    const VectorXd rest = VectorXd::Zero(row.u.size());
    const VectorXd none = VectorXd::Zero(lambda.size());
    const VectorXd change = through(rest, rest, idle) - through(rest, rest, none);
    for (Eigen::Index i = 0; i < thrust.size(); ++i)
      if (std::abs(change[i]) > rounding * idle.cwiseAbs().maxCoeff()) thrust[i] = not_there;
    return thrust;
  }

 private:
  const Mechanism& mechanism_;
  const std::vector<Actuator>& actuators_;
  std::vector<JointPlace> joints_;
  std::unique_ptr<WrenchSweep> sweep_;
  Poses poses_;
};

/// "A (1), B (-0.3)": largest rates of a motion, relative.
std::string moving(const EffortResult& result, const VectorXd& way) {
  constexpr std::size_t most = 4;
  std::vector<int> order(static_cast<std::size_t>(way.size()));
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::abs(way[a]) > std::abs(way[b]); });
  const double first = way[order.front()];
  std::string text;
  for (std::size_t k = 0; k < std::min(most, order.size()); ++k) {
    const double part = way[order[k]] / first;
    if (!(std::abs(part) > 0.01)) break;
    char number[32];
    std::snprintf(number, sizeof number, "%.2g", part);
    text += (text.empty() ? "'" : ", '") + result.rates[static_cast<std::size_t>(order[k])].name +
            "' (" + number + ")";
  }
  return text;
}

EffortResult begin(const Mechanism& mechanism, const EffortRequest& request,
                   std::vector<double>& weights) {
  EffortResult result;
  result.scene = mechanism.scene().name;
  result.coordinates = mechanism.coordinate_columns();
  result.rates = mechanism.rate_columns();
  result.poses_alone = request.motion.poses_alone;
  const std::vector<Actuator> all = at_all_rates(mechanism);
  for (const int rate : actuated_rates(mechanism, request, all, result.rates))
    result.actuators.push_back(all[static_cast<std::size_t>(rate)]);
  weights.assign(result.actuators.size(), 0);
  for (const auto& [name, weight] : request.weights) {
    const int rate = rate_named(all, result.rates, name);
    const auto found = std::find_if(result.actuators.begin(), result.actuators.end(),
                                    [&](const Actuator& a) { return a.rate == rate; });
    if (found == result.actuators.end())
      throw SceneError("weight of '" + name + "': it is not an actuator; expected a weight of one");
    if (!(weight > 0) || !std::isfinite(weight))
      throw SceneError("weight of '" + name + "' is " + reading::digits(weight) +
                       "; expected a number above zero");
    found->weight = weights[static_cast<std::size_t>(found - result.actuators.begin())] = weight;
  }
  return result;
}

}  // namespace

bool EffortResult::has_thrust() const {
  return std::any_of(actuators.begin(), actuators.end(),
                     [](const Actuator& a) { return a.helical >= 0; });
}

Scene undriven(Scene scene, double t) {
  std::vector<std::string> held;
  for (const DriveSpec& drive : scene.drives) {
    expect_effort_of(scene, drive);
    const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                    [&](const JointSpec& j) { return j.name == drive.joint; });
    double f = 0, rate = 0, second = 0;
    MotionLaw(drive).evaluate(t, f, rate, second);
    const auto count = static_cast<std::size_t>(coordinates_of(joint->kind));
    joint->position.resize(count);
    joint->velocity.resize(count);
    joint->position[static_cast<std::size_t>(drive.coordinate)] = f;
    joint->velocity[static_cast<std::size_t>(drive.coordinate)] = rate;
    const auto drives = std::count_if(scene.drives.begin(), scene.drives.end(),
                                      [&](const DriveSpec& d) { return d.joint == drive.joint; });
    if (static_cast<std::size_t>(drives) == count) held.push_back(drive.joint);
  }
  for (const std::string& name : held)
    if (std::find(scene.held.begin(), scene.held.end(), name) == scene.held.end())
      scene.held.push_back(name);
  scene.drives.clear();
  return scene;
}

EffortResult effort(const Mechanism& mechanism, const EffortRequest& request) {
  refuse_bearings(mechanism.scene(), "inverse dynamics");
  if (mechanism.nv() == 0)
    throw SceneError(
        mechanism.scene().where({}) +
        "all joints are welds, so that no effort is needed; expected a joint that moves");
  if (!(request.within > 0) || !std::isfinite(request.within))
    throw SceneError("motion is to be followed within " + reading::digits(request.within) +
                     "; expected a number above zero");
  std::vector<double> weights;
  EffortResult result = begin(mechanism, request, weights);
  const double first = request.motion.table           ? request.motion.table->times().front()
                       : request.motion.times.empty() ? 0
                                                      : request.motion.times.front();
  VectorXd guess = mechanism.tree().q0;
  if (request.motion.table) {
    MotionSource given = request.motion;
    given.hold.clear();
    guess = given_motion(mechanism, guess, given).rows.front().q;
  }
  const VectorXd start =
      assemble(mechanism, first, guess, mechanism.tree().u0, Assembled::rates).start.q;
  const GivenMotion motion = given_motion(mechanism, start, request.motion);
  result.given =
      static_cast<std::size_t>(std::count(motion.given.begin(), motion.given.end(), true));
  ClosedMotion closed(mechanism, motion, start, request.within);
  std::vector<int> rates;
  for (const Actuator& a : result.actuators) rates.push_back(a.rate);
  Actuation actuation(mechanism, rates, weights);
  std::optional<Thrusts> thrusts;
  if (result.has_thrust()) thrusts.emplace(mechanism, result.actuators);
  for (std::size_t i = 0; i < motion.rows.size(); ++i) {
    EffortRow row;
    row.t = motion.rows[i].t;
    closed.go_to(i, row.q, row.u, row.udot);
    if (request.motion.poses_alone) {  // all is at rest
      row.u.setZero();
      row.udot.setZero();
    }
    const Actuation::Unheld unheld = actuation.efforts(closed.loops(), closed.islands(), row.t,
                                                       row.q, row.u, row.udot, row.effort);
    const std::string when = "at t = " + reading::digits(row.t) + " s ";
    if (unheld.missing > request.within) {
      char force[32];
      std::snprintf(force, sizeof force, "%.3g", unheld.force);
      throw SceneError(
          when + "no actuator holds the motion of " + moving(result, unheld.way) +
          ", all others in proportion: a generalised force of " + force +
          " N m, lengths in that of the scene, is missing; expected one more actuator: a "
          "coordinate that moves in it");
    }
    if (!row.effort.allFinite()) {
      const std::string formula = closed.loops().evaluation().formula_without_value();
      throw SceneError(when + "efforts have no finite value" +
                       (formula.empty() ? "; expected forces that have one" : ": " + formula));
    }
    result.missing = std::max(result.missing, unheld.missing);
    result.redundant = std::max(result.redundant, actuation.redundant());
    result.unactuated = std::max(result.unactuated, actuation.unactuated());
    row.power.resize(row.effort.size());
    for (std::size_t k = 0; k < rates.size(); ++k)
      row.power[static_cast<Eigen::Index>(k)] =
          row.effort[static_cast<Eigen::Index>(k)] * row.u[rates[k]];
    row.thrust = VectorXd::Constant(row.effort.size(), not_there);
    if (thrusts)
      row.thrust =
          thrusts->at(row, actuation.multipliers(closed.loops(), closed.islands(), row.effort),
                      closed.islands(), closed.loops().units().equations);
    result.rows.push_back(std::move(row));
  }
  result.gap = closed.largest_gap();
  return result;
}

}  // namespace momenta
