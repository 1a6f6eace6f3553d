#include "equations/ensemble.h"
#include "equations/runs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <random>

namespace momenta::equations {

int jitter() {
  const char* k = std::getenv("MOMENTA_JITTER");
  return k ? std::atoi(k) : 0;
}

void move_last_places(Eigen::VectorXd& numbers, int k) {
  if (k == 0) return;
  std::mt19937 random(static_cast<unsigned>(k));
  for (double& x : numbers) {
    const int places = static_cast<int>(random() % 7) - 3;
    for (int i = 0; i < std::abs(places) && x != 0; ++i)
      x = std::nextafter(x, places > 0 ? std::numeric_limits<double>::infinity()
                                       : -std::numeric_limits<double>::infinity());
  }
}

Start moved(Start start, int k) {
  move_last_places(start.q, k);
  move_last_places(start.u, k);
  move_last_places(start.udot, k);
  move_last_places(start.lambda, k);
  return start;
}

Start start_of(const Mechanism& mechanism) {
  return moved(assemble(mechanism).start, jitter());
}

RunResult run_of(const Mechanism& mechanism, const std::string& form, const std::string& integrator,
                 const std::string& gauge, double tolerance, double end, double max_cpu_seconds) {
  RunRequest request = kept(adaptive(form, integrator, gauge, tolerance, end, 20));
  request.max_cpu_seconds = max_cpu_seconds;
  return run_form(mechanism, start_of(mechanism), request);
}

std::vector<Start> starts_of(const Mechanism& mechanism, int members) {
  const Start start = assemble(mechanism).start;
  std::vector<Start> all;
  for (int i = 0; i < members; ++i) all.push_back(moved(start, jitter() + 1000 * i));
  return all;
}

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const auto last = static_cast<double>(values.size()) - 1;
  return values[static_cast<std::size_t>(std::lround(std::ceil(share * last)))];
}

}  // namespace momenta::equations
