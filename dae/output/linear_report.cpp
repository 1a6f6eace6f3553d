#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/linear_report.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace momenta {
namespace {

using Eigen::MatrixXd;

const char* word_for(LinearRequest::Kind kind) {
  return kind == LinearRequest::Kind::minimal ? "minimal" : "descriptor";
}

std::vector<std::string> labels(const std::vector<Column>& columns) {
  std::vector<std::string> all;
  for (const Column& c : columns) all.push_back(c.label());
  return all;
}

std::array<std::pair<const char*, const MatrixXd*>, 5> matrices(const LinearModel& m) {
  return {{{"E", &m.E}, {"A", &m.A}, {"B", &m.B}, {"C", &m.C}, {"D", &m.D}}};
}
std::array<std::pair<const char*, const std::vector<Column>*>, 3> sides(const LinearModel& m) {
  return {{{"states", &m.states}, {"inputs", &m.inputs}, {"outputs", &m.outputs}}};
}

std::string how_many(std::size_t n, const char* what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

/// A text in quotes; `escape` precedes each `quote` in it.
std::string in_marks(const std::string& text, char quote, char escape) {
  std::string all(1, quote);
  for (const char c : text) {
    if (c == quote || c == escape) all += escape;
    all += c;
  }
  return all + quote;
}

std::string first_line(const LinearModel& m) {
  std::string name;
  for (const char c : m.scene) name += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return (name.empty() ? "" : name + ": ") + "E x' = A x + B w, y = C x + D w, " +
         word_for(m.kind) + ", at t = " + round_trip(m.t) + " s";
}

/// Joined by `between`.
std::string numbers_of(const MatrixXd& a, Eigen::Index i, const char* between) {
  std::string line;
  for (Eigen::Index j = 0; j < a.cols(); ++j) line += (j == 0 ? "" : between) + round_trip(a(i, j));
  return line;
}

}  // namespace

std::string linear_table(const LinearModel& m) {
  constexpr double rounding = 1e-6;  // relative: a double zero is split by its root
  const double largest = m.poles.size() > 0 ? m.poles.cwiseAbs().maxCoeff() : 0;
  const auto growing =
      std::count_if(m.poles.begin(), m.poles.end(),
                    [&](const std::complex<double>& s) { return s.real() > rounding * largest; });
  std::string text =
      (m.scene.empty() ? "" : m.scene + ": ") + "linear model (" + word_for(m.kind) +
      ") about the state at t = " + compact(m.t, 6) + " s: " + how_many(m.states.size(), "state") +
      ", " + how_many(m.inputs.size(), "input") + ", " + how_many(m.outputs.size(), "output") +
      ", " + how_many(static_cast<std::size_t>(m.poles.size()), "pole") +
      (growing > 0 ? ", " + std::to_string(growing) + " of them growing.\n" : ".\n");
  if (!m.left_out.empty()) {
    text += "Loop equations that follow from others: ";
    for (std::size_t i = 0; i < m.left_out.size(); ++i)
      text += (i == 0 ? "" : "; ") + m.left_out[i];
    text += "\n";
  }
  if (m.poles.size() == 0) return text;
  std::vector<std::vector<std::string>> rows{
      {"pole", "real part [1/s]", "imaginary part [rad/s]", "f [Hz]", "damping ratio"}};
  for (Eigen::Index i = 0; i < m.poles.size(); ++i) {
    const std::complex<double> s = m.poles[i];
    if (s.imag() < 0) continue;
    const bool swings = s.imag() > 0;
    rows.push_back({std::to_string(rows.size()), compact(s.real(), 5),
                    swings ? "± " + compact(s.imag(), 5) : "0",
                    swings ? compact(s.imag() / (2 * std::numbers::pi), 5) : "-",
                    std::abs(s) > 0 ? compact(-s.real() / std::abs(s) + 0.0, 4) : "-"});
  }
  return text + "\n" + in_columns(rows);
}

std::string linear_json(const LinearModel& m) {
  JsonWriter w;
  w.text("scene", m.scene);
  w.text("kind", word_for(m.kind));
  w.number("t", m.t);
  const auto by_name = [&](const char* key, const std::vector<Column>& columns,
                           const Eigen::VectorXd& values) {
    w.open(key);
    for (std::size_t i = 0; i < columns.size(); ++i)
      w.number(columns[i].label(), values[static_cast<Eigen::Index>(i)]);
    w.close();
  };
  by_name("q", m.coordinates, m.q);
  by_name("u", m.rates, m.u);
  w.numbers("udot", m.udot);
  for (const auto& [key, columns] : sides(m)) w.texts(key, labels(*columns));
  for (const auto& [key, matrix] : matrices(m)) w.rows(key, *matrix);
  MatrixXd poles(m.poles.size(), 2);
  poles << m.poles.real(), m.poles.imag();
  w.rows("poles", poles);
  w.texts("left_out", m.left_out);
  w.number("kept", m.kept);
  return w.take();
}

std::string linear_octave(const LinearModel& m) {
  std::string text = "% " + first_line(m) + "\n";
  for (const auto& [key, columns] : sides(m)) {
    text += std::string(key) + " = {";
    for (std::size_t i = 0; i < columns->size(); ++i)
      text += (i == 0 ? "" : "; ") + in_marks((*columns)[i].label(), '\'', '\'');
    text += "};\n";
  }
  for (const auto& [key, matrix] : matrices(m)) {
    if (matrix->size() == 0) {
      text += std::string(key) + " = zeros(" + std::to_string(matrix->rows()) + ", " +
              std::to_string(matrix->cols()) + ");\n";
      continue;
    }
    text += std::string(key) + " = [\n";
    for (Eigen::Index i = 0; i < matrix->rows(); ++i) text += numbers_of(*matrix, i, " ") + "\n";
    text += "];\n";
  }
  return text + "if exist('dss')\n  sys = dss(A, B, C, D, E);\nend\n";
}

std::string linear_python(const LinearModel& m) {
  std::string text = "# " + first_line(m) + "\n";
  for (const auto& [key, columns] : sides(m)) {
    text += std::string(key) + " = [";
    for (std::size_t i = 0; i < columns->size(); ++i)
      text += (i == 0 ? "" : ", ") + in_marks((*columns)[i].label(), '"', '\\');
    text += "]\n";
  }
  for (const auto& [key, matrix] : matrices(m)) {
    text += std::string(key) + " = [\n";
    for (Eigen::Index i = 0; i < matrix->rows(); ++i)
      text += "    [" + numbers_of(*matrix, i, ", ") + "],\n";
    text += "]\n";
  }
  text +=
      "\n\n"
      "def response(s):\n"
      "    \"\"\"G(s) = C (s E - A)^-1 B + D, outputs x inputs.\"\"\"\n"
      "    import numpy as np\n"
      "    n, k, l = len(states), len(inputs), len(outputs)\n"
      "    shaped = lambda m, rows, columns: np.array(m, dtype=float).reshape(rows, columns)\n"
      "    inside = np.linalg.solve(s * shaped(E, n, n) - shaped(A, n, n), shaped(B, n, k))\n"
      "    return shaped(C, l, n) @ inside + shaped(D, l, k)\n";
  if (m.kind == LinearRequest::Kind::minimal)
    text +=
        "\n\n"
        "def system():\n"
        "    \"\"\"A StateSpace of python-control.\"\"\"\n"
        "    import control\n"
        "    return control.ss(A, B, C, D, states=states, inputs=inputs, outputs=outputs)\n";
  return text;
}

}  // namespace momenta
