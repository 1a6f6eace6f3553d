// Files of equations: their index is that of the same equations elsewhere, whatever order they are
// written in; structure and index part where they are known to; starts are consistent and moved
// least; runs have their methods' order and end where published references do.

#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/equations/equation_run.h>
#include <momenta/dae/analysis/equations/quad_reference.h>
#include <momenta/dae/study/index_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <Eigen/LU>

#include <cmath>
#include <filesystem>
#include <map>
#include <numeric>
#include <random>

#include "equations/refusal.h"
#include "equations/tolerance.h"

namespace momenta::dae_equations {
namespace {

using structure::at;

std::filesystem::path example(const std::string& file) {
  return std::filesystem::path(MOMENTA_SOURCE_DIR) / "examples" / file;
}

std::string quoted(const std::vector<std::string>& words) {
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "\"" : ", \"") + word + "\"";
  return "[" + all + "]";
}

EquationFile file_of(const std::vector<std::string>& variables,
                     const std::vector<std::string>& equations, const std::string& more = "") {
  return parse_equations("[dae]\nvariables = " + quoted(variables) +
                             "\nequations = " + quoted(equations) + "\n" + more,
                         "equations.toml");
}

// ---- the pendulum in four forms ----------------------------------------------------------------

const std::vector<std::string> dynamics{"der(x) = u", "der(y) = v", "der(u) = -x*lambda",
                                        "der(v) = -y*lambda - 9.81"};
const std::vector<std::string> unknowns{"x", "y", "u", "v", "lambda"};
const std::string swinging = "values = { x = 0.6, y = -0.8, u = 1.6, v = 1.2 }\n";

EquationFile pendulum(const std::string& last) {
  std::vector<std::string> equations = dynamics;
  equations.push_back(last);
  return file_of(unknowns, equations, swinging);
}

std::map<std::string, EquationFile> forms() {
  return {{"acceleration-index3", pendulum("x^2 + y^2 = 1")},
          {"acceleration-index2", pendulum("x*u + y*v = 0")},
          {"acceleration-index1", pendulum("u^2 + v^2 - (x^2 + y^2)*lambda - 9.81*y = 0")},
          {"stabilised-index2", file_of({"x", "y", "u", "v", "lambda", "mu"},
                                        {"der(x) = u - x*mu", "der(y) = v - y*mu", dynamics[2],
                                         dynamics[3], "x^2 + y^2 = 1", "x*u + y*v = 0"},
                                        swinging)}};
}

TEST(Equations, HaveTheIndexOfTheSceneInTheSameForm) {
  const Mechanism mechanism(read_scene(example("pendulum/cartesian.toml")));
  const Start start = assemble(mechanism).start;
  for (const auto& [name, file] : forms()) {
    SCOPED_TRACE(name);
    const IndexStudy study = run_index_study(mechanism, start, {name});
    const EquationStart found = equation_start(file);
    ASSERT_EQ(found.point.why, "");
    EXPECT_EQ(found.point.found.index, study.forms[0].found.index);
    EXPECT_EQ(found.offsets.index, found.point.found.index);
    EXPECT_TRUE(found.structure_holds());
    ASSERT_EQ(found.point.found.levels.size(), study.forms[0].found.levels.size());
    for (std::size_t k = 0; k < found.point.found.levels.size(); ++k) {
      EXPECT_EQ(found.point.found.levels[k].constraints,
                study.forms[0].found.levels[k].constraints);
      EXPECT_EQ(found.point.found.levels[k].undetermined,
                study.forms[0].found.levels[k].undetermined);
    }
    // What is left of the unknowns when the constraints are met is the freedom of structure.
    EXPECT_EQ(file.size() - found.point.found.levels.back().constraints, found.offsets.freedom);
  }
}

TEST(Equations, OrderIsNothingToTheIndex) {
  std::mt19937 random(7);
  for (const auto& [name, file] : forms()) {
    SCOPED_TRACE(name);
    const EquationStart here = equation_start(file);
    std::vector<std::string> variables = file.variables, equations;
    for (const auto& e : file.equations) equations.push_back(e.text);
    std::shuffle(variables.begin(), variables.end(), random);
    std::shuffle(equations.begin(), equations.end(), random);
    const EquationFile shuffled = file_of(variables, equations, swinging);
    const EquationStart there = equation_start(shuffled);
    EXPECT_EQ(there.point.found.index, here.point.found.index);
    EXPECT_EQ(there.offsets.index, here.offsets.index);
    EXPECT_EQ(there.offsets.freedom, here.offsets.freedom);
    EXPECT_NEAR(std::abs(there.jacobian.determinant), std::abs(here.jacobian.determinant), 1e-12);
    for (std::size_t j = 0; j < variables.size(); ++j) {
      const auto before = static_cast<std::size_t>(
          std::find(file.variables.begin(), file.variables.end(), variables[j]) -
          file.variables.begin());
      EXPECT_EQ(there.index_of[j], here.index_of[before]) << variables[j];
      EXPECT_NEAR(there.point.y[static_cast<Eigen::Index>(j)],
                  here.point.y[static_cast<Eigen::Index>(before)], 1e-12);
    }
  }
}

TEST(Equations, NeitherUnitsOfTimeNorTheEndAreAnythingToTheIndex) {
  // The pendulum with time in units of k seconds: x' = k u and so on.
  for (const double k : {1e-4, 1e-2, 1e2, 1e4}) {
    SCOPED_TRACE(k);
    const std::string unit = reading::digits(k) + "*";
    const EquationStart found = equation_start(file_of(
        unknowns,
        {"der(x) = " + unit + "u", "der(y) = " + unit + "v", "der(u) = -" + unit + "x*lambda",
         "der(v) = " + unit + "(-y*lambda - 9.81)", "x^2 + y^2 = 1"},
        swinging));
    ASSERT_EQ(found.point.why, "");
    EXPECT_EQ(found.point.found.index, 3);
    EXPECT_TRUE(found.structure_holds());
  }
  for (const double end : {1e-4, 1e4})
    for (const char* name : {"ivp/car_axis", "ivp/transistor_amplifier", "ivp/akzo_nobel",
                             "structure/turned_pendulum"}) {
      SCOPED_TRACE(name);
      const std::string file = std::string("suites/") + name + ".toml";
      EquationFile here = read_equations(example(file));
      const int index = equation_start(here).point.found.index;
      here.end = end;
      EXPECT_EQ(equation_start(here).point.found.index, index);
    }
}

// ---- where structure and index part ------------------------------------------------------------

TEST(Equations, StructureMayDifferentiateMoreThanIndexOne) {
  // Reißig, Martinson, Barton: x_1 + x_2' + x_3', x_2 + x_2' + x_3', and so on, the last one given:
  // each difference of a pair is algebraic, and one differentiation of the last gives all.
  for (int pairs = 1; pairs <= 3; ++pairs) {
    const int n = 2 * pairs + 1;
    std::vector<std::string> variables, equations;
    for (int k = 1; k <= n; ++k) variables.push_back("x" + std::to_string(k));
    for (int k = 1; k < n; k += 2)
      for (int row = 0; row < 2; ++row)
        equations.push_back("x" + std::to_string(k + row) + " + der(x" + std::to_string(k + 1) +
                            ") + der(x" + std::to_string(k + 2) + ") = cos(t)");
    equations.push_back("x" + std::to_string(n) + " = sin(t)");
    const EquationStart found = equation_start(file_of(variables, equations));
    ASSERT_EQ(found.point.why, "");
    EXPECT_EQ(found.point.found.index, 1) << pairs;
    EXPECT_EQ(found.offsets.index, pairs + 1);
    EXPECT_EQ(found.pantelides, found.offsets.equation);
    EXPECT_TRUE(found.jacobian.regular(n)) << "so the structural index is a bound";
    EXPECT_FALSE(found.structure_holds());
    for (const int index : found.index_of) EXPECT_EQ(index, 1);
  }
}

TEST(Equations, CombinationsHideTheIndexFromStructure) {
  // F multiplied by a regular matrix has the same solutions and the same index; its signature is
  // full, and no equation is differentiated.
  std::mt19937 random(11);
  std::uniform_real_distribution<double> entry(-1, 1);
  const EquationFile plain = pendulum("x^2 + y^2 = 1");
  const EquationStart here = equation_start(plain);
  Eigen::MatrixXd m(5, 5);
  for (auto& x : m.reshaped()) x = entry(random);
  ASSERT_GT(std::abs(m.determinant()), 1e-2);
  std::vector<std::string> mixed;
  for (int i = 0; i < 5; ++i) {
    std::string sum;
    for (int k = 0; k < 5; ++k) {
      const std::string& text = plain.equations[at(k)].text;
      const std::size_t equals = text.find('=');
      sum +=
          (k == 0 ? "" : " + ") + ("(" + reading::digits(m(i, k)) + ")*(" + text.substr(0, equals) +
                                   "- (" + text.substr(equals + 1) + "))");
    }
    mixed.push_back(sum);
  }
  const EquationFile turned = file_of(unknowns, mixed, swinging);
  const EquationStart there = equation_start(turned);
  ASSERT_EQ(there.point.why, "");
  EXPECT_EQ(there.point.found.index, 3);
  EXPECT_LT(there.offsets.index, 3);
  EXPECT_FALSE(there.structure_holds());
  // The determinant's check sees it: five equations for four rates.
  EXPECT_EQ(there.jacobian.rank.rank, 4);
  ASSERT_EQ(there.jacobian.cancelling.size(), 1u);
  // The combination without rates is the constraint: its row of m⁻¹.
  const Eigen::VectorXd row = m.inverse().row(4).transpose();
  const Eigen::VectorXd found = there.jacobian.cancelling[0];
  EXPECT_LT((found / found.norm() - row / row.norm() * (found.dot(row) > 0 ? 1 : -1)).norm(), 1e-9);
  for (Eigen::Index j = 0; j < 5; ++j)
    EXPECT_NEAR(there.point.y[j], here.point.y[j], 1e-10) << unknowns[static_cast<std::size_t>(j)];
}

TEST(Equations, OfTheExamplesHaveTheirIndices) {
  struct Expected {
    const char* file;
    int index, structural;
    bool regular = true;  ///< the system Jacobian
  };
  for (const Expected& e :
       {Expected{"suites/ivp/akzo_nobel.toml", 1, 1},
        Expected{"suites/ivp/transistor_amplifier.toml", 1, 0, false},
        Expected{"suites/ivp/slider_crank.toml", 2, 2}, Expected{"suites/ivp/pendulum.toml", 3, 3},
        Expected{"suites/ivp/car_axis.toml", 3, 3}, Expected{"suites/ivp/wheelset.toml", 2, 2},
        Expected{"suites/ivp/charge_pump.toml", 2, 2, false},
        Expected{"suites/ivp/fekete.toml", 2, 2}, Expected{"suites/structure/pairs.toml", 1, 3},
        Expected{"suites/structure/turned_pendulum.toml", 3, 1, false}}) {
    SCOPED_TRACE(e.file);
    const EquationStart found = equation_start(read_equations(example(e.file)));
    ASSERT_EQ(found.point.why, "");
    EXPECT_EQ(found.point.found.index, e.index);
    EXPECT_EQ(found.offsets.index, e.structural);
    EXPECT_EQ(found.jacobian.regular(static_cast<int>(found.index_of.size())), e.regular);
    EXPECT_EQ(found.structure_holds(), e.regular && e.index == e.structural);
  }
}

TEST(Equations, WhereTheJacobianIsRegularStructureIsABound) {
  // Linear systems with whole numbers: the differentiation index is at most the structural one
  // where the determinant is not zero (Pryce).
  std::mt19937 random(13);
  std::uniform_int_distribution<int> number(-2, 2), choice(0, 5);
  int regular = 0, higher = 0, below = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 3 + trial % 3;
    std::vector<std::string> variables, equations;
    for (int k = 0; k < n; ++k) variables.push_back("x" + std::to_string(k));
    for (int i = 0; i < n; ++i) {
      std::string sum = "sin(t)*0";
      for (int j = 0; j < n; ++j) {
        const int c = number(random), pick = choice(random);
        if (c == 0 || pick > 3) continue;
        sum += " + (" + std::to_string(c) + ")*" +
               (pick == 0 ? "der(x" + std::to_string(j) + ")" : "x" + std::to_string(j));
      }
      equations.push_back(sum);
    }
    EquationStart found;
    try {
      found = equation_start(file_of(variables, equations));
    } catch (const SceneError&) {
      continue;  // structurally singular
    }
    if (!found.point.why.empty() || !found.jacobian.regular(n)) continue;
    ++regular;
    EXPECT_LE(found.point.found.index, found.offsets.index) << trial;
    below += found.point.found.index < found.offsets.index;
    higher += found.point.found.index > 1;
    EXPECT_EQ(n - found.point.found.levels.back().constraints, found.offsets.freedom) << trial;
  }
  EXPECT_GT(regular, 60);
  EXPECT_GT(higher, 5);
  EXPECT_GT(below, 0);
}

