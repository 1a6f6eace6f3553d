#include <momenta/core/expression/spline.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>

namespace momenta {
namespace {

using Kind = Signal::Kind;
using reading::in_quotes;

constexpr std::array<std::string_view, 6> of_markers{"x", "y", "z", "vx", "vy", "vz"};

/// "J.q" or "'left-knee'.q".
std::string named(std::string_view owner, std::string_view component) {
  const std::string name(owner);
  return (is_plain_name(owner) ? name : "'" + name + "'") + "." + std::string(component);
}

/// Number of coordinates that are angles and displacements by themselves.
int scalar_coordinates(const JointSpec& joint) {
  return joint.kind == JointKind::user ? 0 : static_cast<int>(scalar_coordinates_of(joint.kind));
}

/// q, u, or with several coordinates q0, u0, …
std::string component_of(const JointSpec& joint, bool rate, int i) {
  return std::string(rate ? "u" : "q") +
         (scalar_coordinates(joint) == 1 ? std::string() : std::to_string(i));
}

/// Name of the length of a spring-damper, or of the sum of a coordinate spring; empty: none.
std::string_view length_name(const ForceSpec& force) {
  if (force.kind == "spring-damper") return "length";
  return force.kind == "coordinate-spring" ? "l" : "";
}

bool is_length(std::string_view component) {
  return component == "length" || component == "l" || component == "rate";
}
bool is_coordinate(std::string_view component) {
  return (component.front() == 'q' || component.front() == 'u') &&
         std::all_of(component.begin() + 1, component.end(),
                     [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::shared_ptr<const CubicSpline> curve_of(const FunctionSpec& function) {
  const Interpolation between = function.kind == "linear"     ? Interpolation::linear
                                : function.kind == "monotone" ? Interpolation::monotone
                                                              : Interpolation::cubic;
  return std::make_shared<const CubicSpline>(function.x, function.y, between);
}

FormulaReader::FormulaReader(const Scene& scene) : scene_(scene) {
  const auto take = [](const auto& all, Places& places) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!all[i].name.empty()) places.emplace(all[i].name, static_cast<int>(i));
  };
  take(scene.joints, joints_);
  take(scene.markers, markers_);
  take(scene.forces, forces_);
  take(scene.parameters, parameters_);
  take(scene.functions, functions_);
  for (const FunctionSpec& f : scene.functions)
    curves_.push_back(spline_fault(f.x, f.y, "x", "y").empty() ? curve_of(f) : nullptr);
}

/// Meanings of the names in one formula.
class FormulaReader::Names final : public FormulaNames {
 public:
  Names(const FormulaReader& reader, std::span<const OwnName> own, bool of_time_alone = false)
      : r_(reader), own_(own), of_time_alone_(of_time_alone) {}

  std::optional<Meaning> meaning(std::string_view name, std::size_t place) override {
    const auto own =
        std::find_if(own_.begin(), own_.end(), [&](const OwnName& o) { return o.name == name; });
    const auto parameter = r_.parameters_.find(name);
    if (own != own_.end()) {
      if (parameter != r_.parameters_.end())
        throw ExpressionError("name " + in_quotes(name) +
                                  " is a parameter's and the force's own, expected another name "
                                  "for the parameter",
                              place);
      return variable(own->signal);
    }
    if (parameter != r_.parameters_.end()) {
      const double value = r_.scene_.parameters[static_cast<std::size_t>(parameter->second)].value;
      parameters.push_back(parameter->second);
      replaced.push_back({place, name.size(), value});
      return Meaning{-1, value};
    }
    if (name == "t") return variable({});
    const auto [owner, component] = split(name);
    if (component.empty() || of_time_alone_) return {};
    if (const auto signal = of(owner, component, place)) return variable(*signal);
    return {};
  }

  std::shared_ptr<const CubicSpline> function(std::string_view name) override {
    const int* found = find(r_.functions_, name);
    if (!found) return nullptr;
    functions_called.push_back(*found);
    return r_.curves_[static_cast<std::size_t>(*found)];
  }
  std::vector<std::string_view> functions() const override {
    std::vector<std::string_view> all;
    for (const FunctionSpec& f : r_.scene_.functions) all.push_back(f.name);
    return all;
  }
  std::string expected(std::string_view name) const override {
    std::vector<std::string> all{"t", "pi"};
    for (const OwnName& o : own_) all.emplace_back(o.name);
    for (const ParameterSpec& p : r_.scene_.parameters) all.push_back(p.name);
    const auto ending = [&](const char* otherwise) {
      const std::vector<std::string_view> known(all.begin(), all.end());
      const std::string meant = reading::did_you_mean(name, known);
      return !meant.empty() ? meant : otherwise;
    };
    if (of_time_alone_) return ending(", expected t, pi or a parameter");
    if (const std::string whose = of_an_owner(name); !whose.empty()) return whose;
    const auto add = [&](std::string_view owner, std::string_view component) {
      all.push_back(named(owner, component));
    };
    for (const JointSpec& joint : r_.scene_.joints)
      for (int i = 0; i < scalar_coordinates(joint); ++i)
        for (const bool rate : {false, true}) add(joint.name, component_of(joint, rate, i));
    for (const MarkerSpec& marker : r_.scene_.markers)
      for (const std::string_view component : of_markers) add(marker.name, component);
    for (const ForceSpec& force : r_.scene_.forces)
      if (!force.name.empty() && !length_name(force).empty())
        add(force.name, length_name(force)), add(force.name, "rate");
    return ending(
        ", expected t, pi, a parameter, J.q or J.u of a joint J, M.x to M.vz of a marker M, or "
        "S.length or S.rate of a spring-damper S");
  }

  /// Hint on rates in other notations: "der(x)".
  std::string expected_in_brackets(std::string_view word, std::string_view) const override {
    if (of_time_alone_ || find(r_.parameters_, word)) return "";
    for (const char* elsewhere : {"dot", "der", "diff", "d", "D", "ddt", "derivative"})
      if (word == elsewhere) return ", expected a rate: J.u of a joint J, M.vx of a marker M";
    return "";
  }

  /// Hint for the bare name of a joint or marker, or the beginning of a name that needs quotes.
  std::string of_an_owner(std::string_view name) const {
    if (const int* joint = find(r_.joints_, name)) {
      const JointSpec& j = r_.scene_.joints[static_cast<std::size_t>(*joint)];
      if (scalar_coordinates(j) > 0)
        return ": it is a joint, expected " + named(j.name, component_of(j, false, 0)) + " or " +
               named(j.name, component_of(j, true, 0));
    }
    if (find(r_.markers_, name))
      return ": it is a marker, expected " + named(name, "x") + " to " + named(name, "vz");
    std::string whose;
    const auto look = [&](const auto& all) {
      for (const auto& one : all)
        if (whose.empty() && !is_plain_name(one.name) && one.name.starts_with(name))
          whose = ", expected quotes around " + in_quotes(one.name) +
                  ", which has other characters than letters, digits and _";
    };
    look(r_.scene_.joints);
    look(r_.scene_.markers);
    look(r_.scene_.forces);
    return whose;
  }

  std::vector<Signal> signals;
  std::vector<int> parameters, functions_called;
  struct Replaced {
    std::size_t place, size;
    double value;
  };
  std::vector<Replaced> replaced;  ///< in the order of the text

 private:
  Meaning variable(const Signal& signal) {
    const auto known = std::find(signals.begin(), signals.end(), signal);
    if (known != signals.end()) return {static_cast<int>(known - signals.begin()), 0};
    signals.push_back(signal);
    return {static_cast<int>(signals.size()) - 1, 0};
  }
  /// 'left-knee'.q and a.b.q: the owner, and its component.
  static std::pair<std::string_view, std::string_view> split(std::string_view name) {
    if (name.front() == '\'') {
      const std::size_t end = name.find('\'', 1);
      const std::string_view rest = name.substr(end + 1);
      return {name.substr(1, end - 1), rest.empty() ? rest : rest.substr(1)};
    }
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return {name, {}};
    return {name.substr(0, dot), name.substr(dot + 1)};
  }
  static const int* find(const Places& places, std::string_view name) {
    const auto found = places.find(name);
    return found == places.end() ? nullptr : &found->second;
  }

  std::optional<Signal> of(std::string_view owner, std::string_view component,
                           std::size_t place) const {
    const int *joint = find(r_.joints_, owner), *marker = find(r_.markers_, owner),
              *force = find(r_.forces_, owner);
    if (joint && is_coordinate(component)) return of_joint(*joint, component, place);
    const auto axis = std::find(of_markers.begin(), of_markers.end(), component);
    if (marker && axis != of_markers.end()) {
      const auto i = static_cast<int>(axis - of_markers.begin());
      return Signal{i < 3 ? Kind::position : Kind::velocity, *marker, i % 3};
    }
    if (force && is_length(component)) {
      const ForceSpec& spring = r_.scene_.forces[static_cast<std::size_t>(*force)];
      if (component == "rate" && !length_name(spring).empty())
        return Signal{Kind::length_rate, *force, 0};
      if (component == length_name(spring)) return Signal{Kind::length, *force, 0};
    }
    if (joint || marker || force) refuse(joint, marker, force, component, place);
    return {};
  }
  Signal of_joint(int which, std::string_view component, std::size_t place) const {
    const JointSpec& joint = r_.scene_.joints[static_cast<std::size_t>(which)];
    const int count = scalar_coordinates(joint);
    const bool rate = component.front() == 'u';
    const std::string_view number = component.substr(1);
    int i = 0;
    const bool readable =
        std::from_chars(number.data(), number.data() + number.size(), i).ec == std::errc{};
    if (count == 0 || number.empty() != (count == 1) || (count > 1 && (!readable || i >= count)))
      refuse(&which, nullptr, nullptr, component, place);
    return {rate ? Kind::rate : Kind::coordinate, which, count == 1 ? 0 : i};
  }
  /// Refuses a component, and lists those of its owner.
  [[noreturn]] void refuse(const int* joint, const int* marker, const int* force,
                           std::string_view component, std::size_t place) const {
    std::string sentence;
    if (joint) {
      const JointSpec& j = r_.scene_.joints[static_cast<std::size_t>(*joint)];
      const int count = scalar_coordinates(j);
      const std::string kind(reading::name_of(j.kind));
      sentence = "joint " + in_quotes(j.name) + " is " + kind;
      if (count == 0)
        sentence += " and has no coordinates that formulas take, expected a marker on its body";
      else if (count == 1)
        sentence += " and has no " + in_quotes(component) + ", expected " + named(j.name, "q") +
                    " or " + named(j.name, "u");
      else
        sentence += " and has no " + in_quotes(component) + ", expected " + named(j.name, "q0") +
                    " to " + named(j.name, "q" + std::to_string(count - 1)) + " or " +
                    named(j.name, "u0") + " to " + named(j.name, "u" + std::to_string(count - 1));
    } else if (marker) {
      const std::string& name = r_.scene_.markers[static_cast<std::size_t>(*marker)].name;
      sentence = "marker " + in_quotes(name) + " has no " + in_quotes(component) +
                 ", expected x, y, z, vx, vy or vz";
    } else {
      const ForceSpec& f = r_.scene_.forces[static_cast<std::size_t>(*force)];
      sentence = "force " + in_quotes(f.name) + " is a " + f.kind + " and has no " +
                 in_quotes(component) + ", expected ";
      sentence += length_name(f).empty() ? "a spring-damper or a coordinate-spring"
                                         : std::string(length_name(f)) + " or rate";
    }
    throw ExpressionError(sentence, place);
  }

  const FormulaReader& r_;
  std::span<const OwnName> own_;
  bool of_time_alone_;
};

Formula FormulaReader::read(std::string_view text, std::span<const OwnName> own) const {
  Names names(*this, own);
  return read(text, names);
}

Formula FormulaReader::read_of_time(std::string_view text) const {
  Names names(*this, {}, true);
  return read(text, names);
}

Formula FormulaReader::read(std::string_view text, Names& names) const {
  Expression expression(text, names);
  std::string with_numbers;
  std::size_t from = 0;
  for (const auto& r : names.replaced) {
    with_numbers += text.substr(from, r.place - from);
    const std::string number = reading::digits(r.value);
    with_numbers += number.front() == '-' ? "(" + number + ")" : number;
    from = r.place + r.size;
  }
  with_numbers += text.substr(from);
  return {std::move(expression), std::move(names.signals), std::move(names.parameters),
          std::move(names.functions_called), std::move(with_numbers)};
}

std::vector<OwnName> FormulaReader::own_names(const ForceSpec& force) const {
  if (force.kind == "torque") {
    const auto joint = joints_.find(force.joint);
    const int which = joint == joints_.end() ? -1 : joint->second;
    return {{"q", {Kind::coordinate, which, 0}}, {"u", {Kind::rate, which, 0}}};
  }
  if (force.kind != "spring-damper" && force.kind != "coordinate-spring") return {};
  const auto which = static_cast<int>(&force - scene_.forces.data());
  return {{length_name(force), {Kind::length, which, 0}}, {"rate", {Kind::length_rate, which, 0}}};
}

std::string in_words(const Scene& scene, const Signal& signal) {
  const auto which = static_cast<std::size_t>(signal.which);
  switch (signal.kind) {
    case Kind::time:
      return "t";
    case Kind::coordinate:
    case Kind::rate: {
      const JointSpec& joint = scene.joints[which];
      return named(joint.name, component_of(joint, signal.kind == Kind::rate, signal.component));
    }
    case Kind::position:
    case Kind::velocity:
      return named(scene.markers[which].name,
                   of_markers[static_cast<std::size_t>(signal.component) +
                              (signal.kind == Kind::velocity ? 3 : 0)]);
    case Kind::length:
    case Kind::length_rate: {
      const ForceSpec& spring = scene.forces[which];
      const std::string component(signal.kind == Kind::length ? length_name(spring)
                                                              : std::string_view("rate"));
      return spring.name.empty() ? component : named(spring.name, component);
    }
  }
  return "";
}

bool has_formula(const ForceSpec& force) {
  bool any = false;
  each_formula(force, [&](const std::string&, const std::string&) { any = true; });
  return any;
}

}  // namespace momenta
