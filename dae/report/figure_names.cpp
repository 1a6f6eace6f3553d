#include <momenta/dae/report/figure_names.h>
#include <momenta/dae/report/svg.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
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
