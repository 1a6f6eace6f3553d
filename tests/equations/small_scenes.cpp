#include "equations/small_scenes.h"

#include "equations/any_text.h"
#include "equations/parts.h"
#include "equations/random_loops.h"
#include "equations/runs.h"

#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/extremes.h>

#include <cmath>
#include <exception>

namespace momenta::equations {
namespace {

void add_loop(RandomTree& random, Scene& s, bool planar) {
  if (random.chance(0.15)) {
    if (auto coupler = random_coupler(random, s)) s.loops.push_back(*std::move(coupler));
    return;
  }
  const auto any = [&](const auto& kinds) {
    return kinds[static_cast<std::size_t>(random.below(static_cast<int>(kinds.size())))];
  };
  LoopSpec l = random_loop(random, s, planar ? any(planar_loop_kinds) : any(loop_kinds));
  if (planar) {
    const Tree tree = build_tree(s);
    const auto axes = axes_at_zero(s);
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
    for (const JointSpec& j : s.joints)
      if (j.kind == JointKind::revolute || j.kind == JointKind::planar)
        normal = axes.at(j.child) * j.axis;
    l = into_plane(random, s, l, normal);
    level(l, s, tree, normal);
  }
  if (random.chance(0.6)) close(l, s, build_tree(s));
  if (random.chance(0.3)) {
    const int origins = random.below(8), coordinates = random.below(8);
    drive_loop(random, s, l, coordinates, origins);
  }
  s.loops.push_back(l);
  if (random.chance(0.2)) {
    l.name += "again";
    s.loops.push_back(l);
  }
}

/// What no careful author writes, and the program meets all the same.
void make_odd(RandomTree& random, Scene& s) {
  const auto body = [&]() -> BodySpec& {
    return s.bodies[static_cast<std::size_t>(random.below(static_cast<int>(s.bodies.size())))];
  };
  switch (random.below(8)) {
    case 0: {
      BodySpec& b = body();
      b.mass = 0;
      b.inertia.setZero();
      break;
    }
    case 1:
      body().inertia.setZero();
      break;
    case 2:
      for (LoopSpec& l : s.loops) l.origin_parent.setZero(), l.origin_child.setZero();
      break;
    case 3:
      for (JointSpec& j : s.joints) j.origin_parent.setZero();
      break;
    case 4: {
      s.bodies.front().mass *= std::pow(10.0, random.below(601) - 300);
      break;
    }
    default: {
      const auto extreme = static_cast<Extreme>(random.below(6));
      if (lacks(s, extreme).empty())
        s = driven_to(s, extreme, std::pow(10.0, random.below(25) - 12));
    }
  }
}

constexpr std::array forms{"momentum",
                           "projected",
                           "momentum-index2",
                           "stabilised-index2",
                           "baumgarte",
                           "partitioned",
                           "acceleration-index3",
                           "augmented-lagrangian",
                           "momentum-stabilised",
                           "augmented-lagrangian-canonical",
                           "acceleration"};

}  // namespace

std::string form_for(std::span<const unsigned char> bytes) {
  return forms[bytes.empty() ? 0 : bytes.back() % forms.size()];
}

Scene small_scene(std::span<const unsigned char> bytes) {
  RandomTree random(bytes);
  TreeRecipe recipe;
  recipe.bodies = 1 + random.below(6);
  recipe.branching = static_cast<Branching>(random.below(3));
  recipe.placing = static_cast<Placing>(random.below(3));
  recipe.gravity = random.chance(0.7);
  recipe.drives = random.chance(0.3);
  recipe.joint_forces = random.chance(0.4);
  recipe.body_forces = random.chance(0.4);
  const bool planar = random.chance(0.4);
  Scene s = planar ? random.planar_scene(recipe) : random.scene(recipe);
  for (JointSpec& j : s.joints)
    if (has_one_coordinate(j.kind) && random.chance(0.7)) {
      bool driven = false;
      for (const DriveSpec& d : s.drives) driven |= d.joint == j.name;
      if (driven) continue;
      j.position = {random.uniform(-1, 1)};
      j.velocity = {random.uniform(-2, 2)};
    }
  for (int loops = random.below(4); loops > 0; --loops) add_loop(random, s, planar);
  if (random.chance(0.4)) make_odd(random, s);
  s.run.end_time = 0.1;
  return s;
}

Scene sound_scene(std::span<const unsigned char> bytes, bool planar) {
  RandomTree random(bytes);
  TreeRecipe recipe;
  recipe.bodies = (planar ? 3 : 2) + random.below(4);
  recipe.drives = false;
  recipe.joint_forces = random.chance(0.5);
  recipe.body_forces = random.chance(0.5);
  if (planar) {
    recipe.branching = Branching::serial;
    recipe.kinds = {JointKind::revolute};
  }
  Scene s = planar ? random.planar_scene(recipe) : random.scene(recipe);
  const Tree tree = build_tree(s);
  if (planar) {
    LoopSpec l = make_loop(LoopKind::revolute, "loop", "ground", s.bodies.back().name, {0, 0, 0},
                           random.vector(0.6));
    l.axis = axes_at_zero(s).at(l.child).conjugate() *
             (axes_at_zero(s).at(s.joints.back().child) * s.joints.back().axis);
    close(l, s, tree);
    s.loops.push_back(l);
  } else {
    for (JointSpec& j : s.joints)
      for (int i = 0; i < rates_of(j.kind); ++i) j.velocity.push_back(random.uniform(-1, 1));
    LoopSpec l = random_loop(
        random, s,
        loop_kinds[static_cast<std::size_t>(random.below(static_cast<int>(loop_kinds.size())))]);
    if (l.kind != LoopKind::distance) close(l, s, tree);
    s.loops.push_back(l);
  }
  s.run.end_time = 0.2;
  return s;
}

std::string outline(const Scene& scene) {
  std::string text;
  const auto add = [&](const auto& name, std::string_view kind, const auto& a, const auto& b) {
    text += name + " " + std::string(kind) + ": " + a + " - " + b + "\n";
  };
  for (const JointSpec& j : scene.joints) add(j.name, reading::name_of(j.kind), j.parent, j.child);
  for (const LoopSpec& l : scene.loops) add(l.name, reading::name_of(l.kind), l.parent, l.child);
  return text + std::to_string(scene.forces.size()) + " forces\n";
}

Tried try_scene(const Scene& scene, const std::string& form, double seconds) {
  RunResult run;
  int m = 0;
  try {
    validate(scene);
    const Mechanism mechanism(scene);
    m = mechanism.m();
    const Assembly assembly = assemble(mechanism);
    if (!assembly.start.q.allFinite() || !assembly.start.u.allFinite())
      return {"assembled to what is not finite"};
    if (m > 0 && rank_report(mechanism, assembly.start).rank > m) return {"rank above m"};
    plan_lines(mechanism);
    RunRequest request = kept(adaptive(form, "", "leak", 1e-5, seconds, 5));
    request.max_cpu_seconds = seconds;
    run = run_form(mechanism, assembly.start, request);
  } catch (const SceneError& error) {
    return {wrong_as_a_sentence(error.what(), "refused")};
  } catch (const std::exception& error) {
    return {std::string("not a SceneError: ") + error.what()};
  }
  const Series& s = run.series;
  for (std::size_t i = 0; i < s.t.size(); ++i)
    if (!std::isfinite(s.t[i]) || !std::isfinite(s.position_drift[i]) ||
        !std::isfinite(s.velocity_drift[i]))
      return {"a sample that is not finite, status " + run.status};
  if (run.status != "done") return {wrong_as_a_sentence(run.reason, run.status)};
  if (s.t.empty() || std::abs(s.t.back() - seconds) > 1e-12) return {"done, but not at the end"};
  if (m > 0 && !std::isfinite(run.position_drift_max)) return {"done without a drift"};
  return {"", true};
}

}  // namespace momenta::equations
