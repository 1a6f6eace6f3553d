#pragma once
// Cells of a line of a CSV file.

#include <string>
#include <string_view>
#include <vector>

namespace momenta {

/// Cells between commas, without blanks and quotes around them or a carriage return at the end. For
/// numbers and plain names: no commas in quotes.
std::vector<std::string> csv_cells(std::string_view line);

}  // namespace momenta
