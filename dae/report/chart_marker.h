#pragma once
// Markers of a chart's points, as SVG.

#include <string>

namespace momenta {

/// A circle, square, triangle, diamond, plus or star about (x, y), r in size [px]; else a square.
std::string marker(const std::string& kind, double x, double y, double r, const std::string& fill);

/// Sign of a failed run.
std::string cross_at(double x, double y);

}  // namespace momenta
