#include <momenta/core/text/near_name.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/assembly/scaled_loops.h>
#include <momenta/dae/gradient/numbers_alone.h>
#include <momenta/dae/gradient/start_tangents.h>
#include <momenta/dae/joint_places.h>
#include <momenta/dae/kkt/least_norm.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace momenta {
namespace {

using Eigen::VectorXd;

/// The start from this guess, loops closed to rounding.
Start closed_start(const Mechanism& mechanism, const VectorXd& q, const VectorXd& u) {
  Assembly a = assemble(mechanism, 0, q, u);
  if (mechanism.m() == 0 || a.start.residue.size() > 0) return a.start;
  ScaledLoops loops(mechanism);
  for (const std::string& name : mechanism.scene().held)
    for (const JointPlace& joint : joint_places(mechanism))
      if (joint.name == name)
        for (const int i : joint.u) loops.columns[static_cast<std::size_t>(i)] = false;
  LeastNorm steps(loops.pattern(), mechanism.m(), mechanism.nv());
  VectorXd pose = a.start.q;
  for (int pass = 0; pass < 2; ++pass) {
    const VectorXd gap = loops.gap(0, pose);
    steps.factor(loops.jacobian());
    pose = loops.moved(pose, -steps.solve(gap));
  }
  return assemble(mechanism, 0, pose, u).start;
}

/// The derivative of the numbers made of these scenes, at θ + k h; empty where a difference of
/// fourth order has another: at θ they jump, as where a frame is chosen anew.
VectorXd numbers_by(const NumberSlopes& slopes, double h, const std::vector<Scene>& scenes) {
  VectorXd sixth = VectorXd::Zero(slopes.size()), fourth = sixth;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const VectorXd made = slopes.numbers(scenes[i]);
    if (made.size() != sixth.size()) return {};
    sixth += sixth_order::points[i].weight / h * made;
    if (i < sixth_order::fourth.size()) fourth += sixth_order::fourth[i] / h * made;
  }
  if (!((sixth - fourth).cwiseAbs().maxCoeff() <= 1e-4 * sixth.cwiseAbs().maxCoeff())) return {};
  return sixth;
}

/// Takes the derivatives by numbers of bodies', joints' and springs' own, of as many of these as
/// there are by six readings of the scene, in which all of them have moved. Formulas know
/// parameters alone, so that such a number is in no other body. What a reading refuses, or what
/// changes more, is left to be taken alone.
void take_own_numbers(const SceneText& scene, const std::vector<RunVariable>& variables,
                      const NumberSlopes& slopes, const NumbersAlone& same,
                      std::vector<OtherParameter>& all) {
  using Range = NumberSlopes::Range;
  std::vector<Range> range_of(variables.size());
  for (std::size_t j = 0; j < variables.size(); ++j)
    if (variables[j].kind == RunVariable::Kind::parameter)
      range_of[j] = slopes.of(variables[j].name);
  while (true) {
    std::vector<std::size_t> together;  // one of a body, joint or spring
    std::set<Eigen::Index> parts;
    for (std::size_t j = 0; j < variables.size(); ++j)
      if (range_of[j].count > 0 && parts.insert(range_of[j].first).second) together.push_back(j);
    if (together.size() < 2) return;
    std::vector<VectorXd> numbers;
    try {
      for (const auto& [k, weight] : sixth_order::points) {
        std::vector<Setting> moved;
        for (const std::size_t j : together)
          moved.push_back({variables[j].name, variables[j].value + k * all[j].h});
        const Scene made = scene.scene(moved);
        if (same.of(made) != Change::inertias_and_forces) return;
        numbers.push_back(slopes.numbers(made));
        if (numbers.back().size() != slopes.size()) return;
      }
    } catch (const std::exception&) {  // which of them it is, its own reading tells
      return;
    }
    for (const std::size_t j : together) {
      const Range its = range_of[j];
      all[j].numbers = VectorXd::Zero(slopes.size());
      for (std::size_t i = 0; i < numbers.size(); ++i)
        all[j].numbers.segment(its.first, its.count) +=
            sixth_order::points[i].weight / all[j].h * numbers[i].segment(its.first, its.count);
      range_of[j] = {};
    }
  }
}

}  // namespace

