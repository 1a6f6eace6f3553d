// The page in a real browser: no console message, no horizontal scroll, every chart and table
// there. In Chromium and in Firefox, skipped where one is not installed.
#include "equations/ensemble.h"
#include "equations/output_of.h"

#include <dae/output/page/firefox.h>
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/part_file.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/study/modes_study.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>

namespace momenta::dae_report_browser {
namespace {

namespace fs = std::filesystem;

using equations::output_of;

// The page tells what it measures of itself to the frame around it, whose root element --dump-dom
// shows. A frame, because a window of Chromium is not made as narrow as a telephone. It measures
// again and again and the last report stands: a busy machine lays the page out late.
constexpr const char* probe = R"(addEventListener("load", () => {
const sort = document.querySelector("thead button");
sort.click();
setInterval(() => {
  const root = document.documentElement;
  const small = [...document.querySelectorAll("body *")].filter((e) => e.checkVisibility() && e.childNodes.length &&
    [...e.childNodes].some((n) => n.nodeType === 3 && n.data.trim()) && !["SCRIPT", "STYLE", "SUP"].includes(e.tagName) &&
    parseFloat(getComputedStyle(e).fontSize) < 13.99);
  parent.postMessage([root.scrollWidth <= innerWidth ? "fits" : "scrolls", "width=" + innerWidth,
    "plots=" + document.querySelectorAll(".plot canvas").length, "tables=" + document.querySelectorAll("table").length,
    "small=" + small.length, "sorted=" + sort.closest("th").getAttribute("aria-sort"),
    "movies=" + document.querySelectorAll(".movie canvas").length].join(" "), "*");
}, 200); });)";

// Firefox tells of errors alone: what a page writes to its console becomes one.
constexpr const char* written_is_thrown =
    R"(for (const level of ["log", "info", "warn", "error"])
  console[level] = (...said) => setTimeout(() => { throw Error(level + ": " + said); });
)";

class Browser : public ::testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  void SetUp() override {
    if (std::system(("command -v " + browser() + " >/dev/null 2>&1").c_str()) != 0)
      GTEST_SKIP() << browser() << " is not installed";
    std::string pattern = (fs::temp_directory_path() / "momenta-page-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override {
    if (!directory_.empty()) fs::remove_all(directory_);
  }

  static std::string browser() { return std::get<0>(GetParam()); }
  static int width() { return std::get<1>(GetParam()); }

  // The page's own report, and what the console said. Without a screen and in virtual time a
  // browser makes next to no frames: a timer stands for them.
  std::pair<std::string, std::string> opened(std::string page, const char* question = probe) {
    page.insert(page.rfind("}\n</script>"),  // among the page's own functions
                std::string("requestAnimationFrame = (act) => setTimeout(() => "
                            "act(performance.now()), 16);\n") +
                    (browser() == "firefox-esr" ? written_is_thrown : "") + question);
    const fs::path file = directory_ / "frame.html";
    EXPECT_EQ(atomic_write(directory_ / "index.html", page), std::nullopt);
    EXPECT_EQ(atomic_write(
                  file,
                  "<!doctype html><script>onmessage = (e) => document.documentElement.setAttribute("
                  "'data-probe', e.data)</script><iframe src=\"index.html\" "
                  "style=\"border:0;height:2000px;"
                  "width:" +
                      std::to_string(width()) + "px\"></iframe>"),
              std::nullopt);
    return browser() == "firefox-esr" ? in_firefox(file) : in_chromium(file);
  }

  std::pair<std::string, std::string> in_firefox(const fs::path& file) {
    Firefox firefox(directory_ / "profile");
    firefox.open(file);
    std::string report, last;
    // It measures five times a second: what stands for a second is its last word.
    for (int waited = 0, stood = 0; waited < 300 && stood < 10; ++waited) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      const auto told =
          firefox.in_page("return document.documentElement.getAttribute('data-probe')");
      last = std::exchange(report, told.is_null() ? "" : told.get<std::string>());
      stood = !report.empty() && report == last ? stood + 1 : 0;
    }
    return {report, firefox.console()};
  }

  std::pair<std::string, std::string> in_chromium(const fs::path& file) {
    const fs::path log = directory_ / "log";
    const std::string command =
        "timeout 60 chromium --headless --no-sandbox --disable-gpu --disable-background-networking "
        "--no-first-run "
        "--user-data-dir=" +
        (directory_ / "profile").string() +
        " --window-size=1700,2100 --virtual-time-budget=3000 --enable-logging=stderr --v=0 "
        "--dump-dom file://" +
        file.string() + " 2>" + log.string();
    const std::string name = "data-probe=\"";
    std::string report;
    // A browser that dies or never answers says nothing about the page: it is asked again.
    for (int attempt = 0; attempt < 3 && report.empty(); ++attempt) {
      const std::string dom = output_of(command);
      const auto from = dom.find(name);
      if (from != std::string::npos)
        report =
            dom.substr(from + name.size(), dom.find('"', from + name.size()) - from - name.size());
    }
    if (report.empty()) ADD_FAILURE() << "no answer; " << output_of("tail -n 20 " + log.string());
    return {report, output_of("grep CONSOLE " + log.string())};
  }

  fs::path directory_;
};

