#include <momenta/dae/report/embedded.h>
#include <momenta/dae/report/stress_report.h>
#include <momenta/dae/report/template.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>

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

}  // namespace momenta
