// The sentences that docs/reference/formula-mistakes.md shows are those that are told: each row
// puts one wrong formula into the file above its table.

#include "equations/refusal.h"

#include <gtest/gtest.h>
#include <momenta/core/format/toml/parse_scene.h>
#include <momenta/dae/analysis/equations/equation_start.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace momenta::dae_formula_mistakes {
namespace {

struct Row {
  std::string file, key, formula, sentence;
  int line;
};

/// "`a \| b`" as a | b.
std::string plain(std::string cell) {
  const std::size_t begin = cell.find('`'), end = cell.rfind('`');
  if (begin == std::string::npos || end == begin) return "";
  cell = cell.substr(begin + 1, end - begin - 1);
  for (std::size_t at = 0; (at = cell.find("\\|", at)) != std::string::npos;) cell.erase(at, 1);
  return cell;
}

std::vector<Row> rows() {
  std::ifstream page(std::filesystem::path(MOMENTA_SOURCE_DIR) /
                     "docs/reference/formula-mistakes.md");
  std::vector<Row> all;
  std::string file;
  bool in_file = false;
  int number = 0;
  for (std::string line; std::getline(page, line);) {
    ++number;
    if (line == "```toml") {
      in_file = true;
      file.clear();
    } else if (line == "```") {
      in_file = false;
    } else if (in_file) {
      file += line + "\n";
    } else if (line.starts_with("| `")) {
      std::vector<std::string> cells;
      for (std::size_t from = 1, at = 1; at < line.size(); ++at)
        if (line[at] == '|' && line[at - 1] != '\\') {
          cells.push_back(line.substr(from, at - from));
          from = at + 1;
        }
      if (cells.size() == 3)
        all.push_back({file, plain(cells[0]), plain(cells[1]), plain(cells[2]), number});
      else
        ADD_FAILURE() << "line " << number << " has " << cells.size() << " cells, expected 3";
    }
  }
  return all;
}

/// The file with the formula at its key: in place of the text or number there.
std::string with(const Row& row) {
  const std::regex value("\\b" + row.key + " = (\"[^\"]*\"|[0-9.]+|\\[\\n  \"[^\"]*\")");
  std::smatch found;
  if (!std::regex_search(row.file, found, value)) {
    ADD_FAILURE() << "line " << row.line << ": the file above has no key '" << row.key << "'";
    return row.file;
  }
  const bool first_of_many = found[1].str().front() == '[';
  return found.prefix().str() + row.key + " = " + (first_of_many ? "[\n  " : "") + "\"" +
         row.formula + "\"" + found.suffix().str();
}

std::string told(const std::string& text) {
  const std::string sentence = equations::sentence_of([&] {
    if (text.find("[dae]") != std::string::npos) {
      (void)parse_equations(text, "scene.toml");
      return;
    }
    const Mechanism mechanism(parse_scene(text, "scene.toml"));
    (void)assemble(mechanism);
  });
  const std::string file = "scene.toml:";
  return sentence.starts_with(file)
             ? sentence.substr(file.size() + (sentence[file.size()] == ' ' ? 1 : 0))
             : sentence;
}

TEST(FormulaMistakes, AreToldAsTheTableShows) {
  std::set<std::string> different;
  for (const Row& row : rows()) {
    EXPECT_EQ(told(with(row)), row.sentence)
        << "docs/reference/formula-mistakes.md:" << row.line << ": " << row.formula;
    different.insert(row.key + row.formula);
  }
  EXPECT_GE(different.size(), 100U);
}

// Where, what was found, what was expected: of every sentence of the table.
TEST(FormulaMistakes, HaveAPlaceAndSayWhatIsExpected) {
  for (const Row& row : rows()) {
    const auto has = [&](const char* part) { return row.sentence.find(part) != std::string::npos; };
    const bool placed = std::regex_search(row.sentence, std::regex("^[0-9]+:[0-9]+: "));
    EXPECT_TRUE(placed || has("coordinate '")) << row.sentence;
    EXPECT_TRUE(has("expected") || has("did you mean") || has("is not closed") ||
                has("ends where a number is"))
        << row.sentence;
  }
}

}  // namespace
}  // namespace momenta::dae_formula_mistakes