std::vector<OtherParameter> other_parameters(const SceneText& scene, const Mechanism& mechanism,
                                             const std::vector<RunVariable>& variables,
                                             const NumberSlopes* slopes) {
  std::vector<OtherParameter> all(variables.size());
  std::optional<NumbersAlone> same;
  if (slopes) same.emplace(mechanism.scene(), slopes->of_places());
  for (std::size_t j = 0; j < variables.size(); ++j)
    all[j].h = sixth_order::part * variables[j].size;
  if (slopes) take_own_numbers(scene, variables, *slopes, *same, all);
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const RunVariable& v = variables[j];
    OtherParameter& other = all[j];
    if (v.kind != RunVariable::Kind::parameter || other.numbers.size() > 0) continue;
    std::vector<Scene> scenes;
    for (const auto& [k, weight] : sixth_order::points)
      scenes.push_back(scene.scene({{v.name, v.value + k * other.h}}));
    if (slopes) {
      Change change = Change::inertias_and_forces;
      for (const Scene& made : scenes) change = std::max(change, same->of(made));
      if (change != Change::more) other.numbers = numbers_by(*slopes, other.h, scenes);
      if (change == Change::inertias_and_forces && other.numbers.size() > 0) continue;
    }
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      other.mechanisms.push_back(std::make_unique<Mechanism>(std::move(scenes[i]), scene.options));
      const Mechanism& made = *other.mechanisms.back();
      if (made.nq() != mechanism.nq() || made.nv() != mechanism.nv() || made.m() != mechanism.m())
        throw SceneError("with " + v.name + " = " +
                         reading::digits(v.value + sixth_order::points[i].k * other.h) +
                         " the mechanism has other coordinates or equations; expected a parameter "
                         "that changes numbers alone");
      other.evaluations.push_back(made.evaluation<double>());
    }
  }
  return all;
}

StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others) {
  StartTangents tangents;
  tangents.of_state.setZero(mechanism.nq() + mechanism.nv(),
                            static_cast<Eigen::Index>(variables.size()));
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const RunVariable& v = variables[j];
    const OtherParameter& other = others[j];
    if (other.numbers.size() > 0 && other.mechanisms.empty()) continue;
    VectorXd sixth = VectorXd::Zero(tangents.of_state.rows()), fourth = sixth;
    double size = 1;
    for (std::size_t k = 0; k < sixth_order::points.size(); ++k) {
      const Mechanism& made = other.mechanisms.empty() ? mechanism : *other.mechanisms[k];
      VectorXd q = made.tree().q0, u = made.tree().u0;
      const double change = sixth_order::points[k].k * other.h;
      if (v.kind == RunVariable::Kind::position) q[v.place] += change;
      if (v.kind == RunVariable::Kind::rate) u[v.place] += change;
      const Start start = closed_start(made, q, u);
      const std::vector<double> y = make_form(form, made, options, start)->initial(start);
      const Eigen::Map<const VectorXd> state(y.data(), sixth.size());
      sixth += sixth_order::points[k].weight / other.h * state;
      if (k < sixth_order::fourth.size()) fourth += sixth_order::fourth[k] / other.h * state;
      size = std::max(size, state.cwiseAbs().maxCoeff());
    }
    tangents.of_state.col(static_cast<Eigen::Index>(j)) = sixth;
    // Of a smooth start they differ by h⁴; another assembly is about 1/h away.
    const double apart = (sixth - fourth).cwiseAbs().maxCoeff();
    if (!(apart <= 1e-3 * (size / v.size + sixth.cwiseAbs().maxCoeff())))
      tangents.broken.push_back("the start changes too abruptly with " +
                                reading::in_quotes(v.name) + " for a derivative: within " +
                                reading::digits(3 * other.h) +
                                " of its value the scene is assembled otherwise");
  }
  return tangents;
}

}  // namespace momenta
