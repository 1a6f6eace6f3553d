#pragma once
// Figures for papers: self-contained SVG without script, black text on white, the pages' colours.

#include <momenta/dae/output/chart.h>
#include <momenta/dae/run/picture.h>
#include <momenta/dae/study/stress_study.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

struct Figure {
  std::string name;  ///< file name without ending
  std::string svg;
};

/// Axes and curves, named at their ends and thinned to visible points of the data, extremes kept.
/// <desc> has the ranges of both axes.
std::string chart_svg(const Chart& chart);

/// The mechanism at its start and the page's charts.
std::vector<Figure> figures_of_run(const StudyResult&);
std::vector<Figure> figures_of_study(const StudyResult&);
/// A table of verdicts a ladder.
std::vector<Figure> figures_of_stress(const StressResult&);

/// The mechanism at a frame of its motion, in its plane or in perspective.
std::string mechanism_svg(const Picture& picture, const Motion::Frame& frame);

// Projection of figures, as on pages (page/camera.js):
//
//   in the plane  x = s e₁·r, y = −s e₂·r
//   in space      x = f a·d/(c·d), y = −f b·d/(c·d),  d = r − eye

inline constexpr double figure_width = 560, most_figure_height = 480;  ///< pixels

struct Projected {
  Eigen::Vector2d at;
  double depth, scale;  ///< scale: pixels per metre there
};

/// A camera in front of the plane, or one in space that sees everything.
class FigureEye {
 public:
  /// @pre `points` fit within the figure, ground axes
  FigureEye(const Picture& picture, const std::vector<Eigen::Vector3d>& points)
      : planar_(picture.planar) {
    constexpr double margin = 48;
    Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
    for (const Eigen::Vector3d& p : points) {
      const Eigen::Vector3d c = picture.view.transpose() * p;
      low = low.cwiseMin(c);
      high = high.cwiseMax(c);
    }
    if (points.empty()) low = high = Eigen::Vector3d::Zero();
    const Eigen::Vector3d middle = 0.5 * (low + high);
    const double size = std::max({(high - low).maxCoeff(), 0.5 * picture.length, 1e-9});
    centre_ = picture.view * middle;
    const double inner_width = figure_width - 2 * margin,
                 inner_height = most_figure_height - 2 * margin;
    if (planar_) {
      const double across = high.x() - low.x() > 0 ? high.x() - low.x() : size,
                   along = high.y() - low.y() > 0 ? high.y() - low.y() : size;
      scale_ = std::min(inner_width / across, inner_height / along);
      height_ = std::max(180.0, along * scale_ + 2 * margin);
      axes_ = picture.view;
      return;
    }
    constexpr double yaw = 0.62, pitch = 0.42, focal = 2.6;
    double radius = 0;
    for (const Eigen::Vector3d& p : points) radius = std::max(radius, (p - centre_).norm());
    if (!(radius > 0)) radius = size;
    const Eigen::Vector3d right = picture.view.col(0), up = picture.view.col(1),
                          toward = picture.view.col(2);
    const Eigen::Vector3d ahead = -std::sin(yaw) * std::cos(pitch) * right - std::sin(pitch) * up -
                                  std::cos(yaw) * std::cos(pitch) * toward;
    axes_.col(0) = std::cos(yaw) * right - std::sin(yaw) * toward;
    axes_.col(1) = axes_.col(0).cross(ahead);
    axes_.col(2) = ahead;
    height_ = most_figure_height;
    scale_ = focal * inner_height / 2;
    eye_ = centre_ - 1.05 * focal * radius * ahead;
  }

  Projected project(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d d = axes_.transpose() * (p - (planar_ ? centre_ : eye_));
    const double scale = planar_ ? scale_ : scale_ / d.z();
    return {Eigen::Vector2d(figure_width / 2 + d.x() * scale, height_ / 2 - d.y() * scale),
            planar_ ? -d.z() : d.z(), scale};
  }
  bool sees(const Eigen::Vector3d& corner, const Eigen::Vector3d& outward) const {
    return (planar_ ? axes_.col(2) : Eigen::Vector3d(eye_ - corner)).dot(outward) > 0;
  }
  /// Brightness from 0 to 1, in light from above on the left.
  double light(const Eigen::Vector3d& outward) const {
    const Eigen::Vector3d towards = planar_ ? axes_.col(2) : Eigen::Vector3d(-axes_.col(2));
    const Eigen::Vector3d from =
        (-0.35 * axes_.col(0) + 0.75 * axes_.col(1) + 0.6 * towards).normalized();
    return 0.5 + 0.5 * outward.dot(from);
  }
  double height() const { return height_; }
  bool planar() const { return planar_; }

 private:
  bool planar_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero(), eye_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  double scale_ = 1, height_ = most_figure_height;
};

// Limits of joints in figures, as on pages (page/solids.js): for an angle a sector between its
// bounds, from the joint towards the body's mass; for a displacement the way between them.
// Spherical joints have no mark: their limit is a cone only for some axes.

struct LimitMark {
  std::vector<Eigen::Vector3d> outline;  ///< ground axes; its first and last two points: the bounds
  std::array<Eigen::Vector3d, 2> now;    ///< place of the joint
  bool passed = false;                   ///< beyond a bound
};

/// Limits that are drawn. `at`: poses of the bodies; `width`: of bars [m]. O(bodies)
std::vector<LimitMark> limit_marks(const Picture& picture, const std::vector<Eigen::Isometry3d>& at,
                                   double width);

// Names in a figure that do not overlap.

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
