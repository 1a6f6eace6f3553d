// Every form's file begins with the same headings, each at the start of a line of its own.
#include <gtest/gtest.h>
#include <momenta/dae/form/form.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace momenta::dae_form_heads {
namespace {

TEST(FormHeads, StandInLinesOfTheirOwn) {
  const auto folder = std::filesystem::path(MOMENTA_SOURCE_DIR) / "dae" / "form";
  std::map<std::string, int> heads;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream in(entry.path());
    std::string line;
    std::getline(in, line);
    std::string name;
    if (line.size() > 3) name.assign(line, 3);
    if (std::find(form_names().begin(), form_names().end(), name) == form_names().end()) continue;
    std::map<std::string, int> met;
    for (; line.rfind("//", 0) == 0; std::getline(in, line))
      for (const char* heading :
           {"Unknowns  ", "Equations  ", "Index  ", "Multipliers  ", "Drifts  ", "Source  "}) {
        const auto at = line.find(heading);
        if (at == std::string::npos) continue;
        EXPECT_EQ(at, 3U) << entry.path() << ": " << line;
        ++met[heading];
      }
    EXPECT_EQ(met.size(), 6U) << entry.path();
    for (const auto& [heading, times] : met) EXPECT_EQ(times, 1) << entry.path() << " " << heading;
    ++heads[name];
  }
  EXPECT_EQ(heads.size(), form_names().size());
}

}  // namespace
}  // namespace momenta::dae_form_heads
