#pragma once
// Values as TOML text.

#include <Eigen/Core>
#include <string>
#include <vector>

namespace momenta::toml_text {

/// Digits of a number; TOML's integers have no minus zero and end at 2^63.
std::string of(double value);
std::string of(bool value);
/// A string in quotes, control characters written \u00NN.
std::string of(const std::string& text);
// Arrays: "[a, b]".
std::string of(const std::vector<double>& values);
std::string of(const Eigen::Vector3d& v);
std::string of(const std::vector<Eigen::Vector3d>& points);
std::string of(const std::vector<std::string>& texts);

/// Whether two values are one, minus zero apart from zero.
bool same(double a, double b);
bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
inline bool same(bool a, bool b) {
  return a == b;
}
inline bool same(const std::string& a, const std::string& b) {
  return a == b;
}

}  // namespace momenta::toml_text
