#include <momenta/dae/report/thinning.h>

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

}  // namespace momenta
