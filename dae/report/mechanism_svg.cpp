// The mechanism as a figure: the eye of the pages (page/camera.js), lines for solids.
//
//   in the plane  x = s e₁·r, y = −s e₂·r;   in space  x = f a·d/(c·d), y = −f b·d/(c·d),  d = r −
//   eye
//
// What is far is drawn first.

#include <momenta/dae/report/figure.h>
#include <momenta/dae/report/svg.h>
#include <momenta/dae/study/motion.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double picture_width = 560, most_height = 480, margin = 48;
constexpr const char *body_colour = "#8fa3bb", *rim = "#3c4653", *gap_colour = "#d55e00",
                     *dark = "#17191d";

struct Projected {
  Vector2d at;
  double depth, scale;  ///< scale: pixels per metre there
};

class Eye {
 public:
  Eye(const Picture& picture, const std::vector<Vector3d>& points) : planar_(picture.planar) {
    Vector3d low = Vector3d::Constant(INFINITY), high = -low;
    for (const Vector3d& p : points) {
      const Vector3d c = picture.view.transpose() * p;
      low = low.cwiseMin(c);
      high = high.cwiseMax(c);
    }
    if (points.empty()) low = high = Vector3d::Zero();
    const Vector3d middle = 0.5 * (low + high);
    const double size = std::max({(high - low).maxCoeff(), 0.5 * picture.length, 1e-9});
    centre_ = picture.view * middle;
    const double inner_width = picture_width - 2 * margin, inner_height = most_height - 2 * margin;
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
    for (const Vector3d& p : points) radius = std::max(radius, (p - centre_).norm());
    if (!(radius > 0)) radius = size;
    const Vector3d right = picture.view.col(0), up = picture.view.col(1),
                   toward = picture.view.col(2);
    const Vector3d ahead = -std::sin(yaw) * std::cos(pitch) * right - std::sin(pitch) * up -
                           std::cos(yaw) * std::cos(pitch) * toward;
    axes_.col(0) = std::cos(yaw) * right - std::sin(yaw) * toward;
    axes_.col(1) = axes_.col(0).cross(ahead);
    axes_.col(2) = ahead;
    height_ = most_height;
    scale_ = focal * inner_height / 2;
    eye_ = centre_ - 1.05 * focal * radius * ahead;
  }

  Projected project(const Vector3d& p) const {
    const Vector3d d = axes_.transpose() * (p - (planar_ ? centre_ : eye_));
    const double scale = planar_ ? scale_ : scale_ / d.z();
    return {Vector2d(picture_width / 2 + d.x() * scale, height_ / 2 - d.y() * scale),
            planar_ ? -d.z() : d.z(), scale};
  }
  double height() const { return height_; }
  bool planar() const { return planar_; }

 private:
  bool planar_;
  Vector3d centre_ = Vector3d::Zero(), eye_ = Vector3d::Zero();
  Eigen::Matrix3d axes_ = Eigen::Matrix3d::Identity();
  double scale_ = 1, height_ = most_height;
};

/// A thing to be drawn, the farthest first.
struct Item {
  double depth;
  std::string markup;
};

std::string circle(const Vector2d& at, double r, const char* fill, const char* stroke,
                   double width) {
  return svg::element("circle", {{"cx", svg::number(at.x())},
                                 {"cy", svg::number(at.y())},
                                 {"r", svg::number(r)},
                                 {"fill", fill},
                                 {"stroke", stroke},
                                 {"stroke-width", svg::number(width)}});
}

/// A piece of a bar with a rim of the ground, so that nearer ones pass in front; round where the
/// bar ends.
std::string bar(const Projected& a, const Projected& b, double width, bool first, bool last) {
  const Vector2d way = (b.at - a.at).normalized() * 0.7;
  const auto stroke = [&](const char* colour, double w, double over) {
    const Vector2d from = a.at - over * way, to = b.at + over * way;
    std::string markup = svg::line(from.x(), from.y(), to.x(), to.y(), colour, w);
    if (over > 0 && first) markup += circle(a.at, w / 2, colour, "none", 0);
    if (over > 0 && last) markup += circle(b.at, w / 2, colour, "none", 0);
    return markup;
  };
  return stroke("#ffffff", width + 2.5, 0) + stroke(rim, width, 1) +
         stroke(body_colour, std::max(0.6, width - 2), 1);
}

