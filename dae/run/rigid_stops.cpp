#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/run/rigid_stops.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace momenta {
namespace {

constexpr double shortest = 1e-8;  ///< flight, part of the run
constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

RigidStops::RigidStops(const Mechanism& mechanism, double span)
    : mechanism_(mechanism), span_(span), impact_(mechanism), acting_(&mechanism) {
  const Tree& tree = mechanism.tree();
  for (const JointSpec& joint : mechanism.scene().joints) {
    if (!joint.restitution) continue;
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(tree.carried_by(joint.name))];
    if (b.nq == 0) continue;
    for (const double side : {-1.0, 1.0})
      stops_.push_back(
          {joint.name, b.q, b.u, side, (*joint.limits)[side > 0 ? 1 : 0], *joint.restitution});
  }
  slack_.assign(stops_.size(), 0);
}

std::string RigidStops::loop_name(std::size_t i) const {
  return "stop of " + stops_[i].joint;
}

RigidStops::Acting& RigidStops::with(const std::set<std::size_t>& held) {
  Acting& made = made_[held];
  if (made.mechanism) return made;
  Scene scene = mechanism_.scene();
  scene.held.clear();  // assembly closes drift where it is least
  for (const std::size_t i : held) {
    LoopSpec loop;
    loop.name = loop_name(i);
    loop.kind = LoopKind::coupler;
    loop.joints = {stops_[i].joint};
    loop.ratios = {1};
    loop.offset = stops_[i].limit;
    scene.loops.push_back(std::move(loop));
  }
  made.mechanism = std::make_unique<Mechanism>(std::move(scene), mechanism_.options());
  made.e = made.mechanism->evaluation<double>();
  if (made.mechanism->m() > 0) made.solver = make_loop_solver(*made.mechanism, *made.e);
  return made;
}

double RigidStops::push(const Mechanism& acting, std::size_t i,
                        const Eigen::VectorXd& lambda) const {
  const auto& rows = acting.rows();
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows[row].loop == loop_name(i))
      return stops_[i].side * lambda[static_cast<Eigen::Index>(row)];
  return 0;
}

bool RigidStops::is_flight(std::size_t i, double off, double pressed) const {
  const double rounding = std::numeric_limits<double>::epsilon() * (1 + std::abs(stops_[i].limit));
  return 2 * off / pressed >= shortest * span_ && off * off / (2 * pressed) >= rounding;
}

double RigidStops::value(std::size_t i, double t, const Eigen::VectorXd& q,
                         const Eigen::VectorXd& u) {
  const Stop& stop = stops_[i];
  if (!held_.contains(i)) return stop.side * (q[stop.q] - stop.limit) - slack_[i];
  udot_.resize(acting_->nv());
  lambda_.resize(acting_->m());
  if (!solving_->solver->acceleration(t, q.data(), u.data(), nullptr, 0, 0, udot_.data(),
                                      lambda_.data()))
    return std::numeric_limits<double>::quiet_NaN();
  return push(*acting_, i, lambda_);
}

void RigidStops::tell(RunResult& told, double t, std::size_t i, const char* what, double before,
                      double after, double impulse) const {
  told.stops.push_back({stops_[i].joint, stops_[i].limit, t, what, before, after, impulse});
}

Start RigidStops::begin(const Start& start, RunResult& told) {
  std::vector<std::size_t> hit;
  for (std::size_t i = 0; i < stops_.size(); ++i) {
    const Stop& stop = stops_[i];
    const double gap = stop.side * (start.q[stop.q] - stop.limit),
                 rounding = 1e-9 * (1 + std::abs(stop.limit));
    if (gap > rounding)
      throw SceneError(mechanism_.scene().where({}) + "joint " + reading::in_quotes(stop.joint) +
                       " starts at " + compact(start.q[stop.q], 6) + ", beyond its rigid stop at " +
                       compact(stop.limit, 6) + ", expected a start within its limits");
    if (gap > -rounding && stop.side * start.u[stop.u] >= 0) hit.push_back(i);
  }
  if (hit.empty()) {
    pause_ = 0;
    return start;
  }
  double taken = 0;
  return behind(start.t, start.q, start.u, hit, told, taken);
}

Start RigidStops::meet(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                       const std::vector<std::size_t>& which, RunResult& told, double& taken) {
  std::vector<std::size_t> hit;
  for (const std::size_t i : which)
    if (held_.erase(i) > 0)
      tell(told, t, i, "released", 0, 0, 0);
    else
      hit.push_back(i);
  return behind(t, q, u, hit, told, taken);
}

