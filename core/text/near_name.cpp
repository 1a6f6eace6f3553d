#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <vector>

namespace momenta::reading {
namespace {

constexpr std::size_t longest_name = 60;
constexpr std::size_t farthest = 2;

/// Levenshtein distance, or farthest + 1 when it is larger.
std::size_t distance(std::string_view a, std::string_view b) {
  const std::size_t longer = std::max(a.size(), b.size());
  if (longer - std::min(a.size(), b.size()) > farthest || longer > 200) return farthest + 1;

  // row[j]: distance between the first i letters of a and the first j letters of b
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return std::min(row[b.size()], farthest + 1);
}

}  // namespace

namespace {

/// Bytes of the UTF-8 character that `text` begins with; 0: none does.
std::size_t character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const std::size_t size = byte(0) < 0x80                       ? 1
                           : byte(0) >= 0xc2 && byte(0) < 0xe0  ? 2
                           : byte(0) >= 0xe0 && byte(0) < 0xf0  ? 3
                           : byte(0) >= 0xf0 && byte(0) <= 0xf4 ? 4
                                                                : 0;
  if (size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Too long for what it says, half of a pair, or beyond the last character.
  if (size > 2) {
    const unsigned second = byte(1);
    if ((byte(0) == 0xe0 && second < 0xa0) || (byte(0) == 0xed && second > 0x9f) ||
        (byte(0) == 0xf0 && second < 0x90) || (byte(0) == 0xf4 && second > 0x8f))
      return 0;
  }
  return size;
}

}  // namespace

std::string on_one_line(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string line;
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t size = byte < 0x20 || byte == 0x7f ? 0 : character(text.substr(i));
    if (size == 0) {
      line += "\\x";
      line += hex[byte >> 4];
      line += hex[byte & 15];
    }
    line += text.substr(i, size);
    i += std::max<std::size_t>(1, size);
  }
  return line;
}

std::string in_quotes(std::string_view name) {
  if (name.size() <= longest_name) return "'" + on_one_line(name) + "'";
  std::size_t cut = longest_name;
  while (cut > 0 && (static_cast<unsigned char>(name[cut]) & 0xc0) == 0x80) --cut;
  return "'" + on_one_line(name.substr(0, cut)) + "...'";
}

std::string all_in_quotes(std::span<const std::string> names, std::size_t most) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i == most) return all + " and " + std::to_string(names.size() - i) + " more";
    all += (i == 0 ? "" : ", ") + in_quotes(names[i]);
  }
  return all;
}

std::string listed(std::span<const std::string_view> names) {
  std::string list;
  for (const std::string_view name : names) {
    if (!list.empty()) list += ", ";
    list += name;
  }
  return list;
}

std::string digits(double number) {
  if (std::isnan(number)) return "nan";  // with a sign on some machines
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), number).ptr;
  return {text.data(), end};
}

std::string did_you_mean(std::string_view word, std::span<const std::string_view> known) {
  std::string_view nearest;
  std::size_t least = farthest + 1;
  for (const std::string_view name : known) {
    const std::size_t d = distance(word, name);
    if (d < least && d < std::max(word.size(), name.size())) {
      least = d;
      nearest = name;
    }
  }
  return nearest.empty() ? std::string() : "; did you mean " + in_quotes(nearest) + "?";
}

}  // namespace momenta::reading