std::string polygon(const std::vector<Projected>& corners, const char* fill, double opacity) {
  std::string points;
  for (const Projected& c : corners)
    points += (points.empty() ? "" : " ") + svg::number(c.at.x()) + "," + svg::number(c.at.y());
  return svg::element("polygon", {{"points", points},
                                  {"fill", fill},
                                  {"fill-opacity", svg::number(opacity)},
                                  {"stroke", rim},
                                  {"stroke-linejoin", "round"}});
}

std::string ground_sign(const Vector2d& at) {
  const std::string d =
      "M" + svg::number(at.x()) + " " + svg::number(at.y()) + "l-9 13h18zm-13 13h26";
  return svg::element("path",
                      {{"d", d}, {"fill", "#ffffff"}, {"stroke", dark}, {"stroke-width", "1.8"}}) +
         circle(at, 4, "#ffffff", dark, 2);
}

/// Corners of a box about the mass centre, body axes; bits of `i` choose the sides.
Vector3d corner(const Picture::Body& body, int i) {
  const Vector3d half = 0.5 * body.shape.size;
  return body.com + Vector3d((i & 1) != 0 ? half.x() : -half.x(),
                             (i & 2) != 0 ? half.y() : -half.y(),
                             (i & 4) != 0 ? half.z() : -half.z());
}

/// Everything that has to be within the picture, ground axes.
std::vector<Vector3d> extent(const Picture& picture, const std::vector<Isometry3d>& at) {
  std::vector<Vector3d> points;
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    for (const Vector3d& end : body.ends) points.push_back(at[k] * end);
    for (int i = 0; i < 8 && body.shape.kind == "box"; ++i)
      points.push_back(at[k] * corner(body, i));
    if (body.shape.kind == "sphere")
      for (int i = 0; i < 6; ++i)
        points.push_back(at[k] * body.com +
                         (i % 2 == 0 ? 1 : -1) * body.shape.size.x() * Vector3d::Unit(i / 2));
    if (body.shape.kind == "cylinder")
      for (const double s : {-0.5, 0.5})
        points.push_back(at[k] * (body.com + s * body.shape.size.x() * body.shape.axis));
    if (body.parent < 0 && body.joint_kind != "free") points.push_back(body.at_parent);
  }
  for (const auto* pairs : {&picture.loops, &picture.springs})
    for (const Picture::Pair& pair : *pairs)
      if (pair.parent < 0) points.push_back(pair.at_parent);
  return points;
}

/// Median length of links: what widths of lines follow.
double usual_length(const Picture& picture) {
  std::vector<double> lengths;
  for (const Picture::Body& body : picture.bodies)
    for (std::size_t i = 1; i < body.ends.size(); ++i)
      lengths.push_back((body.ends[i] - body.ends[0]).norm());
  if (lengths.empty()) return picture.length;
  std::nth_element(lengths.begin(), lengths.begin() + static_cast<long>(lengths.size() / 2),
                   lengths.end());
  return lengths[lengths.size() / 2];
}