// ---- starts
// --------------------------------------------------------------------------------------

TEST(EquationStarts, MeetHiddenConstraintsWithTheLeastChange) {
  const EquationFile off =
      file_of(unknowns, {dynamics[0], dynamics[1], dynamics[2], dynamics[3], "x^2 + y^2 = 1"},
              "values = { x = 1.2, y = -0.5 }\n");
  const EquationStart found = equation_start(off);
  ASSERT_EQ(found.point.why, "");
  const Eigen::VectorXd& y = found.point.y;
  // Nearest to the guess on the circle, at rest as it was.
  EXPECT_NEAR(y[0], 1.2 / 1.3, 1e-12);
  EXPECT_NEAR(y[1], -0.5 / 1.3, 1e-12);
  EXPECT_NEAR(y[2], 0, 1e-12);
  EXPECT_NEAR(y[3], 0, 1e-12);
  EXPECT_NEAR(y[4], 9.81 * 0.5 / 1.3, 1e-11) << "λ of rest: −g y";
  EXPECT_NEAR(found.point.ydot[3], -y[1] * y[4] - 9.81, 1e-11);
  EXPECT_NEAR(found.point.ydot[4], 0, 1e-9) << "λ' = −3 g v";
}

TEST(EquationStarts, KeepWhatIsHeld) {
  const EquationFile held =
      file_of(unknowns, {dynamics[0], dynamics[1], dynamics[2], dynamics[3], "x^2 + y^2 = 1"},
              "values = { x = 0.28, y = -0.5, u = 2, v = -3 }\nhold = [\"x\", \"u\"]\n");
  const EquationStart found = equation_start(held);
  ASSERT_EQ(found.point.why, "");
  const Eigen::VectorXd& y = found.point.y;
  EXPECT_EQ(y[0], 0.28);
  EXPECT_EQ(y[2], 2);
  EXPECT_NEAR(y[1], -0.96, 1e-12);
  EXPECT_NEAR(y[0] * y[2] + y[1] * y[3], 0, 1e-12);
  EXPECT_NEAR(y[4], y[2] * y[2] + y[3] * y[3] - 9.81 * y[1], 1e-10);
  // Both coordinates held off the circle: no point.
  const EquationStart none = equation_start(
      file_of(unknowns, {dynamics[0], dynamics[1], dynamics[2], dynamics[3], "x^2 + y^2 = 1"},
              "values = { x = 1, y = 1 }\nhold = [\"x\", \"y\"]\n"));
  EXPECT_TRUE(equations::says(none.point.why, "no point near the guess"));
}

