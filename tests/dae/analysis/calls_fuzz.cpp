// Any call of run_form, of ClosedChain and of the loops' solvers, with any arguments: finite
// results, false or a status with one sentence, or std::invalid_argument with one. MOMENTA_CALLS=n
// makes n times as many.

#include "equations/ensemble.h"
#include "equations/examples.h"
#include "equations/wild.h"

#include <gtest/gtest.h>
#include <momenta/dae/analysis/chain/closed_chain.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/run_form.h>

#include <cstdlib>

namespace momenta::dae_calls_fuzz {
namespace {

using namespace equations;
using Eigen::VectorXd;
using equations::example;

int times_more() {
  const char* asked = std::getenv("MOMENTA_CALLS");  // NOLINT: tests have one thread
  return asked ? std::atoi(asked) : 1;
}

class RunCaller {
 public:
  RunCaller(unsigned seed, const Mechanism& mechanism)
      : wild_(seed), mechanism_(mechanism), start_(start_of(mechanism)) {}

  /// Whether the run was done.
  bool call() {
    RunRequest request;
    RunSettings& s = request.settings;
    s.form = one_of(form_names());
    std::vector<std::string> methods{""};
    for (const Integrator& i : integrators()) methods.push_back(i.name);
    s.integrator = one_of(methods);
    s.gauge = one_of({"", "none", "leak", "leak:3", "leak:-1", "leak:nan", "reset", "flip", "x"});
    s.when_stiff = one_of({"", "", "", "bdf", "dp5", "x"});
    s.rtol = maybe(1e-5), s.atol = maybe(1e-5);
    s.step = maybe(2e-3);
    s.end_time = maybe(0.02);
    s.samples = wild_.chance(0.9) ? 1 + wild_.below(5) : wild_.below(3) - 1;
    s.project = wild_.chance(0.3);
    s.baumgarte_alpha = maybe(0), s.baumgarte_beta = maybe(0), s.beta = maybe(0);
    s.penalty = maybe(0), s.spectral_radius = maybe(0.8);
    request.keep_trajectory = wild_.chance(0.5);
    request.keep_every = wild_.chance(0.95) ? 1 + wild_.below(3) : wild_.below(3) - 2;
    request.film_intervals = wild_.below(6) - 1;
    request.max_cpu_seconds = wild_.chance(0.95) ? 0.1 : wild_.wild();
    if (!(request.max_cpu_seconds < 1)) request.max_cpu_seconds = std::nan("");
    if (request.max_cpu_seconds == 0) request.max_cpu_seconds = 0.1;  // 0: no limit
    if (wild_.chance(0.1)) request.going_on = [this] { return wild_.chance(0.9); };
    Start start = start_;
    for (VectorXd* x : {&start.q, &start.u, &start.udot, &start.lambda})
      if (wild_.chance(0.05)) *x = wild_.vector(static_cast<int>(x->size()));
    if (wild_.chance(0.05)) start.t = wild_.wild();
    const std::string asked =
        mechanism_.scene().name + " " + s.form + " " + s.integrator + " " + s.gauge;
    try {
      return judge(run_form(mechanism_, start, request), asked);
    } catch (const std::invalid_argument& e) {
      EXPECT_TRUE(is_sentence(e.what())) << asked << ": " << e.what();
    }
    return false;
  }

 private:
  double maybe(double usual) { return wild_.chance(0.95) ? usual : wild_.wild(); }
  std::string one_of(const std::vector<std::string>& all) {
    return all[static_cast<std::size_t>(wild_.below(static_cast<int>(all.size())))];
  }
  static bool judge(const RunResult& run, const std::string& asked) {
    EXPECT_TRUE(run.status == "done" || run.status == "failed" || run.status == "time limit" ||
                run.status == "came apart")
        << run.status;
    if (run.status != "done") {
      EXPECT_TRUE(is_sentence(run.reason)) << asked << ": '" << run.reason << "'";
      EXPECT_TRUE(run.reason.find(" nan") == std::string::npos &&
                  run.reason.find("-nan") == std::string::npos)
          << asked << ": " << run.reason;
    }
    for (const auto* kept : {&run.series.t, &run.series.position_drift, &run.series.velocity_drift})
      for (const double x : *kept) EXPECT_TRUE(std::isfinite(x)) << asked;
    if (run.status == "done") {
      EXPECT_EQ(run.series.t.back(), run.settings.end_time) << asked;
      for (const auto& row : run.trajectory.rows)
        for (std::size_t i = 0; i < 2; ++i) EXPECT_TRUE(std::isfinite(row[i])) << asked;
    }
    return run.status == "done";
  }

