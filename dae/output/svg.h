#pragma once
// Pieces of SVG text.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace momenta::svg {

/// A number with two decimals, or fewer: "12", "0.5", "-3.25".
std::string number(double value);

using Attributes = std::vector<std::pair<std::string_view, std::string>>;

/// <name a="…">inside</name>, values escaped; `inside` is markup.
std::string element(std::string_view name, const Attributes& attributes,
                    const std::string& inside = "");

/// Text at (x, y), anchor start, middle or end; escaped.
std::string text(double x, double y, const std::string& words, const char* anchor = "start",
                 const Attributes& more = {});

std::string line(double x0, double y0, double x1, double y1, const char* stroke, double width);

/// White ground, title and description, a sans-serif of 14 px.
std::string document(double width, double height, const std::string& title,
                     const std::string& description, const std::string& inside);

/// Approximate width of words [px].
double width_of(const std::string& words);

}  // namespace momenta::svg
