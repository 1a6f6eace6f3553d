#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/form/form_entry.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

// clang-format off
/// In the order of the tables.
#define MOMENTA_FORMS(form)            \
  form(momentum)                       \
  form(momentum_index1)                \
  form(momentum_index2)                \
  form(momentum_stabilised)            \
  form(momentum_index3)                \
  form(augmented_lagrangian_canonical) \
  form(acceleration)                   \
  form(projected)                      \
  form(partitioned)                    \
  form(baumgarte)                      \
  form(maximal_coordinates)            \
  form(augmented_lagrangian)           \
  form(acceleration_index1)            \
  form(acceleration_index2)            \
  form(acceleration_index3)            \
  form(stabilised_index2)
// clang-format on

namespace momenta {

#define MOMENTA_DECLARED(form) FormEntry form##_entry();
MOMENTA_FORMS(MOMENTA_DECLARED)

const std::vector<FormEntry>& all_forms() {
#define MOMENTA_LISTED(form) form##_entry(),
  static const std::vector<FormEntry> all{MOMENTA_FORMS(MOMENTA_LISTED)};
  return all;
}

const FormEntry* find_form(const std::string& name) {
  for (const FormEntry& e : all_forms())
    if (e.name == name) return &e;
  return nullptr;
}

int FormEntry::index() const {
  if (kind != Kind::dae) return 0;
  int most = 0;
  for (const Constraint& c : words.constraints) most = std::max(most, c.differentiations);
  return 1 + most;
}

const char* name_of(Constraint::Origin origin) {
  switch (origin) {
    case Constraint::Origin::given:
      return "given";
    case Constraint::Origin::hidden:
      return "hidden";
    case Constraint::Origin::invariant:
      return "invariant";
  }
  return "";
}

namespace {

const FormEntry& entry(const std::string& name) {
  if (const FormEntry* known = find_form(name)) return *known;
  std::vector<std::string_view> all;
  for (const FormEntry& e : all_forms()) all.push_back(e.name);
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
    for (const FormEntry& e : all_forms()) all.push_back(e.name);
    return all;
  }();
  return names;
}

bool is_dae_form(const std::string& name) {
  return entry(name).kind == FormEntry::Kind::dae;
}

bool takes_gauge(const std::string& name) {
  return entry(name).impulses;
}

bool needs_one_step_method(const std::string& name) {
  return entry(name).kind == FormEntry::Kind::ode_one_step;
}

bool holds_positions(const std::string& name) {
  return entry(name).positions;
}

std::unique_ptr<Form> make_form(const std::string& name, const Mechanism& mechanism,
                                const FormOptions& options, const Start& start) {
  const FormEntry& e = entry(name);
  if (e.kind == FormEntry::Kind::dae && options.project)
    throw std::invalid_argument("position correction after steps needs a one-step method; '" +
                                name + "' is integrated by IDA, expected an ODE form");
  if (const JointSpec* joint = with_bearing(mechanism.scene()); joint && !e.bearings)
    throw std::invalid_argument(
        "joint '" + joint->name + "' has a bearing, whose friction takes accelerations and " +
        "forces of loops: form '" + name + "' has " +
        (e.kind == FormEntry::Kind::dae ? "no accelerations among its unknowns"
                                        : "no place for it") +
        "; expected 'momentum', 'acceleration' or another form");
  return e.make(mechanism, options, start);
}

}  // namespace momenta
