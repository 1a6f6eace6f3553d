#include <momenta/dae/kinematics/homotopy.h>
#include <momenta/dae/kinematics/path_follower.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>
#include <utility>

namespace momenta {
namespace {

using Eigen::VectorXcd;

constexpr double same_end = 1e-8;  // distance between equal ends of length one

/// Whether ends are parallel in every group.
bool is_same(const PolynomialSystem& f, const VectorXcd& a, const VectorXcd& b) {
  for (const VariableGroup& g : f.groups()) {
    Complex product = 0;
    for (const int v : g.variables) product += std::conj(a[v]) * b[v];
    if (std::abs(product) < 1e-3) return false;
    double gap = 0;
    for (const int v : g.variables) gap += std::norm(b[v] - product / std::abs(product) * a[v]);
    if (std::sqrt(gap) > same_end) return false;
  }
  return true;
}

}  // namespace

HomotopyEnds solve_by_homotopy(const PolynomialSystem& system, std::uint64_t seed, int threads) {
  UnitCircle circle(seed);
  const StartSystem start(system, circle);
  const Complex gamma = circle.next();
  std::vector<std::pair<PathEnd, VectorXcd>> ends(start.solutions());
  const auto follow_all = [&](const std::vector<std::size_t>& which, double longest) {
    std::atomic<std::size_t> next{0};
    std::vector<std::jthread> workers;
    for (int k = 0; k < std::max(1, threads); ++k)
      workers.emplace_back([&] {
        PathFollower follower(system, start, gamma, longest);
        for (std::size_t i; (i = next++) < which.size();)
          ends[which[i]] = follower.follow(start.solution(which[i]));
      });
  };
  const auto doubtful = [&] {
    std::vector<std::size_t> some;
    std::vector<bool> met(ends.size(), false);
    for (std::size_t i = 0; i < ends.size(); ++i) {
      met[i] = met[i] || ends[i].first == PathEnd::lost;
      if (ends[i].first != PathEnd::finite) continue;
      for (std::size_t j = 0; j < i; ++j)
        if (ends[j].first == PathEnd::finite && is_same(system, ends[i].second, ends[j].second))
          met[i] = met[j] = true;
    }
    for (std::size_t i = 0; i < ends.size(); ++i)
      if (met[i]) some.push_back(i);
    return some;
  };
  std::vector<std::size_t> again(ends.size());
  for (std::size_t i = 0; i < again.size(); ++i) again[i] = i;
  double longest = 1;
  for (int round = 0; round < 3 && !again.empty(); ++round, longest /= 10) {
    follow_all(again, longest);
    again = doubtful();
  }
  HomotopyEnds found;
  found.paths = static_cast<long>(ends.size());
  for (const std::size_t i : again) ends[i].first = PathEnd::lost;
  for (auto& [end, x] : ends) {
    if (end == PathEnd::finite) found.finite.push_back(std::move(x));
    found.infinite += end == PathEnd::infinite;
    found.singular += end == PathEnd::singular;
    found.lost += end == PathEnd::lost;
  }
  return found;
}

}  // namespace momenta