// y'² = y at y = 1 leaves y' = ±1: no reason to move y to 0, where y' = 0 is right.
TEST(EquationStarts, AskForARateThatTheGuessLeavesOpen) {
  const auto branches = [](const std::string& more) {
    return file_of({"y"}, {"der(y)^2 = y"}, "values = { y = 1 }\n" + more + "[run]\nend = 3\n");
  };
  for (const std::string more : {"", "hold = [\"y\"]\n"}) {
    const EquationStart open = equation_start(branches(more));
    EXPECT_TRUE(equations::says(open.point.why,
                                "leave the rate of y undetermined, 1 or -1: expected one of them"));
  }
  const EquationStart given = equation_start(branches("rates = { y = -0.8 }\n"));
  EXPECT_EQ(given.point.why, "");
  EXPECT_NEAR(given.point.y[0], 1, 1e-12);
  EXPECT_NEAR(given.point.ydot[0], -1, 1e-12);
  const EquationStart corner =
      equation_start(file_of({"x"}, {"abs(der(x)) = x"}, "values = { x = 1 }\n"));
  EXPECT_TRUE(equations::says(corner.point.why, "leave the rate of x undetermined"));
  // Without a start at the guess: x' = y' = ±1.
  const EquationStart product = equation_start(
      file_of({"x", "y"}, {"der(x)*der(y) = 1", "x - y = t^2"}, "values = { x = 1 }\n"));
  EXPECT_TRUE(equations::says(product.point.why, "leave the rate of x undetermined"));
  // One rate alone: it is found.
  const EquationStart turning =
      equation_start(file_of({"x"}, {"der(x) + 0.5*abs(der(x)) = 1 - x"}, ""));
  EXPECT_EQ(turning.point.why, "");
  EXPECT_NEAR(turning.point.ydot[0], 2.0 / 3, 1e-12);
  const EquationStart one =
      equation_start(file_of({"y"}, {"der(y)^3 = y"}, "values = { y = 8 }\n"));
  EXPECT_EQ(one.point.why, "");
  EXPECT_NEAR(one.point.y[0], 8, 1e-9);
  EXPECT_NEAR(one.point.ydot[0], 2, 1e-9);
}