TEST_P(Browser, ShowsAllFormsWithinTheWindow) {
  const auto [report, console] = opened(drift_page(synthetic::all_forms()));
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(width()) +
                        " plots=5 tables=4 small=0 sorted=ascending movies=1");
}

TEST_P(Browser, ShowsALadderWithinTheWindow) {
  const auto [report, console] = opened(drift_page(synthetic::ladder()));
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(width()) +
                        " plots=9 tables=4 small=0 sorted=ascending movies=1");
}

TEST_P(Browser, ShowsALoneRunWithoutHistory) {
  RunResult run;
  run.position_drift_max = 0;
  run.cpu_s = 0.1;
  const auto [report, console] = opened(drift_page(synthetic::study_of({run})));
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(width()) +
                        " plots=1 tables=1 small=0 sorted=ascending movies=1");
}

// What a page with a mechanism shows: pixels of its canvas that change with the time, links that
// hold together at their joints, axes that stay unit, a line at the same time in every chart, the
// camera.
constexpr const char* moving = R"(addEventListener("load", async () => {
const canvas = document.querySelector(".movie canvas"), pixels = () => canvas.toDataURL();
const drawn = async () => { for (let i = 0; i < 3; ++i) await new Promise(requestAnimationFrame); };
await drawn();
const film = filmOf(study.motions.at(-1));
let apart = 0, length = 0;
for (let i = 0; i <= 200; ++i) {
  const state = film.at(film.start + ((film.end - film.start) * i) / 200);
  picture.bodies.forEach((body, k) => {
    length = Math.max(length, Math.abs(Math.hypot(...state.turns[k]) - 1));
    const at = minus(pointOf(state, body.parent, body.at_parent), pointOf(state, k, body.at_child));
    if (!body.slides) apart = Math.max(apart, norm(at));
  });
}
const first = pixels(), slide = document.querySelector(".clock input");
slide.value = 2500;
slide.dispatchEvent(new Event("input"));
await drawn();
const quarter = pixels(), time = document.querySelector(".time").textContent;
const lines = [...document.querySelectorAll(".now")].map((line) => {
  const over = line.parentElement.getBoundingClientRect();
  return (line.getBoundingClientRect().left + 1 - over.left) / over.width;
});
canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "+", bubbles: true }));
await drawn();
const zoomed = pixels();
document.querySelectorAll(".boxes input").forEach((box) => box.click());
await drawn();
const ticked = pixels();
document.querySelector(".play").click();
await drawn();
await drawn();
const root = document.documentElement;
setInterval(() => parent.postMessage([root.scrollWidth <= innerWidth ? "fits" : "scrolls", time.replaceAll(" ", ""),
  "moved=" + (first !== quarter), "zoomed=" + (quarter !== zoomed), "ticked=" + (zoomed !== ticked),
  "plays=" + (ticked !== pixels()), "apart=" + (apart < 1e-6), "unit=" + (length < 1e-12),
  "cursors=" + lines.length, "common=" + lines.every((x) => Math.abs(x - 0.25) < 0.01)].join(" "), "*"), 100);
});)";

StudyResult filmed(std::vector<Motion> motions) {
  RunResult run = synthetic::run_of({}, 2, 500);
  run.trajectory.columns = {"t [s]", "O.q [rad]", "A.q [rad]", "O.u [rad/s]", "energy [J]"};
  for (int i = 0; i <= 500; ++i) {
    const double t = i / 250.0;
    run.trajectory.rows.push_back({t, 6.28 * t, -6 * t, 6.28, 12});
  }
  StudyResult study = synthetic::study_of({run, run});
  study.motions = std::move(motions);
  return study;
}

TEST_P(Browser, MovesTheMechanismOfARunWithItsCurves) {
  const auto [report, console] = opened(run_page(filmed({synthetic::motion(0, 2, 101)})), moving);
  EXPECT_EQ(console, "");
  EXPECT_EQ(
      report,
      "fits t=0.500s moved=true zoomed=true ticked=true plays=true apart=true unit=true cursors=6 "
      "common=true");
}

TEST_P(Browser, MovesTheMechanismsOfAllForms) {
  StudyResult study = filmed({synthetic::motion(0, 2, 101), synthetic::motion(1, 2, 101)});
  study.runs[1].settings.form = "acceleration";
  const auto [report, console] = opened(drift_page(study), moving);
  EXPECT_EQ(console, "");
  EXPECT_EQ(
      report,
      "fits t=0.500s moved=true zoomed=true ticked=true plays=true apart=true unit=true cursors=0 "
      "common=true");
}

