#pragma once
// Formulas of a scene and what their names mean: t, parameters, and numbers of the mechanism,
//
//   J.q  J.u                         coordinate of joint J and its rate; with several coordinates
//                                    J.q0, J.q1, … and J.u0, J.u1, …
//   M.x  M.y  M.z  M.vx  M.vy  M.vz  position and velocity of marker M, ground axes
//   S.length  S.rate                 length of spring-damper S and its rate
//   C.l  C.rate                      the sum l of coordinate spring C and its rate
//
// A name with other characters than letters, digits and _ stands in single quotes: 'left-knee'.q.
// [[function]] gives functions by points names: f(J.q).
//
// Joints are those whose coordinates are angles and displacements by themselves, driven or not.
// Scenes keep formulas as text, so that they hold wherever joints stand in other order; numbers
// stand in place of parameters there.

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

/// A number of a mechanism that formulas take.
struct Signal {
  enum class Kind { time, coordinate, rate, position, velocity, length, length_rate };
  Kind kind = Kind::time;
  int which = -1;     ///< of the scene's joints, markers or forces; of none for the time
  int component = 0;  ///< which coordinate of the joint; x, y or z of the marker
  bool operator==(const Signal&) const = default;
};

/// Whether it is the rate of another signal: so that no potential can depend on it.
constexpr bool is_rate(Signal::Kind kind) {
  return kind == Signal::Kind::rate || kind == Signal::Kind::velocity ||
         kind == Signal::Kind::length_rate;
}

/// A signal by a name that one formula alone has for it.
struct OwnName {
  std::string_view name;
  Signal signal;
};

/// A formula read: a function of signals.
struct Formula {
  Expression expression;
  std::vector<Signal> signals;  ///< of which its variables are
  std::vector<int> parameters;  ///< of the scene, those it takes
  std::vector<int> functions;   ///< and those it calls
  std::string text;             ///< as written, numbers in place of parameters
};

/// Reads formulas of a scene, which must outlive it. Functions that are none are left out. O(scene)
/// once, O(length) a formula.
class FormulaReader {
 public:
  explicit FormulaReader(const Scene& scene);

  /// @throws ExpressionError: a formula that is none, a name that is unknown or has two meanings
  Formula read(std::string_view text, std::span<const OwnName> own = {}) const;
  /// One that may name t, parameters and functions alone. @throws ExpressionError
  Formula read_of_time(std::string_view text) const;
  /// The names a force's formulas have for themselves: q and u of a torque's joint, length and rate
  /// of a spring-damper, l and rate of a coordinate spring.
  std::vector<OwnName> own_names(const ForceSpec& force) const;

 private:
  class Names;
  Formula read(std::string_view text, Names& names) const;
  using Places = std::unordered_map<std::string_view, int>;
  const Scene& scene_;
  Places joints_, markers_, forces_, parameters_, functions_;
  std::vector<std::shared_ptr<const CubicSpline>> curves_;  ///< null: its points are none
};

/// The curve of a function. @pre spline_fault() of its points is empty
std::shared_ptr<const CubicSpline> curve_of(const FunctionSpec& function);

/// The signal as formulas name it.
std::string in_words(const Scene& scene, const Signal& signal);

/// Calls act(key, text) for every formula of a force, constant or not.
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

/// Why a formula of a force cannot be one, in words; empty where it can.
std::string formula_fault(const Scene& scene, const ForceSpec& force, const Formula& formula);

/// Why a formula cannot be that of an event, in words; empty where it can.
std::string event_fault(const Formula& formula);

/// Why a formula cannot be the equation of a loop, of positions or of velocities, in words; empty
/// where it can.
std::string equation_fault(const Scene& scene, LoopKind kind, const Formula& formula);

/// What the formulas of forces, equations and events name, their own names included. @pre the scene
/// is valid
struct NamedInFormulas {
  explicit NamedInFormulas(const Scene& scene);
  std::set<std::string> joints;   ///< whose coordinates or rates they take
  std::set<std::string> springs;  ///< forces whose length or sum they take
  std::set<std::string> bodies;   ///< with markers that they take
};

}  // namespace momenta