TEST(EquationStarts, SayWhenThereIsNone) {
  const EquationStart none =
      equation_start(file_of({"x"}, {"x^2 + 1 = 0"}, "values = { x = 1 }\n"));
  EXPECT_TRUE(equations::says(none.point.why, "no point near the guess"));
  const EquationStart singular =
      equation_start(file_of({"x", "y"}, {"x + y = 0", "2*x + 2*y = 0"}));
  EXPECT_TRUE(equations::says(singular.point.why, "of y' not determined"));
}

// ---- runs
// ----------------------------------------------------------------------------------------

EquationRun run(const EquationFile& file, const std::string& integrator, double tolerance,
                double step = 0, int samples = 10) {
  const EquationStart start = equation_start(file);
  EXPECT_EQ(start.point.why, "");
  EquationRunRequest request;
  request.integrator = integrator;
  request.rtol = request.atol = tolerance;
  request.step = step;
  request.samples = samples;
  request.end = file.end;
  EquationRun done = run_equations(file, start, request);
  EXPECT_TRUE(done.done) << done.reason;
  return done;
}

TEST(EquationRuns, HaveTheOrderOfRadau) {
  // x' = −x + z, z³ + z = sin t: order 5. The pendulum of index 3: at least 4 for
  // positions, 3 for velocities, 2 for λ.
  const EquationFile one =
      file_of({"x", "z"}, {"der(x) = -x + z", "z^3 + z = sin(t)"}, "[run]\nend = 2\n");
  const EquationFile three = read_equations(example("suites/ivp/pendulum.toml"), {{"run.end", 1}});
  // From the largest errors of the variables over the run.
  const auto order = [](const EquationFile& file, std::size_t first, std::size_t count, double h) {
    const EquationRun exact = run(file, "radau5", 1e-12, h / 16);
    const auto error = [&](double step) {
      const EquationRun r = run(file, "radau5", 1e-12, step);
      double largest = 0;
      for (std::size_t k = 0; k < r.y.size(); ++k)
        for (std::size_t j = first; j < first + count; ++j)
          largest = equations::larger(largest, std::abs(r.y[k][j] - exact.y[k][j]));
      return largest;
    };
    return std::log2(error(h) / error(h / 2));
  };
  EXPECT_NEAR(order(one, 0, 2, 0.2), 5, 0.4);
  EXPECT_GT(order(three, 0, 2, 0.05), 3.8);
  EXPECT_NEAR(order(three, 2, 2, 0.05), 3, 0.3);
  EXPECT_NEAR(order(three, 4, 1, 0.05), 2, 0.3);
}

TEST(EquationRuns, OfBothMethodsEndAlike) {
  const EquationFile file = read_equations(example("suites/ivp/slider_crank.toml"));
  const EquationRun bdf = run(file, "ida", 1e-9), radau = run(file, "radau5", 1e-9);
  for (std::size_t j = 0; j < 6; ++j)
    EXPECT_NEAR(bdf.last[j], radau.last[j], 1e-5 * (1 + std::abs(radau.last[j])))
        << file.variables[j];
  const EquationFile three = read_equations(example("suites/ivp/pendulum.toml"));
  const EquationStart start = equation_start(three);
  EquationRunRequest request;
  request.integrator = "ida";
  EXPECT_THROW(run_equations(three, start, request), std::invalid_argument);
}

// From rest at (1, 0): λ = u² + v² − g y = −3 g y. A sample is no worse than the ends of steps, of
// which 25 are samples too.
TEST(EquationRuns, SampleMultipliersRightBehindAStep) {
  const auto error = [](const EquationRun& r) {
    double largest = 0;
    for (const auto& y : r.y)
      largest = equations::larger(largest, std::abs(y[4] + 3 * 9.81 * y[1]));
    return largest;
  };
  const EquationFile file = read_equations(example("suites/ivp/pendulum.toml"));
  const EquationRun often = run(file, "radau5", 1e-6, 0, 1000);
  EXPECT_LT(error(often), 0.3);
  // Samples next to the ends of steps of one length.
  const EquationFile short_run =
      read_equations(example("suites/ivp/pendulum.toml"), {{"run.end", 1}});
  const EquationRun ends = run(short_run, "radau5", 1e-9, 0.04, 25),
                    behind = run(short_run, "radau5", 1e-9, 0.04 / (1 + 1e-5), 25);
  EXPECT_LT(error(behind), 3 * error(ends));
}

