#pragma once
// Numbers as text, all by std::to_chars, so that no locale changes a digit or decimal point.

#include <string>
#include <vector>

namespace momenta {

/// Fewest digits that read back to the same double: "0.1", "1e-08". NaN gives "" and infinities
/// "inf", "-inf".
std::string round_trip(double value);

/// `digits` significant digits, exponents without padding: "0.27", "2.7e-5", "1.2e4". Plain between
/// 1e-3 and 1e4; NaN: "-".
std::string compact(double value, int digits);

/// Number with exponent, to compare in columns: "2.7e-1", "0", "-" for NaN.
std::string scientific(double value, int digits);

/// `decimals` decimals: "1.00"; "-" for NaN.
std::string fixed(double value, int decimals);

/// Length with SI prefix: "0.27 m", "27 mm", "3.5 µm", "12 nm"; below 1 pm in powers of ten:
/// "4.4e-14 m".
std::string length_text(double metres);

/// Time with SI prefix: "12 s", "0.31 s", "31 ms", "4.2 µs".
std::string time_text(double seconds);

/// Characters on a terminal: bytes of UTF-8 without continuations and combining dots.
std::size_t width(const std::string& text);
/// Adds spaces up to that width.
std::string padded(const std::string& text, std::size_t to);
/// Rows of a table, one a line; columns two blanks apart.
std::string in_columns(const std::vector<std::vector<std::string>>& rows);

}  // namespace momenta
