#include <momenta/core/scene/validate.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/mechanism/joint_places.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/state_input.h>
#include <momenta/dae/run/state_text.h>
#include <momenta/dae/topology/assembly/drive_reach.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

namespace momenta {
namespace {

constexpr double closed = 1e-8;      // |Φ|, |Φ̇| of a given point
constexpr double norm_slack = 1e-6;  // for quaternions
constexpr std::array<std::string_view, 5> state_keys = {"t", "q", "v", "p", "tau"};
constexpr std::array<std::string_view, 2> start_keys = {"q", "v"};

class StateReader {
 public:
  StateReader(const Mechanism& mechanism, const std::string& state)
      : mechanism_(mechanism), text_(state, state_keys), places_(joint_places(mechanism)) {
    for (const JointPlace& joint : places_) by_name_[joint.name] = &joint;
  }

  GivenState read() {
    const auto& json = text_.json();
    if (json.contains("v") && json.contains("p"))
      text_.fail("found both 'v' and 'p', expected one of them: each follows from the other");
    GivenState state;
    if (json.contains("t")) state.t = text_.number(json["t"], "key 't'", "a time [s]");
    const Values q = values("q", true), v = values("v", false), p = values("p", false),
                 tau = values("tau", false);
    state.of_momenta = json.contains("p");
    const bool all_rates = state.of_momenta ? p.complete() : v.complete();
    start(state, !q.complete() || !all_rates);
    q.put(state.q);
    v.put(state.v);
    state.p = Eigen::VectorXd::Zero(mechanism_.nv());
    p.put(state.p);
    state.p_given = p.given;
    state.tau = Eigen::VectorXd::Zero(mechanism_.nv());
    tau.put(state.tau);
    unit_quaternions(state.q, q.given);
    return state;
  }

 private:
  struct Values {
    Eigen::VectorXd number;
    std::vector<bool> given;
    bool complete() const { return std::find(given.begin(), given.end(), false) == given.end(); }
    void put(Eigen::VectorXd& into) const {
      for (std::size_t i = 0; i < given.size(); ++i)
        if (given[i]) into[static_cast<Eigen::Index>(i)] = number[static_cast<Eigen::Index>(i)];
    }
  };

  const JointPlace& joint(const std::string& name, const std::string& key) const {
    if (const auto it = by_name_.find(name); it != by_name_.end()) return *it->second;
    std::vector<std::string_view> names;
    for (const JointPlace& place : places_) names.push_back(place.name);
    text_.unknown_joint(name, key, names, mechanism_.scene().lagrangian ? "coordinate" : "joint");
  }

  Values values(const std::string& key, bool coordinates) const {
    const int size = coordinates ? mechanism_.nq() : mechanism_.nv();
    Values all{Eigen::VectorXd::Zero(size), std::vector<bool>(static_cast<std::size_t>(size))};
    const auto* table = text_.table(key);
    if (!table) return all;
    for (const auto& [name, value] : table->items()) {
      const JointPlace& place = joint(name, key);
      const std::string where = place_in_state(key, name);
      const std::vector<int>& to = coordinates ? place.q : place.u;
      if (to.empty())
        text_.fail(where + (place.drives.empty()
                                ? ": the joint has no coordinates, expected no value"
                                : ": the joint is driven, expected no value: t alone moves it"));
      std::vector<double> numbers(to.size());
      text_.numbers(value, where, to.size(), numbers.data());
      for (std::size_t i = 0; i < to.size(); ++i) {
        all.number[to[i]] = numbers[i];
        all.given[static_cast<std::size_t>(to[i])] = true;
      }
    }
    return all;
  }

  void start(GivenState& state, bool needed) const {
    state.q = mechanism_.tree().q0;
    state.v = mechanism_.tree().u0;
    if (mechanism_.m() == 0 || !needed) return;
    const Assembly assembly = assemble_at(mechanism_, state.t, Assembled::rates);
    state.q = assembly.start.q;
    state.v = assembly.start.u;
    if (!text_.json().contains("q")) state.residue = assembly.residue;
  }

  void unit_quaternions(Eigen::VectorXd& q, const std::vector<bool>& given) const {
    for (const JointPlace& place : places_)
      for (const int at : place.quaternions) {
        if (!given[static_cast<std::size_t>(at)]) continue;
        const double norm = q.segment<4>(at).norm();
        if (!(std::abs(norm - 1) <= norm_slack))
          text_.fail(place_in_state("q", place.name) + ": found a quaternion of norm " +
                     reading::digits(norm) + ", expected 1 within 1e-6");
        q.segment<4>(at) /= norm;
      }
  }