// x₁ = x₂ = eᵗ, z = −eᵗ/(2 − t). Errors of z of order h are not in x, and hold BDF at order 1 where
// they are tested.
TEST(EquationRuns, OfIndexTwoFilterTheirErrors) {
  const EquationFile file = file_of(
      {"x1", "x2", "z"},
      {"der(x1) = (10 - 1/(2-t))*x1 + (2-t)*10*z + (t-3)*exp(t)/(t-2)",
       "der(x2) = 9/(2-t)*x1 - x2 + 9*z + 2*exp(t)", "(t+2)*x1 + (t^2-4)*x2 = (t^2+t-2)*exp(t)"},
      "values = { x1 = 1, x2 = 1, z = -0.5 }\n[run]\nend = 1\n");
  for (const double tolerance : {1e-6, 1e-9}) {
    const EquationRun r = run(file, "ida", tolerance);
    EXPECT_LT(r.counters.steps, 1000);
    EXPECT_NEAR(r.last[0], std::exp(1), 100 * tolerance);
    EXPECT_NEAR(r.last[1], std::exp(1), 100 * tolerance);
  }
}

// The same right behind the ends of steps of one length.
TEST(EquationRuns, SampleVariablesOfIndexTwoRightBehindAStep) {
  const EquationFile file = file_of(
      {"x", "z"}, {"der(x) = z*exp(0.3*x) - x", "x + 0.2*x^3 = sin(t)"}, "[run]\nend = 4\n");
  const auto error = [](const EquationRun& r) {
    double largest = 0;
    for (std::size_t k = 1; k < r.t.size(); ++k) {
      const double x = r.y[k][0], rate = std::cos(r.t[k]) / (1 + 0.6 * x * x);
      largest = std::max(largest, std::abs(r.y[k][1] - (rate + x) * std::exp(-0.3 * x)));
    }
    return largest;
  };
  for (const double tolerance : {1e-5, 1e-7}) {
    const EquationRun ends = run(file, "radau5", tolerance, 0.04, 100),
                      behind = run(file, "radau5", tolerance, 0.04 / (1 + 1e-5), 100);
    EXPECT_LT(error(behind), 3 * error(ends));
  }
}

// All variables are of index 2: a − b = 2 sin t.
TEST(EquationRuns, TestVariablesOfIndexTwoWhereThereAreNoOthers) {
  const EquationFile file = file_of(
      {"a", "b", "c"}, {"der(a) + der(b) + a - b = sin(t)", "a + b = cos(t)", "der(c) = -c"},
      "values = { c = 1 }\n[run]\nend = 10\n");
  for (const double tolerance : {1e-4, 1e-6, 1e-10}) {
    const EquationRun r = run(file, "ida", tolerance);
    EXPECT_LT(r.counters.steps, 1000);
    EXPECT_NEAR(r.last[0], 0.5 * std::cos(10) + std::sin(10), 100 * tolerance);
    EXPECT_NEAR(r.last[2], std::exp(-10), 100 * tolerance);
  }
  const EquationFile alone =
      file_of({"a", "b"}, {"der(a) + der(b) + a - b = sin(t)", "a + b = cos(t)"}, "");
  EXPECT_LT(run(alone, "ida", 1e-8).counters.steps, 200);
}

// x follows from an equation without a freedom, and no dynamics hold the steps: each sample of it
// is tested, and of der(x).
TEST(EquationRuns, TestWhatEquationsPrescribe) {
  struct Case {
    std::vector<std::string> variables, equations;
    std::string values;
  };
  const std::vector<Case> cases{
      {{"x", "l"}, {"der(x) = l", "x = sin(t)"}, ""},
      {{"x", "y", "l"}, {"der(x) = l", "der(y) = -y", "x = sin(t)"}, ""},
      {{"x", "y", "l"}, {"der(x) = l + y", "der(y) = -100*y", "x = sin(t)"}, "y = 1"},
      {{"x", "l", "w"}, {"der(x) = l", "x = sin(t)", "w = cos(3*t)"}, ""},
      {{"x", "i", "w"}, {"1e-6*der(x) = i", "x = sin(t)", "der(w) = (5 - w)/2"}, ""},
      {{"x", "z", "l"}, {"der(x) = l*(2 + x)", "z + 0.1*z^3 = sin(t)", "x = z + 0.1*z^3"}, ""}};
  for (const Case& c : cases)
    for (const double tolerance : {1e-6, 1e-9}) {
      const EquationFile file =
          file_of(c.variables, c.equations, "values = { " + c.values + " }\n[run]\nend = 20\n");
      const EquationRun r = run(file, "ida", tolerance, 0, 200);
      double worst = 0, worst_rate = 0;
      for (std::size_t k = 0; k < r.t.size(); ++k) {
        worst = equations::larger(worst, std::abs(r.y[k][0] - std::sin(r.t[k])));
        if (c.equations.back() == "w = cos(3*t)")
          worst = equations::larger(worst, std::abs(r.y[k][2] - std::cos(3 * r.t[k])));
        if (c.variables[1] == "l" && c.variables.size() == 2)
          worst_rate = equations::larger(worst_rate, std::abs(r.y[k][1] - std::cos(r.t[k])));
      }
      EXPECT_LT(worst, 10 * tolerance) << c.equations[0];
      EXPECT_LT(worst_rate, 1e4 * tolerance) << c.equations[0];
      EXPECT_LT(r.counters.steps, 3000) << c.equations[0];
    }
}