void add_body(std::vector<Item>& items, const Picture::Body& body, const Isometry3d& at,
              const Eye& eye, double width) {
  const auto project = [&](const Vector3d& p) { return eye.project(at * p); };
  const auto add_bar = [&](const Vector3d& a, const Vector3d& b, double metres) {
    // In pieces, each at its own depth.
    const int pieces = eye.planar() ? 1 : 8;
    for (int i = 0; i < pieces; ++i) {
      const Projected p = project(a + (b - a) * i / pieces),
                      q = project(a + (b - a) * (i + 1) / pieces);
      const double w = std::clamp(0.5 * metres * (p.scale + q.scale), 2.0, 60.0);
      items.push_back({0.5 * (p.depth + q.depth), bar(p, q, w, i == 0, i + 1 == pieces)});
    }
  };
  const std::string& kind = body.shape.kind;
  if (kind == "box") {
    static constexpr std::array<std::array<int, 4>, 6> faces{
        {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}}};
    const double middle = project(body.com).depth;
    for (const auto& face : faces) {
      std::vector<Projected> corners;
      double depth = 0;
      for (const int i : face) {
        corners.push_back(project(corner(body, i)));
        depth += corners.back().depth / 4;
      }
      if (depth < middle) items.push_back({depth, polygon(corners, body_colour, 1)});
    }
  } else if (kind == "cylinder") {
    const Vector3d half = 0.5 * body.shape.size.x() * body.shape.axis.normalized();
    add_bar(body.com - half, body.com + half, 2 * body.shape.size.y());
  } else if (kind == "sphere") {
    const Projected p = project(body.com);
    items.push_back(
        {p.depth, circle(p.at, std::max(2.0, body.shape.size.x() * p.scale), body_colour, rim, 1)});
  } else if (body.ends.size() == 3) {
    std::vector<Projected> corners;
    double depth = -INFINITY;
    for (const Vector3d& end : body.ends) {
      corners.push_back(project(end));
      depth = std::max(depth, corners.back().depth);
    }
    items.push_back({depth, polygon(corners, body_colour, 0.35)});
    for (std::size_t i = 0; i < 3; ++i) add_bar(body.ends[i], body.ends[(i + 1) % 3], width);
  } else if (body.ends.size() == 2) {
    add_bar(body.ends[0], body.ends[1], width);
  } else {
    Vector3d middle = Vector3d::Zero();
    for (const Vector3d& end : body.ends) middle += end / static_cast<double>(body.ends.size());
    for (const Vector3d& end : body.ends) add_bar(middle, end, width);
  }
}

}  // namespace

std::string mechanism_svg(const Picture& picture, const Motion::Frame& frame) {
  const std::vector<Isometry3d> at = places(picture, frame);
  const Eye eye(picture, extent(picture, at));
  const auto point = [&](int body, const Vector3d& p) -> Vector3d {
    return body < 0 ? p : Vector3d(at[static_cast<std::size_t>(body)] * p);
  };
  const double width = 0.1 * usual_length(picture), nearer = picture.planar ? 1e-9 : 1.2 * width;
  std::vector<Item> items;
  std::string names;
  const bool named = picture.bodies.size() + picture.loops.size() <= 16;
  const auto name = [&](const Projected& p, const std::string& words) {
    if (!named) return;
    names += svg::text(p.at.x() + 10, p.at.y() - 9, words, "start",
                       {{"stroke", "#ffffff"},
                        {"stroke-width", "4"},
                        {"stroke-linejoin", "round"},
                        {"paint-order", "stroke"}});
  };
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    add_body(items, body, at[k], eye, width);
    if (body.joint_kind == "free") continue;
    const Projected p = eye.project(at[k] * body.at_child);
    items.push_back({p.depth - nearer,
                     body.parent < 0 ? ground_sign(p.at) : circle(p.at, 4.5, "#ffffff", dark, 2)});
    name(p, body.joint);
  }
  for (const Picture::Pair& spring : picture.springs) {
    const Projected a = eye.project(point(spring.parent, spring.at_parent)),
                    b = eye.project(point(spring.child, spring.at_child));
    items.push_back({0.5 * (a.depth + b.depth),
                     svg::line(a.at.x(), a.at.y(), b.at.x(), b.at.y(), "#525a66", 1.5)});
  }
  for (const Picture::Pair& loop : picture.loops) {
    const Projected a = eye.project(point(loop.parent, loop.at_parent)),
                    b = eye.project(point(loop.child, loop.at_child));
    std::string sign =
        circle(b.at, 7, "#ffffff", gap_colour, 2) + circle(b.at, 3, gap_colour, gap_colour, 0);
    if (loop.kind == "distance")
      sign = svg::line(a.at.x(), a.at.y(), b.at.x(), b.at.y(), gap_colour, 2) + sign;
    items.push_back({b.depth - 2 * nearer, sign});
    name(b, "loop " + loop.name);
  }
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.depth > b.depth; });
  std::string inside;
  for (const Item& item : items) inside += item.markup;
  return svg::document(picture_width, eye.height(), "The mechanism",
                       std::to_string(picture.bodies.size()) + " bodies, " +
                           std::to_string(picture.loops.size()) + " loops",
                       inside + names);
}

}  // namespace momenta
