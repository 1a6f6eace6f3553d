#pragma once
// Numbers as text. Everything goes through std::to_chars, so no locale can change a digit or a
// decimal point.

#include <string>
#include <vector>

namespace momenta {

/// The fewest digits that read back to the same double: "0.1", "1e-08". NaN gives "" and infinities
/// "inf", "-inf".
std::string round_trip(double value);

/// `digits` significant digits without padding zeros in the exponent: "0.27", "2.7e-5", "1.2e+4" as
/// "1.2e4". Plain notation between 1e-3 and 1e4; NaN gives "-".
std::string compact(double value, int digits);

/// Always an exponent, for columns to be compared by eye: "2.7e-1", "0", "-" for NaN.
std::string scientific(double value, int digits);

/// Exactly `decimals` decimals: "1.00"; "-" for NaN.
std::string fixed(double value, int decimals);

/// A length with its SI prefix: "0.27 m", "27 mm", "3.5 µm", "12 nm"; below 1 pm in powers of ten:
/// "4.4e-14 m".
std::string length_text(double metres);

/// The same for a time: "12 s", "0.31 s", "31 ms", "4.2 µs".
std::string time_text(double seconds);

/// Characters on a terminal: bytes of UTF-8 without its continuations, combining dots not counted.
std::size_t width(const std::string& text);
/// With spaces behind it to that width.
std::string padded(const std::string& text, std::size_t to);
/// Rows of a table, one a line, each column as wide as its widest cell and two blanks.
std::string in_columns(const std::vector<std::vector<std::string>>& rows);

}  // namespace momenta