// b = e⁻ᵗ, a = (1 − ηt) b. The simplified iteration contracts by 2η/(1 + η) whatever the step is.
TEST(EquationRuns, ConvergeWhereDerivativesOfTheStartDoNot) {
  for (const double eta : {0.5, 3.0, 10.0}) {
    const std::string text = std::to_string(eta);
    const EquationFile file = file_of({"a", "b"},
                                      {"a + " + text + "*t*b = exp(-t)",
                                       "der(a) + " + text + "*t*der(b) + (1 + " + text + ")*b = 0"},
                                      "values = { a = 1, b = 1 }\n[run]\nend = 2\n");
    for (const double step : {0.0, 0.05}) {
      const EquationRun r = run(file, "radau5", 1e-8, step);
      for (std::size_t k = 0; k < r.t.size(); ++k)
        EXPECT_NEAR(r.y[k][1], std::exp(-r.t[k]), 1e-4) << eta << " " << r.t[k];
      EXPECT_LT(r.counters.steps, 400);
    }
  }
}

TEST(EquationRuns, SayWhatLeavesEveryBound) {
  const auto reason = [](const std::vector<std::string>& equations, const std::string& integrator) {
    std::vector<std::string> variables{"x", "z"};
    variables.resize(equations.size());
    const EquationFile file = file_of(variables, equations, "values = { x = 1 }\n[run]\nend = 2\n");
    EquationRunRequest request;
    request.integrator = integrator;
    request.end = 2;
    const EquationRun r = run_equations(file, equation_start(file), request);
    EXPECT_FALSE(r.done);
    return r.reason;
  };
  for (const std::string integrator : {"ida", "radau5"}) {
    const std::string pole = reason({"der(x) = x^2"}, integrator),
                      root = reason({"2*x*der(x) = -1"}, integrator),
                      of_none = reason({"der(x) = -1", "x*z = 1"}, integrator);
    EXPECT_TRUE(equations::says(pole, "; x leaves every bound near t = 1"));
    EXPECT_TRUE(equations::says(root, "; the rate of x leaves every bound near t = 1"));
    EXPECT_TRUE(equations::says(of_none, "; z leaves every bound near t = 1"));
  }
}

// ---- switches
// ------------------------------------------------------------------------------------

class Switches : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Of, Switches, testing::Values("ida", "radau5"),
                         [](const auto& one) { return one.param; });

TEST_P(Switches, BeginAnewAtJumps) {
  // A condenser behind a square wave, v' = (s − v)/RC.
  const EquationFile wave = file_of(
      {"v", "i"}, {"0.3*der(v) = i", "2*i + v = if(sin(2*pi*t) >= 0, 1, -1)"}, "[run]\nend = 2\n");
  const EquationRun square = run(wave, GetParam(), 1e-8, 0, 40);
  ASSERT_EQ(square.t.size(), 41u);
  double v = 0, begin = 0;
  for (std::size_t k = 0; k <= 40; ++k) {
    const double side = (k == 0 ? 0 : (k - 1) / 10) % 2 == 0 ? 1 : -1;
    if (k > 10 && (k - 1) % 10 == 0) v = square.y[k - 1][0], begin = square.t[k - 1];
    EXPECT_NEAR(square.y[k][0], side + (v - side) * std::exp(-(square.t[k] - begin) / 0.6), 1e-6)
        << square.t[k];
  }
  EXPECT_EQ(square.switchings, 3);
  // In an algebraic equation; by the state; of floor, sign, abs, min and max.
  const auto end = [](const std::vector<std::string>& variables,
                      const std::vector<std::string>& equations, const std::string& more) {
    return run(file_of(variables, equations, more), GetParam(), 1e-8).last[0];
  };
  EXPECT_NEAR(end({"x", "z"}, {"der(x) = z - x", "z = if(t < 1, x, 2*x)"},
                  "values = { x = 1 }\n[run]\nend = 2\n"),
              std::exp(1), 1e-6);
  EXPECT_NEAR(end({"x"}, {"der(x) = if(x < 1, 1, 1 + x)"}, "[run]\nend = 2\n"), 2 * std::exp(1) - 1,
              1e-6);
  EXPECT_NEAR(end({"x"}, {"der(x) = floor(3*t)"}, "[run]\nend = 2\n"), 5, 1e-7);
  EXPECT_NEAR(end({"x"}, {"der(x) = sign(t - 0.5)*max(t, 1)"}, "[run]\nend = 2\n"), 1.5, 1e-7);
  // From rest: friction takes 2/100 of each swing.
  EXPECT_NEAR(end({"x", "v"}, {"der(x) = v", "der(v) = -100*x - sign(v)"},
                  "values = { x = 1 }\n[run]\nend = 0.6283185307179586\n"),
              0.96, 1e-6);
  EXPECT_NEAR(end({"x"}, {"der(x) = min(abs(t - 1), 0.25)"}, "[run]\nend = 2\n"), 0.4375, 1e-7);
  EXPECT_NEAR(end({"x"}, {"der(x) = if(abs(t - 1) < 1e-4, 1e4, 0)"}, "[run]\nend = 2\n"), 2, 1e-7);
}

// u(1) = −1/4: time passes by 2(1 − ln 2) down to u = 0, and by 2 ln 2 − 1 from there. Formulas
// have no values, or no slopes, behind where they turn.
TEST_P(Switches, ArePassedWhereFormulasEndAtThem) {
  for (const std::string law : {"-sign(u)*sqrt(abs(u))", "if(u > 0, -sqrt(u), sqrt(-u))",
                                "sqrt(max(-u, 0)) - sqrt(max(u, 0))"}) {
    const EquationFile file =
        file_of({"u"}, {"der(u) = " + law + " - 1"}, "values = { u = 1 }\n[run]\nend = 1\n");
    EXPECT_NEAR(run(file, GetParam(), 1e-8).last[0], -0.25, 1e-6) << law;
  }
}

