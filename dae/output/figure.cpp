#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/svg.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {

namespace {

std::vector<Figure> drawn_all(const std::vector<Chart>& charts, const Picture& picture,
                              const std::vector<Motion>& motions) {
  std::vector<Figure> figures;
  if (!picture.bodies.empty() && !motions.empty() && !motions.front().frames.empty())
    figures.push_back({"mechanism", mechanism_svg(picture, motions.front().frames.front())});
  for (const Chart& chart : charts) figures.push_back({chart.key, chart_svg(chart)});
  return figures;
}

}  // namespace

std::vector<Figure> figures_of_run(const StudyResult& study) {
  return drawn_all(charts_of_run(study.runs.front()), study.picture, study.motions);
}
std::vector<Figure> figures_of_study(const StudyResult& study) {
  return drawn_all(charts_of_study(study), study.picture, study.motions);
}

namespace {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double whole_turn = 2 * std::numbers::pi;

LimitMark of_slide(const Picture::Body& body, const Isometry3d& parent, const Vector3d& centre,
                   double width) {
  const auto [low, high] = *body.limits;
  const Vector3d along = body.rest * body.axis, across = perpendicular_to(along) * width;
  const auto place = [&](double q, double off) -> Vector3d {
    return parent * Vector3d(body.at_parent + q * along + off * across);
  };
  const double q = along.dot(parent.inverse() * centre - body.at_parent);
  constexpr double rounding = 1e-6;  // [m]
  return {{place(low, -0.6), place(low, 0.6), place(low, 0), place(high, 0), place(high, -0.6),
           place(high, 0.6)},
          {place(q, -0.4), place(q, 0.4)},
          q < low - rounding || q > high + rounding};
}

LimitMark of_turn(const Picture::Body& body, const Isometry3d& parent, const Isometry3d& at,
                  const Vector3d& centre, double width, double least_arm) {
  const auto [low, high] = *body.limits;
  const Vector3d arm = body.com - body.at_child, flat = arm - body.axis * body.axis.dot(arm);
  const Vector3d out = flat.norm() > least_arm ? flat.normalized() : perpendicular_to(body.axis);
  const double radius = std::max(2.2 * width, 0.5 * flat.norm());
  const Quaterniond axes = Quaterniond(parent.linear()) * body.rest;
  const auto ray = [&](double angle) -> Vector3d {
    return centre + radius * (axes * (Eigen::AngleAxisd(angle, body.axis) * out));
  };
  LimitMark mark;
  constexpr double step = 0.15;  // [rad]
  const int steps = std::max(2, static_cast<int>(std::ceil((high - low) / step)));
  mark.outline.push_back(centre);
  for (int i = 0; i <= steps; ++i) mark.outline.push_back(ray(low + (high - low) * i / steps));
  mark.outline.push_back(centre);
  mark.now = {centre, centre + 1.25 * radius * (at.linear() * out)};
  const Quaterniond own = axes.conjugate() * Quaterniond(at.linear());
  const double angle = 2 * std::atan2(own.vec().dot(body.axis), own.w());
  const double off = std::remainder(angle - 0.5 * (low + high), whole_turn);
  constexpr double rounding = 1e-4;  // [rad]
  mark.passed = std::abs(off) > 0.5 * (high - low) + rounding;
  return mark;
}

}  // namespace

std::vector<LimitMark> limit_marks(const Picture& picture, const std::vector<Isometry3d>& at,
                                   double width) {
  std::vector<LimitMark> marks;
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    if (!body.limits) continue;
    const double range = (*body.limits)[1] - (*body.limits)[0];
    const Isometry3d parent =
        body.parent < 0 ? Isometry3d::Identity() : at[static_cast<std::size_t>(body.parent)];
    const Vector3d centre = at[k] * body.at_child;
    if (body.joint_kind == "prismatic") {
      if (range <= 20 * picture.length) marks.push_back(of_slide(body, parent, centre, width));
    } else if (body.turn == Picture::Turn::about_axis && range < whole_turn) {
      marks.push_back(of_turn(body, parent, at[k], centre, width, 1e-6 * picture.length));
    }
  }
  return marks;
}

namespace {

std::size_t letters(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned>(c) & 0xc0U) != 0x80U;
  }));
}

}  // namespace

void FigureNames::add(const Eigen::Vector2d& at, const std::string& text) {
  wanted_.emplace_back(at, text);
  taken_.push_back({at.x() - 8, at.y() - 8, 16, 16});
}

bool FigureNames::free(const Box& b) const {
  return b.x > 0 && b.y > 0 && b.x + b.w < width_ && b.y + b.h < height_ &&
         std::none_of(taken_.begin(), taken_.end(), [&](const Box& o) {
           return b.x < o.x + o.w && o.x < b.x + b.w && b.y < o.y + o.h && o.y < b.y + b.h;
         });
}

std::string FigureNames::markup() {
  constexpr double letter = 6.6, height = 16;
  std::string all;
  for (const auto& [at, text] : wanted_) {
    const double w = letter * static_cast<double>(letters(text)) + 4;
    constexpr int around = 12;
    for (int k = 0; k < 2 * around; ++k) {
      const double far = k < around ? 12 : 24, angle = std::numbers::pi / 6 * (k % around + 1);
      const Eigen::Vector2d middle = at + Eigen::Vector2d(std::cos(angle) * (far + w / 2),
                                                          -std::sin(angle) * (far + height / 2));
      const Box box{middle.x() - w / 2, middle.y() - height / 2, w, height};
      if (!free(box)) continue;
      taken_.push_back(box);
      all += svg::text(middle.x(), middle.y() + 4, text, "middle",
                       {{"stroke", "#ffffff"},
                        {"stroke-width", "4"},
                        {"stroke-linejoin", "round"},
                        {"paint-order", "stroke"}});
      break;
    }
  }
  return all;
}

}  // namespace momenta
