#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/csv_cells.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/fit/named_table.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

namespace momenta {
namespace {

class Reader {
 public:
  Reader(const std::filesystem::path& file, const NamedTableForm& form)
      : file_(file.string()), form_(form), in_(reading::text_of(file, form.kind)) {}

  NamedTable read() {
    read_head();
    std::vector<std::vector<double>> rows;
    std::string line;
    while (std::getline(in_, line)) {
      ++line_;
      if (line.empty() || line == "\r") continue;
      rows.push_back(row_of(csv_cells(line)));
      table_.lines.push_back(line_);
    }
    if (rows.empty())
      refuse(std::string("there are no ") + form_.rows + "; expected a line for each");
    const auto columns = static_cast<Eigen::Index>(table_.columns.size());
    table_.values.resize(static_cast<Eigen::Index>(rows.size()), columns);
    bool any = false;
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t k = 0; k < rows[i].size(); ++k) {
        table_.values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = rows[i][k];
        any = any || (!is_whole(k) && !std::isnan(rows[i][k]));
      }
    if (!any) refuse("all cells are empty; expected a number for what is asked");
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(file_ + ":" + std::to_string(line_) + ": " + what);
  }
  bool is_whole(std::size_t column) const { return table_.columns[column] == form_.whole; }

  std::size_t known(const std::string& label) const {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < form_.known.size(); ++i) {
      const Column& k = form_.known[i];
      if (label == k.name || label == k.label()) return i;
      if (label.substr(0, label.find(" [")) == k.name)
        refuse("column " + reading::in_quotes(label) + " is in another unit; expected '" +
               k.label() + "'");
      names.push_back(k.name);
    }
    refuse("column " + reading::in_quotes(label) + " " + form_.other + "; expected of " +
           reading::all_in_quotes(names, 12));
  }

  void read_head() {
    std::string line;
    if (!std::getline(in_, line)) refuse("the file is empty; expected a line of column names");
    for (const std::string& cell : csv_cells(line)) {
      const std::size_t place = known(cell);
      if (std::find(table_.columns.begin(), table_.columns.end(), place) != table_.columns.end())
        refuse("column '" + form_.known[place].name + "' stands twice, expected it once");
      table_.columns.push_back(place);
    }
    if (table_.columns == std::vector<std::size_t>{form_.whole}) refuse(form_.whole_alone);
  }

  std::vector<double> row_of(const std::vector<std::string>& cells) const {
    if (cells.size() != table_.columns.size())
      refuse("found " + std::to_string(cells.size()) + " cells; expected " +
             std::to_string(table_.columns.size()));
    std::vector<double> row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string& cell = cells[i];
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!cell.empty() || is_whole(i)) {
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
          refuse("found " + reading::in_quotes(cell) + "; expected a finite number");
      }
      row.push_back(value);
    }
    return row;
  }

  std::string file_;
  const NamedTableForm& form_;
  std::istringstream in_;
  int line_ = 1;
  NamedTable table_;
};

}  // namespace

NamedTable read_named_table(const std::filesystem::path& file, const NamedTableForm& form) {
  return Reader(file, form).read();
}

}  // namespace momenta
