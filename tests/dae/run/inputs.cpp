// Inputs that are shorter than steps: a pulse on a body that coasts moves it by what it carries, by
// every method with error control, whatever else the run does; of a drive, of a force, of
// equations.

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/analysis/equations/equation_run.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "equations/gradient_runs.h"

namespace momenta::dae_inputs {
namespace {

/// 1 kg on a slide at 0.1 m/s, under a law of t.
std::string pushed(const std::string& law) {
  return "[[body]]\nname = \"b\"\nmass = 1\ninertia = 1\n[[joint]]\nname = \"X\"\nkind = "
         "\"prismatic\"\nchild = \"b\"\naxis = \"x\"\nvelocity = 0.1\n[[force]]\nkind = "
         "\"torque\"\njoint = \"X\"\nlaw = \"" +
         law + "\"\n[run]\nend = 5\n";
}

struct Push {
  std::string law;
  double moves;  ///< [m], in 5 s
};
/// An impulse of 0.5 N s about t = 2, of the one or the other shape.
std::vector<Push> pushes() {
  return {{"if(t < 1.995, 0, if(t < 2.005, 50, 0))", 1.5},
          {"if(t > 1.9999995 and t < 2.0000005, 5e5, 0)", 1.5},
          {"50*max(0, 1 - abs(t - 2)/0.01)", 1.5},
          {"0.5/0.01/sqrt(pi)*exp(-((t - 2)/0.01)^2)", 1.5},
          {"50*(tanh((t - 1.995)*1e4) - tanh((t - 2.005)*1e4))/2", 1.5}};
}

TEST(ShortInputs, ShorterThanStepsMoveWhatTheyCarry) {
  for (const Push& push : pushes()) {
    const Mechanism mechanism(parse_scene(pushed(push.law), "pushed.toml"));
    const Start start = assemble(mechanism).start;
    for (const auto& [form, method] :
         std::vector<std::pair<std::string, std::string>>{{"momentum", "dp5"},
                                                          {"momentum", "dop853"},
                                                          {"momentum", "vern9"},
                                                          {"momentum", "adams"},
                                                          {"momentum", "bdf"},
                                                          {"acceleration", "dop853"},
                                                          {"stabilised-index2", "ida"},
                                                          {"acceleration-index3", "radau5"},
                                                          {"acceleration-index2", "bdf5"},
                                                          {"momentum-index2", "hem5"}}) {
      RunRequest request;
      request.settings = default_settings(mechanism.scene().run, form, method, 1e-8);
      request.settings.samples = 20;
      request.keep_trajectory = true;
      const RunResult run = run_form(mechanism, start, request);
      ASSERT_EQ(run.status, "done") << form << " " << method << ": " << run.reason;
      // Velocities of index 3 are tested h times.
      EXPECT_NEAR(run.trajectory.rows.back()[1], 0.5 + push.moves,
                  form == "acceleration-index3" ? 1e-3 : 1e-5)
          << push.law << " " << form << " " << method;
    }
  }
}

TEST(ShortInputs, ShorterThanStepsHaveGradients) {
  const std::string text = "[parameters]\nF = 50\nw = 0.01\n" + pushed("F*exp(-((t - 2)/w)^2)");
  for (const GradientMode mode : {GradientMode::forward, GradientMode::adjoint}) {
    GradientRequest request = equations::asked("X.q", {"F", "w"}, "momentum", "", 5, 0);
    request.settings.integrator = "dop853";
    request.settings.rtol = request.settings.atol = 1e-9;
    request.mode = mode;
    const GradientResult r = gradient(equations::of_text(text), request);
    const double root = std::sqrt(std::numbers::pi);
    EXPECT_NEAR(r.value, 0.5 + 50 * 0.01 * root * 3, 1e-6);
    EXPECT_NEAR(r.gradient[0], 0.01 * root * 3, 1e-6);
    EXPECT_NEAR(r.gradient[1], 50 * root * 3, 1e-3);
  }
}

EquationRun run(const std::string& text, const std::string& integrator, double tolerance) {
  const EquationFile file = parse_equations(text, "inputs.toml");
  EquationRunRequest request;
  request.integrator = integrator;
  request.rtol = request.atol = tolerance;
  request.end = file.end;
  request.samples = 40;
  const EquationRun r = run_equations(file, equation_start(file), request);
  EXPECT_TRUE(r.done) << r.reason;
  return r;
}

TEST(ShortInputs, OfEquationsAreNotSteppedOver) {
  const std::string pendulum =
      "[dae]\nvariables = [\"x\", \"y\", \"u\", \"v\", \"l\"]\nequations = [\"der(x) = u\", "
      "\"der(y) = v\", \"der(u) = -l*x - T*y\", \"der(v) = -l*y + T*x\", \"x^2 + y^2 = 1\"]\n"
      "values = { x = 1 }\n[run]\nend = 20\n";
  // A torque of 1 in 5…6 s and of −1 in 15…16 s, without weight: it has turned by 10 rad.
  std::string pulses = pendulum;
  const std::string torque = "(if(t > 5 and t < 6, 1, 0) - if(t > 15 and t < 16, 1, 0))";
  for (std::size_t at; (at = pulses.find("T*")) != std::string::npos;)
    pulses.replace(at, 1, torque);
  const EquationRun turned = run(pulses, "radau5", 1e-9);
  EXPECT_NEAR(turned.last[0], std::cos(10), 1e-5);
  EXPECT_NEAR(turned.last[1], std::sin(10), 1e-5);
  const auto of = [](const std::string& rate, double end) {
    return "[dae]\nvariables = [\"y\"]\nequations = [\"der(y) = " + rate +
           "\"]\n[run]\nend = " + std::to_string(end) + "\n";
  };
  for (const char* integrator : {"ida", "radau5"}) {
    EXPECT_NEAR(run(of("max(0, 1 - abs(t - 50))", 100), integrator, 1e-8).last[0], 1, 1e-5);
    EXPECT_NEAR(run(of("floor(t) - 2*floor(t/2)", 20), integrator, 1e-9).last[0], 10, 1e-6);
    EXPECT_NEAR(run(of("exp(-((t - 30)/0.1)^2)", 100), integrator, 1e-9).last[0],
                0.1 * std::sqrt(std::numbers::pi), 1e-6);
  }
}

}  // namespace
}  // namespace momenta::dae_inputs
