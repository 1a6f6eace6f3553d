#pragma once
// Casts an equation of a scene into a loop model. Included only where loops are built.

#include <momenta/core/kernel/take_formulas.h>
#include <momenta/dae/mechanism/loop/loop_equation.h>
#include <momenta/dae/mechanism/loop/loop_model.h>

#include <algorithm>
#include <memory>
#include <random>
#include <set>

namespace momenta {

/// Whether every term of an equation of velocities has a rate, b = 0: judged at some states. An
/// equation without a value there counts as b ≠ 0.
inline bool vanishes_at_rest(const Formula& formula) {
  std::mt19937 random(1);  // the same states every time
  std::vector<double> x(formula.signals.size());
  for (int state = 0; state < 4; ++state) {
    for (std::size_t k = 0; k < x.size(); ++k)
      x[k] = is_rate(formula.signals[k].kind)
                 ? 0
                 : 0.25 + static_cast<double>(random()) / static_cast<double>(std::mt19937::max());
    if (formula.expression(x) != 0) return false;
  }
  return true;
}

/// @pre the scene is valid. O(length of the formula · its names)
template <class Space>
void take_equation(const Scene& scene, const LoopSpec& spec, const Tree& tree,
                   const Model<Space>& model, LoopModel<Space>& all,
                   typename LoopModel<Space>::Loop& l) {
  using Of = typename LoopEquation<Space>::Of;
  const Formula formula = FormulaReader(scene).read(spec.equation);
  std::vector<int> variables;
  for (std::size_t v = 0; v < formula.signals.size(); ++v) variables.push_back(static_cast<int>(v));
  LoopEquation<Space> e(formula.expression.with_second_derivatives(variables));
  std::set<int, std::greater<>> way;
  const auto climb = [&](int k) {
    for (; k >= 0; k = tree.bodies[static_cast<std::size_t>(k)].parent) way.insert(k);
  };
  const auto last = [](const auto& list) { return static_cast<int>(list.size()) - 1; };
  e.of_rates = spec.kind == LoopKind::velocity_equation;
  for (const Signal& s : formula.signals) {
    const auto which = static_cast<std::size_t>(s.which);
    const bool rate = is_rate(s.kind), acts = rate == e.of_rates;
    if (s.kind == Signal::Kind::coordinate || s.kind == Signal::Kind::rate) {
      const int k = tree.part_of(scene.joints[which].name, s.component);
      const Tree::Body& b = tree.bodies[static_cast<std::size_t>(k)];
      if (b.drive >= 0) {
        e.laws.push_back(tree.drives[static_cast<std::size_t>(b.drive)]);
        e.inputs.push_back({rate ? Of::law_rate : Of::law, last(e.laws)});
        e.moves = true;
        continue;
      }
      e.joints.push_back({b.q, b.u});
      if (acts) {
        e.input_of_joint.push_back(static_cast<int>(e.inputs.size()));
        l.joints.push_back({k, b.q, b.u, 1, {}, all.curves++});
        climb(k);
      }
      e.inputs.push_back({rate ? Of::coordinate_rate : Of::coordinate, last(e.joints)});
    } else if (s.kind == Signal::Kind::position || s.kind == Signal::Kind::velocity) {
      const MarkerSpec& marker = scene.markers[which];
      const int k = tree.body(marker.body);
      const Eigen::Vector3d at = tree.point(k, marker.point);
      typename LoopEquation<Space>::Point point;
      point.body = k;
      point.at = model.point(k, at);
      point.along = model.direction(-1, Eigen::Vector3d::Unit(s.component));
      if constexpr (Space::dimension == 3) {
        const double height = k < 0 ? model.basis.col(2).dot(at)
                                    : (model.frames[static_cast<std::size_t>(k)] * at).z();
        point.across = model.basis(s.component, 2) * height;
      }
      e.points.push_back(point);
      e.inputs.push_back({rate ? Of::point_rate : Of::point, last(e.points)});
      if (!acts) continue;
      climb(k);
      if (k >= 0 && std::find(e.bodies.begin(), e.bodies.end(), k) == e.bodies.end())
        e.bodies.push_back(k);
    } else {
      e.inputs.push_back({Of::time, -1});
      e.moves = e.moves || !e.of_rates;
    }
  }
  if (e.of_rates) e.moves = e.moves || !vanishes_at_rest(formula);
  e.way.assign(way.begin(), way.end());
  l.equation = static_cast<int>(all.equations.size());
  all.equations.push_back(std::make_shared<const LoopEquation<Space>>(std::move(e)));
}

}  // namespace momenta
