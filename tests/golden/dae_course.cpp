// The commands of the course run as they are printed, on shortened spans. Its links are those of
// all documents: docs/site/links.py.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path top = MOMENTA_SOURCE_DIR, course = top / "docs/index-reduction";

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<fs::path> pages(const fs::path& folder) {
  std::vector<fs::path> all;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  return all;
}

/// Commands of a page: indented or in backquotes, lines that end in \\ joined; of a shell loop its
/// body with one value for each variable.
std::vector<std::string> commands_of(const std::string& page) {
  std::string text = std::regex_replace(page, std::regex("\\\\\n *"), "");
  const std::map<std::string, std::string> values{
      {"a", "3"}, {"tol", "1e-6"}, {"form", "momentum"}, {"how", "--project"}};
  for (const auto& [name, value] : values)
    text = std::regex_replace(text, std::regex("\\$" + name + "\\b"), value);
  std::vector<std::string> all;
  const std::regex command(
      "(?:\n {4,}|`)(momenta (?:index|check|assemble|evaluate|run|drift|work) [^\n`]*)");
  for (std::sregex_iterator it(text.begin(), text.end(), command), end; it != end; ++it)
    all.push_back((*it)[1]);
  return all;
}

/// The same on a short span, with its results in `out`.
std::string shortened(std::string command, const fs::path& out) {
  command = std::regex_replace(
      command, std::regex(" --(end|samples|out|rtol|from|to|per-decade) [^ ]+"), "");
  const auto is = [&](const char* verb) { return command.rfind(verb, 0) == 0; };
  if (is("momenta run") || is("momenta drift") || is("momenta work")) {
    command += " --end 0.003 --samples 3 --quiet";
    command += is("momenta work") ? " --from 1e-4 --to 1e-5" : " --rtol 1e-6";
  }
  if (!is("momenta check")) command += " --out '" + out.string() + "'";
  return "'" + (fs::path(MOMENTA_BINARY_DIR) / "dae").string() + "'/" + command;
}

TEST(Course, CommandsRun) {
  const fs::path out = fs::temp_directory_path() / ("momenta_course_" + std::to_string(getpid()));
  fs::create_directories(out);
  int count = 0;
  for (const auto& page : pages(course))
    for (const std::string& command : commands_of(text_of(page))) {
      if (command.find("SCENE") != std::string::npos) continue;
      ++count;
      const std::string line = "cd '" + top.string() + "' && " +
                               shortened(command, out / std::to_string(count)) + " >'" +
                               (out / "said").string() + "' 2>&1 </dev/null";
      const int raw = std::system(line.c_str());  // NOLINT: commands of our own pages
      EXPECT_TRUE(WIFEXITED(raw) && WEXITSTATUS(raw) == 0)
          << page.filename() << ": " << command << "\n"
          << text_of(out / "said");
    }
  EXPECT_GE(count, 12);
  fs::remove_all(out);
}

}  // namespace
