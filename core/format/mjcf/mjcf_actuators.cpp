// <actuator> at a constant control u. With l and v the length and velocity of its transmission,
// gear g times those of a joint or a fixed tendon, the force of an actuator without states is
// affine in both:
//
//   f = (g₀ + g₁ l + g₂ v) u + b₀ + b₁ l + b₂ v = A + B l + C v
//
//   motor     g₀ = 1                     position  g₀ = kp, b₁ = −kp, b₂ = −kv
//   velocity  g₀ = kv, b₂ = −kv          damper    g₂ = −kv
//   general   gaintype fixed or affine with gainprm, biastype none or affine with biasprm
//
// On the coordinate acts g f: a spring of stiffness K = −g² B about the q where g A + g² B q
// vanishes, a damper −g² C, a torque where B = 0. The file's q is the scene's plus `ref`.

#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace momenta::reading {
namespace {

/// Controls of `--control`: a value for all, and values by name.
class Controls {
 public:
  explicit Controls(const std::vector<std::string>& texts) {
    for (const std::string& text : texts) {
      const std::size_t sign = text.rfind('=');
      const std::string name = sign == text.npos ? "" : text.substr(0, sign);
      const std::string_view digits =
          std::string_view(text).substr(sign == text.npos ? 0 : sign + 1);
      double value = 0;
      const auto [end, error] =
          std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value) ||
          (sign != text.npos && name.empty()))
        throw SceneError("--control: found " + in_quotes(text) +
                         ", expected ACTUATOR=VALUE, or a VALUE for all actuators");
      values_[name] = value;
    }
  }
  bool any() const { return !values_.empty(); }
  /// Control of the actuator of this name, else `otherwise`.
  double of(const std::string& name, double otherwise) {
    met_.insert(name);
    if (const auto own = values_.find(name); own != values_.end()) return own->second;
    const auto all = values_.find("");
    return all == values_.end() ? otherwise : all->second;
  }
  void refuse_unknown() const {
    std::vector<std::string_view> known(met_.begin(), met_.end());
    std::erase(known, "");
    for (const auto& [name, value] : values_)
      if (!name.empty() && !met_.contains(name))
        throw SceneError("--control: actuator " + in_quotes(name) + " is not in the file" +
                         (known.empty() ? std::string(", which has none with a name")
                                        : ", expected one of: " + listed(known)));
  }

 private:
  std::map<std::string, double> values_;
  std::set<std::string> met_;
};

struct Affine {
  double constant = 0, length = 0, velocity = 0;
};

class ActuatorReader {
 public:
  ActuatorReader(const Node& node, MjcfModel& model) : node_(node), model_(model) {}

  void read(double control) {
    if (node_.text("dyntype", "none") != "none" || node_.number("timeconst", 0) != 0)
      node_.fail("has a state of its own, expected an actuator without dynamics under --control");
    if (node_.number("inheritrange", 0) != 0)
      node_.fail("inheritrange", "is not 0, expected the range of the control as ctrlrange");
    const Affine f = force(clamped(control));
    const std::vector<double> gears = node_.has("gear") ? node_.numbers("gear") : std::vector{1.0};
    if (gears.empty()) node_.fail("gear", "is empty, expected a number");
    const double g = gears.front();
    const Affine on{g * f.constant, g * g * f.length, g * g * f.velocity};
    if (node_.has("joint") || node_.has("jointinparent"))
      on_joint(coordinate_of(node_, node_.has("joint") ? "joint" : "jointinparent", model_), on);
    else if (node_.has("tendon"))
      on_tendon(on);
    else
      node_.fail("acts on no joint and no tendon, expected one of them under --control");
  }

 private:
  bool limited(const char* flag, const char* range) const {
    const std::string word = node_.text(flag, "auto");
    return word == "true" || (word == "auto" && model_.auto_limits && node_.has(range));
  }
  double clamped(double control) const {
    if (!model_.clamps || !limited("ctrllimited", "ctrlrange")) return control;
    const std::vector<double> range = node_.numbers("ctrlrange", 2);
    if (!(range[0] <= range[1]))
      node_.fail("ctrlrange", "has its first number above its second, expected a range");
    return std::clamp(control, range[0], range[1]);
  }
  std::array<double, 3> three(const char* key, std::array<double, 3> otherwise) const {
    if (!node_.has(key)) return otherwise;
    const std::vector<double> given = node_.numbers(key);
    std::array<double, 3> all{};
    std::copy_n(given.begin(), std::min<std::size_t>(3, given.size()), all.begin());
    return all;
  }

  Affine force(double u) const {
    std::array<double, 3> gain{1, 0, 0}, bias{};
    const std::string& kind = node_.name();
    if (kind == "position") {
      if (node_.has("dampratio"))
        node_.fail("dampratio", "is not read, expected the damping as kv");
      const double kp = node_.number("kp", 1);
      gain = {kp, 0, 0};
      bias = {0, -kp, -node_.number("kv", 0)};
    } else if (kind == "velocity") {
      const double kv = node_.number("kv", 1);
      gain = {kv, 0, 0};
      bias = {0, 0, -kv};
    } else if (kind == "damper") {
      gain = {0, 0, -node_.number("kv", 1)};
    } else if (kind == "general") {
      constexpr std::array<std::string_view, 2> gains{"fixed", "affine"}, biases{"none", "affine"};
      gain = three("gainprm", {1, 0, 0});
      if (node_.word("gaintype", gains, 0) == 0) gain = {gain[0], 0, 0};
      if (node_.word("biastype", biases, 0) == 1) bias = three("biasprm", {});
    }
    Affine f{gain[0] * u + bias[0], gain[1] * u + bias[1], gain[2] * u + bias[2]};
    if (!limited("forcelimited", "forcerange")) return f;
    const std::vector<double> range = node_.numbers("forcerange", 2);
    if (!(range[0] <= range[1]))
      node_.fail("forcerange", "has its first number above its second, expected a range");
    if (f.length == 0 && f.velocity == 0)
      f.constant = std::clamp(f.constant, range[0], range[1]);
    else
      model_.remarks.left_out("force ranges of actuators");
    return f;
  }

