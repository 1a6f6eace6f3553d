#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/mechanism/loop/loop_equation.h>
#include <momenta/dae/mechanism/loop/loop_weights.h>
#include <momenta/dae/mechanism/model_data.h>

#include <algorithm>

namespace momenta {
namespace {

Plan plan_with_loops(const Tree& tree, const Scene& scene, Algebra algebra) {
  if (scene.lagrangian) {
    if (algebra != Algebra::automatic)
      throw SceneError(scene.where(scene.lagrangian->at) +
                       "lagrangian: a kernel was asked for, but it has no bodies to compute in a "
                       "plane or in space; expected --algebra auto");
    Plan plan;
    plan.planar = true;
    return plan;
  }
  Plan plan = make_plan(tree, scene, algebra);
  if (!plan.planar) return plan;
  const std::string why = loops_leave_plane(scene, tree, plan.basis);
  if (why.empty()) return plan;
  if (algebra == Algebra::planar)
    throw SceneError(scene.where({}) + "the planar kernel was asked for, but " + why +
                     ", expected a mechanism in a plane, or the spatial kernel");
  plan = make_plan(tree, scene, Algebra::spatial);
  plan.planar_reason = why;
  return plan;
}

/// Couplers that tie angles alone, by place in the scene.
std::vector<bool> couplers_of_angles(const Scene& scene, const Tree& tree) {
  std::vector<bool> of_angles;
  for (const LoopSpec& l : scene.loops) {
    bool slides = l.kind != LoopKind::coupler;
    for (std::size_t i = 0; i < l.joints.size(); ++i) {
      const int k = tree.part_of(l.joints[i], l.coordinates.empty() ? 0 : l.coordinates[i]);
      slides |= tree.bodies[static_cast<std::size_t>(k)].kind == JointKind::prismatic;
    }
    of_angles.push_back(!slides);
  }
  return of_angles;
}

}  // namespace

Mechanism::Mechanism(Scene scene, MechanismOptions options)
    : scene_(std::move(scene)),
      options_(options),
      tree_(build_tree(scene_)),
      plan_(plan_with_loops(tree_, scene_, options.algebra)),
      models_(std::make_unique<Models>()) {
  if (scene_.lagrangian)
    take_lagrangian();
  else
    take_bodies();
  if (rows_ > 0 && !scene_.lagrangian) take_weights();
}

void Mechanism::take_bodies() {
  const auto take_into = [&](auto& data, auto&& model) {
    data.model = std::move(model);
    data.loops = build_loops(scene_, tree_, data.model);
  };
  if (plan_.planar)
    take_into(models_->data.emplace<0>(), build_planar_model(tree_, scene_, plan_.basis));
  else
    take_into(models_->data.emplace<1>(), build_spatial_model(tree_, scene_));
  row_names_ = row_names(scene_, plan_.planar);
  rows_ = static_cast<int>(row_names_.size());
  plan_.loops = rows_ > 0;
  plan_.joint_forces |= with_bearing(scene_) != nullptr;
  plan_.drives |= visit([](const auto& data) {
    const auto& equations = data.loops.equations;
    return !data.loops.motions.empty() ||
           std::any_of(equations.begin(), equations.end(), [](const auto& e) { return e->moves; });
  });
  const std::vector<bool> of_angles = couplers_of_angles(scene_, tree_);
  nonholonomic_ = visit([](const auto& data) { return data.loops.nonholonomic(); });
  const auto group = [&](const auto& data) {
    int index = 0;
    for (const auto& l : data.loops.loops) {
      const int points = l.first_rows();
      const bool coupler = of_angles[static_cast<std::size_t>(index / 2)];
      for (int i = 0; i < l.rows; ++i) {
        row_groups_.push_back(i < points ? index : index + 1);
        angle_rows_.push_back(i >= points || coupler);
      }
      index += 2;
    }
  };
  visit(group);
}

void Mechanism::take_weights() {
  const auto e = evaluation<double>();
  e->place(0, tree_.q0.data());
  std::vector<double> inertia(static_cast<std::size_t>(tree_.nv));
  e->mass_diagonal(inertia.data());
  const auto take = [&](auto& data) {
    const LoopWeights weights = weigh_loops(data.loops, tree_, inertia, length_of(scene_));
    for (std::size_t k = 0; k < weights.least_scales.size(); ++k) {
      auto& l = data.loops.loops[k];
      l.least_scale = weights.least_scales[k];
      for (int i = 0; i < l.rows; ++i)
        least_scales_.push_back(i < l.first_rows() ? l.least_scale : 0.0);
    }
    mass_spread_ = weights.spread;
    masses_apart_ = weights.apart;
    furthest_apart_ = weights.light;
  };
  if (plan_.planar)
    take(std::get<0>(models_->data));
  else
    take(std::get<1>(models_->data));
}

bool Mechanism::has_nonholonomic() const {
  return std::find(nonholonomic_.begin(), nonholonomic_.end(), true) != nonholonomic_.end();
}
bool Mechanism::has_lengths() const {
  return std::find(angle_rows_.begin(), angle_rows_.end(), false) != angle_rows_.end();
}
bool Mechanism::has_angles() const {
  return std::find(angle_rows_.begin(), angle_rows_.end(), true) != angle_rows_.end();
}
bool Mechanism::has_body_forces() const {
  return visit([](const auto& data) { return data.model.has_body_forces(); });
}
bool Mechanism::has_forces_apart() const {
  return visit([](const auto& data) { return data.model.has_forces_apart(); });
}
bool Mechanism::has_joint_forces() const {
  return visit([](const auto& data) { return data.model.has_joint_forces; });
}

Mechanism::~Mechanism() = default;

}  // namespace momenta
