#pragma once
// Names in a figure that do not overlap.

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Each name stands in the nearest of a few places where it crosses no sign or other name, or is
/// left out.
class FigureNames {
 public:
  /// Size of the figure [pixels].
  FigureNames(double width, double height) : width_(width), height_(height) {}
  /// Adds a name for the sign at a place.
  void add(const Eigen::Vector2d& at, const std::string& text);
  /// O(names²)
  std::string markup();

 private:
  struct Box {
    double x, y, w, h;
  };
  bool free(const Box& b) const;
  double width_, height_;
  std::vector<std::pair<Eigen::Vector2d, std::string>> wanted_;
  std::vector<Box> taken_;
};

}  // namespace momenta
