#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/embedded.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/stress_report.h>
#include <momenta/dae/output/svg.h>

#include <algorithm>
#include <cctype>

namespace momenta {

namespace {

std::string tag(const std::string& name, const std::string& attributes, const std::string& inside) {
  return "<" + name + (attributes.empty() ? "" : " " + attributes) + ">" + inside + "</" + name +
         ">";
}
std::string of_class(const std::string& name) {
  return "class=\"" + name + "\"";
}
std::string row_head(const Contestant& c) {
  return tag(
      "th", "scope=\"row\"",
      escape_html(c.form) + " " + tag("span", of_class("integrator"), escape_html(c.integrator)));
}
std::string framed(const std::string& name, const std::string& table) {
  return tag("div",
             "class=\"frame\" tabindex=\"0\" role=\"region\" aria-label=\"Table: " +
                 escape_html(name) + "\"",
             tag("table", "", table));
}

std::string cell(const StressRun* r) {
  if (!r) return tag("td", of_class("verdict untried"), "–");
  const std::string much = r->verdict == Verdict::survived || r->verdict == Verdict::wrong
                               ? scientific(worst_measure(*r), 1)
                               : "at " + compact(r->at, 2) + " s";
  const std::string name = name_of(r->verdict);
  return tag("td", of_class("verdict " + name) + " title=\"" + escape_html(r->cause) + "\"",
             name + tag("span", of_class("much"), much));
}

std::string ladder_section(const StressResult& study, const LadderResult& ladder) {
  std::string head = tag("th", "scope=\"col\" class=\"verdict\"", "form, integrator");
  for (const std::string& rung : ladder.rungs)
    head += tag("th", "scope=\"col\" class=\"verdict\"", escape_html(rung));
  std::string rows, causes;
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    if (ladder.runs[c].empty()) continue;
    std::string row = row_head(study.contestants[c]);
    for (std::size_t k = 0; k < ladder.rungs.size(); ++k) {
      const auto found =
          std::find_if(ladder.runs[c].begin(), ladder.runs[c].end(),
                       [&](const StressRun& r) { return r.rung == static_cast<int>(k); });
      row += cell(found == ladder.runs[c].end() ? nullptr : &*found);
      if (found != ladder.runs[c].end() && found->verdict != Verdict::survived)
        causes += tag("li", "",
                      tag("b", "", escape_html(found->contestant.form)) + " " +
                          escape_html(found->contestant.integrator) + ", " +
                          escape_html(ladder.rungs[k]) + ": " + escape_html(found->cause));
    }
    rows += tag("tr", "", row);
  }
  std::string notes;
  for (std::size_t k = 0; k < ladder.rungs.size(); ++k)
    if (!ladder.refused[k].empty())
      notes +=
          tag("p", of_class("notes"),
              escape_html(ladder.rungs[k]) + " has no start: " + escape_html(ladder.refused[k]));
  return tag(
      "section", "",
      tag("h2", "", escape_html(ladder.name)) +
          framed(ladder.name, tag("thead", "", tag("tr", "", head)) + tag("tbody", "", rows)) +
          notes +
          (causes.empty() ? ""
                          : tag("details", "",
                                tag("summary", "", "How they failed") + tag("ul", "", causes))));
}

std::string summary_section(const StressResult& study) {
  std::string rows;
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    const Tally t = tally(study, c);
    if (t.tried() == 0) continue;
    std::string row = row_head(study.contestants[c]);
    for (const int n : {t.survived, t.rungs, t.wrong, t.stopped, t.slow})
      row += tag("td", "", std::to_string(n));
    rows += tag("tr", "", row);
  }
  std::string head = tag("th", "scope=\"col\" class=\"verdict\"", "form, integrator");
  for (const char* title : {"survived", "of rungs", "wrong in silence", "stopped", "slow"})
    head += tag("th", "scope=\"col\"", title);
  return tag(
      "section", "",
      tag("h2", "", "Ladders that all took part in") +
          tag("p", of_class("caption"),
              "Wrong: came to a result beyond the bound without saying so. Stopped: gave a reason "
              "and ended. Slow: not done within " +
                  compact(study.cpu_limit, 3) +
                  " s of processor time. On a rising ladder nothing is tried after the first "
                  "failure. The number in a cell is the largest of position drift over length, "
                  "energy "
                  "error over what is exchanged, and error against the reference.") +
          framed("ladders that all took part in",
                 tag("thead", "", tag("tr", "", head)) + tag("tbody", "", rows)));
}