TEST_P(Browser, TurnsAMechanismInSpace) {
  StudyResult study = filmed({synthetic::motion(0, 2, 101)});
  study.picture.planar = false;
  study.picture.bodies[1].turn = Picture::Turn::freely;
  study.picture.bodies[1].shape = {"box", {0.4, 0.3, 0.2}, {1, 0, 0}};
  study.picture.bodies[0].shape = {"cylinder", {0.4, 0.1, 0}, {1, 0, 0}};
  study.picture.bodies[2].shape = {"sphere", {0.2, 0, 0}, {1, 0, 0}};
  const auto [report, console] = opened(run_page(study), moving);
  EXPECT_EQ(console, "");
  EXPECT_EQ(
      report,
      "fits t=0.500s moved=true zoomed=true ticked=true plays=true apart=true unit=true cursors=6 "
      "common=true");
}

// Nothing moves and nothing was run: the picture and its boxes.
constexpr const char* still = R"(addEventListener("load", async () => {
const canvas = document.querySelector(".movie canvas");
const drawn = async () => { for (let i = 0; i < 3; ++i) await new Promise(requestAnimationFrame); };
await drawn();
const before = canvas.toDataURL();
document.querySelector(".boxes input").click();
await drawn();
setInterval(() => parent.postMessage([document.documentElement.scrollWidth <= innerWidth ? "fits" : "scrolls",
  "clock=" + document.querySelectorAll(".clock").length, "rows=" + document.querySelectorAll("tbody tr").length,
  "ticked=" + (canvas.toDataURL() !== before)].join(" "), "*"), 100);
});)";

TEST_P(Browser, ShowsASceneThatWasNotRun) {
  StudyResult study = synthetic::study_of({});
  const auto [report, console] = opened(view_page(study, "Three links."), still);
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits clock=0 rows=4 ticked=true");
}

// What the page of modes shows: another picture for another mode, for another amplitude, and at
// another time; links that hold together in between.
constexpr const char* swinging = R"(addEventListener("load", async () => {
const pixels = () => document.querySelector(".movie canvas").toDataURL();
const drawn = async () => { for (let i = 0; i < 4; ++i) await new Promise(requestAnimationFrame); };
await drawn();
const first = pixels();
document.querySelectorAll("tbody button")[1].click();
await drawn();
const second = pixels(), choice = document.querySelector(".boxes select");
const size = document.querySelector(".boxes input[type=range]");
size.value = 0.3;
size.dispatchEvent(new Event("input"));
await drawn();
const smaller = pixels();
choice.value = "0";
choice.dispatchEvent(new Event("change"));
await drawn();
const slide = document.querySelector(".clock input");
slide.value = 250;
slide.dispatchEvent(new Event("input"));
await drawn();
const later = pixels();
const root = document.documentElement;
setInterval(() => parent.postMessage([root.scrollWidth <= innerWidth ? "fits" : "scrolls", "modes=" + choice.options.length,
  "other=" + (first !== second), "smaller=" + (second !== smaller), "moved=" + (first !== later),
  "time=" + document.querySelector(".time").textContent.replaceAll(" ", "")].join(" "), "*"), 100);
});)";

TEST_P(Browser, SwingsInTheModeThatIsChosen) {
  const Mechanism mechanism(parse_scene(R"(
name = "Two rods"
gravity = [0, -9.81, 0]
[[body]]
name = "a"
mass = 1
shape = { kind = "rod", length = 1, axis = "x" }
[[body]]
name = "b"
mass = 1
shape = { kind = "rod", length = 1, axis = "x" }
[[joint]]
name = "O"
kind = "revolute"
child = "a"
[[joint]]
name = "A"
kind = "revolute"
parent = "a"
child = "b"
origin = { parent = [1, 0, 0] }
)",
                                        "test"));
  const ModesResult result = find_modes(mechanism, equations::start_of(mechanism), {});
  StudyResult study = synthetic::study_of({});
  study.picture = picture_of(mechanism);
  study.motions.clear();
  for (std::size_t i = 0; i < 2; ++i) {
    study.motions.push_back(
        motion_of(mechanism, swing(mechanism, result, result.spectrum.modes[i])));
    study.motions.back().run = static_cast<int>(i);
    study.motions.back().every = 1;
  }
  const auto [report, console] = opened(modes_page(study, result), swinging);
  EXPECT_EQ(console, "");
  // A fortieth of twenty periods, half of 2π/√((3 − 6/√7) g/l).
  EXPECT_EQ(report, "fits modes=2 other=true smaller=true moved=true time=t=1.17s");
}

INSTANTIATE_TEST_SUITE_P(Widths, Browser,
                         ::testing::Combine(::testing::Values(std::string("chromium"),
                                                              std::string("firefox-esr")),
                                            ::testing::Values(360, 1600)));

}  // namespace
}  // namespace momenta::dae_report_browser
