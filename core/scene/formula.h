#pragma once
// Formulas of a scene: names of t, parameters, and numbers of the mechanism,
//
//   J.q  J.u                         coordinate of joint J and its rate; with several coordinates
//                                    J.q0, J.q1, … and J.u0, J.u1, …
//   M.x  M.y  M.z  M.vx  M.vy  M.vz  position and velocity of marker M, ground axes
//   S.length  S.rate                 length of spring-damper S and its rate
//   C.l  C.rate                      the sum l of coordinate spring C and its rate
//
// A name with characters besides letters, digits and _ stands in single quotes: 'left-knee'.q.
// [[function]] gives names to functions by points: f(J.q).
//
// J is a joint whose coordinates are angles and displacements by themselves, driven or not. Scenes
// keep formulas as text, with numbers for parameters, so that they hold in any order of joints.

#include <momenta/core/expression/expression.h>
#include <momenta/core/scene/scene.h>

#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace momenta {

/// A number of a mechanism in formulas.
struct Signal {
  enum class Kind { time, coordinate, rate, position, velocity, length, length_rate };
  Kind kind = Kind::time;
  int which = -1;     ///< index of the scene's joint, marker or force; −1 for the time
  int component = 0;  ///< coordinate of the joint; x, y or z of the marker
  bool operator==(const Signal&) const = default;
};

/// Whether a signal is the rate of another: no potential can depend on it.
constexpr bool is_rate(Signal::Kind kind) {
  return kind == Signal::Kind::rate || kind == Signal::Kind::velocity ||
         kind == Signal::Kind::length_rate;
}

/// A name of a signal in one formula alone.
struct OwnName {
  std::string_view name;
  Signal signal;
};

/// A formula read, as a function of signals.
struct Formula {
  Expression expression;
  std::vector<Signal> signals;  ///< its variables
  std::vector<int> parameters;  ///< parameters of the scene in it
  std::vector<int> functions;   ///< functions of the scene in it
  std::string text;             ///< as written, numbers in place of parameters
};

/// Reads formulas of a scene, which must outlive it. Functions with unusable points are left out.
/// O(scene) once, O(length) a formula.
class FormulaReader {
 public:
  explicit FormulaReader(const Scene& scene);

  /// @throws ExpressionError: a faulty formula, a name that is unknown or has two meanings
  Formula read(std::string_view text, std::span<const OwnName> own = {}) const;
  /// A formula of t, parameters and functions alone. @throws ExpressionError
  Formula read_of_time(std::string_view text) const;
  /// Names of a force's own in its formulas: q and u of a torque's joint, length and rate of a
  /// spring-damper, l and rate of a coordinate spring.
  std::vector<OwnName> own_names(const ForceSpec& force) const;

 private:
  class Names;
  Formula read(std::string_view text, Names& names) const;
  using Places = std::unordered_map<std::string_view, int>;
  const Scene& scene_;
  Places joints_, markers_, forces_, parameters_, functions_;
  std::vector<std::shared_ptr<const CubicSpline>> curves_;  ///< null: unusable points
};

/// The curve of a function. @pre spline_fault() of its points is empty
std::shared_ptr<const CubicSpline> curve_of(const FunctionSpec& function);

/// The name of the signal in formulas.
std::string in_words(const Scene& scene, const Signal& signal);

/// Calls act(key, text) for every formula of a force.
template <class Force, class Act>
void each_formula(Force& force, Act&& act) {
  if (!force.law.empty()) act(std::string(force.kind == "potential" ? "V" : "law"), force.law);
  for (std::size_t i = 0; i < 3; ++i)
    if (!force.force_law[i].empty()) act("force[" + std::to_string(i) + "]", force.force_law[i]);
  for (std::size_t i = 0; i < 3; ++i)
    if (!force.torque_law[i].empty()) act("torque[" + std::to_string(i) + "]", force.torque_law[i]);
}
/// Whether a force is given by formulas.
bool has_formula(const ForceSpec& force);

/// Why a formula of a force is unfit, in words; empty: it is fit.
std::string formula_fault(const Scene& scene, const ForceSpec& force, const Formula& formula);

/// Why a formula of an event is unfit, in words; empty: it is fit.
std::string event_fault(const Formula& formula);

/// Why a formula of a loop, of positions or velocities, is unfit, in words; empty: it is fit.
std::string equation_fault(const Scene& scene, LoopKind kind, const Formula& formula);

/// Things named in formulas of forces, equations and events, those of their own included. @pre the
/// scene is valid
struct NamedInFormulas {
  explicit NamedInFormulas(const Scene& scene);
  std::set<std::string> joints;   ///< joints with coordinates or rates in formulas
  std::set<std::string> springs;  ///< forces with length or sum in formulas
  std::set<std::string> bodies;   ///< bodies with markers in formulas
};

}  // namespace momenta