Start RigidStops::behind(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& before,
                         const std::vector<std::size_t>& hit, RunResult& told, double& taken) {
  if (!q.allFinite() || !before.allFinite())
    throw std::runtime_error("at t = " + compact(t, 8) +
                             " s, where a rigid stop is met, the state is not finite: the method's "
                             "steps there are too short for its dense output");
  const std::set<std::size_t> held_before = held_;
  std::set<std::size_t> soft;  // stops taken with e = 0
  for (const std::size_t i : hit)
    if (stops_[i].restitution == 0) soft.insert(i);
  // A stop met again at once, without a way that tells, was not left: the flight is below what the
  // method resolves.
  std::set<std::size_t> stuck;
  for (const std::size_t i : hit)
    if (const auto met = last_.find(i); met != last_.end()) {
      const double flight = t - met->second, way = flight * std::abs(before[stops_[i].u]);
      if (flight < shortest * span_ && way < 1e-9 * (1 + std::abs(stops_[i].limit)))
        soft.insert(i), stuck.insert(i);
    }
  for (const std::size_t i : hit) last_[i] = t;
  std::set<std::size_t> through = held_;  // hold at the impact, whatever they do behind it
  std::set<std::size_t> left;             // held stops pushed off by the impact
  for (std::size_t trial = 0; trial <= 4 * stops_.size(); ++trial) {
    std::vector<StopAtImpact> at;
    for (const std::size_t i : hit)
      at.push_back({stops_[i].u, stops_[i].side, soft.contains(i) ? 0 : stops_[i].restitution,
                    false, stuck.contains(i)});
    for (const std::size_t i : through)
      at.push_back({stops_[i].u, stops_[i].side, 0, true, stuck.contains(i)});
    Eigen::VectorXd u = before;
    taken = hit.empty() ? 0 : impact_.jump(t, q, u, at);
    // A stop pushed off by an impact ceases to hold.
    const double still = 1e-9 * (1 + u.cwiseAbs().maxCoeff());
    const auto is_off = [&](std::size_t i) {
      return !stuck.contains(i) && stops_[i].side * u[stops_[i].u] < -still;
    };
    std::copy_if(through.begin(), through.end(), std::inserter(left, left.end()), is_off);
    std::erase_if(held_, is_off);
    if (std::erase_if(through, is_off) > 0) continue;
    std::set<std::size_t> holding = held_;
    Acting& acting = with(holding);
    const Mechanism& now = *acting.mechanism;
    const Assembly assembly = assemble(now, t, q, u);
    const Start& start = assembly.start;
    bool again = false;
    double pause = infinite;
    for (const std::size_t i : hit) {
      const Stop& stop = stops_[i];
      if (holding.contains(i)) continue;
      const double off = -stop.side * u[stop.u], pressed = stop.side * start.udot[stop.u];
      if (!(pressed > 0)) continue;
      if (is_flight(i, off, pressed)) {
        pause = std::min(pause, off / pressed);
        continue;
      }
      again = true;
      // A stop with e = 0 already holds; the rate left, on either side, is an error.
      if (!soft.insert(i).second) held_.insert(i), stuck.insert(i);
    }
    // A stop pushed off for less than a flight holds on: else two that push each other off never
    // rest.
    for (const std::size_t i : left) {
      const Stop& stop = stops_[i];
      const double off = -stop.side * u[stop.u], pressed = stop.side * start.udot[stop.u];
      if (holding.contains(i) || !(pressed > 0) || is_flight(i, off, pressed)) continue;
      again |= held_.insert(i).second;
      through.insert(i), stuck.insert(i);
    }
    for (const std::size_t i : holding)  // let go behind the impact
      if (push(now, i, start.lambda) < 0) again |= held_.erase(i) > 0, left.erase(i);
    if (again) continue;
    for (std::size_t k = 0; k < hit.size(); ++k) {
      const Stop& stop = stops_[hit[k]];
      if (stop.side * before[stop.u] > still)
        tell(told, t, hit[k], "impact", before[stop.u], u[stop.u], at[k].impulse);
    }
    for (const std::size_t i : held_)
      if (!held_before.contains(i)) tell(told, t, i, "held", 0, 0, 0);
    for (const std::size_t i : held_before)
      if (!held_.contains(i)) tell(told, t, i, "released", 0, 0, 0);
    acting_ = held_.empty() ? &mechanism_ : &now;
    solving_ = &acting;
    // If pulled off, no next impact can be foreseen: a short pause covers the first step.
    pause_ = std::isfinite(pause) ? pause : hit.empty() ? 0 : 1e-6 * span_;
    met_ = {hit.begin(), hit.end()};
    for (std::size_t i = 0; i < stops_.size(); ++i)
      slack_[i] = std::max(0.0, stops_[i].side * (start.q[stops_[i].q] - stops_[i].limit));
    return start;
  }
  throw std::runtime_error("at t = " + compact(t, 8) +
                           " s the stops that are met find no state in which each either holds or "
                           "is open");
}

}  // namespace momenta
