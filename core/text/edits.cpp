#include <momenta/core/text/edits.h>

#include <algorithm>
#include <vector>

namespace momenta::reading {

std::size_t edits(std::string_view a, std::string_view b) {
  const std::size_t longer = std::max(a.size(), b.size());
  if (longer - std::min(a.size(), b.size()) > most_edits || longer > 200) return most_edits + 1;

  // row[j]: edits between the first i letters of a and the first j letters of b
  std::vector<std::size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before = last;
    last = row;
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] =
          std::min({last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1), last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return std::min(row[b.size()], most_edits + 1);
}

bool is_misspelt(std::string_view word, std::string_view name) {
  const std::size_t apart = edits(word, name);
  return apart == 1 || (apart == 2 && std::min(word.size(), name.size()) >= 5);
}

}  // namespace momenta::reading
