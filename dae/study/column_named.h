#pragma once
// Columns of a trajectory by name.

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Place of a column, named with its unit or without: "B.x [m]" or "B.x".
inline std::optional<std::size_t> column_named(const std::vector<std::string>& columns,
                                               const std::string& name) {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const std::string& c) {
    return c == name || c.substr(0, c.find(" [")) == name;
  });
  if (found == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns.begin());
}

}  // namespace momenta