  void torque(const std::string& joint, double value) {
    if (value == 0) return;
    ForceSpec f;
    f.at = node_.at();
    f.kind = "torque";
    f.joint = joint;
    f.value = value;
    model_.scene.forces.push_back(f);
  }

  /// Adds −k₁ (q − r₁) + A + B (q + ref), as one spring.
  void on_joint(const std::string& name, const Affine& on) {
    const auto ref = model_.refs.find(name);
    const double constant = on.constant + on.length * (ref == model_.refs.end() ? 0 : ref->second);
    for (JointSpec& joint : model_.scene.joints) {
      if (joint.name != name) continue;
      joint.damping -= on.velocity;
      if (on.length == 0) return torque(name, constant);
      const double before = joint.stiffness * joint.rest + constant;
      joint.stiffness -= on.length;
      joint.rest = joint.stiffness == 0 ? 0 : before / joint.stiffness;
      return joint.stiffness == 0 ? torque(name, before) : void();
    }
  }

  void on_tendon(const Affine& on) {
    const std::string name = node_.text("tendon");
    const auto found = model_.tendons.find(name);
    if (found == model_.tendons.end())
      node_.fail("tendon", "is " + in_quotes(name) + ", expected the name of a tendon");
    const MjcfModel::Tendon& tendon = found->second;
    if (tendon.ratios.empty())
      node_.fail("tendon", "is " + in_quotes(name) + ", expected a fixed tendon under --control");
    const double constant = on.constant + on.length * tendon.ref;
    if (on.length != 0 || on.velocity != 0) {
      ForceSpec f;
      f.at = node_.at();
      f.kind = "coordinate-spring";
      for (const auto& [joint, ratio] : tendon.ratios) {
        f.joints.push_back(joint);
        f.ratios.push_back(ratio);
      }
      f.stiffness = -on.length;
      f.damping = -on.velocity;
      f.rest = on.length == 0 ? 0 : -constant / on.length;
      model_.scene.forces.push_back(f);
    }
    if (on.length == 0)
      for (const auto& [joint, ratio] : tendon.ratios) torque(joint, constant * ratio);
  }

  const Node& node_;
  MjcfModel& model_;
};

/// Checks that the joint or tendon of an actuator that is left out exists.
void expect_known(const Node& node, const MjcfModel& model) {
  for (const char* key : {"joint", "jointinparent"}) {
    if (!node.has(key)) continue;
    const std::string name = node.text(key);
    std::vector<std::string_view> known;
    for (const JointSpec& joint : model.scene.joints) known.push_back(joint.name);
    if (std::find(known.begin(), known.end(), name) == known.end())
      node.fail(key, "is " + in_quotes(name) + ", expected the name of a joint" +
                         did_you_mean(name, known));
  }
  const auto expect = [&](const char* key, const auto& all, const char* what) {
    if (!node.has(key)) return;
    const std::string name = node.text(key);
    if (all.contains(name)) return;
    std::vector<std::string_view> known;
    for (const auto& one : all) known.push_back(one.first);
    node.fail(key, "is " + in_quotes(name) + ", expected the name of a " + what +
                       did_you_mean(name, known));
  };
  expect("tendon", model.tendons, "tendon");
  for (const char* key : {"site", "refsite", "cranksite", "slidersite"})
    expect(key, model.sites, "site");
  expect("body", model.frames, "body");
}

}  // namespace

std::size_t count_actuators(const std::vector<Node>& sections) {
  std::size_t count = 0;
  for (const Node& section : sections) count += section.children().size();
  return count;
}

void read_actuators(const std::vector<Node>& sections, const std::vector<std::string>& given,
                    const std::vector<double>& of_key, MjcfModel& model) {
  Controls controls(given);
  const std::size_t count = count_actuators(sections);
  if (controls.any() && count > 0 && (!model.actuates || model.disabled_groups))
    fail(model.scene.file, {},
         "the options of the model keep actuators from acting, by actuation or "
         "actuatorgroupdisable; expected neither under --control");
  std::size_t place = 0;
  constexpr std::array<std::string_view, 5> kinds{"motor", "position", "velocity", "damper",
                                                  "general"};
  for (const Node& section : sections)
    for (const Node& part : section.children()) {
      const std::string name = part.text("name", "");
      const std::string who =
          name.empty() ? std::string("actuator") : "actuator " + in_quotes(name);
      const Element full =
          model.defaults.with_defaults(part, part.name(), MjcfDefaults::main_class);
      const Node actuator(full, who, model.scene.file);
      expect_known(actuator, model);
      if (!controls.any()) {
        model.remarks.left_out("actuators, which --control lets act");
        continue;
      }
      const double control = controls.of(name, of_key.empty() ? 0 : of_key[place]);
      ++place;
      if (std::find(kinds.begin(), kinds.end(), part.name()) == kinds.end())
        part.of(who).fail("is not read under --control, expected one of: " + listed(kinds));
      ActuatorReader(actuator, model).read(control);
    }
  controls.refuse_unknown();
}

}  // namespace momenta::reading
