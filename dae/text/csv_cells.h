#pragma once
// A line of a CSV file taken apart.

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// The cells between commas, without blanks and quotes around them and without a carriage return at
/// the line's end. Cells of numbers and plain names: no comma stands in quotes.
std::vector<std::string> csv_cells(std::string_view line);

}  // namespace momenta