/// Contestants that survived most, and silent errors.
std::string answer(const StressResult& study) {
  if (study.contestants.empty()) return "Nothing was run.";
  std::size_t best = 0;
  int silent = 0, tried = 0;
  for (std::size_t c = 0; c < study.contestants.size(); ++c) {
    const Tally t = tally(study, c);
    if (t.survived > tally(study, best).survived) best = c;
    silent += t.wrong;
    tried += t.tried();
  }
  const Tally t = tally(study, best);
  int others = 0;  // others with as many rungs as the best
  for (std::size_t c = 0; c < study.contestants.size(); ++c)
    others += c != best && tally(study, c).survived == t.survived;
  const std::string equals =
      others == 0 ? "" : " and " + std::to_string(others) + (others == 1 ? " other" : " others");
  return tag("code", "", escape_html(study.contestants[best].form)) + " by " +
         escape_html(study.contestants[best].integrator) + equals +
         " survived most: " + std::to_string(t.survived) + " of " + std::to_string(t.rungs) +
         " rungs within " + compact(study.bound, 2) + ". Of all " + std::to_string(tried) +
         " runs " + std::to_string(silent) + (silent == 1 ? " was" : " were") +
         " wrong without a word." + (study.complete ? "" : " The study was interrupted.");
}

std::string how_section(const StressResult& study) {
  const auto pair = [](const std::string& what, const std::string& value) {
    return tag("dt", "", what) + tag("dd", "", escape_html(value));
  };
  std::string versions;
  for (const auto& [name, version] : study.environment.versions)
    versions += (versions.empty() ? "" : ", ") + name + " " + version;
  return tag(
      "section", "",
      tag("h2", "", "How it was made") +
          tag("dl", "",
              pair("Command", study.command) +
                  pair("Tolerance", "rtol = atol = " + scientific(study.rtol, 1)) +
                  pair("Bound", compact(study.bound, 2)) + pair("Versions", versions) +
                  pair("Compiler", study.environment.compiler + ", " + study.environment.flags +
                                       ", kernels x86-64-v" +
                                       std::to_string(study.environment.level)) +
                  pair("Processor", study.environment.cpu) + pair("Date", study.environment.date)));
}

/// Colours of the light page.
std::string verdict_colours() {
  std::string css;
  for (const Verdict v : {Verdict::survived, Verdict::slow, Verdict::stopped, Verdict::wrong})
    css += "--" + std::string(name_of(v)) + ": " + colour_of(v) + "; ";
  return ":root { " + css + "}";
}

}  // namespace

const char* colour_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::survived:
      return "#dcefe4";
    case Verdict::slow:
      return "#eef0f3";
    case Verdict::stopped:
      return "#fbeed3";
    case Verdict::wrong:
      return "#f9d9cf";
    case Verdict::untried:
      return "#ffffff";
  }
  return "#ffffff";
}

std::string stress_page(const StressResult& study, const std::string& title) {
  std::string main = summary_section(study);
  for (const LadderResult& ladder : study.ladders) main += ladder_section(study, ladder);
  return filled(embedded::stress_html(),
                {{"title", escape_html(title)},
                 {"kind", "Extremes"},
                 {"about", "extremes"},
                 {"answer", answer(study)},
                 {"main", main + how_section(study)},
                 {"page_css", std::string(embedded::page_css())},
                 {"stress_css", verdict_colours() + "\n" + std::string(embedded::stress_css())}});
}

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
