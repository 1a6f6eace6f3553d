// Rows descriptions/<way>/<model>: (7)-(8) with leak of one mechanism written in different ways
// (equations/descriptions.h), by what its runs evaluate; counters ns_best and ns_worst, and
// largest_ratio of the two, which is 1 where it does not matter how a mechanism is written. The
// label names the worst. Each iteration evaluates all descriptions by turns; of each the least
// counts.
//
// Rows descriptions/row_of_four_bars/<n>/<tree>: a run of 10 s through all flat poses in the
// momentum form, default integrator at 1e-8, of n four-bars cut as given, by recut() and at random;
// counter error: of the tips at the end, against a pendulum [m]; the label says how the run ended.

#include <benchmark/benchmark.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/cut/integrated_scene.h>
#include <momenta/dae/topology/cut/recut.h>

#include <chrono>
#include <functional>
#include <memory>

#include "equations/linkages.h"
#include "equations/other_trees.h"
#include "models.h"
#include "pushed_state.h"

namespace momenta {
namespace {

constexpr int in_different_trees = 10;

/// One description, as runs integrate it, ready to be evaluated.
class Evaluated {
 public:
  Evaluated(const Scene& scene, std::string how)
      : how_(std::move(how)),
        written_(scene),
        start_(assemble(written_, Assembled::motion).start),
        swept_(written_, start_),
        mechanism_(swept_.mechanism()),
        e_(mechanism_.evaluation<double>()),
        solver_(make_loop_solver(mechanism_, *e_)),
        state_(pushed_state(mechanism_, swept_.start().q)),
        u_(mechanism_.nv()),
        rate_(mechanism_.nv()),
        sigma_(mechanism_.m()) {}

  const std::string& how() const { return how_; }
  double least_ns() const { return least_ns_; }
  /// False where there is no solution.
  bool evaluate_some() {
    constexpr int some = 20;
    const auto from = std::chrono::steady_clock::now();
    bool solved = true;
    for (int i = 0; i < some; ++i)
      solved &= solver_->momentum(0, state_.q.data(), state_.p.data(), nullptr, fade_evaluation, 3,
                                  u_.data(), sigma_.data(), rate_.data());
    const std::chrono::duration<double, std::nano> took = std::chrono::steady_clock::now() - from;
    least_ns_ = std::min(least_ns_, took.count() / some);
    benchmark::DoNotOptimize(rate_.data());
    return solved;
  }

