// momenta fit as its users call it: text, files, sentences.

#include "dae/app/program.h"

#include <nlohmann/json.hpp>
#include <sstream>

namespace momenta::golden::dae_fit_program {
namespace {

using FitOfTheProgram = Program;

std::string line() {
  return std::string(MOMENTA_SOURCE_DIR) + "/examples/straight_line/wanted.csv";
}

TEST_F(FitOfTheProgram, FindsHoeckensLinkageAndWritesItsScene) {
  const std::string wanted = " --vary coupler,rocker,reach --sweep O --to '" + line() + "'",
                    out = "'" + (folder_ / "f").string() + "'";
  const Outcome o = call("fit '" + example("straight_line") + "'" + wanted + " --out " + out);
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(says(o.out,
                   "The largest error of 13 poses is 4.7 mm; as the scene is, 0.99 m. A "
                   "minimum, of one start."));
  const auto json = nlohmann::json::parse(text_of(folder_ / "f" / "fit.json"));
  EXPECT_EQ(json["converged"], true);
  EXPECT_EQ(json["places_given"], false);
  EXPECT_NEAR(json["parameters"]["coupler"]["after"].get<double>(), 2.50770797, 1e-7);
  EXPECT_NEAR(json["parameters"]["rocker"]["after"].get<double>(), 2.50214957, 1e-7);
  EXPECT_NEAR(json["parameters"]["reach"]["after"].get<double>(), 4.99460112, 1e-7);
  EXPECT_EQ(json["parameters"]["reach"]["before"], 6);
  std::istringstream csv(text_of(folder_ / "f" / "fit.csv"));
  std::string head;
  std::getline(csv, head);
  EXPECT_EQ(head,
            "O.q [rad],P.x.wanted [m],P.x [m],P.x.before [m],P.y.wanted [m],P.y [m],"
            "P.y.before [m]");
  const std::string page = text_of(folder_ / "f" / "index.html");
  EXPECT_TRUE(says(page, "Synthesis"));
  EXPECT_TRUE(says(page, "before: coupler"));
  EXPECT_EQ(page.find("http://"), page.find("http://www.w3.org"));

  // The scene that was written is at the minimum already.
  const Outcome again =
      call("fit '" + (folder_ / "f" / "fitted.toml").string() + "'" + wanted + " --json");
  EXPECT_EQ(again.status, 0) << again.err;
  const auto same = nlohmann::json::parse(again.out);
  EXPECT_NEAR(same["errors"]["before"]["cost"].get<double>(),
              json["errors"]["after"]["cost"].get<double>(), 1e-14);
}

TEST_F(FitOfTheProgram, FindsParametersOfAMeasuredMotion) {
  const std::string scene = "fit '" + example("identification") + "'",
                    out = "'" + (folder_ / "f").string() + "'";
  const Outcome o = call(scene + " --vary stiffness=1:20,damping,centre --out " + out);
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_TRUE(says(o.out, "Of 202 numbers measured at 101 times the rms error is 0.0049 rad"));
  const auto json = nlohmann::json::parse(text_of(folder_ / "f" / "fit.json"));
  EXPECT_EQ(json["converged"], true);
  EXPECT_EQ(json["motion"], "measured");
  for (const auto& [name, truth] : {std::pair{"stiffness", 6.2}, {"damping", 0.23}}) {
    const auto& parameter = json["parameters"][name];
    EXPECT_NEAR(parameter["after"].get<double>(), truth, 2 * parameter["deviation"].get<double>());
  }
  EXPECT_TRUE(text_of(folder_ / "f" / "fit.csv")
                  .starts_with("t [s],O.q.measured [rad],O.q [rad],O.q.before [rad],"
                               "C.q.measured [rad],C.q [rad],C.q.before [rad]\n0,0.4064,"));
  const std::string page = text_of(folder_ / "f" / "index.html");
  EXPECT_TRUE(says(page, "Identification"));
  EXPECT_TRUE(says(page, "before: coupler"));
  EXPECT_TRUE(says(text_of(folder_ / "f" / "fitted.toml"), "# N m s, at O"));

  expect_refused(scene + " --vary centre --poses 9", "--over, --poses and --rate are of a motion");
  expect_refused(scene + " --vary centre --keep 'centre < 1'",
                 "--keep does not go with a measured motion");
  expect_refused(scene + " --vary centre --form index3", "form 'index3'");
  expect_refused(scene + " --vary body.crank.mas",
                 "'body.crank.mas': the scene leaves it out, expected a number that it has");
  expect_refused(scene + " --vary centre --to '" + line() + "'",
                 "column 'P.x [m]' is no time, coordinate, rate or marker");
}

TEST_F(FitOfTheProgram, MakesAFunctionalLeast) {
  const std::string scene = "fit '" + example("straight_line") + "'",
                    out = "'" + (folder_ / "f").string() + "'",
                    half = " --sweep O --over 1.5707963267948966:4.71238898038469 --poses 61";
  const Outcome o = call(scene + half +
                         " --vary coupler=2:4,rocker=2:4,reach=4:7 --starts 2"
                         " --least 'max(P.y) - min(P.y)' --keep 'max(P.x) - min(P.x) >= 4'"
                         " --out " +
                         out);
  EXPECT_EQ(o.status, 0) << o.err;
  const auto json = nlohmann::json::parse(text_of(folder_ / "f" / "fit.json"));
  // Hoecken's linkage has the least deviation of all with crank 1 and ground 2.
  EXPECT_NEAR(json["parameters"]["coupler"]["after"].get<double>(), 2.5, 1e-8);
  EXPECT_NEAR(json["parameters"]["rocker"]["after"].get<double>(), 2.5, 1e-8);
  EXPECT_NEAR(json["parameters"]["reach"]["after"].get<double>(), 5, 1e-8);
  EXPECT_GE(json["keep"][0]["after"].get<double>(), -1e-10);
  EXPECT_EQ(json["starts"].size(), 2u);
  EXPECT_EQ(json["motion"], "swept");
  EXPECT_TRUE(
      text_of(folder_ / "f" / "fit.csv").starts_with("O.q [rad],P.y,P.y before,P.x,P.x before\n"));
  EXPECT_TRUE(says(text_of(folder_ / "f" / "index.html"), "before: coupler"));
  EXPECT_TRUE(says(text_of(folder_ / "f" / "fitted.toml"), "coupler = 2.5"));
  EXPECT_FALSE(fs::exists(folder_ / "f" / "runs.jsonl"));

  const std::string run = scene + " --vary coupler --end 0.5 --integrator rk4 --step 0.01";
  expect_refused(run + " --least 'max(O.q)'", "of a run no largest, smallest or first value");
  expect_refused(run + " --least 'last(O.q)' --poses 9", "--over, --poses and --rate are of a");
  expect_refused(scene + " --vary coupler --to x.csv --sweep O --least coupler",
                 "found both --to and --least");
  expect_refused(scene + " --vary coupler", "expected --sweep NAME");
  expect_refused(scene + half + " --vary coupler --least 'max(P.y)' --keep 'coupler'",
                 "expected one comparison");
}

// A search that was killed takes the starts it had finished and ends with the very same numbers.
TEST_F(FitOfTheProgram, GoesOnWhereItWasKilled) {
  const std::string search = "fit '" + example("straight_line") +
                             "' --vary coupler=1.5:4,rocker=1.5:4,reach=2:8 --starts 6 --sweep O"
                             " --over 1.5707963267948966:4.71238898038469 --poses 31"
                             " --least 'max(P.y) - min(P.y)' --keep 'first(P.x) - last(P.x) >= 4'"
                             " --out ";
  const std::string killed = "'" + (folder_ / "killed").string() + "'",
                    whole = "'" + (folder_ / "whole").string() + "'";
  status_when_killed(search + killed, folder_ / "killed" / "runs.jsonl", 3);
  const Outcome again = call(search + killed), once = call(search + whole);
  EXPECT_EQ(again.status, once.status) << again.err;
  EXPECT_TRUE(says(again.err, "of 6 runs taken from"));
  const auto a = nlohmann::json::parse(text_of(folder_ / "killed" / "fit.json")),
             b = nlohmann::json::parse(text_of(folder_ / "whole" / "fit.json"));
  for (const char* key : {"after", "parameters", "keep", "starts", "best"})
    EXPECT_EQ(a[key], b[key]) << key;
}

TEST_F(FitOfTheProgram, RefusesWhatItCannotDoInOneSentence) {
  const std::string scene =
      "fit '" + example("straight_line") + "' --sweep O --to '" + line() + "'";
  expect_refused(scene + " --vary rokcer",
                 "'rokcer': the scene has no parameter of that name; did you mean 'rocker'?");
  expect_refused(scene + " --vary rocker --starts 3",
                 "parameter 'rocker' has no range to draw starts from; expected rocker=FROM:TO");
  expect_refused(
      "fit '" + example("straight_line") + "' --vary rocker --sweep Q --to '" + line() + "'",
      "coordinate 'Q' is not known; expected 'O.q', 'A.q', 'C.q'");
  expect_refused("fit '" + example("straight_line") + "' --vary rocker --sweep O --to '" +
                     write("wanted.csv", "P.x\n1\nx\n").string() + "'",
                 "wanted.csv:3: found 'x'; expected a finite number");
  const std::string model = std::string(MOMENTA_SOURCE_DIR) + "/examples/models/ur5/ur5_robot.urdf";
  expect_refused("fit '" + model + "' --vary a --sweep O --to '" + line() + "'",
                 "parameters are varied in scenes of TOML alone");
}

}  // namespace
}  // namespace momenta::golden::dae_fit_program
