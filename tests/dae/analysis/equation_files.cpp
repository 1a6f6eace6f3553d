// Files of equations: what they say, and the sentences of those that are wrong. Each file of
// broken_equations/ opens with "# expect: " lines, the parts its sentence must contain.

#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/scene/scene.h>
#include <momenta/dae/analysis/equations/equation_file.h>
#include <momenta/dae/analysis/equations/equation_start.h>
#include <momenta/dae/analysis/equations/suite.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>

namespace momenta::dae_equation_files {
namespace {

namespace fs = std::filesystem;

using equations::sentence_of;

std::vector<fs::path> broken_files() {
  std::vector<fs::path> files;
  for (const auto& entry :
       fs::directory_iterator(fs::path(MOMENTA_SOURCE_DIR) / "tests/dae/analysis/broken_equations"))
    files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

class BrokenEquations : public testing::TestWithParam<fs::path> {};

TEST_P(BrokenEquations, AreRefusedWithTheExpectedSentence) {
  const std::string sentence = sentence_of([&] { (void)read_equations(GetParam()); });
  const std::string name = GetParam().string();
  ASSERT_TRUE(sentence.starts_with(name)) << sentence;
  int line = 0, column = 0;
  EXPECT_EQ(std::sscanf(sentence.c_str() + name.size(), ":%d:%d: ", &line, &column), 2) << sentence;
  std::ifstream stream(GetParam());
  const std::string mark = "# expect: ";
  int expected = 0;
  for (std::string head; std::getline(stream, head) && head.starts_with(mark); ++expected)
    EXPECT_NE(sentence.find(head.substr(mark.size())), std::string::npos)
        << "sentence: " << sentence << "\nmissing:  " << head.substr(mark.size());
  EXPECT_GT(expected, 0);
}

INSTANTIATE_TEST_SUITE_P(Files, BrokenEquations, testing::ValuesIn(broken_files()),
                         [](const auto& file) { return file.param.stem().string(); });

const char* const pendulum = R"([dae]
name = "pendulum"
variables = ["x", "y", "u"]
equations = [
  "der( x ) = u*a",
  "x^2 + y^2 = 1",
  "der(u) + t",
]
values = { x = "a/2", y = 1 }
rates = { x = 3 }
scales = { u = 1e-3 }
hold = ["y"]
[parameters]
a = 4
[run]
start = 1
end = 3
samples = 7
[reference]
values = { x = 5 }
)";

TEST(EquationFiles, AreReadAsTheyAreWritten) {
  ASSERT_TRUE(holds_equations(pendulum));
  EXPECT_FALSE(holds_equations("name = \"[dae]\"\n[[body]]\n"));
  const EquationFile file = parse_equations(pendulum, "p.toml");
  EXPECT_EQ(file.name, "pendulum");
  EXPECT_EQ(file.size(), 3);
  EXPECT_EQ(file.equations[1].at.line, 6);
  EXPECT_EQ(file.values, (std::vector<double>{2, 1, 0}));
  EXPECT_EQ(file.rates, (std::vector<double>{3, 0, 0}));
  EXPECT_EQ(file.scales, (std::vector<double>{1, 1, 1e-3}));
  EXPECT_EQ(file.held, (std::vector<char>{0, 1, 0}));
  EXPECT_EQ(file.start, 1);
  EXPECT_EQ(file.end, 3);
  EXPECT_EQ(file.samples, 7);
  EXPECT_EQ(file.reference->t, 3) << "the end, where no time is given";
  EXPECT_EQ(file.reference->judged, (std::vector<char>{1, 0, 0}));
  const structure::Signature s = file.signature();
  EXPECT_EQ(s(0, 0), 1);
  EXPECT_FALSE(s.has(0, 1));
  EXPECT_EQ(s(0, 2), 0);
  EXPECT_EQ(s(1, 0), 0);
  EXPECT_EQ(s(2, 2), 1);
  // der(x) − u a, x² + y² − 1, der(u) + t
  Residual<double> residual(file);
  const double y[]{0.5, 2, 7}, ydot[]{11, 13, 17};
  double r[3];
  residual(1.25, y, ydot, r);
  EXPECT_EQ(r[0], 11 - 28.0);
  EXPECT_EQ(r[1], 0.25 + 4 - 1);
  EXPECT_EQ(r[2], 17 + 1.25);
}

// The same equations with what they have in common by name: the same bits, derivatives among them.
TEST(EquationFiles, DefinitionsStandForTheirFormulas) {
  const std::string head = "[dae]\nvariables = ['x', 'y', 'z']\n";
  const EquationFile named = parse_equations(head + R"--(
equations = ["der(x) = s*y + a", "r = 2 + s", "der(z) = fall/r"]
[dae.definitions]
r = "sqrt(x^2 + y^2)"
s = "sin(r - t)/r"
fall = "-a*der(x)*s^2"
unused = "z"
[parameters]
a = 3)--",
                                             "f.toml");
  const std::string r = "sqrt(x^2 + y^2)", s = "(sin(" + r + " - t)/" + r + ")";
  const EquationFile whole =
      parse_equations(head + "equations = ['der(x) = " + s + "*y + a', '" + r + " = 2 + " + s +
                          "', 'der(z) = -a*der(x)*" + s + "^2/" + r + "']\n[parameters]\na = 3\n",
                      "f.toml");
  for (int i = 0; i < 3; ++i) {
    const Expression &a = named.equations[i].formula, &b = whole.equations[i].formula;
    EXPECT_EQ(a.variables(), b.variables()) << i;
    EXPECT_EQ(named.equations[i].text.find("sqrt"), std::string::npos);
    std::vector<int> all(static_cast<std::size_t>(named.arguments()));
    for (std::size_t v = 0; v < all.size(); ++v) all[v] = static_cast<int>(v);
    const Expression da = a.with_derivatives(all), db = b.with_derivatives(all);
    EXPECT_EQ(da.tape().size(), db.tape().size()) << i << ": what occurs twice is computed once";
    const std::vector<double> x{0.3, 1.1, -0.7, 0.2, 2.1, 0.4, -1.3, 3};
    EXPECT_EQ(a(x), b(x)) << i;
    EXPECT_EQ(da(x), db(x)) << i;
  }
  const structure::Signature sa = named.signature(), sb = whole.signature();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_EQ(sa.has(i, j), sb.has(i, j)) << i << " " << j;
}

TEST(EquationFiles, NumbersAreSetFromOutside) {
  const EquationFile file = parse_equations(pendulum, "p.toml", {{"a", 10}, {"run.end", 5}});
  EXPECT_EQ(file.values[0], 5);
  EXPECT_EQ(file.end, 5);
}

TEST(EquationFiles, SlopesAreThoseOfDualNumbers) {
  const EquationFile file = parse_equations(R"([dae]
variables = ["x", "y"]
equations = ["der(x)*sin(y) = exp(x)*der(y)^2", "t*der(x) + atan2(x, y) + 0"]
)",
                                            "f.toml");
  Slopes<double> slopes(file);
  const double y[]{0.4, 1.3}, ydot[]{-0.7, 2.1};
  slopes.evaluate_at(0.9, y, ydot);
  ASSERT_EQ(slopes.entries().size(), 7u);
  using D = Dual<double, 1>;
  for (std::size_t k = 0; k < 7; ++k) {
    const auto& e = slopes.entries()[k];
    D yd[2]{D(y[0]), D(y[1])}, ydd[2]{D(ydot[0]), D(ydot[1])}, r[2];
    (e.of_rate ? ydd : yd)[e.variable].b[0] = 1;
    Residual<D> residual(file);
    residual(D(0.9), yd, ydd, r);
    EXPECT_NEAR(slopes.values()[k], r[e.equation].b[0], 1e-14);
  }
}

