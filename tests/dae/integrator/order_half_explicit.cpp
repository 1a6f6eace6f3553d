// hem5 has order 5: every order condition of index 2 by its tree, and halved steps on mechanisms,
// in q, u, p and in the multiplier, for both forms, with prescribed motion and with quaternions;
// the order of what one linear solution a stage leaves; the same motion in every gauge.

#include "equations/ensemble.h"
#include "equations/half_explicit.h"
#include "equations/index2_trees.h"
#include "equations/linkages.h"
#include "equations/refusal.h"
#include "equations/runs.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/implicit_methods.h>
#include <momenta/dae/integrator/tableau_hem5.h>
#include <momenta/dae/run/run_form.h>

#include <array>
#include <numbers>

namespace momenta::dae_order_half_explicit {
namespace {

using namespace equations;
using explicit_rk::TableauDp5;

/// What a tree has: at the six stages Y_i and at y_1, where z is that of the hidden constraint; at
/// the six Ȳ_i.
struct Weights {
  std::array<double, 7> at{};
  std::array<double, 6> bar{};
  double exact = 1;  ///< times c^ρ
};

Weights weights_of(const Index2Tree& tree, const std::vector<Weights>& known) {
  constexpr std::size_t s = TableauHem5::stages;
  Weights w;
  std::array<double, 7> product;
  std::array<double, 6> product_bar;
  product.fill(1);
  product_bar.fill(1);
  for (const std::size_t son : tree.sons) {
    for (std::size_t i = 0; i <= s; ++i) product[i] *= known[son].at[i];
    for (std::size_t i = 0; i < s; ++i) product_bar[i] *= known[son].bar[i];
    w.exact *= known[son].exact;
  }
  if (!tree.z) {
    w.exact /= tree.order;
    for (std::size_t i = 0; i <= s; ++i)
      for (std::size_t j = 0; j < std::min(i, s); ++j) w.at[i] += TableauDp5::a[i][j] * product[j];
    for (std::size_t i = 1; i < s; ++i)
      for (std::size_t j = 0; j <= i; ++j) w.bar[i] += TableauHem5::a_bar[i][j] * product[j];
    return w;
  }
  w.exact *= tree.order + 1;
  for (std::size_t i = 1; i < s; ++i) {
    w.at[i] = product_bar[i];
    for (std::size_t j = 1; j < i; ++j) w.at[i] -= TableauHem5::a_bar[i][j] * w.at[j];
    w.at[i] /= TableauHem5::a_bar[i][i];
  }
  w.at[s] = w.exact;
  return w;
}

TEST(HalfExplicitOrder, EveryConditionOfOrderFive) {
  const auto trees = index2_trees(6);
  std::vector<Weights> known;
  std::array<int, 7> count{}, missed{}, missed_embedded{};
  for (const Index2Tree& tree : trees) {
    known.push_back(weights_of(tree, known));
    if (tree.z) continue;
    const auto order = static_cast<std::size_t>(tree.order);
    ++count[order];
    const double exact = known.back().exact;
    const double off = known.back().at[6] - exact;
    if (std::abs(off) > 1e-13 * exact) ++missed[order];
    // b̂ = b − e.
    double embedded = off;
    for (std::size_t j = 0; j < 7; ++j) {
      double product = 1;
      for (const std::size_t son : tree.sons) product *= known[son].at[j];
      embedded -= TableauDp5::e[0][j] * product;
    }
    if (std::abs(embedded) > 1e-13 * exact) ++missed_embedded[order];
  }
  // As many as the literature counts.
  EXPECT_EQ(count[1], 1);
  EXPECT_EQ(count[2], 3);
  EXPECT_EQ(count[3], 22);
  for (std::size_t order = 1; order <= 5; ++order) EXPECT_EQ(missed[order], 0) << order;
  EXPECT_GT(missed[6], 0);
  for (std::size_t order = 1; order <= 4; ++order) EXPECT_EQ(missed_embedded[order], 0) << order;
  EXPECT_GT(missed_embedded[5], 0);
}

TEST(HalfExplicitOrder, HalvedStepsOnMechanisms) {
  struct Case {
    Scene scene;
    double end;
    int coarse;
  };
  for (const Case& c :
       {Case{example_of("four_bar"), 1, 200}, Case{example_of("andrews"), 0.01, 100},
        Case{driven_crank(), 1, 60}, Case{flying_rod(), 1, 100}})
    for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
      SCOPED_TRACE(c.scene.name + " " + form);
      const Halving halving("hem5", c.scene, form, c.end);
      const Errors a = halving.with(c.coarse), b = halving.with(4 * c.coarse);
      // Below this rounding counts; the driven crank leaves no freedom, with Φ = 0 its q is exact.
      const auto expect_five = [](const char* what, double coarse, double fine) {
        if (fine < 1e-12) {
          EXPECT_LT(coarse, std::pow(2, 2 * 5.6) * 1e-12) << what;
          return;
        }
        EXPECT_NEAR(std::log2(coarse / fine) / 2, 5, 0.6) << what << ": " << coarse << ", " << fine;
      };
      expect_five("q", a.q, b.q);
      expect_five("u or p", a.x, b.x);
      expect_five("multiplier", a.multiplier, b.multiplier);
    }
}

// With a reset, in q: p and σ at the end are those of another gauge.
TEST(HalfExplicitOrder, HalvedStepsWithAReset) {
  struct Case {
    Scene scene;
    double end;
    int coarse;
  };
  for (const Case& c : {Case{example_of("four_bar"), 1, 200},
                        Case{example_of("andrews"), 0.01, 100}, Case{flying_rod(), 1, 100}}) {
    SCOPED_TRACE(c.scene.name);
    const Halving halving("hem5", c.scene, "momentum-index2", c.end, "reset");
    const double coarse = halving.with(c.coarse).q, fine = halving.with(4 * c.coarse).q;
    if (fine < 1e-12)
      EXPECT_LT(coarse, std::pow(2, 2 * 5.6) * 1e-12);
    else
      EXPECT_NEAR(std::log2(coarse / fine) / 2, 5, 0.6) << coarse << ", " << fine;
  }
}

// From rates foreseen with an error h^r d, one linear solution has σ up to O(h^(2r+1)).
TEST(HalfExplicitOrder, OneLinearSolutionAStage) {
  const Mechanism mechanism(example_of("four_bar"));
  const Start start = equations::start_of(mechanism);
  FormOptions options;
  options.gauge = parse_gauge("reset");
  const auto form = make_form("momentum-index2", mechanism, options, start);
  DaeSystem& system = *form->dae();
  auto& parts = dynamic_cast<HalfExplicit&>(system);
  // Somewhere on the way, where it moves.
  IntegrationOptions tight;
  tight.step = 1e-3;
  const auto there = integrate_hem5(system, 0, {0.4}, tight, {});
  ASSERT_TRUE(there.done) << there.reason;
  const auto n = static_cast<std::size_t>(parts.differential_unknowns()),
             m = static_cast<std::size_t>(parts.multipliers());
  std::vector<double> z(m), f(n);
  ASSERT_TRUE(parts.consistent(0.4, there.y.data(), z.data(), f.data()));
  for (const int r : {1, 2}) {
    const auto error = [&](double h) {
      std::vector<double> exact_z = z, exact_f = f;
      EXPECT_TRUE(parts.advance(0.4, there.y.data(), 0.4 + h, there.y.data(), h, true,
                                exact_z.data(), exact_f.data()));
      std::vector<double> one_z = z, one_f = exact_f;
      for (int i = 0; i < mechanism.nq(); ++i)
        one_f[static_cast<std::size_t>(i)] += 20 * std::pow(h, r) * (1 - 0.7 * i);
      EXPECT_TRUE(parts.advance(0.4, there.y.data(), 0.4 + h, there.y.data(), h, false,
                                one_z.data(), one_f.data()));
      double largest = 0;
      for (std::size_t i = 0; i < m; ++i)
        largest = equations::larger(largest, std::abs(one_z[i] - exact_z[i]));
      return largest;
    };
    const double a = error(0.04), b = error(0.02);
    EXPECT_NEAR(std::log2(a / b), 2 * r + 1, 0.4) << r << ": " << a << ", " << b;
  }
}

TEST(HalfExplicit, TheSameMotionInEveryGauge) {
  expect_the_same_motion_in_every_gauge("hem5", 0.01);
}

RunResult run_hem5(const Mechanism& mechanism, const std::string& form, double tolerance,
                   double end, int samples) {
  return run_form(
      mechanism, equations::start_of(mechanism),
      equations::kept(equations::adaptive(form, "hem5", form == "momentum-index2" ? "leak" : "",
                                          tolerance, end, samples)));
}

// The constraint that stands in the equations, at every sample inside steps too; the other one
// drifts with the local error.
TEST(HalfExplicit, KeepsItsConstraint) {
  const Mechanism mechanism(example_of("four_bar"));
  const RunResult p = run_hem5(mechanism, "momentum-index2", 1e-6, 5, 500);
  ASSERT_EQ(p.status, "done") << p.reason;
  EXPECT_LE(p.position_drift_max, 1e-14);
  const RunResult u = run_hem5(mechanism, "acceleration-index2", 1e-6, 5, 500);
  ASSERT_EQ(u.status, "done") << u.reason;
  EXPECT_LE(u.velocity_drift_max, 1e-13);
  EXPECT_LE(u.position_drift_max, 1e-3);
  EXPECT_GE(u.position_drift_max, 1e-12);
}

// A redundant equation in every configuration; KLU above 60 unknowns.
TEST(HalfExplicit, RedundantAndSparse) {
  const Mechanism redundant(bricard()), many(row_of_four_bars(12, 1.0, 0.5));
  for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
    const RunResult a = run_hem5(redundant, form, 1e-9, 0.5, 10);
    ASSERT_EQ(a.status, "done") << form << a.reason;
    EXPECT_LE(a.energy_error_max, 1e-6) << form;
    EXPECT_LE(a.position_drift_max, 1e-7) << form;
    const RunResult b = run_hem5(many, form, 1e-9, 0.3, 10);
    ASSERT_EQ(b.status, "done") << form << b.reason;
    EXPECT_LE(b.energy_error_max, 1e-6) << form;
  }
}

