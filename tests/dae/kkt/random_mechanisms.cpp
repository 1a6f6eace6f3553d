// Laws on random small mechanisms, by rapidcheck: every kind of joint and loop. A counterexample is
// made smaller by leaving out bytes of what the mechanism was made from, and told in outline.
// Another search: RC_PARAMS="seed=7 max_success=1000".

#include "equations/ensemble.h"
#include "equations/recut.h"
#include "equations/runs.h"
#include "equations/small_scenes.h"

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <vector>

namespace momenta::dae_random_mechanisms {
namespace {

using namespace equations;
using Bytes = std::vector<unsigned char>;
using Eigen::VectorXd;

// The same scenes each time, unless asked for others.
[[maybe_unused]] const int fixed_seed =
    setenv("RC_PARAMS", "seed=1 max_success=60 max_size=150", 0);

struct Ready {
  std::unique_ptr<Mechanism> mechanism;
  Start start;
};
/// Assembled and regular: all rows of the loops independent, none weakly so. Else nothing.
std::optional<Ready> regular(const Scene& scene) {
  try {
    validate(scene);
    Ready r{std::make_unique<Mechanism>(scene), {}};
    r.start = equations::start_of(*r.mechanism);
    const RankReport rank = rank_report(*r.mechanism, r.start);
    if (rank.rank < r.mechanism->m() || rank.rank_nearby < r.mechanism->m() || rank.kept < 1e-2)
      return std::nullopt;
    if (r.mechanism->nv() == r.mechanism->m()) return std::nullopt;  // nothing moves
    return r;
  } catch (const SceneError&) {  // loops that do not close
    return std::nullopt;
  }
}

RunResult run_of(const Ready& r, double step = 0) {
  RunRequest request =
      equations::kept(equations::adaptive("momentum", step > 0 ? "rk4" : "dop853", "reset", 1e-11,
                                          r.mechanism->scene().run.end_time, 4));
  request.settings.step = step;
  request.settings.project = true;
  request.max_cpu_seconds = 5;  // none takes a hundredth of it
  return run_form(*r.mechanism, r.start, request);
}

/// Whether two runs say the same of one quantity; large numbers are compared relatively.
bool same(double a, double b, double tolerance) {
  return std::abs(a - b) <= tolerance * (1 + std::abs(b));
}

/// A run that comes near to no singular pose; there the least difference grows.
bool smooth(const RunResult& run) {
  return run.status == "done" && run.singular_crossings.empty();
}

void expect_same_coordinates(const Ready& a, const RunResult& x, const RunResult& y,
                             double tolerance) {
  const auto &p = x.trajectory.rows.back(), &q = y.trajectory.rows.back();
  for (int i = 1; i <= a.mechanism->nq() + a.mechanism->nv(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    RC_ASSERT(same(p[at], q[at], tolerance));
  }
}

RC_GTEST_PROP(RandomMechanisms, GaugeShiftsMomentaAndImpulsesAndNothingElse, (const Bytes& bytes)) {
  const Scene scene = sound_scene(bytes);
  RC_LOG() << outline(scene);
  const auto r = regular(scene);
  RC_PRE(r.has_value());
  const auto form = make_form("momentum", *r->mechanism, {}, r->start);
  auto y = form->initial(r->start);
  Snapshot before, after;
  RC_ASSERT(form->read(0, y.data(), nullptr, before));
  const auto e = r->mechanism->evaluation<double>();
  const VectorXd c = VectorXd::LinSpaced(r->mechanism->m(), 1, -2);
  VectorXd load(r->mechanism->nv());
  e->place(0, before.q.data());
  e->constraint_forces(c.data(), load.data());
  for (Eigen::Index i = 0; i < load.size(); ++i)
    y[static_cast<std::size_t>(before.q.size() + i)] += load[i];
  RC_ASSERT(form->read(0, y.data(), nullptr, after));
  RC_ASSERT((after.u - before.u).norm() <= 1e-9 * (1 + before.u.norm()));
  RC_ASSERT((after.multipliers - before.multipliers - c).norm() <= 1e-8 * (1 + c.norm()));
}

RC_GTEST_PROP(RandomMechanisms, EnergyChangesByTheDissipatedPower, (const Bytes& bytes)) {
  const Scene scene = sound_scene(bytes);
  RC_LOG() << outline(scene);
  const auto r = regular(scene);
  RC_PRE(r.has_value());
  const RunResult run = run_of(*r);
  RC_PRE(smooth(run));
  RC_ASSERT(run.energy_error_max <= 1e-8 * (1 + run.energy_scale));
  RC_ASSERT(run.position_drift_max <= 1e-9);
  RC_ASSERT(run.velocity_drift_max <= 1e-9 * (1 + std::sqrt(run.kinetic_energy_max)));
}

RC_GTEST_PROP(RandomMechanisms, MoveAlikeInATurnedAndShiftedRoom, (const Bytes& bytes)) {
  Scene scene = sound_scene(bytes);
  RC_LOG() << outline(scene);
  const auto r = regular(scene);
  RC_PRE(r.has_value());
  const Eigen::Vector3d shift(3, -2, 1.5);
  for (JointSpec& j : scene.joints)
    if (j.parent == "ground") j.origin_parent += shift;
  for (LoopSpec& l : scene.loops)
    if (l.parent == "ground") l.origin_parent += shift;
  for (ForceSpec& f : scene.forces)
    if (f.kind == "spring-damper" && f.parent == "ground") f.origin_parent += shift;
  auto other = regular(turned(scene, Eigen::Quaterniond(0.3, -0.6, 0.2, 0.5).normalized()));
  RC_ASSERT(other.has_value());
  // Of starts that the loops allow the nearest is taken, by a length of the scene that is measured
  // along its axes: the same for both.
  other->start.q = r->start.q;
  other->start.u = r->start.u;
  const RunResult plain = run_of(*r), moved = run_of(*other);
  RC_PRE(smooth(plain) && smooth(moved));
  expect_same_coordinates(*r, moved, plain, 1e-7);
}

RC_GTEST_PROP(RandomMechanisms, MoveAlikeInOtherUnits, (const Bytes& bytes)) {
  const Scene scene = sound_scene(bytes);
  RC_LOG() << outline(scene);
  const auto r = regular(scene);
  RC_PRE(r.has_value());
  const Units units{0.0254, 60, 0.4536};
  const auto other = regular(in_units(scene, units));
  RC_ASSERT(other.has_value());
  // The same steps, so that rounding alone is between them.
  const RunResult plain = run_of(*r, scene.run.end_time / 200),
                  scaled = run_of(*other, other->mechanism->scene().run.end_time / 200);
  RC_PRE(smooth(plain) && smooth(scaled));
  const auto &p = plain.trajectory.rows.back(), &q = scaled.trajectory.rows.back();
  for (const auto& b : r->mechanism->tree().bodies) {
    for (int i = 0; i < b.nq; ++i) {
      const bool length = b.kind == JointKind::prismatic || (b.nq == 7 && i < 3);
      const auto at = static_cast<std::size_t>(1 + b.q + i);
      RC_ASSERT(same(q[at] / (length ? units.length : 1), p[at], 1e-8));
    }
    for (int i = 0; i < b.nv; ++i) {
      const bool length = b.kind == JointKind::prismatic || (b.nv == 6 && i < 3);
      const auto at = static_cast<std::size_t>(1 + r->mechanism->nq() + b.u + i);
      RC_ASSERT(same(q[at] * units.time / (length ? units.length : 1), p[at], 1e-7));
    }
  }
}

/// How far the hinges have turned, by name.
std::map<std::string, double> turns(const RunResult& run) {
  std::map<std::string, double> by_name;
  const auto& t = run.trajectory;
  for (std::size_t i = 0; i < t.columns.size(); ++i)
    if (t.columns[i].ends_with(".q [rad]"))
      by_name[t.columns[i]] = t.rows.back()[i] - t.rows.front()[i];
  return by_name;
}

RC_GTEST_PROP(RandomMechanisms, MoveAlikeCutAnywhere, (const Bytes& bytes, unsigned char where)) {
  Scene scene = sound_scene(bytes, true);
  for (JointSpec& j : scene.joints) j.rotor_inertia.clear();  // they keep a joint from being a loop
  RC_LOG() << outline(scene);
  const auto r = regular(scene);
  RC_PRE(r.has_value());
  const std::string cut = scene.joints[where % scene.joints.size()].name;
  const Scene elsewhere = recut(scene, r->mechanism->tree(), r->start.q, cut, "loop");
  RC_ASSERT(elsewhere.joints.size() == scene.joints.size());
  const auto other = regular(elsewhere);
  RC_PRE(other.has_value());  // weak rows of one cut may be strong ones of another
  const RunResult here = run_of(*r), there = run_of(*other);
  RC_PRE(smooth(here) && smooth(there));
  const auto expected = turns(here);
  int common = 0;
  for (const auto& [name, angle] : turns(there)) {
    if (!expected.contains(name)) continue;
    ++common;
    RC_ASSERT(same(angle, expected.at(name), 1e-7));
  }
  RC_ASSERT(common == static_cast<int>(scene.joints.size()) - 1);
}

}  // namespace
}  // namespace momenta::dae_random_mechanisms