TEST(EquationFiles, AGuessWhereNothingIsFiniteIsRefused) {
  const EquationFile file = parse_equations(R"([dae]
variables = ["x", "y"]
equations = ["der(x) = y", "0 = log(x) - y"]
)",
                                            "f.toml");
  const std::string sentence = sentence_of([&] { (void)equation_start(file); });
  EXPECT_EQ(sentence,
            "f.toml:3:28: equation 2, '0 = log(x) - y': not a finite number at the guess of the "
            "start, expected dae.values where it is one");
}

TEST(Suites, NameTheirFilesAndWhatIsWrong) {
  const fs::path folder = fs::temp_directory_path() / "momenta_suite_test";
  fs::create_directories(folder);
  const auto sentence = [&](const std::string& text) {
    std::ofstream(folder / "suite.toml") << text;
    return sentence_of([&] { (void)read_suite(folder / "suite.toml"); });
  };
  const auto has = [](const std::string& all, const std::string& part) {
    EXPECT_NE(all.find(part), std::string::npos) << all;
  };
  has(sentence("name = \"a\"\n"), "no problem, expected at least one [[problem]]");
  has(sentence("[[problem]]\nfile = \"b.toml\"\n"),
      "suite.toml:2:8: problem number 1: file is 'b.toml', expected a file of equations");
  std::ofstream(folder / "b.toml") << "[dae]\nvariables = [\"x\"]\nequations = [\"der(x) = -x\"]\n";
  has(sentence("methods = [\"rk4\"]\n[[problem]]\nfile = \"b.toml\"\n"), "methods has 'rk4'");
  has(sentence("tolerances = [2]\n[[problem]]\nfile = \"b.toml\"\n"),
      "tolerances has 2, expected numbers between 0 and 1");
  std::ofstream(folder / "suite.toml")
      << "[[problem]]\nfile = \"b.toml\"\ntolerances = [1e-5]\nmethods = [\"radau5\"]\n";
  const Suite suite = read_suite(folder / "suite.toml");
  ASSERT_EQ(suite.problems.size(), 1u);
  EXPECT_EQ(suite.name, "suite");
  EXPECT_EQ(suite.problems[0].methods, std::vector<std::string>{"radau5"});
  // One that is wrong keeps no other from running.
  std::ofstream(folder / "c.toml") << "[dae]\nvariables = [\"x\"]\nequations = [\"x = x + \"]\n";
  std::ofstream(folder / "suite.toml")
      << "tolerances = [1e-5]\n[[problem]]\nfile = \"c.toml\"\n[[problem]]\nfile = \"b.toml\"\n";
  const SuiteResult result = run_suite(read_suite(folder / "suite.toml"), {});
  ASSERT_EQ(result.problems.size(), 2u);
  has(result.problems[0].why, "equation 1");
  EXPECT_EQ(result.problems[1].runs.size(), 2u);
  for (const Digits& d : result.problems[1].digits) EXPECT_GT(d.mescd, 4);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace momenta::dae_equation_files
