// The page of the course that integrates in the browser (docs/index-reduction/play) has the runs of
// the library: same form, same method, same step, on both its mechanisms. Its scripts are run by
// node, or by Chromium; skipped where neither is installed.

#include "equations/examples.h"
#include "equations/output_of.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace momenta::dae_play_page {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr double step = 0.005, alpha = 12, beta = 7, kappa = 3;
constexpr int every = 20, samples = 20;  // to 2 s

/// Runs both mechanisms in all forms of the page: {mechanism: {form: [[q …, u …, |Φ|, |Φ̇|], …]}}.
const std::string driver = R"(
const all = {};
for (const s of [pendulum, fourBar]) {
  all[s.name] = {};
  for (const form of Object.keys(forms)) {
    const run = runOf(s, form, { h: 0.005, alpha: 12, beta: 7, kappa: 3 });
    all[s.name][form] = run.advance(400).filter((_, i) => (i + 1) % 20 === 0)
      .map(({ q, u, position, velocity }) => [...q, ...u, position, velocity]);
  }
}
)";

using equations::output_of, equations::text_of;

bool installed(const std::string& program) {
  return std::system(("command -v " + program + " >/dev/null 2>&1").c_str()) == 0;
}

/// What the scripts give; null where nothing runs them.
json by_page() {
  std::string pattern = (fs::temp_directory_path() / "momenta-play-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) return nullptr;
  const fs::path folder = pattern;
  const fs::path source = fs::path(MOMENTA_SOURCE_DIR) / "docs/index-reduction/play";
  const std::string scripts = text_of(source / "mechanisms.js") + text_of(source / "methods.js");
  json found = nullptr;
  if (installed("node")) {
    const fs::path file = folder / "runs.js";
    EXPECT_EQ(atomic_write(file, scripts + driver + "process.stdout.write(JSON.stringify(all));\n"),
              std::nullopt);
    found = json::parse(output_of("timeout 60 node " + file.string()));
  } else if (installed("chromium")) {
    const fs::path file = folder / "runs.html";
    EXPECT_EQ(atomic_write(file, "<!doctype html><meta charset=\"utf-8\"><body><script>" + scripts +
                                     driver +
                                     "document.body.textContent = '[[[' + JSON.stringify(all) + "
                                     "']]]';</script>"),
              std::nullopt);
    const std::string page = output_of(
        "timeout 60 chromium --headless --no-sandbox --disable-gpu --user-data-dir=" +
        (folder / "profile").string() + " --dump-dom file://" + file.string() + " 2>/dev/null");
    const std::size_t begin = page.rfind("[[["), end = page.rfind("]]]");
    if (begin != std::string::npos && end != std::string::npos)
      found = json::parse(page.substr(begin + 3, end - begin - 3));
  }
  fs::remove_all(folder);
  return found;
}

struct Method {
  const char *of_page, *form, *integrator;
};
constexpr std::array<Method, 6> methods{{
    {"index-3", "acceleration-index3", "generalised-alpha"},
    {"index-2", "acceleration-index2", "hem5"},
    {"index-1", "acceleration", "rk4"},
    {"baumgarte", "baumgarte", "rk4"},
    {"projected", "projected", "rk4"},
    {"momentum", "momentum", "rk4"},
}};

/// The same of the library.
std::vector<std::vector<double>> by_library(const Mechanism& mechanism, const Method& method) {
  const Start start = assemble(mechanism).start;
  FormOptions form_options;
  if (takes_gauge(method.form)) form_options.gauge = parse_gauge("leak:" + std::to_string(kappa));
  if (std::string(method.form) == "baumgarte")
    form_options.baumgarte_alpha = alpha, form_options.baumgarte_beta = beta;
  const auto form = make_form(method.form, mechanism, form_options, start);
  IntegrationOptions options;
  options.step = step;
  options.rtol = options.atol = 1e-16;  // of Newton's method: to rounding
  std::vector<double> times;
  for (int i = 1; i <= samples; ++i) times.push_back(step * every * i);
  const auto e = mechanism.evaluation<double>();
  std::vector<std::vector<double>> rows;
  Observer observer;
  observer.sample = [&](double t, const double* y, const double* ydot) {
    Snapshot s{Eigen::VectorXd(mechanism.nq()), Eigen::VectorXd(mechanism.nv()),
               Eigen::VectorXd(mechanism.m())};
    if (!form->read(t, y, ydot, s)) return false;
    Eigen::VectorXd phi(mechanism.m()), rate(mechanism.m());
    e->place(t, s.q.data());
    e->positions(phi.data());
    e->move(s.u.data());
    e->velocities(rate.data());
    std::vector<double> row(s.q.begin(), s.q.end());
    row.insert(row.end(), s.u.begin(), s.u.end());
    row.insert(row.end(), {phi.norm(), rate.norm()});
    rows.push_back(row);
    return true;
  };
  const IntegrationResult result =
      form->is_dae() ? integrate(method.integrator, *form->dae(), 0, times, options, observer)
                     : integrate(method.integrator, *form->ode(), 0, form->initial(start), times,
                                 options, observer);
  EXPECT_TRUE(result.done) << method.form << ": " << result.reason;
  EXPECT_EQ(result.counters.steps, every * samples) << method.form;
  return rows;
}

TEST(PlayPage, HasTheRunsOfTheLibrary) {
  const json page = by_page();
  if (page.is_null()) GTEST_SKIP() << "neither node nor chromium is installed";
  for (const auto& [name, scene] : {std::pair{"pendulum", "pendulum/cartesian.toml"},
                                    std::pair{"four-bar", "four_bar/scene.toml"}}) {
    const Mechanism mechanism(equations::example(scene));
    for (const Method& method : methods) {
      const auto rows = by_library(mechanism, method);
      const json& found = page[name][method.of_page];
      ASSERT_EQ(rows.size(), static_cast<std::size_t>(samples));
      ASSERT_EQ(found.size(), rows.size()) << name << ", " << method.of_page;
      double apart = 0, at_first = 0;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        ASSERT_EQ(found[i].size(), rows[i].size());
        for (std::size_t k = 0; k < rows[i].size(); ++k)
          apart = equations::larger(apart, std::abs(found[i][k].get<double>() - rows[i][k]));
        if (i < samples / 4) at_first = apart;
      }
      // Of index 3 the library ends Newton's method at the rounding of its norm, with |Φ| up to
      // 1e-14, which the fall of the four-bar magnifies: there the first half second is compared.
      const bool by_newton = std::string(method.of_page) == "index-3";
      EXPECT_LT(by_newton ? at_first : apart, 1e-10) << name << ", " << method.of_page;
      EXPECT_LT(apart, 1e-8) << name << ", " << method.of_page;
    }
  }
}

}  // namespace
}  // namespace momenta::dae_play_page
