// Points of a function from two columns of a file: names in the first line, then numbers, commas
// between. Empty lines and lines that begin with # are skipped.

#include <momenta/core/format/toml/scene_keys.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace momenta::reading {
namespace {

/// Text between two commas, and its place.
struct Cell {
  std::string_view text;
  int column;  ///< from 1
};

class Columns {
 public:
  Columns(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {}

  /// Reads the cells of the next line; none at the end of the file.
  bool next() {
    while (from_ < text_.size()) {
      ++line_;
      const std::size_t end = std::min(text_.find('\n', from_), text_.size());
      std::string_view line = std::string_view(text_).substr(from_, end - from_);
      from_ = end + 1;
      if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
      if (trimmed({line, 1}).text.empty() || line.front() == '#') continue;
      split(line);
      return true;
    }
    return false;
  }
  /// Index of the column of this name. @pre the first line was read
  std::size_t named(std::string_view name) const {
    std::vector<std::string_view> names;
    for (const Cell& c : cells) names.push_back(c.text);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    fail(1, "no column " + in_quotes(name) + ", expected one of: " + listed(names));
  }
  double number(std::size_t column, std::size_t of) const {
    if (cells.size() != of)
      fail(1, "the line has " + std::to_string(cells.size()) + " entries, expected " +
                  std::to_string(of) + " as in the first line");
    const Cell& c = cells[column];
    double x = 0;
    const std::string_view digits = c.text.starts_with('+') ? c.text.substr(1) : c.text;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x);
    if (error != std::errc{} || end != digits.data() + digits.size() || !std::isfinite(x))
      fail(c.column, "found " + in_quotes(c.text) + ", expected a finite number");
    return x;
  }
  [[noreturn]] void fail(int column, const std::string& sentence) const {
    reading::fail(file_, {line_, column}, sentence);
  }
  std::vector<Cell> cells;

 private:
  static Cell trimmed(Cell c) {
    const auto blank = [](char x) { return x == ' ' || x == '\t' || x == '\r'; };
    while (!c.text.empty() && blank(c.text.front())) c.text.remove_prefix(1), ++c.column;
    while (!c.text.empty() && blank(c.text.back())) c.text.remove_suffix(1);
    return c;
  }
  void split(std::string_view line) {
    cells.clear();
    for (std::size_t from = 0;;) {
      const std::size_t end = std::min(line.find(',', from), line.size());
      Cell c = trimmed({line.substr(from, end - from), static_cast<int>(from) + 1});
      if (c.text.size() > 1 && c.text.front() == '"' && c.text.back() == '"')
        c = {c.text.substr(1, c.text.size() - 2), c.column + 1};
      cells.push_back(c);
      if (end == line.size()) return;
      from = end + 1;
    }
  }

  std::string text_, file_;
  std::size_t from_ = 0;
  int line_ = 0;
};

void take_points(Columns& columns, const std::string& x_name, const std::string& y_name,
                 FunctionSpec& function) {
  if (!columns.next()) columns.fail(1, "the file is empty, expected names of columns");
  const std::size_t x = columns.named(x_name), y = columns.named(y_name), of = columns.cells.size();
  while (columns.next()) {
    const double at = columns.number(x, of);
    if (!function.x.empty() && !(function.x.back() < at))
      columns.fail(columns.cells[x].column,
                   in_quotes(x_name) +
                       " does not increase here, expected a number above that of "
                       "the line before");
    function.x.push_back(at);
    function.y.push_back(columns.number(y, of));
  }
  if (function.x.size() < 2)
    columns.fail(1, "the file ends after fewer than 2 lines of numbers, expected at least 2");
}

}  // namespace

void read_columns(const Fields& table, FunctionSpec& function) {
  const std::string x = table.text("x"), y = table.text("y");
  const std::string name = table.text("file");
  const std::filesystem::path folder = std::filesystem::path(table.file()).parent_path();
  const NamedFile file = file_inside(name, folder);
  if (!file.fault.empty()) table.fail_key("file", "is " + in_quotes(name) + file.fault);
  try {
    Columns columns(text_of(file.path, "file of columns"), (folder / name).string());
    take_points(columns, x, y, function);
  } catch (const SceneError& e) {
    table.fail_at(table.find("file")->at, std::string("file, ") + e.what());
  }
}

}  // namespace momenta::reading
