// Rows closed/<form>/<model>/<n>: one right-hand side of a closed loop, counter ns_per_evaluation.

#include <benchmark/benchmark.h>
#include <momenta/dae/assembly.h>
#include <momenta/dae/form/form.h>

#include "models.h"

namespace momenta {
namespace {

void evaluate(benchmark::State& state, const char* form_name, Scene (*model)(int), Algebra algebra,
              KktChoice kkt) {
  const Mechanism mechanism(model(static_cast<int>(state.range(0))), {algebra, kkt});
  const Assembly assembly = assemble(mechanism);
  FormOptions options;
  options.gauge = {Gauge::Kind::leak, 3};
  const auto form = make_form(form_name, mechanism, options, assembly.start);
  const auto y = form->initial(assembly.start);
  std::vector<double> ydot(y.size());
  for (auto _ : state) {
    form->ode()->rhs(0, y.data(), ydot.data());
    benchmark::DoNotOptimize(ydot.data());
  }
  state.counters["ns_per_evaluation"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 1e-9,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

Scene one_four_bar(int) {
  return benchmark_models::four_bar();
}

}  // namespace

void register_closed_loops() {
  for (const char* form : {"momentum", "acceleration"}) {
    const std::string head = std::string("closed/") + form + "/";
    const auto add = [&](const char* model, Scene (*scene)(int), Algebra algebra, KktChoice kkt,
                         int n) {
      benchmark::RegisterBenchmark((head + model).c_str(), evaluate, form, scene, algebra, kkt)
          ->Arg(n);
    };
    add("four_bar", one_four_bar, Algebra::automatic, KktChoice::dense, 1);
    add("four_bar_sparse", one_four_bar, Algebra::automatic, KktChoice::sparse, 1);
    add("four_bar_in_space", one_four_bar, Algebra::spatial, KktChoice::dense, 1);
    for (const int n : {5, 40}) {
      add("n_four_bar_dense", benchmark_models::n_four_bar, Algebra::automatic, KktChoice::dense,
          n);
      add("n_four_bar_sparse", benchmark_models::n_four_bar, Algebra::automatic, KktChoice::sparse,
          n);
    }
  }
}

}  // namespace momenta
