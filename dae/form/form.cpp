#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/ode_form.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <stdexcept>

namespace momenta {
namespace {

using Maker =
    std::function<std::unique_ptr<Form>(const Mechanism&, const FormOptions&, const Start&)>;
enum class Kind { ode, ode_one_step, dae };
struct Entry {
  std::string name;
  Kind kind;
  bool impulses;   ///< σ among its unknowns or solved for: takes a gauge
  bool positions;  ///< Φ = 0 among its equations, or met after each step
  bool bearings;   ///< u̇ and forces of loops are found, as friction by reaction needs them
  Maker make;
};

const std::vector<Entry>& registry() {
  static const std::vector<Entry> entries{
      {"momentum", Kind::ode, true, false, true, make_momentum},
      {"momentum-index1", Kind::dae, true, false, false, make_momentum_index1},
      {"momentum-index2", Kind::dae, true, true, false, make_momentum_index2},
      {"momentum-stabilised", Kind::dae, true, true, false, make_momentum_stabilised},
      {"momentum-index3", Kind::dae, false, true, false, make_momentum_index3},
      {"augmented-lagrangian-canonical", Kind::ode, true, false, true,
       make_augmented_lagrangian_canonical},
      {"acceleration", Kind::ode, false, false, true, make_acceleration},
      {"projected", Kind::ode_one_step, false, true, true, make_projected},
      {"partitioned", Kind::ode_one_step, false, true, true, make_partitioned},
      {"baumgarte", Kind::ode, false, false, true, make_baumgarte},
      {"maximal-coordinates", Kind::ode, false, false, false, make_maximal_coordinates},
      {"augmented-lagrangian", Kind::ode, false, false, true, make_augmented_lagrangian},
      {"acceleration-index1", Kind::dae, false, false, true, make_acceleration_index1},
      {"acceleration-index2", Kind::dae, false, false, true, make_acceleration_index2},
      {"acceleration-index3", Kind::dae, false, true, true, make_acceleration_index3},
      {"stabilised-index2", Kind::dae, false, true, true, make_stabilised_index2},
  };
  return entries;
}

const Entry& entry(const std::string& name) {
  for (const auto& e : registry())
    if (e.name == name) return e;
  std::vector<std::string_view> all;
  for (const auto& e : registry()) all.push_back(e.name);
  throw std::invalid_argument("form " + reading::in_quotes(name) +
                              " is not known; expected one of " + reading::listed(all) +
                              reading::did_you_mean(name, all));
}

}  // namespace

std::string Gauge::text() const {
  if (kind == Kind::none) return "none";
  if (kind == Kind::reset) return "reset";
  if (kind == Kind::flip) return "flip";
  if (kappa == 0) return "leak";  // at default_leak()
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, kappa).ptr;
  return "leak:" + std::string(digits, end);
}

Gauge parse_gauge(const std::string& text) {
  if (text == "none") return {Gauge::Kind::none, 0};
  if (text == "reset") return {Gauge::Kind::reset, 0};
  if (text == "flip") return {Gauge::Kind::flip, 0};
  if (text == "leak") return {Gauge::Kind::leak, 0};
  if (text.rfind("leak:", 0) == 0) {
    double kappa = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data() + 5, end, kappa);
    if (error == std::errc() && stop == end && std::isfinite(kappa) && kappa > 0)
      return {Gauge::Kind::leak, kappa};
  }
  throw std::invalid_argument(
      "gauge '" + text +
      "' is not known; expected none, reset, flip, leak or leak:κ with κ > 0 in 1/s");
}

const std::vector<std::string>& form_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& e : registry()) all.push_back(e.name);
    return all;
  }();
  return names;
}

bool is_dae_form(const std::string& name) {
  return entry(name).kind == Kind::dae;
}

bool takes_gauge(const std::string& name) {
  return entry(name).impulses;
}

bool needs_one_step_method(const std::string& name) {
  return entry(name).kind == Kind::ode_one_step;
}

bool holds_positions(const std::string& name) {
  return entry(name).positions;
}

std::unique_ptr<Form> make_form(const std::string& name, const Mechanism& mechanism,
                                const FormOptions& options, const Start& start) {
  const Entry& e = entry(name);
  if (e.kind == Kind::dae && options.project)
    throw std::invalid_argument("position correction after steps needs a one-step method; '" +
                                name + "' is integrated by IDA, expected an ODE form");
  if (const JointSpec* joint = with_bearing(mechanism.scene()); joint && !e.bearings)
    throw std::invalid_argument(
        "joint '" + joint->name + "' has a bearing, whose friction takes accelerations and " +
        "forces of loops: form '" + name + "' has " +
        (e.kind == Kind::dae ? "no accelerations among its unknowns" : "no place for it") +
        "; expected 'momentum', 'acceleration' or another form");
  return e.make(mechanism, options, start);
}

}  // namespace momenta
