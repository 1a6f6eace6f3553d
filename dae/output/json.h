#pragma once
// Results as JSON: summary.json of one run, and the array of a study. Keys are public interface.

#include <momenta/dae/run/run_result.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace momenta {

using Json = nlohmann::ordered_json;

/// summary.json: scene form integrator gauge rtol atol step end_time status reason stopped_at
/// project jacobian linear_solver kkt counters{…} time{…} drift{…} energy{…} error{…}
/// environment{…}. Missing measurements are null.
Json summary_json(const RunResult&, const Environment&);

Json study_json(const StudyResult&);

/// null unless finite: JSON has no NaN.
Json number_or_null(double);

/// {cpu compiler flags build_type date versions{name: version}}.
Json environment_json(const Environment&);

// JSON written directly, in order: objects indented, arrays of numbers on one line, matrices one
// row a line. Cost is that of the text.

class JsonWriter {
 public:
  JsonWriter();

  void open(const std::string& key);
  void close();

  void text(const std::string& key, const std::string& value);
  void texts(const std::string& key, const std::vector<std::string>& values);
  void whole_number(const std::string& key, int value);
  /// Digits that read back as the same double; null unless finite.
  void number(const std::string& key, double value);
  template <class Numbers>
  void numbers(const std::string& key, const Numbers& values) {
    start(key);
    row(values);
  }
  template <class Matrix>
  void rows(const std::string& key, const Matrix& matrix) {
    start(key);
    out_ += '[';
    for (long i = 0; i < matrix.rows(); ++i) {
      out_ += i == 0 ? "\n" : ",\n";
      out_.append(2 * depth_ + 2, ' ');
      row(matrix.row(i));
    }
    if (matrix.rows() > 0) line();
    out_ += ']';
  }

  std::string take();

 private:
  void line();
  void start(const std::string& key);
  void put(double value);
  template <class Numbers>
  void row(const Numbers& values) {
    out_ += '[';
    bool first = true;
    for (const double value : values) {
      if (!first) out_ += ", ";
      put(value);
      first = false;
    }
    out_ += ']';
  }

  std::string out_;
  std::size_t depth_ = 1;
  bool first_ = true;  ///< the open object is empty
};

}  // namespace momenta