 private:
  std::string how_;
  Mechanism written_;
  Start start_;
  IntegratedScene swept_;
  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;
  PushedState state_;
  Eigen::VectorXd u_, rate_, sigma_;
  double least_ns_ = HUGE_VAL;
};

/// way −1: several ways one after the other.
void compare(benchmark::State& state, const Scene& given, int way) {
  const Scene scene = equations::at_start(given);
  std::vector<std::unique_ptr<Evaluated>> all;
  all.push_back(std::make_unique<Evaluated>(scene, "as given"));
  for (unsigned seed = 0; seed < in_different_trees; ++seed) {
    const equations::Description d =
        way < 0 ? equations::description(scene, seed) : equations::description(scene, way, seed);
    all.push_back(std::make_unique<Evaluated>(d.scene, std::to_string(seed) + ", " + d.how));
  }
  bool solved = true;
  for (auto _ : state)
    for (const auto& one : all) solved &= one->evaluate_some();
  if (!solved) return state.SkipWithError("no solution");
  const auto less = [](const auto& a, const auto& b) { return a->least_ns() < b->least_ns(); };
  const auto [best, worst] = std::minmax_element(all.begin(), all.end(), less);
  state.counters["ns_as_given"] = all.front()->least_ns();
  state.counters["ns_best"] = (*best)->least_ns();
  state.counters["ns_worst"] = (*worst)->least_ns();
  state.counters["largest_ratio"] = (*worst)->least_ns() / (*best)->least_ns();
  state.SetLabel((*worst)->how());
}

Scene example(const char* name) {
  return read_scene(std::string(MOMENTA_SOURCE_DIR) + "/examples/" + name);
}

/// The angle of the uprights of n four-bars after `end` seconds from rest: they are a pendulum,
/// (n + 1)/3 + n about the pins, with ((n + 1)/2 + n) g cos φ against it.
double angle_of_uprights(int n, double angle, double end) {
  constexpr int steps = 100000;
  const double pull = 9.81 * (0.5 * (n + 1) + n) / ((n + 1) / 3.0 + n), h = end / steps;
  double at = angle, rate = 0;
  for (int i = 0; i < steps; ++i) {  // RK4
    const auto f = [&](double x) { return -pull * std::cos(x); };
    const double k1 = f(at), k2 = f(at + h / 2 * rate), k3 = f(at + h / 2 * (rate + h / 2 * k1)),
                 k4 = f(at + h * (rate + h / 2 * k2));
    at += h * (rate + h / 6 * (k1 + k2 + k3));
    rate += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return at;
}

constexpr double first_angle = 1.1;

Scene marked_row(int n) {
  Scene scene = equations::row_of_four_bars(n, first_angle);
  for (int i = 0; i <= n; ++i) {
    MarkerSpec tip;
    tip.name = "tip " + std::to_string(i);
    tip.body = "upright" + std::to_string(i);
    tip.point = {1, 0, 0};
    scene.markers.push_back(tip);
  }
  scene.run.project = true;  // it passes singular poses
  return scene;
}

/// tree −1: as given; −2: by recut(); else by seed.
Scene cut(const Scene& scene, int tree) {
  if (tree == -1) return scene;
  if (tree == -2) {
    const Mechanism mechanism(scene);
    return recut(mechanism, assemble(mechanism).start).scene;
  }
  Scene other = scene;
  equations::RandomTree random(static_cast<unsigned>(tree));
  equations::cut_elsewhere(random, other);
  return other;
}

void run_row(benchmark::State& state, int n, int tree) {
  const Mechanism mechanism(cut(equations::at_start(marked_row(n)), tree));
  const Start start = assemble(mechanism).start;
  RunRequest request;
  request.settings = default_settings(mechanism.scene().run, "momentum", "", 1e-8);
  request.settings.end_time = 10;
  request.settings.samples = 1;
  request.keep_trajectory = true;
  request.max_cpu_seconds = 120;
  RunResult run;
  for (auto _ : state) run = run_form(mechanism, start, request);
  state.SetLabel(run.status + (run.reason.empty() ? "" : ": " + run.reason));
  state.counters["rows_faded_at"] = static_cast<double>(run.weak_evaluations);
  state.counters["steps"] = static_cast<double>(run.counters.steps);
  if (run.status != "done") return;
  const double angle = angle_of_uprights(n, first_angle, 10);
  const auto& labels = run.trajectory.columns;
  const auto at = [&](const std::string& label) {
    const auto found = std::find(labels.begin(), labels.end(), label) - labels.begin();
    return run.trajectory.rows.back().at(static_cast<std::size_t>(found));
  };
  double error = 0;
  for (int i = 0; i <= n; ++i) {
    const std::string tip = "tip " + std::to_string(i);
    error = std::max({error, std::abs(at(tip + ".x [m]") - i - std::cos(angle)),
                      std::abs(at(tip + ".y [m]") - std::sin(angle))});
  }
  state.counters["error"] = error;
}

}  // namespace

void register_descriptions() {
  const std::pair<const char*, std::function<Scene()>> models[] = {
      {"four_bar", [] { return benchmark_models::four_bar(); }},
      {"andrews", [] { return example("andrews/scene.toml"); }},
      {"n_four_bar_40", [] { return benchmark_models::n_four_bar(40); }},
      {"ladder_10", [] { return benchmark_models::scissor_ladder(10); }},
      {"stewart", [] { return equations::platform(6); }},
      {"bricard", [] { return equations::bricard(); }},
      {"cassie", [] { return example("models/agility_cassie/cassie.xml"); }}};
  for (int way = -1; way < equations::ways_of_writing(); ++way)
    for (const auto& [model, make] : models) {
      std::string name = way < 0 ? "several" : equations::name_of_way(way);
      std::replace(name.begin(), name.end(), ' ', '_');
      benchmark::RegisterBenchmark(("descriptions/" + name + "/" + model).c_str(),
                                   [make, way](benchmark::State& state) {
                                     try {
                                       compare(state, make(), way);
                                     } catch (const SceneError& e) {
                                       state.SkipWithError(e.what());
                                     }
                                   });
    }
  for (const int n : {40, 200})
    for (int tree = -2; tree < in_different_trees; ++tree) {
      const std::string name = tree == -2   ? "recut"
                               : tree == -1 ? "as_given"
                                            : "tree_" + std::to_string(tree);
      benchmark::RegisterBenchmark(
          ("descriptions/row_of_four_bars/" + std::to_string(n) + "/" + name).c_str(), run_row, n,
          tree)
          ->Iterations(1)
          ->Unit(benchmark::kMillisecond);
    }
}

}  // namespace momenta