TEST_P(Switches, AreNamedWhereTheyMakeValuesJump) {
  const EquationFile file =
      file_of({"v", "i"}, {"v = if(t < 0.5, 0, 1)", "i = der(v)"}, "[run]\nend = 1\n");
  EquationRunRequest request;
  request.integrator = GetParam();
  const EquationRun r = run_equations(file, equation_start(file), request);
  EXPECT_FALSE(r.done);
  EXPECT_TRUE(equations::says(
      r.reason, "'if' of equation 1, 'v = if(t < 0.5, 0, 1)', makes v jump from 0 to 1"));
  EXPECT_NEAR(r.stopped_at, 0.5, 1e-9);
}

// x = 0 up to t = 1 and 1 from there: z = x' has an impulse, and no value.
TEST_P(Switches, AreNamedBeforeImpulses) {
  const EquationFile file =
      file_of({"x", "z"}, {"x = if(t > 1, 1, 0)", "der(x) = z"}, "[run]\nend = 2\n");
  EquationRunRequest request;
  request.integrator = GetParam();
  request.end = 2;
  const EquationRun r = run_equations(file, equation_start(file), request);
  EXPECT_FALSE(r.done);
  EXPECT_TRUE(equations::says(r.reason, "makes x jump from 0 to 1"));
}

// Both sides drive x to 0: no mode holds there, and steps across the jump have no end.
TEST(EquationRuns, NameASwitchThatTurnsBackAndForth) {
  const EquationFile file =
      file_of({"x"}, {"der(x) = -sign(x)"}, "values = { x = 1 }\n[run]\nend = 2\n");
  EquationRunRequest request;
  request.integrator = "ida";
  request.end = 2;
  request.max_cpu_seconds = 0.2;
  const EquationRun r = run_equations(file, equation_start(file), request);
  EXPECT_FALSE(r.done);
  EXPECT_TRUE(
      equations::says(r.reason,
                      "from t = 1 on 'sign' of equation 1, 'der(x) = -sign(x)', turns back and "
                      "forth"));
}

TEST(EquationRuns, OfLargeSystemsTakeASparseMatrix) {
  // The heat equation in 60 cells with the flux at the end as an algebraic unknown.
  const int n = 60;
  std::vector<std::string> variables, equations;
  for (int k = 0; k < n; ++k) variables.push_back("c" + std::to_string(k));
  variables.push_back("q");
  for (int k = 0; k < n; ++k) {
    const std::string c = "c" + std::to_string(k);
    const std::string left = k > 0 ? "c" + std::to_string(k - 1) : "1",
                      right = k + 1 < n ? "c" + std::to_string(k + 1) : c;
    equations.push_back("der(" + c + ") = " + left + " - 2*" + c + " + " + right +
                        (k + 1 < n ? "" : " - q"));
  }
  equations.push_back("q = 0.1*c" + std::to_string(n - 1));
  const EquationFile file = file_of(variables, equations, "[run]\nend = 50\n");
  const EquationRun sparse = run(file, "ida", 1e-9), radau = run(file, "radau5", 1e-9);
  EXPECT_EQ(sparse.linear_solver, "KLU");
  for (std::size_t j = 0; j < variables.size(); ++j)
    EXPECT_NEAR(sparse.last[j], radau.last[j], 1e-6) << variables[j];
}

// ---- references
// ----------------------------------------------------------------------------------

struct Published {
  const char* file;
  double error;  ///< of the published values, of which the last digits are not all right
  std::vector<double> values;
};

TEST(EquationReferences, AreThePublishedEnds) {
  // Test Set for IVP Solvers, release 2.4.
  const Published all[]{
      {"akzo_nobel.toml",
       1e-16,
       {0.1150794920661702, 0.1203831471567715e-2, 0.1611562887407974, 0.3656156421249283e-3,
        0.1708010885264404e-1, 0.4873531310307455e-2}},
      {"transistor_amplifier.toml",
       2e-15,
       {-0.5562145012262709e-2, 0.3006522471903042e1, 0.2849958788608128e1, 0.2926422536206241e1,
        0.2704617865010554e1, 0.2761837778393145e1, 0.4770927631616772e1, 0.1236995868091548e1}},
      {"car_axis.toml",
       5e-12,
       {0.4934557842755629e-1, 0.4969894602303324, 0.1041742524885400e1, 0.3739110272652214,
        -0.7705836840321485e-1, 0.7446866596327776e-2, 0.1755681574942899e-1, 0.7703410437794031}},
      {"wheelset.toml",
       2e-7,
       {0.86355386965811e-2, 0.13038281022727e-4, -0.93635784016818e-4, -0.13642299804033e-1,
        0.15292895005422e-2, -0.76985374142666e-1, -0.25151106429207e-3, 0.20541188079539e-2,
        -0.23904837703692, -0.13633468454173e-1, -0.24421377661131, 0.37839614386969e-3,
        0.14173214964613, -0.33666751972196e-3, -0.15949425684022, -0.10124044903201e-1,
        -0.56285630573753e-2}},
      {"fekete.toml",
       3e-12,
       {-0.4070263380333202, 0.3463758772791802, 0.8451942450030429, 0.7752934752521549e-1,
        -0.2628662719972299, 0.9617122871829146, 0.7100577833343567, 0.1212948055586120,
        0.6936177005172217, 0.2348267744557627, 0.7449277976923311, 0.6244509285956391}}};
  for (const Published& p : all) {
    const EquationFile file = read_equations(example(std::string("suites/ivp/") + p.file));
    for (std::size_t j = 0; j < p.values.size(); ++j)
      EXPECT_NEAR(file.reference->values[j], p.values[j], p.error)
          << p.file << " " << file.variables[j];
  }
}

