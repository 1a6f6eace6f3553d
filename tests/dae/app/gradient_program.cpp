// momenta gradient as its users call it: text, files, sentences.

#include "dae/app/program.h"

#include <nlohmann/json.hpp>
#include <sstream>

namespace momenta::golden::dae_gradient_program {
namespace {

using GradientOfTheProgram = Program;

TEST_F(GradientOfTheProgram, TellsAndWrites) {
  const std::string out = (folder_ / "g").string();
  const Outcome o =
      call("gradient '" + example("pendulum") +
           "' --of P.y --by O.q,O.u,body.bob.mass --end 1 --samples 4 --out '" + out + "'");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_NE(o.out.find("Pendulum: P.y at t = 1 s is -0.165010853; form momentum, dop853, tolerance "
                       "1e-8, "),
            std::string::npos)
      << o.out;
  EXPECT_NE(o.out.find("Without effect: 'body.bob.mass'."), std::string::npos) << o.out;
  const auto json = nlohmann::json::parse(text_of(folder_ / "g" / "gradient.json"));
  EXPECT_EQ(json["by"]["O.q"]["kind"], "start position");
  EXPECT_EQ(json["by"]["O.u"]["kind"], "start rate");
  EXPECT_EQ(json["by"]["body.bob.mass"]["kind"], "parameter");
  EXPECT_EQ(json["without_effect"], nlohmann::json::array({"body.bob.mass"}));
  EXPECT_EQ(json["form"], "momentum");
  std::istringstream csv(text_of(folder_ / "g" / "gradient.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line,
            "t [s],d(O.q)/d(O.q),d(O.u)/d(O.q),d(O.q)/d(O.u),d(O.u)/d(O.u),d(O.q)/d(body.bob.mass),"
            "d(O.u)/d(body.bob.mass)");
  std::getline(csv, line);
  EXPECT_EQ(line.substr(0, 2), "0,");
  EXPECT_NEAR(std::stod(line.substr(2)), 1, 1e-12) << line;
  int lines = 1;
  while (std::getline(csv, line)) ++lines;
  EXPECT_EQ(lines, 5);
  const Outcome integral = call("gradient '" + example("pendulum") +
                                "' --of t^2 --integral --by gravity.1 --end 3 --json");
  EXPECT_EQ(integral.status, 0) << integral.err;
  EXPECT_NEAR(nlohmann::json::parse(integral.out)["value"].get<double>(), 9, 1e-12);
}

TEST_F(GradientOfTheProgram, GoesBackwards) {
  const std::string run = "gradient '" + example("four_bar") +
                          "' --of B.y --by O.q,body.coupler.mass,gravity.1 --gauge reset "
                          "--integrator rk4 --step 0.01 --end 0.5 ";
  const Outcome forward = call(run + "--json");
  const Outcome back = call(run + "--mode adjoint --json --out '" + (folder_ / "b").string() + "'");
  EXPECT_EQ(back.status, 0) << back.err;
  EXPECT_TRUE(fs::exists(folder_ / "b" / "gradient.json"));
  EXPECT_FALSE(fs::exists(folder_ / "b" / "gradient.csv"));
  const auto a = nlohmann::json::parse(forward.out), b = nlohmann::json::parse(back.out);
  EXPECT_EQ(a["mode"], "forward");
  EXPECT_EQ(b["mode"], "adjoint");
  EXPECT_TRUE(a["products"].is_null());
  EXPECT_EQ(b["products"], 4 * 50 + 1);
  EXPECT_EQ(b["at_once"], 2);
  for (const char* name : {"O.q", "body.coupler.mass", "gravity.1"})
    EXPECT_NEAR(a["by"][name]["derivative"].get<double>(),
                b["by"][name]["derivative"].get<double>(), 1e-11)
        << name;
  expect_refused("gradient '" + example("bicycle") +
                     "' --of energy --by gravity.2 --mode adjoint --form acceleration",
                 "spherical and free joints, whose rates are no derivatives of coordinates, have "
                 "no adjoint; expected the "
                 "mode 'forward'");
}

TEST_F(GradientOfTheProgram, RefusesInOneSentence) {
  const std::string scene = "gradient '" + example("four_bar") + "' --of B.y";
  expect_refused(scene + " --by body.crank.size",
                 "'body.crank.size': the scene leaves it out, expected a number that it has");
  expect_refused(scene + " --by O.q --form partitioned",
                 "form 'partitioned' has no gradient; expected one of: momentum, acceleration, "
                 "projected or baumgarte");
  expect_refused(scene + " --by O.q --integrator bdf",
                 "integrator 'bdf' has no gradient; expected one of: rk4, dp5, dop853 or vern9");
}

}  // namespace
}  // namespace momenta::golden::dae_gradient_program
