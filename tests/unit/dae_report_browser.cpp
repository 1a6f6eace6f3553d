// The page in a real browser: no console message, no horizontal scroll, every chart and table
// there. Skipped where Chromium is not installed.
#include <gtest/gtest.h>
#include <momenta/dae/report/atomic_write.h>
#include <momenta/dae/report/page.h>
#include <unit/page/synthetic_study.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace momenta {
namespace {

namespace fs = std::filesystem;

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  std::array<char, 4096> block{};
  for (std::size_t n = 0; (n = fread(block.data(), 1, block.size(), pipe)) > 0;)
    text.append(block.data(), n);
  pclose(pipe);
  return text;
}

// The page tells what it measures of itself to the frame around it, whose root element --dump-dom
// shows. A frame, because a window of Chromium is not made as narrow as a telephone. It measures
// again and again and the last report stands: a busy machine lays the page out late.
constexpr const char* probe = R"(<script>addEventListener("load", () => {
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
}, 200); });</script>)";

class Browser : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (std::system("command -v chromium >/dev/null 2>&1") != 0)
      GTEST_SKIP() << "Chromium is not installed";
    std::string pattern = (fs::temp_directory_path() / "momenta-page-XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    directory_ = pattern;
  }
  void TearDown() override {
    if (!directory_.empty()) fs::remove_all(directory_);
  }

  // The page's own report, and what the console said.
  std::pair<std::string, std::string> opened(const StudyResult& study, int width) {
    std::string page = drift_page(study);
    page.insert(page.rfind("</body>"), probe);
    const fs::path file = directory_ / "frame.html", log = directory_ / "log";
    EXPECT_EQ(atomic_write(directory_ / "index.html", page), std::nullopt);
    EXPECT_EQ(atomic_write(
                  file,
                  "<!doctype html><script>onmessage = (e) => document.documentElement.setAttribute("
                  "'data-probe', e.data)</script><iframe src=\"index.html\" "
                  "style=\"border:0;height:2000px;"
                  "width:" +
                      std::to_string(width) + "px\"></iframe>"),
              std::nullopt);
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
  const auto [report, console] = opened(synthetic::all_forms(), GetParam());
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(GetParam()) +
                        " plots=5 tables=4 small=0 sorted=ascending movies=1");
}

TEST_P(Browser, ShowsALadderWithinTheWindow) {
  const auto [report, console] = opened(synthetic::ladder(), GetParam());
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(GetParam()) +
                        " plots=9 tables=4 small=0 sorted=ascending movies=1");
}

TEST_P(Browser, ShowsALoneRunWithoutHistory) {
  RunResult run;
  run.position_drift_max = 0;
  run.cpu_s = 0.1;
  const auto [report, console] = opened(synthetic::study_of({run}), GetParam());
  EXPECT_EQ(console, "");
  EXPECT_EQ(report, "fits width=" + std::to_string(GetParam()) +
                        " plots=1 tables=1 small=0 sorted=ascending movies=1");
}

INSTANTIATE_TEST_SUITE_P(Widths, Browser, ::testing::Values(360, 1600));

}  // namespace
}  // namespace momenta
