#include <momenta/dae/report/figure.h>
#include <momenta/dae/report/stress_report.h>
#include <momenta/dae/report/svg.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cctype>

namespace momenta {
namespace {

constexpr double row_height = 26, head_height = 64, cell_width = 124;

/// Letters and digits of a name, joined by "_".
std::string file_name(const std::string& name) {
  std::string file;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0)
      file += static_cast<char>(std::tolower(letter));
    else if (!file.empty() && file.back() != '_')
      file += '_';
  }
  while (!file.empty() && file.back() == '_') file.pop_back();
  return file;
}

std::string cell(const StressRun& run, double x, double y) {
  const bool measured = run.verdict == Verdict::survived || run.verdict == Verdict::wrong;
  const std::string much =
      measured ? scientific(worst_measure(run), 1) : "at " + compact(run.at, 2) + " s";
  return svg::element("rect", {{"x", svg::number(x + 1)},
                               {"y", svg::number(y + 1)},
                               {"width", svg::number(cell_width - 2)},
                               {"height", svg::number(row_height - 2)},
                               {"fill", colour_of(run.verdict)}}) +
         svg::text(x + 6, y + 18, std::string(name_of(run.verdict)) + " " + much, "start",
                   {{"font-size", "12"},
                    {"font-weight", run.verdict == Verdict::wrong ? "bold" : "normal"}});
}

Figure table_of(const StressResult& study, const LadderResult& ladder) {
  double names = 0;
  std::vector<std::pair<std::size_t, std::string>> rows;
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    if (ladder.runs[c].empty()) continue;
    rows.emplace_back(c, study.contestants[c].form + " " + study.contestants[c].integrator);
    names = std::max(names, svg::width_of(rows.back().second) + 20);
  }
  std::string inside = svg::text(10, 22, ladder.name, "start", {{"font-weight", "bold"}});
  for (std::size_t k = 0; k < ladder.rungs.size(); ++k)
    inside += svg::text(names + cell_width * static_cast<double>(k) + 6, head_height - 10,
                        ladder.rungs[k], "start", {{"font-size", "12"}});
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double y = head_height + row_height * static_cast<double>(i);
    inside += svg::text(10, y + 18, rows[i].second);
    for (const StressRun& run : ladder.runs[rows[i].first])
      inside += cell(run, names + cell_width * run.rung, y);
  }
  const double width = std::max(names + cell_width * static_cast<double>(ladder.rungs.size()),
                                svg::width_of(ladder.name)) +
                       10;
  const double height = head_height + row_height * static_cast<double>(rows.size()) + 10;
  return {file_name(ladder.name),
          svg::document(
              width, height, ladder.name,
              "Verdicts of forms and integrators along a ladder; the number is the "
              "largest of position drift over length, energy error over what is exchanged, and "
              "error against the reference, or when the run stopped.",
              inside)};
}

}  // namespace

std::vector<Figure> figures_of_stress(const StressResult& study) {
  std::vector<Figure> figures;
  for (const LadderResult& ladder : study.ladders) figures.push_back(table_of(study, ladder));
  return figures;
}

}  // namespace momenta
