#pragma once
// Common parts of reports of searches for parameters, fits and functionals alike: starts in words,
// parameters and conditions before and after, charts over the swept coordinate. Keys are public
// interface: docs/reference/fit.md.

#include <momenta/dae/study/fit/fit.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace momenta {

/// " A minimum, of one start.", " The least of 3 minima from 8 starts, seed 1.", or why the best is
/// none. `Result` is FitResult or LeastResult.
template <class Result>
std::string starts_in_words(const Result& r) {
  std::size_t minima = 0;
  for (const auto& start : r.starts) minima += start.converged ? 1 : 0;
  const auto& best = r.starts[r.best];
  std::string text = !best.converged ? " It is no minimum: " + best.why + "."
                     : r.starts.size() == 1
                         ? " A minimum, of one start."
                         : " The least of " + std::to_string(minima) + " minima from " +
                               std::to_string(r.starts.size()) + " starts, seed " +
                               std::to_string(r.seed) + ".";
  if (r.stopped) text += " The search was stopped.";
  return text;
}

/// Parameters found at an end of their range.
std::vector<std::string> at_ends(const std::vector<FittedParameter>& parameters,
                                 const Eigen::VectorXd& found);
/// " At an end of its range: 'a'."; or empty.
std::string at_ends_in_words(const std::vector<FittedParameter>& parameters,
                             const Eigen::VectorXd& found);

/// Parameters of the scene and found, with ranges and standard deviations, if any.
std::string parameters_table(const std::vector<FittedParameter>& parameters,
                             const Eigen::VectorXd& own, const Eigen::VectorXd& found,
                             const Eigen::VectorXd& deviations = {});
/// Parameters by name: {"a": {before, after, deviation, from, to}}.
nlohmann::ordered_json parameters_json(const std::vector<FittedParameter>& parameters,
                                       const Eigen::VectorXd& own, const Eigen::VectorXd& found,
                                       const Eigen::VectorXd& deviations = {});
/// [{from, to, cost, iterations, cosine, slope, violation, converged, why}]
nlohmann::ordered_json starts_json(const std::vector<FittedParameter>& parameters,
                                   const std::vector<FitStart>& starts);
/// Values by name: {"a": 1.5}; null without values.
nlohmann::ordered_json values_json(const std::vector<FittedParameter>& parameters,
                                   const Eigen::VectorXd& values);

/// Conditions as in fit.json: [{condition, before, after, multiplier}].
nlohmann::ordered_json kept_json(const std::vector<UserConstraint>& keep);
/// Empty without conditions.
std::string kept_table(const std::vector<UserConstraint>& keep);

struct SweptCurve {
  const char* name;
  Eigen::VectorXd values;
  int colour;
  std::vector<int> dash;
};
/// Charts over the swept coordinate from `first` (dae/output/page/timeline.js).
class SweptCharts {
 public:
  SweptCharts(const Column& swept, const std::vector<double>& places, double first);
  /// `unit` may be empty.
  void add(const std::string& name, const std::string& unit, const std::vector<SweptCurve>& curves);
  const nlohmann::ordered_json& json() const { return charts_; }

 private:
  std::vector<std::size_t> order_;
  nlohmann::ordered_json t_, charts_;
  std::string x_title_;
};

}  // namespace momenta
