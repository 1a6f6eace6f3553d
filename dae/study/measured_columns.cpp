#include <momenta/dae/study/measured_columns.h>
#include <momenta/dae/study/run_form.h>

namespace momenta {

std::vector<Column> momentum_columns(const Mechanism& mechanism) {
  std::vector<Column> columns = mechanism.rate_columns();
  for (Column& c : columns) {
    const auto dot = c.name.rfind('.');
    const std::string rate = dot == std::string::npos ? "" : c.name.substr(dot + 1);
    c.name = c.name.substr(0, dot) + ".p" +
             (rate == "dot"           ? ""
              : rate.starts_with('u') ? rate.substr(1)
                                      : rate);
    const std::string of = c.unit.substr(0, c.unit.rfind("/s"));
    c.unit = of == "rad" ? "N m s" : of == "m" ? "N s" : "J s/" + of;
  }
  return columns;
}

std::vector<Column> impulse_columns(const Mechanism& mechanism) {
  std::vector<Column> columns = mechanism.multiplier_columns();
  const std::string lambda = ".lambda";
  for (Column& c : columns) {
    c.name.replace(c.name.rfind(lambda), lambda.size(), ".impulse");
    c.unit += " s";
  }
  return columns;
}

std::vector<std::string> measured_columns(const Mechanism& mechanism) {
  std::vector<std::string> columns = trajectory_columns(mechanism, true);
  for (const Column& c : momentum_columns(mechanism)) columns.push_back(c.label());
  for (const Column& c : impulse_columns(mechanism)) columns.push_back(c.label());
  columns.emplace_back("work [J]");
  return columns;
}

}  // namespace momenta
