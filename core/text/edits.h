#pragma once
// How far a word is from another.

#include <cstddef>
#include <string_view>

namespace momenta::reading {

/// Beyond it words have nothing to do with each other.
inline constexpr std::size_t most_edits = 2;

/// Letters put in, left out, replaced, or exchanged with their neighbours, that make one word of
/// the other (the optimal string alignment); most_edits + 1 where it takes more.
std::size_t edits(std::string_view a, std::string_view b);

/// Whether `word` is a slip of the pen for `name`: one edit away, or two of five letters or more.
bool is_misspelt(std::string_view word, std::string_view name);

}  // namespace momenta::reading