  const Mechanism& mechanism_;
  StateText text_;
  std::vector<JointPlace> places_;
  std::map<std::string, const JointPlace*> by_name_;
};

}  // namespace

GivenState read_state(const std::string& state, const Mechanism& mechanism) {
  return StateReader(mechanism, state).read();
}

Start start_of(const std::string& state, const Mechanism& mechanism) {
  if (state.empty()) return assemble(mechanism).start;
  const GivenState given = read_state(state, mechanism);
  const StateValues s = evaluate_state(mechanism, given);
  const std::string word = std::string("--at: ") + loop_word(mechanism) + " '";
  for (Eigen::Index i = 0; i < s.phi.size(); ++i) {
    const auto& loop = mechanism.rows()[static_cast<std::size_t>(i)].loop;
    if (!(std::abs(s.phi[i]) <= closed))
      throw SceneError(word + loop + "' is open by " + compact(std::abs(s.phi[i]), 3) +
                       "; expected positions that close the loops to 1e-8");
    if (!(std::abs(s.phidot[i]) <= closed * (1 + s.v.cwiseAbs().maxCoeff())))
      throw SceneError(word + loop + "' opens at a rate of " + compact(std::abs(s.phidot[i]), 3) +
                       "; expected rates that the loops allow, as those from \"p\" are");
  }
  Start start;
  start.t = given.t;
  start.q = given.q;
  start.u = s.v;
  start.udot = mechanism.m() > 0 ? s.constrained : s.free;
  start.lambda = s.lambda;
  return start;
}

namespace {

using JointValues = std::vector<double> JointSpec::*;

JointSpec* joint_named(Scene& scene, const std::string& name) {
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const JointSpec& j) { return j.name == name; });
  return joint == scene.joints.end() ? nullptr : &*joint;
}

/// Sets the one joint of a coupler Σ r_i q_i = c that was given no value: so rotors turn with their
/// joints.
void follow_coupler(Scene& scene, const LoopSpec& coupler, std::set<std::string>& given,
                    JointValues values, double sum) {
  if (has_powers(coupler)) return;
  JointSpec* left = nullptr;
  double ratio = 0;
  for (std::size_t i = 0; i < coupler.joints.size(); ++i) {
    JointSpec* joint = joint_named(scene, coupler.joints[i]);
    if (!joint || coordinates_of(*joint) != 1) return;
    if (given.count(joint->name)) {
      sum -= coupler.ratios[i] * (joint->*values).front();
    } else {
      if (left) return;
      left = joint;
      ratio = coupler.ratios[i];
    }
  }
  if (!left) return;
  left->*values = {sum / ratio};
  given.insert(left->name);
}

void start_coordinates(const StateText& text, LagrangianSpec& spec) {
  std::vector<std::string_view> names;
  for (const auto& c : spec.coordinates) names.push_back(c.name);
  for (const std::string key : {"q", "v"}) {
    const auto* table = text.table(key);
    if (!table) continue;
    for (const auto& [name, value] : table->items()) {
      const auto found = std::find(names.begin(), names.end(), name);
      if (found == names.end()) text.unknown_joint(name, key, names, "coordinate");
      auto& c = spec.coordinates[static_cast<std::size_t>(found - names.begin())];
      text.numbers(value, place_in_state(key, name), 1, key == "q" ? &c.position : &c.velocity);
    }
  }
}

}  // namespace

void start_at(const std::string& state, Scene& scene) {
  if (state == "-")
    throw SceneError(
        "--at: found -, expected a JSON file or the text itself");  // read again to go on
  const StateText text(state, start_keys);
  if (scene.lagrangian) return start_coordinates(text, *scene.lagrangian);
  const auto put = [&](const std::string& key, int (*size_of)(const JointSpec&),
                       JointValues values) {
    const auto* table = text.table(key);
    if (!table) return;
    std::set<std::string> given;
    for (const auto& [name, value] : table->items()) {
      JointSpec* joint = joint_named(scene, name);
      if (!joint) {
        std::vector<std::string_view> names;
        for (const JointSpec& j : scene.joints) names.push_back(j.name);
        text.unknown_joint(name, key, names);
      }
      const std::string where = place_in_state(key, name);
      const auto size = static_cast<std::size_t>(size_of(*joint));
      if (size == 0) text.fail(where + ": the joint has no coordinates, expected no value");
      const auto drives = static_cast<std::size_t>(
          std::count_if(scene.drives.begin(), scene.drives.end(),
                        [joint](const DriveSpec& d) { return d.joint == joint->name; }));
      if (drives >= size)
        text.fail(where + ": the joint is driven, expected no value: t alone moves it");
      (joint->*values).resize(size);
      text.numbers(value, where, size, (joint->*values).data());
      given.insert(name);
    }
    for (const LoopSpec& l : scene.loops)
      if (l.kind == LoopKind::coupler)
        follow_coupler(scene, l, given, values, key == "q" ? l.offset : 0);
  };
  put("q", coordinates_of, &JointSpec::position);
  put("v", rates_of, &JointSpec::velocity);
  try {
    validate(scene);
  } catch (const SceneError& e) {
    text.fail(std::string("with these values ") + e.what());
  }
}

}  // namespace momenta