/// Fekete's points rest in the end: on the sphere, and what the others push each with is radial.
TEST(EquationReferences, FeketePointsRest) {
  const EquationFile file = read_equations(example("suites/ivp/fekete.toml"));
  const std::vector<double>& at = file.reference->values;
  const auto point = [&](std::size_t i) {
    return Eigen::Vector3d(at[3 * i], at[3 * i + 1], at[3 * i + 2]);
  };
  for (std::size_t i = 0; i < 20; ++i) {
    Eigen::Vector3d push = Eigen::Vector3d::Zero();
    for (std::size_t j = 0; j < 20; ++j)
      if (j != i) push += (point(i) - point(j)) / (point(i) - point(j)).squaredNorm();
    EXPECT_NEAR(point(i).norm(), 1, 4e-16);
    EXPECT_LT(push.cross(point(i)).norm(), 3e-14) << i;
    // Σ over pairs: each of the others has its half in the radial part
    EXPECT_NEAR(push.dot(point(i)), 9.5, 3e-14);
  }
}

TEST(EquationReferences, AreMadeAnew) {
  for (const char* name : {"akzo_nobel.toml", "slider_crank.toml", "car_axis.toml"}) {
    SCOPED_TRACE(name);
    const EquationFile file = read_equations(example(std::string("suites/ivp/") + name));
    const QuadReference own = quad_reference(file, equation_start(file), file.reference->t);
    EXPECT_LT(own.accuracy, 1e-18);
    for (std::size_t j = 0; j < own.values.size(); ++j) {
      if (!file.reference->judged[j]) continue;
      EXPECT_NEAR(value_of(own.values[j]) / file.reference->values[j], 1, 4e-16);
    }
  }
}

TEST(EquationReferences, KeepWhatThePendulumKeeps) {
  const EquationFile file = read_equations(example("suites/ivp/pendulum.toml"));
  const EquationStart start = equation_start(file);
  std::vector<Quad> y0, rate0;
  refine_start(file, start, y0, rate0);
  const QuadReference own = quad_reference(file, start, 3);
  const std::vector<Quad>& y = own.values;
  const Quad g(file.parameters[0]);
  const auto energy = [&](const std::vector<Quad>& s) {
    return Quad(0.5) * (s[2] * s[2] + s[3] * s[3]) + g * s[1];
  };
  EXPECT_LT(std::abs(value_of(energy(y) - energy(y0))), 1e-17);
  EXPECT_LT(std::abs(value_of(y[0] * y[0] + y[1] * y[1] - Quad(1.0))), 1e-22);
  EXPECT_LT(std::abs(value_of(y[0] * y[2] + y[1] * y[3])), 1e-17);
  EXPECT_LT(std::abs(value_of(y[2] * y[2] + y[3] * y[3] - g * y[1] - y[4])), 1e-10);
}

TEST(EquationReferences, StartOnHiddenConstraintsToTheLastDigit) {
  const EquationFile file = pendulum("x^2 + y^2 = 1");
  std::vector<Quad> y, rate;
  refine_start(file, equation_start(file), y, rate);
  const Quad g(9.81);
  EXPECT_LT(std::abs(value_of(y[0] * y[0] + y[1] * y[1] - Quad(1.0))), 1e-31);
  EXPECT_LT(std::abs(value_of(y[0] * y[2] + y[1] * y[3])), 1e-31);
  EXPECT_LT(std::abs(value_of(y[2] * y[2] + y[3] * y[3] - g * y[1] - y[4])), 1e-29);
  EXPECT_LT(std::abs(value_of(rate[4] + Quad(3.0) * g * y[3])), 1e-27);
}

TEST(EquationRuns, CountDigitsAsTheTestSetDoes) {
  EquationFile file =
      file_of({"x", "y", "z"}, {"der(x) = 1", "der(y) = 1", "der(z) = 1"}, "scales = { y = 10 }\n");
  EquationRun run;
  run.done = true;
  run.rtol = 1e-6;
  run.atol = 1e-7;
  run.last = {1.001, 2e-3, 5};
  const Digits all = digits_of(run, file, {1, 1e-3, 1}, {1, 1, 0});
  EXPECT_NEAR(all.scd, 0, 1e-9) << "y by as much as it is";
  EXPECT_NEAR(all.mescd, -std::log10(1e-3 / 1.001), 1e-9) << "y over atol/rtol · 10 + |r|";
  const Digits first = digits_of(run, file, {1, 1e-3, 1}, {1, 0, 0});
  EXPECT_NEAR(first.scd, 3, 1e-9);
  EXPECT_NEAR(first.mescd, -std::log10(1e-3 / 1.1), 1e-9);
  EXPECT_EQ(digits_of(run, file, {1.001, 0, 0}, {1, 0, 0}).scd, 17);
  run.done = false;
  EXPECT_TRUE(std::isnan(digits_of(run, file, {1, 1e-3, 1}, {1, 1, 0}).scd));
}

TEST(EquationRuns, GainDigitsWithTheTolerance) {
  for (const char* name :
       {"akzo_nobel.toml", "slider_crank.toml", "pendulum.toml", "car_axis.toml"}) {
    const EquationFile file = read_equations(example(std::string("suites/ivp/") + name));
    const auto digits = [&](double tolerance) {
      return digits_of(run(file, "radau5", tolerance), file, file.reference->values,
                       file.reference->judged);
    };
    const Digits loose = digits(1e-5), tight = digits(1e-9);
    EXPECT_GT(tight.mescd, loose.mescd + 2) << name;
    EXPECT_GE(loose.mescd, loose.scd) << name;
  }
}

}  // namespace
}  // namespace momenta::dae_equations
