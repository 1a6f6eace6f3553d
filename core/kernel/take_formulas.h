#pragma once
// Signals and formula forces of a model, from a scene. Included only where models are built.

#include <momenta/core/kernel/model.h>
#include <momenta/core/scene/formula.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Signals of a scene in a model's frames. Needs the frames of all bodies.
template <class Space>
class SignalTaker {
 public:
  using Taken = typename Model<Space>::Signal;
  using Of = typename Taken::Of;
  using Term = typename Model<Space>::CoordinateSpring::Term;

  SignalTaker(const Tree& tree, const Scene& scene, Model<Space>& model)
      : tree_(tree), scene_(scene), model_(model) {}

  /// Adds a signal; gives its place in model.signals.
  int take(const Signal& signal) {
    Taken taken;
    taken.is_rate = is_rate(signal.kind);
    const auto which = static_cast<std::size_t>(signal.which);
    switch (signal.kind) {
      case Signal::Kind::time:
        break;
      case Signal::Kind::coordinate:
      case Signal::Kind::rate:
        taken.of = Of::sum;
        taken.terms = {term(scene_.joints[which].name, signal.component, 1)};
        break;
      case Signal::Kind::position:
      case Signal::Kind::velocity: {
        const MarkerSpec& marker = scene_.markers[which];
        taken.of = Of::point;
        taken.ends.child = tree_.body(marker.body);
        const Eigen::Vector3d at = tree_.point(taken.ends.child, marker.point);
        taken.ends.at_child = model_.point(taken.ends.child, at);
        taken.along = model_.direction(-1, Eigen::Vector3d::Unit(signal.component));
        if constexpr (in_plane)
          taken.across = model_.basis(signal.component, 2) * across(taken.ends.child, at, true);
        break;
      }
      case Signal::Kind::length:
      case Signal::Kind::length_rate: {
        const ForceSpec& spring = scene_.forces[which];
        if (spring.kind == "coordinate-spring") {
          taken.of = Of::sum;
          taken.terms = sum(spring);
        } else {
          taken.of = Of::distance;
          take_points(spring, taken.ends);
        }
        break;
      }
    }
    return add(std::move(taken));
  }

  /// A component of a wrench's force, or of its torque.
  int take_component(const ForceSpec& wrench, int i, bool of_torque) {
    Taken taken;
    const int body = tree_.body(wrench.body), axes_of = wrench.in_body_axes ? body : -1;
    const Eigen::Vector3d e = tree_.direction(axes_of, Eigen::Vector3d::Unit(i));
    taken.of = of_torque ? Of::turn : Of::point;
    taken.ends.child = body;
    taken.ends.at_child = model_.point(body, tree_.point(body, wrench.point));
    taken.in_body_axes = wrench.in_body_axes;
    taken.along = model_.direction(axes_of, e);
    if constexpr (in_plane)
      if (of_torque) taken.across = across(axes_of, e, false);
    return add(std::move(taken));
  }

  /// Two points of bodies, for springs and bushings.
  template <class Between>
  void take_points(const ForceSpec& f, Between& between) {
    between.parent = tree_.body(f.parent);
    between.child = tree_.body(f.child);
    const Eigen::Vector3d at_parent = tree_.point(between.parent, f.origin_parent);
    const Eigen::Vector3d at_child = tree_.point(between.child, f.origin_child);
    between.at_parent = model_.point(between.parent, at_parent);
    between.at_child = model_.point(between.child, at_child);
    if constexpr (in_plane) {
      const double offset =
          across(between.child, at_child, true) - across(between.parent, at_parent, true);
      between.offset2 = offset * offset;
    }
  }
  /// Σ ratios q of a coordinate spring.
  std::vector<Term> sum(const ForceSpec& f) {
    std::vector<Term> terms;
    for (std::size_t i = 0; i < f.joints.size(); ++i)
      terms.push_back(term(f.joints[i], f.coordinates.empty() ? 0 : f.coordinates[i], f.ratios[i]));
    return terms;
  }
  /// Planar: component of a point or direction of a body (−1: ground axes) across the plane.
  double across(int body, const Eigen::Vector3d& v, bool is_point) const {
    if (body < 0) return model_.basis.col(2).dot(v);
    const Eigen::Isometry3d& frame = model_.frames[static_cast<std::size_t>(body)];
    return is_point ? (frame * v).z() : (frame.linear() * v).z();
  }

 private:
  static constexpr bool in_plane = Space::dimension == 3;

  Term term(const std::string& joint, int coordinate, double ratio) {
    const int k = tree_.part_of(joint, coordinate);
    int& place = model_.bodies[static_cast<std::size_t>(k)].sprung;
    if (place < 0) place = model_.sprung++;
    return {k, place, ratio};
  }
  int add(Taken taken) {
    model_.signals.push_back(std::move(taken));
    return static_cast<int>(model_.signals.size()) - 1;
  }

  const Tree& tree_;
  const Scene& scene_;
  Model<Space>& model_;
};

/// Adds the forces given by formulas. @pre the scene is valid
template <class Space>
void take_formulas(const Scene& scene, SignalTaker<Space>& taker, Model<Space>& model) {
  using Force = typename Model<Space>::FormulaForce;
  if (std::none_of(scene.forces.begin(), scene.forces.end(), has_formula)) return;
  const FormulaReader reader(scene);
  for (const ForceSpec& f : scene.forces) {
    if (!has_formula(f)) continue;
    const std::vector<OwnName> own = reader.own_names(f);
    const auto which = static_cast<int>(&f - scene.forces.data());
    const auto add = [&](const std::string& key, const std::string& text, int signal,
                         double factor) {
      Formula formula = reader.read(text, own);
      Force force{std::move(formula.expression), {}, {{0, factor, signal}}, false, -1, which, key};
      for (const Signal& s : formula.signals) force.inputs.push_back(taker.take(s));
      model.formula_forces.push_back(std::move(force));
    };
    if (f.kind == "potential") {
      const Formula formula = reader.read(f.law);
      std::vector<int> all;
      for (std::size_t v = 0; v < formula.signals.size(); ++v) all.push_back(static_cast<int>(v));
      Force force{formula.expression.with_derivatives(all), {}, {}, true, -1, which, "V"};
      for (const int v : all) {
        const Signal& s = formula.signals[static_cast<std::size_t>(v)];
        force.inputs.push_back(taker.take(s));
        if (s.kind == Signal::Kind::time)
          force.by_time = 1 + v;
        else
          force.acts.push_back({1 + v, -1, force.inputs.back()});
      }
      model.formula_forces.push_back(std::move(force));
    } else if (!f.law.empty()) {
      // the first of its names is the signal it acts along
      add("law", f.law, taker.take(own.front().signal), f.kind == "torque" ? 1 : -1);
    }
    for (int i = 0; i < 3; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const std::string component = "[" + std::to_string(i) + "]";
      if (!f.force_law[at].empty())
        add("force" + component, f.force_law[at], taker.take_component(f, i, false), 1);
      if (!f.torque_law[at].empty())
        add("torque" + component, f.torque_law[at], taker.take_component(f, i, true), 1);
    }
  }
}

}  // namespace momenta
