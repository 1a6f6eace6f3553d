// The verbs run, index, work and bench on files of equations, called as users call them.

#include "dae/app/program.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace momenta::golden::dae_equation_program {
namespace {

using Json = nlohmann::json;

class EquationProgram : public Program {
 protected:
  static std::string suite(const std::string& file) {
    return " '" + (fs::path(MOMENTA_SOURCE_DIR) / "examples/suites" / file).string() + "' ";
  }
  std::string out() const { return " --out '" + (folder_ / "results").string() + "' "; }
  Json made(const std::string& file) const {
    return Json::parse(text_of(folder_ / "results" / file));
  }
};

TEST_F(EquationProgram, RunsAndWritesItsFiles) {
  const Outcome o = call("run" + suite("ivp/pendulum.toml") + "--samples 20" + out());
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("Pendulum: index 3, radau5"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("Digits of the reference"), std::string::npos) << o.out;
  const Json j = made("summary.json");
  EXPECT_EQ(j["status"], "done");
  EXPECT_EQ(j["index"], 3);
  EXPECT_GT(j["mescd"], 4);
  const std::string csv = text_of(folder_ / "results/trajectory.csv");
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "t,x,y,u,v,lambda");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 22);
  const std::string page = text_of(folder_ / "results/index.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_NE(page.find("structural index"), std::string::npos);
  // The reference is of t = 10: at another end there are no digits.
  const Json early =
      Json::parse(call("run" + suite("ivp/pendulum.toml") + "--end 1 --json --timing none").out);
  EXPECT_TRUE(early["mescd"].is_null());
  EXPECT_TRUE(early["cpu_s"].is_null());
  EXPECT_EQ(early["end_time"], 1);
}

TEST_F(EquationProgram, TellsBothIndices) {
  const Json j = Json::parse(call("index" + suite("structure/pairs.toml") + "--json").out);
  EXPECT_EQ(j["index"], 1);
  EXPECT_EQ(j["structure"]["index"], 3);
  EXPECT_EQ(j["structure"]["holds"], false);
  EXPECT_EQ(j["structure"]["pantelides_agrees"], true);
  EXPECT_EQ(j["equations"][4]["c"], 2);
  EXPECT_NEAR(j["variables"][0]["start"].get<double>(), 1, 1e-14);
  const Outcome o = call("index" + suite("structure/turned_pendulum.toml"));
  EXPECT_NE(o.out.find("singular"), std::string::npos) << o.out;
  EXPECT_NE(o.out.find("(4) - (5)"), std::string::npos) << o.out;
  const Outcome moved = call("index" + suite("ivp/slider_crank.toml") + "--set v1=1");
  EXPECT_EQ(moved.status, 2);
}

TEST_F(EquationProgram, ScoresASuite) {
  const fs::path equations =
      write("decay.toml",
            "[dae]\nname = \"decay\"\nvariables = [\"x\"]\nequations = [\"der(x) = -x\"]\n"
            "values = { x = 1 }\n[run]\nend = 2\n");
  const fs::path suite = write("suite.toml",
                               "name = \"one\"\ntolerances = [1e-4, 1e-8]\n[[problem]]\nfile = "
                               "\"decay.toml\"\n[[problem]]\nfile = \"decay.toml\"\nmethods = "
                               "[\"radau5\"]\ntolerances = [1e-6]\n");
  const Outcome o = call("bench '" + suite.string() + "' --timing once" + out());
  ASSERT_EQ(o.status, 0) << o.err;
  const Json j = made("bench.json");
  ASSERT_EQ(j["problems"].size(), 2u);
  EXPECT_EQ(j["problems"][0]["runs"].size(), 4u);
  EXPECT_EQ(j["problems"][1]["runs"].size(), 1u);
  // e⁻² to the digits of quadruple precision.
  EXPECT_EQ(j["problems"][0]["reference"]["values"]["x"].get<std::string>().substr(0, 22),
            "1.35335283236612691893");
  EXPECT_TRUE(j["problems"][0]["reference"]["own"]);
  EXPECT_LT(j["problems"][0]["runs"][0]["scd"], j["problems"][0]["runs"][1]["scd"]);
  const std::string csv = text_of(folder_ / "results/bench.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_NE(text_of(folder_ / "results/index.html").find("<svg"), std::string::npos);
  // One file alone: work.
  const Json work = Json::parse(
      call("work '" + equations.string() + "' --from 1e-3 --to 1e-6 --timing none --json").out);
  EXPECT_EQ(work["problems"][0]["runs"].size(), 8u);
}

TEST_F(EquationProgram, ScoresASuiteOfMechanisms) {
  write("rod.toml",
        "name = \"rod\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"rod\"\nmass = 1\nshape = "
        "{ kind = \"rod\", length = 1 }\n[[joint]]\nname = \"O\"\nkind = \"revolute\"\nchild = "
        "\"rod\"\naxis = \"z\"\n");
  const fs::path suite =
      write("suite.toml",
            "forms = [\"momentum\", \"acceleration\"]\ntolerances = [1e-4, 1e-8]\n[[problem]]\n"
            "scene = \"rod.toml\"\nend = 1\nallowed = [1e-3]\n[[problem]]\nscene = \"rod.toml\"\n"
            "name = \"none\"\nset = { \"body.none.mass\" = 1 }\n");
  const Outcome o = call("bench '" + suite.string() + "' --timing none" + out());
  ASSERT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("rod: within 0.001 with the fewest evaluations, "), std::string::npos)
      << o.out;
  const Json j = made("bench.json");
  ASSERT_EQ(j["problems"].size(), 2u);
  const Json &rod = j["problems"][0], none = j["problems"][1];
  ASSERT_EQ(rod["runs"].size(), 4u);
  EXPECT_GT(rod["runs"][0]["error"], rod["runs"][1]["error"]);
  EXPECT_LT(rod["runs"][1]["error"], 1e-6);
  EXPECT_EQ(rod["columns"].dump(), "[\"O.q [rad]\",\"O.u [rad/s]\"]");
  EXPECT_TRUE(rod["within"][0]["run"].is_number());
  EXPECT_NE(none["why"].get<std::string>().find("body.none.mass"), std::string::npos);
  const std::string csv = text_of(folder_ / "results/bench.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  const std::string page = text_of(folder_ / "results/index.html");
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("{{"), std::string::npos);
}

TEST_F(EquationProgram, RefusesWhatIsOfMechanisms) {
  const std::string file = suite("ivp/pendulum.toml");
  expect_refused("run" + file + "--form acceleration", "found the option --form of mechanisms");
  expect_refused("run" + file + "--integrator rk4", "expected ida or radau5");
  expect_refused("run" + file + "--integrator ida", "found index 3, expected --integrator radau5");
  expect_refused("drift" + file, "holds equations, expected a scene");
  expect_refused("check" + file, "holds equations, expected a scene");
  expect_refused("bench" + file, "holds equations, expected a scene");
  expect_refused(
      "run '" + write("a.toml", "[dae]\nvariables = [\"x\"]\nequations = [\"0 = 1\"]\n").string() +
          "'",
      "structurally singular");
  const Outcome none = call("run '" +
                            write("b.toml",
                                  "[dae]\nvariables = [\"x\"]\nequations = [\""
                                  "x^2 = -1\"]\n")
                                .string() +
                            "'");
  EXPECT_EQ(none.status, 1);
  EXPECT_NE(none.err.find("no consistent start"), std::string::npos) << none.err;
}

}  // namespace
}  // namespace momenta::golden::dae_equation_program
