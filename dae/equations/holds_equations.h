#pragma once
#include <algorithm>
#include <string_view>

namespace momenta {

/// Whether a text is a file of equations and no scene: a line of it opens the table [dae]. O(size)
inline bool holds_equations(std::string_view text) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line = text.substr(begin, end - begin);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (line.starts_with("[dae]")) return true;
    begin = end + 1;
  }
  return false;
}

}  // namespace momenta
