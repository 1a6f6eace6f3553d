#include <momenta/dae/output/json.h>
#include <momenta/dae/output/sampled_curves.h>

#include <algorithm>
#include <cmath>

namespace momenta {

std::vector<std::size_t> thinned(const std::vector<double>& t, const std::vector<double>& y,
                                 std::size_t limit, bool logarithmic) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < std::min(t.size(), y.size()); ++i) {
    if ((t[i] > 0 || !logarithmic) && std::isfinite(t[i]) && std::isfinite(y[i])) all.push_back(i);
  }
  if (all.size() <= limit) return all;

  const auto stretches = static_cast<double>((limit - 1) / 3);
  const auto along = [&](std::size_t i) { return logarithmic ? std::log(t[i]) : t[i]; };
  const auto size = [&](std::size_t i) { return logarithmic ? std::abs(y[i]) : y[i]; };
  const double start = along(all.front());
  const double length = along(all.back()) - start;
  const auto stretch_of = [&](std::size_t i) {
    return std::min(stretches - 1, std::floor(stretches * (along(i) - start) / length));
  };

  std::vector<std::size_t> kept;
  for (std::size_t begin = 0; begin < all.size();) {
    std::size_t end = begin, low = begin, high = begin;
    for (; end < all.size() && stretch_of(all[end]) <= stretch_of(all[begin]); ++end) {
      if (size(all[end]) < size(all[low])) low = end;
      if (size(all[end]) > size(all[high])) high = end;
    }
    for (const std::size_t k : {begin, std::min(low, high), std::max(low, high)}) {
      if (kept.empty() || kept.back() < all[k]) kept.push_back(all[k]);
    }
    begin = end;
  }
  if (kept.back() != all.back()) kept.push_back(all.back());
  return kept;
}

void add_chart(nlohmann::ordered_json& charts, const std::vector<double>& x,
               const SampledCurves& sampled) {
  constexpr std::size_t most = 24;
  const auto& curves = sampled.curves;
  if (curves.empty()) return;
  Json all = Json::array();
  for (std::size_t i = 0; i < std::min(most, curves.size()); ++i) {
    Json y = Json::array();
    for (const double value : curves[i].second) y.push_back(number_or_null(value));
    all.push_back({{"name", curves[i].first},
                   {"y", y},
                   {"colour", i % 8},
                   {"dash", i < 8 ? Json::array() : Json{6, 4}}});
  }
  Json chart = {{"key", sampled.key},      {"title", sampled.title}, {"y_title", sampled.title},
                {"unit", sampled.unit},    {"log", false},           {"t", x},
                {"curves", std::move(all)}};
  if (!sampled.x_title.empty()) chart["x_title"] = sampled.x_title;
  if (curves.size() > most) {
    chart["left_out"] = curves.size() - most;
    chart["file"] = sampled.file;
  }
  charts.push_back(std::move(chart));
}

Film film_of(const std::vector<double>& x,
             const std::function<const Eigen::VectorXd&(std::size_t)>& q, int intervals) {
  Film film;
  if (x.empty() || intervals <= 0) return film;
  film.start = x.front();
  film.every = (x.back() - x.front()) / intervals;
  std::size_t at = 0;
  for (int k = 0; k <= intervals; ++k) {
    const double there = film.start + film.every * k;
    while (at + 2 < x.size() && x[at + 1] < there) ++at;
    const std::size_t next = std::min(at + 1, x.size() - 1);
    const double span = x[next] - x[at];
    const double part = span > 0 ? std::clamp((there - x[at]) / span, 0.0, 1.0) : 0;
    const Eigen::VectorXd pose = (1 - part) * q(at) + part * q(next);
    film.frames.emplace_back(pose.begin(), pose.end());
  }
  return film;
}

}  // namespace momenta
