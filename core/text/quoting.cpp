#include <momenta/core/text/edits.h>
#include <momenta/core/text/quoting.h>
#include <momenta/core/text/utf8.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace momenta::reading {
namespace {

constexpr std::size_t longest_name = 60;

}  // namespace

std::string on_one_line(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string line;
  for (const char c : as_utf8(text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      line += {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
    else
      line += c;
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
  std::size_t least = most_edits + 1;
  for (const std::string_view name : known) {
    const std::size_t d = edits(word, name);
    if (d < least && d < std::max(word.size(), name.size())) {
      least = d;
      nearest = name;
    }
  }
  return nearest.empty() ? std::string() : "; did you mean " + in_quotes(nearest) + "?";
}

}  // namespace momenta::reading
