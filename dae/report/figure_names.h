#pragma once
// Names in a figure that give way to each other.

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Names, each in the nearest of a few places where it crosses no sign and no other name; one that
/// finds none is left out.
class FigureNames {
 public:
  /// Of a figure of this size [pixels].
  FigureNames(double width, double height) : width_(width), height_(height) {}
  /// A name of the sign at a place.
  void add(const Eigen::Vector2d& at, const std::string& text);
  /// All of them as SVG. O(names²)
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
