#include <momenta/core/scene/drive.h>
#include <momenta/dae/kkt/bearing_friction.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace momenta {

std::string replaced_rates_in_words(const Mechanism& mechanism, const Start& start) {
  constexpr double kept = 1e-3;
  constexpr int most_named = 6;
  const Eigen::VectorXd& given = mechanism.tree().u0;
  if (mechanism.m() == 0 || given.size() == 0 || given.isZero(0)) return "";
  const auto columns = mechanism.rate_columns();
  const double largest = given.cwiseAbs().maxCoeff();
  std::string changes;
  int count = 0;
  for (Eigen::Index i = 0; i < given.size(); ++i) {
    if (given[i] == 0 || !(std::abs(start.u[i] - given[i]) > kept * largest)) continue;
    if (++count > most_named) continue;
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, " from %.4g to %.4g ", given[i], start.u[i]);
    const auto& column = columns[static_cast<std::size_t>(i)];
    changes += (changes.empty() ? "" : ", ") + column.name + numbers + column.unit;
  }
  if (count == 0) return "";
  if (count > most_named) changes += " and " + std::to_string(count - most_named) + " more";
  return "start rates replaced by the nearest that the " +
         std::string(mechanism.scene().lagrangian ? "constraints" : "loops") + " allow: " + changes;
}

namespace {

[[noreturn]] void refuse_without_inertia(const Mechanism& mechanism, Evaluation<double>& e,
                                         const Start& s, int rate) {
  expect_no_lost_loop(mechanism, e);
  throw SceneError(
      mechanism.scene().where({}) +
      (mechanism.scene().lagrangian ? "" : "the mechanism cannot move at its start: ") +
      momenta::no_inertia(mechanism, rate, s.t, s.q.data()));
}

/// Names the drive whose second derivative has no value, if there is one.
[[noreturn]] void refuse_without_value(const Scene& scene, double t) {
  char at[48];
  std::snprintf(at, sizeof at, "at t = %.6g s", t);
  for (const DriveSpec& drive : scene.drives) {
    double f = 0, rate = 0, second = 0;
    MotionLaw(drive).evaluate(t, f, rate, second);
    if (!std::isfinite(second))
      throw SceneError(scene.where(drive.at) + "the drive of " +
                       (drive.loop.empty() ? "joint '" + drive.joint : "loop '" + drive.loop) +
                       "' has no finite second derivative " + at +
                       "; expected a law with one, as accelerations and forces follow from it");
  }
  throw SceneError(scene.where({}) + "the accelerations have no finite value " + at +
                   "; expected forces and laws that have one there");
}

/// Fills udot and lambda; `tau` (nv): forces of friction, or null.
void solve_for_accelerations(const Mechanism& mechanism, Evaluation<double>& e, Start& s,
                             const double* tau) {
  const auto no_inertia = [&](int rate) { refuse_without_inertia(mechanism, e, s, rate); };
  if (const UnheldJoints unheld = unheld_by_rounding(mechanism, e, s.t, s.q.data());
      !unheld.joints.empty())
    no_inertia(unheld.joints.front().rate);
  if (mechanism.m() == 0) {
    if (!e.open_accelerations(s.t, s.q.data(), s.u.data(), s.udot.data()))
      no_inertia(e.singular_joint());
    return;
  }
  if (mechanism.solver().by_sweeps()) {
    const auto solver = make_loop_solver(mechanism, e);
    solver->push(tau);
    if (!solver->acceleration(s.t, s.q.data(), s.u.data(), nullptr, 0, 0, s.udot.data(),
                              s.lambda.data()))
      no_inertia(solver->singular_joint());
    return;
  }
  const auto kkt = make_kkt(mechanism);
  if (!kkt->factor(e, s.t, s.q.data(), fade_evaluation)) no_inertia(kkt->singular_joint());
  e.move(s.u.data());
  Eigen::VectorXd r(mechanism.nv()), g(mechanism.m());
  e.joint_forces(s.q.data(), s.u.data(), nullptr, nullptr, r.data());
  e.accelerations(g.data());
  r = -r;
  if (tau) r += Eigen::Map<const Eigen::VectorXd>(tau, mechanism.nv());
  g = -g;
  if (!kkt->solve(r.data(), g.data(), nullptr, s.udot.data(), s.lambda.data())) no_inertia(-1);
}

}  // namespace

void expect_no_lost_loop(const Mechanism& mechanism, Evaluation<double>& e) {
  if (const std::string lost = e.lost_loop(); !lost.empty())
    throw SceneError(mechanism.scene().where({}) +
                     "the mechanism cannot be assembled from these positions: " + lost +
                     "; expected a start where it has both");
}

void start_accelerations(const Mechanism& mechanism, Evaluation<double>& e, Start& s) {
  s.udot = Eigen::VectorXd::Zero(mechanism.nv());
  s.lambda = Eigen::VectorXd::Zero(mechanism.m());
  if (mechanism.nv() == 0) return;
  e.place(s.t, s.q.data());
  if (mechanism.has_forces_apart()) {
    e.move(s.u.data());
    if (const std::string formula = e.formula_without_value(); !formula.empty())
      throw SceneError(formula);
  }
  const auto friction = bearing_friction(mechanism);
  if (friction) {
    const std::string joint = friction->undetermined(s.t, s.q.data(), s.u.data());
    if (!joint.empty())
      throw SceneError(mechanism.scene().where({}) + "joint '" + joint +
                       "' has a bearing, and the force in it is not unique, as loop equations "
                       "depend on each other: expected loops that tie less (momenta check names "
                       "them), or no bearing");
    if (!friction->at(s.t, s.q.data(), s.u.data()))
      throw SceneError(mechanism.scene().where({}) + friction->failure());
    e.push(friction->forces());
  }
  solve_for_accelerations(mechanism, e, s, friction ? friction->forces() : nullptr);
  e.push(nullptr);
  if (!s.udot.allFinite() || !s.lambda.allFinite()) refuse_without_value(mechanism.scene(), s.t);
}

}  // namespace momenta
