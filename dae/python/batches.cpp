// Many states of a mechanism at one time, side by side in vector registers where sweeps carry the
// loops: ClosedChain::rates_of_states, accelerations_of_states.

#include <optional>

#include "bindings.h"

namespace momenta::python {
namespace {

using States = Eigen::Ref<const StateMatrix>;

/// Runs `evaluate` without the interpreter's lock. Raises SceneError where a state has no result.
template <class Evaluate>
void without_interpreter(ClosedChain& chain, Evaluate&& evaluate) {
  bool ok = false;
  {
    py::gil_scoped_release release;
    ok = evaluate();
  }
  if (!ok) throw SceneError(chain.failure());
}

/// (q̇, ṗ) of (7)-(8), a column per state.
py::tuple rates_of_states(Bench& b, double t, const States& q, const States& p,
                          const std::optional<StateMatrix>& tau, double leak, int threads) {
  expect_time(t);
  ClosedChain& chain = b.closed();
  StateMatrix qdot(chain.nq(), q.cols()), pdot(chain.nv(), q.cols());
  without_interpreter(chain, [&] {
    return tau ? chain.rates_of_states(t, q, p, *tau, qdot, pdot, leak, threads)
               : chain.rates_of_states(t, q, p, qdot, pdot, leak, threads);
  });
  return py::make_tuple(std::move(qdot), std::move(pdot));
}

/// (u̇, λ) of (3), a column per state.
py::tuple accelerations_of_states(Bench& b, double t, const States& q, const States& u,
                                  const std::optional<StateMatrix>& tau, int threads) {
  expect_time(t);
  ClosedChain& chain = b.closed();
  StateMatrix udot(chain.nv(), q.cols()), lambda(chain.m(), q.cols());
  without_interpreter(chain, [&] {
    return tau ? chain.accelerations_of_states(t, q, u, *tau, udot, lambda, threads)
               : chain.accelerations_of_states(t, q, u, udot, lambda, threads);
  });
  return py::make_tuple(std::move(udot), std::move(lambda));
}

}  // namespace

void add_batches(py::class_<Bench, BenchPtr>& mechanism) {
  using namespace py::literals;
  mechanism
      .def("rates_of_states", &rates_of_states, "t"_a, "q"_a, "p"_a, "tau"_a = py::none(),
           "leak"_a = 0.0, "threads"_a = 1,
           "(qdot, pdot) of many states at one time, a column per state: q (nq, states), p and tau "
           "(nv, states), C-contiguous without a copy; `tau`: joint forces in addition to those of "
           "the scene [N m or N]; `leak` [1/s]: kappa. Raises SceneError with the first state that "
           "has no rates. O(bodies) a state.")
      .def("accelerations_of_states", &accelerations_of_states, "t"_a, "q"_a, "u"_a,
           "tau"_a = py::none(), "threads"_a = 1,
           "(udot, lambda_) of many states at one time, as rates_of_states: udot (nv, states), "
           "lambda_ (m, states). O(bodies) a state.");
}

}  // namespace momenta::python
