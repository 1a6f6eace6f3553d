#pragma once
// Words in error sentences: names in quotes, lists, and "did you mean".

#include <span>
#include <string>
#include <string_view>

namespace momenta::reading {

/// 'name', on one line whatever it holds: control characters are written \xNN, long names are cut
/// with "...".
std::string in_quotes(std::string_view name);

/// "'a', 'b'"; beyond `most` names only how many more there are.
std::string all_in_quotes(std::span<const std::string> names, std::size_t most = std::string::npos);

/// The same text with control characters and bytes that are not UTF-8 written \xNN, uncut and
/// without quotes.
std::string on_one_line(std::string_view text);

/// "a, b, c".
std::string listed(std::span<const std::string_view> names);

/// The shortest digits that read back as the same number.
std::string digits(double number);

/// "; did you mean 'name'?" for the known name nearest to `word`, at most two edits (edits.h) and
/// fewer than its letters away; else empty. Cost O(names × length).
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

}  // namespace momenta::reading
