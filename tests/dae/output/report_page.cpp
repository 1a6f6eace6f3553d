// A page is one file: nothing remote, data that parse back, thin enough, and deaf to what stands in
// a name.
#include <dae/output/page/synthetic_study.h>
#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/page_data.h>
#include <momenta/dae/output/sampled_curves.h>

#include <nlohmann/json.hpp>

#include <string>

namespace momenta::dae_report_page {
namespace {

nlohmann::json island_of(const std::string& page) {
  const std::string start = "<script type=\"application/json\" id=\"study\">";
  const auto from = page.find(start) + start.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size()))
    ++n;
  return n;
}

TEST(Page, LoadsNothingFromElsewhere) {
  const std::string page = drift_page(synthetic::all_forms());
  for (const char* loads :
       {"src=", "srcset=", "url(http", "url(/", "@import", "import(", "fetch(", "XMLHttpRequest",
        "importScripts", "href=\"http", "href=\"/", "<iframe", "<object"}) {
    EXPECT_EQ(count(page, loads), 0u) << loads;
  }
  // What is left are the name of a namespace and uPlot's own comment.
  EXPECT_GE(count(page, "://"), 2u);
  for (auto at = page.find("://"); at != std::string::npos; at = page.find("://", at + 1)) {
    const auto from = page.find_last_of(" \"'(<>", at) + 1;
    const std::string address = page.substr(from, page.find_first_of(" \"')<>", at) - from);
    EXPECT_TRUE(address == "http://www.w3.org/2000/svg" ||
                address == "https://github.com/leeoniya/uPlot")
        << address;
  }
}

TEST(Page, CarriesTheLicenceOfUplot) {
  const std::string page = drift_page(synthetic::all_forms());
  EXPECT_NE(page.find("Permission is hereby granted, free of charge"), std::string::npos);
  EXPECT_EQ(page.find("{{"), page.find("{{", page.find("</html>")))
      << "a name of the template was left";
}

TEST(Page, DataParseBackAndFitAMegabyte) {
  const std::string page = drift_page(synthetic::all_forms());
  EXPECT_LT(page.size(), 1'000'000u);
  const auto data = island_of(page);
  ASSERT_EQ(data["runs"].size(), form_names().size());
  EXPECT_EQ(data["runs"][8]["status"], "failed");
  EXPECT_EQ(data["picture"]["bodies"].size(), 3u);
  for (const auto& run : data["runs"]) {
    const auto& drift = run["series"]["position_drift"];
    EXPECT_EQ(drift["t"].size(), drift["y"].size());
    EXPECT_LE(drift["t"].size(), points_per_curve);
    EXPECT_GT(drift["t"].size(), 100u);
    // Thinning keeps the extremes: the largest value is the table's, to the digits drawn.
    double largest = 0;
    for (const double y : drift["y"]) largest = std::max(largest, y);
    if (run["status"] == "done") {
      EXPECT_NEAR(largest, run["drift"]["position_max"].get<double>(), 1e-4 * largest);
    }
  }
}

TEST(Page, IsNotBrokenByWhatIsWrittenInNames) {
  StudyResult study = synthetic::study_of({synthetic::run_of({})});
  study.scene = "a</script><script>alert(1)</script><!-- {{study}} & \"b\"";
  study.runs[0].status = "failed";
  study.runs[0].reason = "</SCRIPT> \xff broken bytes";
  const std::string page = drift_page(study);
  EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
  EXPECT_NE(page.find("<h1>a&lt;/script&gt;"), std::string::npos);
  const auto data = island_of(page);
  EXPECT_EQ(data["scene"], study.scene);
}

TEST(Page, MarksUpTheAnswer) {
  const std::string page = drift_page(synthetic::all_forms());
  EXPECT_NE(page.find("<code>acceleration</code> reached 0.27 m, growing like t<sup>2.00</sup>;"),
            std::string::npos);
  EXPECT_NE(page.find("4.6×10<sup>−16</sup> m"), std::string::npos);
}

TEST(Page, HistoriesOfALadderAreThoseOfItsFirstRung) {
  const auto data = island_of(drift_page(synthetic::ladder()));
  EXPECT_TRUE(data["runs"][0]["series"].contains("position_error"));
  EXPECT_TRUE(data["runs"][1]["series"].empty());
  EXPECT_EQ(data["runs"][1]["ladder"], 0);
}

TEST(Thinning, KeepsEverythingWhileItIsLittle) {
  EXPECT_EQ(thinned({0, 1, 2, 3}, {5, 1, not_measured, 2}, 8), (std::vector<std::size_t>{1, 3}));
  EXPECT_TRUE(thinned({}, {}, 8).empty());
}

TEST(Thinning, KeepsExtremesAndTheLastPoint) {
  std::vector<double> t, y;
  for (int i = 0; i <= 100'000; ++i) {
    t.push_back(1e-3 * i);
    y.push_back(i == 77'777 ? -9.0 : i == 5'003 ? 1e-12 : 1.0);
  }
  const auto kept = thinned(t, y, 400);
  EXPECT_LE(kept.size(), 400u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  for (const std::size_t index :
       {std::size_t{1}, std::size_t{5'003}, std::size_t{77'777}, std::size_t{100'000}}) {
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), index)) << index;
  }
}

}  // namespace
}  // namespace momenta::dae_report_page
