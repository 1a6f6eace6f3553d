#include <momenta/dae/run/run_quantities.h>

#include <type_traits>

namespace momenta {
namespace {

/// A member of a run, or the member of a member …
template <auto first, auto... rest>
RunQuantity::Value member_of(const auto& x) {
  if constexpr (sizeof...(rest) > 0)
    return member_of<rest...>(x.*first);
  else if constexpr (std::is_same_v<std::remove_cvref_t<decltype(x.*first)>, int>)
    return static_cast<long>(x.*first);
  else
    return x.*first;
}
template <auto... members>
RunQuantity::Value taken(const RunResult& run) {
  return member_of<members...>(run);
}
/// Exponent of a growth; NaN unless the drift grows like a power of t.
template <auto growth>
RunQuantity::Value power_of(const RunResult& run) {
  return (run.*growth).is_power() ? (run.*growth).exponent : not_measured;
}

}  // namespace

std::string RunQuantity::heading(const std::string& drift_unit) const {
  const std::string text = unit;
  if (text.empty()) return name;
  return std::string(name) + " [" +
         (text.starts_with("drift") ? drift_unit + text.substr(5) : text) + "]";
}

const std::vector<RunQuantity>& run_quantities() {
  using R = RunResult;
  using S = RunSettings;
  // name, unit, in summary.json, column of study.csv, attribute in Python, value, meaning
  static const std::vector<RunQuantity> all{
      {"scene", "", "/scene", true, true, taken<&R::scene>, "name of the scene"},
      {"form", "", "/form", true, true, taken<&R::settings, &S::form>, "name of the form"},
      {"integrator", "", "/integrator", true, true, taken<&R::settings, &S::integrator>,
       "name of the integrator"},
      {"gauge", "", "/gauge", true, true, taken<&R::settings, &S::gauge>,
       "gauge of momentum forms"},
      {"rtol", "", "/rtol", true, true, taken<&R::settings, &S::rtol>, "relative tolerance"},
      {"atol", "", "/atol", true, true, taken<&R::settings, &S::atol>,
       "absolute tolerance, in scales of the unknowns"},
      {"step", "s", "/step", true, true, taken<&R::settings, &S::step>,
       "fixed step [s]; 0: adaptive"},
      {"end_time", "s", "/end_time", true, true, taken<&R::settings, &S::end_time>,
       "time asked for [s]"},
      {"project", "", "/project", true, true, taken<&R::settings, &S::project>,
       "whether positions were corrected after each step"},
      {"baumgarte_alpha", "1/s", nullptr, true, true, taken<&R::settings, &S::baumgarte_alpha>,
       "gain of Phidot [1/s]"},
      {"baumgarte_beta", "1/s", nullptr, true, true, taken<&R::settings, &S::baumgarte_beta>,
       "gain of Phi [1/s]"},
      {"beta", "1/s", "/beta", true, true, taken<&R::settings, &S::beta>,
       "position feedback of momentum forms [1/s]"},
      {"penalty", "", "/penalty", true, true, taken<&R::settings, &S::penalty>,
       "penalty of augmented Lagrangians, in effective masses of the loops"},
      {"kkt", "", "/kkt", true, true, taken<&R::settings, &S::kkt>,
       "how (7) was solved: sweeps, sparse, dense; else empty"},
      {"jacobian", "", "/jacobian", true, true, taken<&R::jacobian>,
       "derivatives of implicit methods: dual numbers or difference quotient"},
      {"linear_solver", "", "/linear_solver", true, true, taken<&R::linear_solver>,
       "linear solver of implicit methods"},
      {"status", "", "/status", true, true, taken<&R::status>,
       "done, event (one of the scene's ended it), failed, time limit or came apart"},
      {"stopped_at", "s", "/stopped_at", true, true, taken<&R::stopped_at>,
       "time at which it stopped [s]"},
      {"reason", "", "/reason", true, true, taken<&R::reason>, "one sentence when not done"},
      {"departure", "", "/departure", false, true, taken<&R::departure>,
       "one sentence where a run that reached its end is not to be relied on: how far the balance "
       "of energy or the rates of loops are off; else empty"},
      {"stiff_from", "s", "/stiff_from", false, true, taken<&R::stiff_from>,
       "time since which stability limited the steps of an explicit method [s]"},
      {"changed_at", "s", "/changed_at", false, true, taken<&R::changed_at>,
       "time at which an implicit method took over [s]"},
      {"position_drift_max", "drift", "/drift/position_max", true, true,
       taken<&R::position_drift_max>, "largest |Phi| at the output times, in drift_unit"},
      {"velocity_drift_max", "drift/s", "/drift/velocity_max", true, true,
       taken<&R::velocity_drift_max>, "largest |Phidot| at the output times, in drift_unit/s"},
      {"between_steps_max", "drift", "/drift/between_steps_max", true, true,
       taken<&R::between_steps_max>,
       "largest |Phi| in the middle of a step, before corrections, in drift_unit"},
      {"angle_drift_max", "rad", "/drift/angle_max", true, true, taken<&R::angle_drift_max>,
       "largest |Phi| of the equations in rad, where others are in m [rad]"},
      {"angle_rate_drift_max", "rad/s", "/drift/angle_rate_max", true, true,
       taken<&R::angle_rate_drift_max>, "largest |Phidot| of the same equations [rad/s]"},
      {"angle_between_steps_max", "rad", "/drift/angle_between_steps_max", true, true,
       taken<&R::angle_between_steps_max>,
       "largest |Phi| of the same equations in the middle of a step [rad]"},
      {"position_exponent", "", nullptr, true, false, taken<&R::position_growth, &Growth::exponent>,
       ""},
      {"position_exponent_half_range", "", nullptr, true, false,
       taken<&R::position_growth, &Growth::half_range>, ""},
      {"velocity_exponent", "", nullptr, true, false, taken<&R::velocity_growth, &Growth::exponent>,
       ""},
      {"velocity_exponent_half_range", "", nullptr, true, false,
       taken<&R::velocity_growth, &Growth::half_range>, ""},
      {"angle_exponent", "", nullptr, true, false, taken<&R::angle_growth, &Growth::exponent>, ""},
      {"angle_exponent_half_range", "", nullptr, true, false,
       taken<&R::angle_growth, &Growth::half_range>, ""},
      {"angle_rate_exponent", "", nullptr, true, false,
       taken<&R::angle_rate_growth, &Growth::exponent>, ""},
      {"angle_rate_exponent_half_range", "", nullptr, true, false,
       taken<&R::angle_rate_growth, &Growth::half_range>, ""},
      {"position_exponent", "", "/drift/position_exponent", false, true,
       power_of<&R::position_growth>,
       "exponent of the position drift's growth; nan: no power of t"},
      {"velocity_exponent", "", "/drift/velocity_exponent", false, true,
       power_of<&R::velocity_growth>,
       "exponent of the velocity drift's growth; nan: no power of t"},
      {"angle_exponent", "", "/drift/angle_exponent", false, true, power_of<&R::angle_growth>,
       "exponent of the growth of the angles' drift; nan: no power of t"},
      {"angle_rate_exponent", "", "/drift/angle_rate_exponent", false, true,
       power_of<&R::angle_rate_growth>,
       "exponent of the growth of the drift of angular rates; nan: no power of t"},
      {"energy_error_max", "J", "/energy/error_max", true, true, taken<&R::energy_error_max>,
       "largest |energy - energy(0)| [J]"},
      {"energy_turned_over", "J", "/energy/turned_over", false, true, taken<&R::energy_turned_over>,
       "energy turned over during the run [J]"},
      {"position_error_max", "", "/error/position_max", true, true, taken<&R::position_error_max>,
       "error against the reference, max |err| / (1 + |ref|); nan without a reference"},
      {"velocity_error_max", "", "/error/velocity_max", true, true, taken<&R::velocity_error_max>,
       "error of rates; nan without a reference that has them"},
      {"force_error_max", "", "/error/force_max", true, true, taken<&R::force_error_max>,
       "error of lambda solved from (3); nan without a reference that has it"},
      {"multiplier_error_max", "", "/error/multiplier_max", true, true,
       taken<&R::multiplier_error_max>,
       "error of lambda as the form itself has it; nan without a reference that has it"},
      {"multiplier_difference_max", "", "/multiplier_difference_max", true, true,
       taken<&R::multiplier_difference_max>,
       "lambda of the form itself against lambda solved from (3), max |difference| / (1 + "
       "|lambda|)"},
      {"momentum_error_max", "", "/error/momentum_max", true, true, taken<&R::momentum_error_max>,
       "error of p without its gauge; nan without a reference that has M u"},
      {"impulse_error_max", "", "/error/impulse_max", true, true, taken<&R::impulse_error_max>,
       "error of the loops' impulses, the integral of lambda; nan without a reference that has "
       "them"},
      {"effort_error_max", "", "/error/effort_max", true, true, taken<&R::effort_error_max>,
       "error of the efforts of drives; nan without a reference that has them"},
      {"reaction_error_max", "", "/error/reaction_max", true, true, taken<&R::reaction_error_max>,
       "error of the reactions of joints, where unique; nan without a reference that has them"},
      {"work_error_max", "", "/error/work_max", true, true, taken<&R::work_error_max>,
       "error of the work of drives and of forces without potential; nan without a reference of "
       "it"},
      {"steps", "", "/counters/steps", true, false, taken<&R::counters, &Counters::steps>, ""},
      {"rejected", "", "/counters/rejected", true, false, taken<&R::counters, &Counters::rejected>,
       ""},
      {"evaluations", "", "/counters/evaluations", true, false,
       taken<&R::counters, &Counters::evaluations>, ""},
      {"jacobians", "", "/counters/jacobians", true, false,
       taken<&R::counters, &Counters::jacobians>, ""},
      {"factorizations", "", "/counters/factorizations", true, false,
       taken<&R::counters, &Counters::factorizations>, ""},
      {"newton_iterations", "", "/counters/newton_iterations", true, false,
       taken<&R::counters, &Counters::newton_iterations>, ""},
      {"ode_restarts", "", "/counters/ode_restarts", false, false,
       taken<&R::counters, &Counters::ode_restarts>, ""},
      {"partitions", "", "/partitions", true, true, taken<&R::partitions>,
       "how often partitioned chose its coordinates"},
      {"cpu", "s", nullptr, true, false, taken<&R::cpu_s>, ""},
      {"wall", "s", nullptr, true, false, taken<&R::wall_s>, ""},
      {"cpu_s", "", "/time/cpu_s", false, true, taken<&R::cpu_s>, "processor time [s]"},
      {"wall_s", "", "/time/wall_s", false, true, taken<&R::wall_s>, "time by the clock [s]"},
      {"repeats", "", "/time/repeats", true, true, taken<&R::repeats>, "timed repeats"},
      {"untimed", "", "/time/untimed", false, true, taken<&R::untimed>,
       "why repeats gave no times; empty: they did"},
      {"integrated", "", "/integrated", false, true, taken<&R::integrated>,
       "what was integrated in place of the scene as written; empty: that"},
      {"residue", "", "/residue", false, true, taken<&R::residue>,
       "what contradicting redundant equations leave open at the start; empty: nothing"},
      {"weak_evaluations", "", "/weak_evaluations", false, true, taken<&R::weak_evaluations>,
       "right-hand sides in which more equations faded than are redundant at the start"},
      {"least_pivot", "", "/least_pivot", false, true, taken<&R::least_pivot>,
       "least relative pivot of the loop equations; 0: a row faded"}};
  return all;
}

const std::vector<RunError>& run_errors() {
  using R = RunResult;
  static const std::vector<RunError> all{
      {&Series::position_error, &R::position_error_max, "q", true},
      {&Series::velocity_error, &R::velocity_error_max, "u", true},
      {&Series::momentum_error, &R::momentum_error_max, "p", false},
      {&Series::force_error, &R::force_error_max, "λ of (3)", true},
      {&Series::reaction_error, &R::reaction_error_max, "reactions", false},
      {&Series::effort_error, &R::effort_error_max, "efforts", false},
      {&Series::work_error, &R::work_error_max, "work", false},
      {&Series::multiplier_error, &R::multiplier_error_max, "own λ", true},
      {&Series::impulse_error, &R::impulse_error_max, "∫λ", false}};
  return all;
}

}  // namespace momenta
