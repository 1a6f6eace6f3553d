#include <momenta/dae/assembly/replaced_rates.h>

#include <cmath>
#include <cstdio>

namespace momenta {

std::string replaced_rates_in_words(const Mechanism& mechanism, const Start& start) {
  constexpr double kept = 1e-3;
  constexpr int most_named = 6;
  const Eigen::VectorXd& given = mechanism.tree().u0;
  if (mechanism.m() == 0 || given.size() == 0 || given.isZero(0)) return "";
  const auto columns = mechanism.rate_columns();
  const double largest = given.cwiseAbs().maxCoeff();
  std::string changes;
  int count = 0;
  for (Eigen::Index i = 0; i < given.size(); ++i) {
    if (given[i] == 0 || !(std::abs(start.u[i] - given[i]) > kept * largest)) continue;
    if (++count > most_named) continue;
    char numbers[80];
    std::snprintf(numbers, sizeof numbers, " from %.4g to %.4g ", given[i], start.u[i]);
    const auto& column = columns[static_cast<std::size_t>(i)];
    changes += (changes.empty() ? "" : ", ") + column.name + numbers + column.unit;
  }
  if (count == 0) return "";
  if (count > most_named) changes += " and " + std::to_string(count - most_named) + " more";
  return "start rates replaced by the nearest that the " +
         std::string(mechanism.scene().lagrangian ? "constraints" : "loops") + " allow: " + changes;
}

}  // namespace momenta
