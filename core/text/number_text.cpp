#include <momenta/core/text/number_text.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace momenta {
namespace {

// "2.70e-05" → "2.7e-5": without idle zeros and plus sign.
std::string tidy(const std::string& text) {
  const auto e = text.find('e');
  std::string mantissa = text.substr(0, e);
  if (mantissa.find('.') != std::string::npos) {
    mantissa.erase(mantissa.find_last_not_of('0') + 1);
    if (mantissa.back() == '.') mantissa.pop_back();
  }
  if (e == std::string::npos) return mantissa;
  std::string exponent = text.substr(e + 1);
  const bool negative = exponent.front() == '-';
  exponent.erase(0, exponent.find_first_of("123456789"));
  return mantissa + 'e' + (negative ? "-" : "") + exponent;
}

std::string format(double value, std::chars_format notation, int precision) {
  std::array<char, 400> text{};  // 309 digits before the point at most
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), value, notation, precision);
  return {text.data(), end.ptr};
}

struct Prefix {
  double unit;
  const char* name;
};

std::string with_prefix(double value, const char* unit, const std::array<Prefix, 4>& prefixes,
                        double base_from) {
  const double size = std::abs(value);
  if (size == 0) return std::string("0 ") + unit;
  if (!std::isfinite(value) || size >= base_from) return compact(value, 2) + ' ' + unit;
  for (const Prefix& prefix : prefixes) {
    // 0.9995 of the unit would print as 1.0 of it.
    if (size >= 0.9995 * prefix.unit)
      return compact(value / prefix.unit, 2) + ' ' + prefix.name + unit;
  }
  return scientific(value, 2) + ' ' + unit;
}

constexpr std::array<Prefix, 4> prefixes{{{1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}, {1e-12, "p"}}};

}  // namespace

std::string round_trip(double value) {
  if (std::isnan(value)) return {};
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::string scientific(double value, int digits) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  if (value == 0) return "0";
  const std::string text = tidy(format(value, std::chars_format::scientific, digits - 1));
  return text.back() == 'e' ? text + '0' : text;
}

std::string compact(double value, int digits) {
  if (std::isnan(value) || std::isinf(value) || value == 0) return scientific(value, digits);
  const double size = std::abs(value);
  if (size < 1e-3 || size >= 1e4) return scientific(value, digits);
  // Rounds to the digits first: 0.0996 with two digits is 0.1, and has one decimal less.
  const std::string rounded = format(value, std::chars_format::scientific, digits - 1);
  double kept = 0;
  std::from_chars(rounded.data(), rounded.data() + rounded.size(), kept);
  const int exponent = static_cast<int>(std::floor(std::log10(std::abs(kept)) + 1e-12));
  return tidy(format(kept, std::chars_format::fixed, std::max(0, digits - 1 - exponent)));
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return scientific(value, 1);
  const std::string text = format(value, std::chars_format::fixed, decimals);
  // -0.00 becomes 0.00
  return text.find_first_of("123456789") == std::string::npos && text.front() == '-'
             ? text.substr(1)
             : text;
}

std::string length_text(double metres) {
  return with_prefix(metres, "m", prefixes, 0.1);
}

std::string time_text(double seconds) {
  return with_prefix(seconds, "s", prefixes, 0.1);
}

std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte & 0xc0) != 0x80 && byte != 0xcc;
  }));
}

std::string padded(const std::string& text, std::size_t to) {
  return text + std::string(to > width(text) ? to - width(text) : 0, ' ');
}

std::string in_columns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widest;
  for (const auto& row : rows) {
    widest.resize(std::max(widest.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widest[i] = std::max(widest[i], width(row[i]));
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) line += padded(row[i], widest[i] + 2);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace momenta
