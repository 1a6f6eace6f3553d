// momenta linearise as its users call it: text, files that other programs read, sentences.

#include "dae/app/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sstream>

namespace momenta::golden::dae_linearise {
namespace {

using Json = nlohmann::json;
using LinearModelsOfTheProgram = Program;

/// The rows of `NAME = [ … ]` in a script: one a line, blanks between numbers.
std::vector<std::vector<double>> matrix_in(const std::string& script, const std::string& name) {
  std::istringstream in(script);
  std::string line;
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line) && line != name + " = [") {
  }
  while (std::getline(in, line) && line != "];") {
    std::istringstream numbers(line);
    rows.emplace_back();
    for (double x; numbers >> x;) rows.back().push_back(x);
  }
  return rows;
}

TEST_F(LinearModelsOfTheProgram, AreToldInATableAndInFiles) {
  for (const std::string kind : {"minimal", "descriptor"}) {
    const fs::path out = folder_ / kind;
    const Outcome o = call("linearise '" + example("motor") + "' --after 0.1 --kind " + kind +
                           " --out '" + out.string() + "'");
    ASSERT_EQ(o.status, 0) << o.err;
    EXPECT_NE(o.out.find("linear model (" + kind + ") about the state at t = 0.1 s"),
              std::string::npos)
        << o.out;
    const Json json = Json::parse(text_of(out / "linear.json"));
    EXPECT_EQ(json["kind"], kind);
    const std::string script = text_of(out / "linear.m");
    for (const char* name : {"A", "B", "C", "D", "E"}) {
      const Json& rows = json[name];
      if (!rows.empty() && !rows[0].empty()) {
        EXPECT_EQ(Json(matrix_in(script, name)), rows) << kind << " " << name;
      }
    }
    EXPECT_EQ(json["C"].size(), json["outputs"].size());
    EXPECT_EQ(json["D"].size(), json["outputs"].size());
    // Python reads the same numbers.
    const std::string python =
        "import sys, json; sys.dont_write_bytecode = True; sys.path.insert(0, sys.argv[1]); import "
        "linear as l; j = json.load(open(sys.argv[1] + '/linear.json')); assert all(getattr(l, k) "
        "== j[k] for k in ('E', 'A', 'B', 'C', 'D', 'states', 'inputs', 'outputs'))";
    EXPECT_EQ(std::system(("python3 -c \"" + python + "\" '" + out.string() + "'").c_str()), 0);
  }
}

TEST_F(LinearModelsOfTheProgram, AtAnEquilibriumHaveItsModes) {
  const Outcome o = call("linearise '" + example("four_bar") +
                         "' --equilibrium settle --json --inputs O "
                         "--outputs O.q");
  ASSERT_EQ(o.status, 0) << o.err;
  const Json json = Json::parse(o.out);
  EXPECT_EQ(json["inputs"], Json({"O.tau [N m]"}));
  ASSERT_EQ(json["poles"].size(), 2u);
  EXPECT_NEAR(json["poles"][0][1].get<double>() / 6.283185307179586, 0.94214845, 1e-8);
}

TEST_F(LinearModelsOfTheProgram, RefuseWhatTheyCannotDoInOneSentence) {
  const std::string verb = "linearise '" + example("four_bar") + "' ";
  expect_refused(verb + "--time 1 --after 1", "expected one of them");
  expect_refused(verb + "--time nan", "--time is not finite");
  expect_refused(verb + "--time inf", "--time is not finite");
  expect_refused(verb + "--kind small", "--kind");
  expect_refused(verb + "--inputs X", "input 'X' is not known");
  expect_refused(verb + "--at '{\"q\": {\"O\": 9}}'", "is open by");
  EXPECT_EQ(call(verb + "--time 1e300").status, 0);
}

TEST_F(LinearModelsOfTheProgram, EndWithASentenceAfterTheirTime) {
  const fs::path out = folder_ / "none";
  const Outcome o = call("linearise '" + example("four_bar") +
                         "' --after 1e6 --cpu-limit 0.2 --out '" + out.string() + "'");
  EXPECT_NE(o.status, 0);
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_FALSE(fs::exists(out / "linear.json"));
  const Outcome effort =
      call("effort '" + example("motor") + "' --samples 1000000 --quiet --cpu-limit 0.2");
  EXPECT_EQ(effort.status, 1);
  EXPECT_NE(effort.err.find("stopped after 0.2 s of CPU time"), std::string::npos) << effort.err;
}

}  // namespace
}  // namespace momenta::golden::dae_linearise
