#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/fit/wanted_poses.h>
#include <momenta/dae/kinematics/coordinate_named.h>
#include <momenta/dae/text/csv_cells.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

namespace momenta {
namespace {

class WantedFile {
 public:
  WantedFile(const std::filesystem::path& file, const Mechanism& mechanism,
             const std::string& sweep)
      : in_(reading::text_of(file, "file of wanted poses")) {
    wanted_.file = file.string();
    const std::vector<Column> q = mechanism.coordinate_columns(),
                              markers = mechanism.marker_columns();
    const int swept = coordinate_named(mechanism, sweep).first;
    for (std::size_t i = 0; i < q.size(); ++i) {
      const bool is_swept = static_cast<int>(i) == swept;
      known_.push_back({{q[i].name, q[i].unit, static_cast<int>(i), -1, 0}, is_swept});
    }
    for (std::size_t i = 0; i < markers.size(); ++i)
      if (i % 6 < 3)
        known_.push_back({{markers[i].name, markers[i].unit, -1, static_cast<int>(i / 6),
                           static_cast<int>(i % 6)},
                          false});
  }

  WantedPoses read() {
    read_head();
    std::vector<std::vector<double>> rows;
    std::string line;
    while (std::getline(in_, line)) {
      ++line_;
      if (!line.empty() && line != "\r") rows.push_back(row_of(csv_cells(line)));
    }
    if (rows.empty()) refuse("there are no poses; expected a line for each");
    const auto columns = static_cast<Eigen::Index>(wanted_.quantities.size());
    wanted_.values.resize(static_cast<Eigen::Index>(rows.size()), columns);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (Eigen::Index k = 0; k < columns; ++k)
        wanted_.values(static_cast<Eigen::Index>(i), k) = rows[i][static_cast<std::size_t>(k)];
    if (wanted_.values.array().isNaN().all())
      refuse("all cells are empty; expected a number for what is asked");
    return std::move(wanted_);
  }

 private:
  struct Known {
    WantedPoses::Quantity quantity;
    bool swept = false;
  };

  [[noreturn]] void refuse(const std::string& what) const {
    throw SceneError(wanted_.file + ":" + std::to_string(line_) + ": " + what);
  }

  const Known& known(const std::string& label) const {
    for (const Known& k : known_) {
      const std::string& name = k.quantity.name;
      if (label == name || label == name + " [" + k.quantity.unit + "]") return k;
      if (label.substr(0, label.find(" [")) == name)
        refuse("column " + reading::in_quotes(label) + " is in another unit; expected '" + name +
               " [" + k.quantity.unit + "]'");
    }
    std::vector<std::string> names;
    for (const Known& k : known_) names.push_back(k.quantity.name);
    refuse("column " + reading::in_quotes(label) +
           " is no coordinate and no position of a marker; expected of " +
           reading::all_in_quotes(names, 12));
  }

  void read_head() {
    std::string line;
    if (!std::getline(in_, line)) refuse("the file is empty; expected a line of column names");
    const std::vector<std::string> cells = csv_cells(line);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const Known& k = known(cells[i]);
      for (std::size_t other = 0; other < i; ++other)
        if (&known(cells[other]) == &k) refuse("column '" + k.quantity.name + "' stands twice");
      if (k.swept)
        swept_ = i;
      else
        wanted_.quantities.push_back(k.quantity);
    }
    columns_ = cells.size();
    if (wanted_.quantities.empty())
      refuse("the swept coordinate is the only column; expected what it is to move");
  }

  /// Of the quantities; the swept coordinate goes to its own place.
  std::vector<double> row_of(const std::vector<std::string>& cells) {
    if (cells.size() != columns_)
      refuse("found " + std::to_string(cells.size()) + " cells; expected " +
             std::to_string(columns_));
    std::vector<double> row;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string& cell = cells[i];
      double value = std::numeric_limits<double>::quiet_NaN();
      if (!cell.empty() || swept_ == i) {
        const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
        if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
          refuse("found " + reading::in_quotes(cell) + "; expected a finite number");
      }
      if (swept_ == i)
        wanted_.swept.push_back(value);
      else
        row.push_back(value);
    }
    return row;
  }

  std::istringstream in_;
  int line_ = 1;
  std::size_t columns_ = 0;
  std::optional<std::size_t> swept_;  ///< its column
  std::vector<Known> known_;
  WantedPoses wanted_;
};

}  // namespace

WantedPoses read_wanted(const std::filesystem::path& file, const Mechanism& mechanism,
                        const std::string& sweep) {
  return WantedFile(file, mechanism, sweep).read();
}

}  // namespace momenta