// Looking on changes nothing of the run.
TEST(HalfExplicit, SamplesDoNotChangeTheRun) {
  const Mechanism mechanism(example_of("four_bar"));
  for (const std::string form : {"acceleration-index2", "momentum-index2"}) {
    const RunResult few = run_hem5(mechanism, form, 1e-7, 2, 1),
                    many = run_hem5(mechanism, form, 1e-7, 2, 200);
    EXPECT_EQ(few.counters.steps, many.counters.steps);
    EXPECT_EQ(few.trajectory.rows.back(), many.trajectory.rows.back()) << form;
  }
}

// 81 rods meet singular poses, where Φ_q of a stage and of the place it leads to do not fit
// together.
// Steps of its own length take the singular poses as an ODE; short fixed ones run into them, one or
// the other.
TEST(HalfExplicit, NamesTheDependentEquationWhereItStops) {
  const Mechanism mechanism(row_of_four_bars(10, std::numbers::pi / 2, -1));
  const RunResult passes = run_hem5(mechanism, "momentum-index2", 1e-8, 5, 5);
  EXPECT_EQ(passes.status, "done") << passes.reason;
  EXPECT_GT(passes.counters.ode_restarts, 0);
  const Start flat = equations::start_of(mechanism);
  int stopped = 0;
  for (const double step : {2.5e-5, 5e-5, 3e-5, 2e-5, 1.5e-5}) {
    const auto row = make_form("momentum-index2", mechanism, {}, flat);
    IntegrationOptions fixed;
    fixed.step = step;
    const auto r = integrate_hem5(*row->dae(), 0, {0.8}, fixed, {});
    if (r.done) continue;
    ++stopped;
    EXPECT_NE(r.reason.find("loop '"), std::string::npos) << r.reason;
    EXPECT_NE(r.reason.find("other equations"), std::string::npos) << r.reason;
    break;
  }
  EXPECT_EQ(stopped, 1);
  // Where all equations are independent nothing is named: a step too long for any solution.
  const Mechanism regular(example_of("four_bar"));
  const Start start = equations::start_of(regular);
  const auto form = make_form("momentum-index2", regular, {}, start);
  IntegrationOptions options;
  options.step = 5;
  const auto run = integrate_hem5(*form->dae(), 0, {10.0}, options, {});
  EXPECT_FALSE(run.done);
  EXPECT_EQ(run.reason.find("other equations"), std::string::npos) << run.reason;
}

TEST(HalfExplicit, RefusesOtherForms) {
  const Mechanism mechanism(example_of("four_bar"));
  for (const char* form : {"acceleration-index3", "momentum-index1", "stabilised-index2"})
    EXPECT_TRUE(equations::says(
        equations::thrown<std::invalid_argument>([&] { run_hem5(mechanism, form, 1e-7, 1, 1); }),
        "acceleration-index2 or momentum-index2"))
        << form;
}

}  // namespace
}  // namespace momenta::dae_order_half_explicit
