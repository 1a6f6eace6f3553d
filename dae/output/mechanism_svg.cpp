// The mechanism as a figure, far parts first: solids, bars for bodies without any, signs of joints
// and loops, limits where there are few, names.

#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/meshes.h>
#include <momenta/dae/output/svg.h>
#include <momenta/dae/run/motion.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace momenta {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr const char *body_colour = "#8fa3bb", *rim = "#3c4653", *gap_colour = "#d55e00",
                     *dark = "#17191d", *limit_colour = "#525a66";

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

/// A piece of a bar, with a rim so that nearer ones pass in front; round at the bar's ends.
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

/// Corner of a box about the mass centre, body axes; bits of `i` choose the sides.
Vector3d corner(const Picture::Body& body, int i) {
  const Vector3d half = 0.5 * body.shape.size;
  return body.com + Vector3d((i & 1) != 0 ? half.x() : -half.x(),
                             (i & 2) != 0 ? half.y() : -half.y(),
                             (i & 4) != 0 ? half.z() : -half.z());
}

std::vector<bool> with_solids(const Picture& picture) {
  std::vector<bool> seen(picture.bodies.size(), false);
  for (const Picture::Solid& solid : picture.solids)
    if (solid.body >= 0 && (solid.visual.kind != "mesh" || solid.mesh >= 0))
      seen[static_cast<std::size_t>(solid.body)] = true;
  return seen;
}

/// Points to be within the picture, ground axes.
std::vector<Vector3d> extent(const Picture& picture, const std::vector<Isometry3d>& at) {
  std::vector<Vector3d> points;
  const std::vector<bool> solid = with_solids(picture);
  for (const Picture::Solid& s : picture.solids)
    if (s.body >= 0)
      for (const Face& face : faces_of(picture, s))
        for (const Vector3d& corner : face)
          points.push_back(at[static_cast<std::size_t>(s.body)] * corner);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    if (solid[k]) {
      points.push_back(at[k] * body.at_child);
      continue;
    }
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
  for (const Picture::Pair& loop : picture.loops)
    if (loop.parent < 0) points.push_back(loop.at_parent);
  // The ground's end of a spring, unless so far away that the mechanism would be a dot.
  Vector3d low = Vector3d::Constant(INFINITY), high = -low;
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  const double reach = points.empty() ? INFINITY : 0.5 * (high - low).norm();
  for (const Picture::Pair& spring : picture.springs)
    if (const Vector3d& p = spring.at_parent;
        spring.parent < 0 && (points.empty() || ((p.array() > low.array() - reach).all() &&
                                                 (p.array() < high.array() + reach).all())))
      points.push_back(p);
  return points;
}

/// Median length of links, for line widths.
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
              const FigureEye& eye, double width) {
  const auto project = [&](const Vector3d& p) { return eye.project(at * p); };
  const auto add_bar = [&](const Vector3d& a, const Vector3d& b, double metres) {
    // Pieces, each at its own depth.
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

/// Limits stand in front of everything.
void add_limits(std::vector<Item>& items, const std::vector<LimitMark>& marks,
                const FigureEye& eye) {
  constexpr double in_front = -1e8;
  for (const LimitMark& mark : marks) {
    const auto line = [&](std::size_t i, const char* colour, double w) {
      const Vector2d a = eye.project(mark.outline[i]).at, b = eye.project(mark.outline[i + 1]).at;
      return svg::line(a.x(), a.y(), b.x(), b.y(), colour, w);
    };
    std::string markup;
    const std::size_t last = mark.outline.size() - 2;
    for (std::size_t i = 0; i <= last; ++i)
      markup += line(i, limit_colour, i == 0 || i == last ? 1.6 : 1.2);
    const Vector2d a = eye.project(mark.now[0]).at, b = eye.project(mark.now[1]).at;
    markup += svg::line(a.x(), a.y(), b.x(), b.y(), mark.passed ? gap_colour : limit_colour,
                        mark.passed ? 2.4 : 1.2);
    items.push_back({in_front, markup});
  }
}

/// Eight bits a channel, darker in less light.
std::string shaded(const std::optional<Vector3d>& colour, double light) {
  const Vector3d base = colour.value_or(Vector3d(0x8f, 0xa3, 0xbb) / 255);
  char hex[8];
  const auto part = [&](int i) {
    return static_cast<unsigned>(std::lround(255 * std::min(1.0, base[i] * (0.55 + 0.6 * light))));
  };
  std::snprintf(hex, sizeof hex, "#%02x%02x%02x", part(0) & 255U, part(1) & 255U, part(2) & 255U);
  return hex;
}

/// Adds a solid's visible faces.
void add_solid(std::vector<Item>& items, const Picture& picture, const Picture::Solid& solid,
               const Isometry3d& at, const FigureEye& eye) {
  for (const Face& face : faces_of(picture, solid)) {
    Vector3d outward = Vector3d::Zero();  // normal of any polygon
    for (std::size_t i = 0; i < face.size(); ++i)
      outward += face[i].cross(face[(i + 1) % face.size()]);
    outward = at.linear() * outward.normalized();
    if (!outward.allFinite() || !eye.sees(at * face[0], outward)) continue;
    std::string points;
    double depth = 0;
    for (const Vector3d& corner : face) {
      const Projected p = eye.project(at * corner);
      points += (points.empty() ? "" : " ") + svg::number(p.at.x()) + "," + svg::number(p.at.y());
      depth += p.depth / static_cast<double>(face.size());
    }
    const std::string fill = shaded(solid.visual.colour, eye.light(outward));
    items.push_back({depth, svg::element("polygon", {{"points", points},
                                                     {"fill", fill},
                                                     {"stroke", fill},
                                                     {"stroke-width", "0.6"},
                                                     {"stroke-linejoin", "round"}})});
  }
}

}  // namespace

std::string mechanism_svg(const Picture& whole, const Motion::Frame& frame) {
  constexpr std::size_t mesh_bytes = 24'000;  // some 200 kB of polygons
  Picture picture = whole;
  coarsen_meshes(picture, mesh_bytes);
  const std::vector<Isometry3d> at = places(picture, frame);
  const FigureEye eye(picture, extent(picture, at));
  const auto point = [&](int body, const Vector3d& p) -> Vector3d {
    return body < 0 ? p : Vector3d(at[static_cast<std::size_t>(body)] * p);
  };
  const double width = 0.1 * usual_length(picture), nearer = picture.planar ? 1e-9 : 1.2 * width;
  std::vector<Item> items;
  FigureNames names(figure_width, eye.height());
  const bool named = picture.bodies.size() + picture.loops.size() <= 16;
  const auto name = [&](const Projected& p, const std::string& words) {
    if (named) names.add(p.at, words);
  };
  const std::vector<bool> solid = with_solids(picture);
  for (const Picture::Solid& s : picture.solids)
    if (s.body >= 0) add_solid(items, picture, s, at[static_cast<std::size_t>(s.body)], eye);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    if (!solid[k]) add_body(items, body, at[k], eye, width);
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
  constexpr std::size_t most_limits = 8;
  if (const auto marks = limit_marks(picture, at, width); marks.size() <= most_limits)
    add_limits(items, marks, eye);
  std::stable_sort(items.begin(), items.end(),
                   [](const Item& a, const Item& b) { return a.depth > b.depth; });
  std::string inside;
  for (const Item& item : items) inside += item.markup;
  return svg::document(figure_width, eye.height(), "The mechanism",
                       std::to_string(picture.bodies.size()) + " bodies, " +
                           std::to_string(picture.loops.size()) + " loops",
                       inside + names.markup());
}

}  // namespace momenta
