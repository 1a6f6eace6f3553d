#pragma once
// Edit distance of words.

#include <cstddef>
#include <string_view>

namespace momenta::reading {

/// Distance beyond which words are unrelated.
inline constexpr std::size_t most_edits = 2;

/// Edit distance (optimal string alignment): letters inserted, deleted, replaced, or swapped with
/// their neighbours; most_edits + 1 where it is larger.
std::size_t edits(std::string_view a, std::string_view b);

/// Whether `word` is a slip for `name`: one edit away, or two for five letters or more.
bool is_misspelt(std::string_view word, std::string_view name);

}  // namespace momenta::reading
