// A chain of n point masses on rods between two walls, the right one shaken, in Cartesian
// coordinates: its Lagrangian and constraints in C++, then three forms and their drift.
//
//   L = Σ ½ mₖ (ẋₖ² + ẏₖ²) − mₖ g yₖ,   Φₖ = (|rₖ₊₁ − rₖ|² − l²)/(2 l) = 0,   k = 0 … n
//   r₀ = (0, 0),   rₙ₊₁ = (d + a sin 3t, 0)

#include <momenta/core/scene/lagrangian/lagrangian_of.h>
#include <momenta/core/scene/scene.h>
#include <momenta/dae/run/run_form.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

struct HangingChain {
  int n = 8;
  double m = 0.2, l = 0.3, d = 1.5, a = 0.02, g = 9.81, drag = 0.05;

  template <class S>
  S lagrangian(const S* q, const S* v, const S&) const {
    S sum = 0;
    for (int k = 0; k < n; ++k) {
      const S &vx = v[2 * k], &vy = v[2 * k + 1], &y = q[2 * k + 1];
      sum += 0.5 * m * (vx * vx + vy * vy) - m * g * y;
    }
    return sum;
  }
  template <class S>
  void forces(const S*, const S* v, const S&, S* tau) const {
    for (int i = 0; i < 2 * n; ++i) tau[i] = -drag * v[i];
  }
  template <class S>
  void constraints(const S* q, const S& t, S* phi) const {
    using std::sin;
    S x = 0, y = 0;
    for (int k = 0; k <= n; ++k) {
      const S next_x = k < n ? q[2 * k] : d + a * sin(3 * t), next_y = k < n ? q[2 * k + 1] : S(0);
      const S dx = next_x - x, dy = next_y - y;
      phi[k] = (dx * dx + dy * dy - l * l) / (2 * l);
      x = next_x, y = next_y;
    }
  }
};

int main() {
  const HangingChain chain;
  std::vector<momenta::LagrangianSpec::Coordinate> coordinates;
  std::vector<momenta::LagrangianSpec::Constraint> rods(1);
  rods[0].name = "rod 0";
  for (int k = 0; k < chain.n; ++k) {  // a first guess: a parabola
    const double s = (k + 1.0) / (chain.n + 1);
    coordinates.push_back({"x" + std::to_string(k), "m", s * chain.d});
    coordinates.push_back({"y" + std::to_string(k), "m", -4 * s * (1 - s)});
    rods.emplace_back().name = "rod " + std::to_string(k + 1);
  }
  momenta::Scene scene;
  scene.name = "Hanging chain";
  scene.lagrangian = momenta::lagrangian_of(chain, coordinates, rods);

  const momenta::Mechanism mechanism(scene);
  const momenta::Start start = momenta::assemble(mechanism).start;
  for (const char* form : {"acceleration", "momentum", "projected"}) {
    momenta::RunRequest request;
    request.settings.form = form;
    request.settings.integrator = "rk4";
    request.settings.step = 0.002;
    request.settings.end_time = 5;
    if (request.settings.form == "momentum") request.settings.gauge = "reset";
    const momenta::RunResult run = momenta::run_form(mechanism, start, request);
    if (run.status != "done") {
      std::fprintf(stderr, "%s: %s\n", form, run.reason.c_str());
      return 1;
    }
    std::printf("%-13s largest |Φ| %.1e m\n", form, run.position_drift_max);
  }
}