  Wild wild_;
  const Mechanism& mechanism_;
  Start start_;
};

TEST(CallsFuzz, OfRuns) {
  int done = 0, all = 0;
  for (const char* name : {"four_bar", "driven", "free_body", "bricard", "pendulum"}) {
    const std::string file = name == std::string("pendulum") ? "chain" : name;
    const Mechanism mechanism(example(file));
    for (unsigned seed = 0; seed < 2u * static_cast<unsigned>(times_more()); ++seed) {
      SCOPED_TRACE(std::string(name) + " seed " + std::to_string(seed));
      RunCaller caller(seed, mechanism);
      for (int k = 0; k < 60; ++k, ++all) done += caller.call();
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(done, all / 20);
}

class ChainCaller {
 public:
  ChainCaller(unsigned seed, const Scene& scene)
      : wild_(seed),
        chain_(scene),
        start_(chain_.assemble().start),
        nq_(chain_.nq()),
        nv_(chain_.nv()),
        m_(chain_.m()) {}

  /// One call, and whether it gave a result.
  bool call() {
    const double t = wild_.chance(0.9) ? 0.1 * std::abs(wild_.sound()) : wild_.wild();
    const double leak = wild_.chance(0.9) ? 3 : wild_.wild();
    const VectorXd q = coordinates(), x = wild_.vector(nv_), y = wild_.vector(nv_),
                   z = wild_.vector(m_);
    VectorXd of_q(wild_.size(nq_)), of_v(wild_.size(nv_)), of_m(wild_.size(m_)),
        of_m2(wild_.size(m_));
    switch (wild_.below(13)) {
      case 0:
        return told([&] { return chain_.rates(t, q, x, of_q, of_v, leak); }, of_q, of_v);
      case 1:
        return told([&] { return chain_.rates(t, q, x, y, of_q, of_v, leak); }, of_q, of_v);
      case 2:
        return told([&] { return chain_.velocities(t, q, x, of_v, of_m); }, of_v, of_m);
      case 3:
        return told([&] { return chain_.accelerations(t, q, x, of_v, of_m); }, of_v, of_m);
      case 4:
        return told([&] { return chain_.accelerations(t, q, x, y, of_v, of_m); }, of_v, of_m);
      case 5:
        return told([&] { return chain_.momenta(t, q, x, of_v), true; }, of_v);
      case 6:
        return told([&] { return chain_.joint_forces(t, q, x, y, z, of_v), true; }, of_v);
      case 7:
        return told([&] { return chain_.constraints(t, q, x, of_m, of_m2), true; }, of_m, of_m2);
      case 8: {
        VectorXd moved = q, rates = x;
        return told([&] { return chain_.correct(t, moved, rates); }, moved, rates);
      }
      case 9: {
        Eigen::MatrixXd of;
        return told([&] { return of = chain_.jacobian(t, q), true; }, of);
      }
      case 10: {
        Eigen::MatrixXd of;
        return told([&] { return of = chain_.mass_matrix(t, q), true; }, of);
      }
      case 11: {
        VectorXd of(3);
        return told(
            [&] {
              const Energies e = chain_.energies(t, q, x);
              of << e.kinetic, e.potential, e.hamiltonian;
              return true;
            },
            of);
      }
      default:
        return told([&] { return chain_.coordinate_rates(t, q, x, of_q), true; }, of_q);
    }
  }

  /// Nothing of the calls before is left: the start's accelerations are what they were.
  VectorXd accelerations() {
    VectorXd udot(nv_), lambda(m_);
    EXPECT_TRUE(chain_.accelerations(0, start_.q, start_.u, udot, lambda)) << chain_.failure();
    return udot;
  }

 private:
  VectorXd coordinates() {
    if (wild_.chance(0.5)) return start_.q;
    return wild_.vector(nq_);
  }
  template <class... Result>
  bool told(const std::function<bool()>& call, const Result&... results) {
    try {
      if (call()) {
        EXPECT_TRUE((results.allFinite() && ...));
        return true;
      }
      EXPECT_TRUE(is_sentence(chain_.failure())) << "'" << chain_.failure() << "'";
    } catch (const std::invalid_argument& e) {
      EXPECT_TRUE(is_sentence(e.what())) << e.what();
    }
    return false;
  }

  Wild wild_;
  ClosedChain chain_;
  Start start_;
  int nq_, nv_, m_;
};

TEST(CallsFuzz, OfClosedChains) {
  int found = 0, all = 0;
  for (const char* name : {"four_bar", "andrews", "bricard", "driven", "chain", "free_body"}) {
    const Scene scene = example(name);
    for (unsigned seed = 0; seed < 2u * static_cast<unsigned>(times_more()); ++seed) {
      SCOPED_TRACE(std::string(name) + " seed " + std::to_string(seed));
      ChainCaller caller(seed, scene);
      const VectorXd before = caller.accelerations();
      for (int k = 0; k < 150; ++k, ++all) found += caller.call();
      // KLU keeps its choice of pivots from one call to the next.
      EXPECT_LT((caller.accelerations() - before).norm(), 1e-9 * (1 + before.norm()));
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(found, all / 5);
}

TEST(CallsFuzz, OfLoopSolvers) {
  int found = 0, all = 0;
  for (const auto kkt : {KktChoice::sweeps, KktChoice::dense, KktChoice::sparse})
    for (const char* name : {"four_bar", "andrews", "bricard", "driven"}) {
      const Mechanism mechanism(example(name), {Algebra::automatic, kkt});
      const auto e = mechanism.evaluation<double>();
      const auto solver = make_loop_solver(mechanism, *e);
      const Start start = start_of(mechanism);
      Wild wild(static_cast<unsigned>(all));
      const int nv = mechanism.nv(), m = mechanism.m();
      for (int k = 0; k < 200 * times_more(); ++k, ++all) {
        const double t = wild.number();
        const VectorXd q = wild.chance(0.5) ? start.q : wild.numbers(mechanism.nq());
        const VectorXd x = wild.numbers(nv), centre = wild.numbers(m);
        VectorXd of_v(nv), of_m(m), rates(nv);
        of_v.setConstant(std::nan("")), of_m = centre, rates.setZero();
        const double* about = wild.chance(0.5) ? centre.data() : nullptr;
        bool ok = false;
        const int which = wild.below(4);
        if (which == 0) {
          of_m.setConstant(std::nan("")), rates.setConstant(std::nan(""));
          ok = solver->momentum(t, q.data(), x.data(), about, fade_evaluation, wild.number(),
                                of_v.data(), of_m.data(), rates.data());
        } else if (which == 1) {
          of_m.setConstant(std::nan(""));
          ok = solver->acceleration(t, q.data(), x.data(), about, wild.number(), wild.number(),
                                    of_v.data(), of_m.data());
        } else {
          of_m.setZero();
          ok = which == 2 ? solver->free_velocity(t, q.data(), x.data(), of_v.data())
                          : solver->position_correction(t, q.data(), of_v.data());
        }
        found += ok;
        if (!ok) continue;
        EXPECT_TRUE(of_v.allFinite() && of_m.allFinite() && rates.allFinite())
            << name << " call " << which << " of " << name_of(kkt) << ", t = " << t << ", q "
            << q.transpose() << ", x " << x.transpose();
        EXPECT_GE(solver->pivots().faded, 0);
        if (testing::Test::HasFailure()) return;
      }
    }
  EXPECT_GT(found, all / 4);
}

}  // namespace
}  // namespace momenta::dae_calls_fuzz
