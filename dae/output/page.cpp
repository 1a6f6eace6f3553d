#include <momenta/dae/output/advice.h>
#include <momenta/dae/output/conclusion.h>
#include <momenta/dae/output/effort_report.h>
#include <momenta/dae/output/embedded.h>
#include <momenta/dae/output/fit_picture.h>
#include <momenta/dae/output/fit_report.h>
#include <momenta/dae/output/identification_report.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/least_report.h>
#include <momenta/dae/output/modes_report.h>
#include <momenta/dae/output/move_report.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/page_data.h>

#include <algorithm>
#include <sstream>

namespace momenta {

std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& replacements) {
  std::string text;
  while (true) {
    const auto open = page.find("{{");
    text += page.substr(0, open);
    if (open == std::string_view::npos) return text;
    const auto close = page.find("}}", open);
    const auto name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : replacements)
      if (key == name) text += value;
    page.remove_prefix(close + 2);
  }
}

std::string escape_html(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

namespace {

// "</script" in a JSON string would end the island; "<\/" is the same string in JSON. After "<!--"
// an HTML parser would not find the end tag.
std::string island(const Json& data) {
  const std::string json = data.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string text;
  text.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char next = i + 1 < json.size() ? json[i + 1] : '\0';
    if (json[i] == '<' && next == '/') {
      text += "<\\";
    } else if (json[i] == '<' && next == '!') {
      text += "\\u003c";
    } else {
      text += json[i];
    }
  }
  return text;
}

bool digit(char c) {
  return c >= '0' && c <= '9';
}

// `name` as code, t^1.98 with raised exponent, 3.5e-7 as 3.5×10 to the −7.
std::string marked_up(const std::string& sentence) {
  const std::string text = escape_html(sentence);
  std::string html;
  bool code = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '`') {
      html += code ? "</code>" : "<code>";
      code = !code;
    } else if (!code && text[i] == '^' && i > 0 && text[i - 1] == 't') {
      const auto from = i + 1;
      auto end = text.find_first_not_of("-0123456789.", from);
      if (end == std::string::npos) end = text.size();
      while (end > from && text[end - 1] == '.') --end;  // the sentence's full stop
      html += "<sup>" + text.substr(from, end - from) + "</sup>";
      i = end - 1;
    } else if (!code && text[i] == 'e' && i > 0 && digit(text[i - 1])) {
      const bool negative = text.compare(i + 1, 1, "-") == 0;
      const auto from = i + (negative ? 2 : 1);
      const auto end = std::min(text.find_first_not_of("0123456789", from), text.size());
      if (end > from) {
        html += "×10<sup>" + std::string(negative ? "−" : "") + text.substr(from, end - from) +
                "</sup>";
        i = end - 1;
      } else {
        html += 'e';
      }
    } else {
      html += text[i];
    }
  }
  return html + (code ? "</code>" : "");
}

// Lines of one paragraph.
std::string paragraphs(const std::string& lines) {
  std::string html, line;
  std::istringstream in(lines);
  while (std::getline(in, line)) html += (html.empty() ? "" : "<br>") + marked_up(line);
  return html;
}

// Scripts share one scope, in order of use.
std::string script(std::initializer_list<std::string_view> own) {
  std::string text;
  const auto add = [&](std::string_view part) {
    text += part;
    text += '\n';
  };
  for (const std::string_view part :
       {embedded::text_js(), embedded::signs_js(), embedded::chart_js(), embedded::film_js(),
        embedded::camera_js(), embedded::solids_js(), embedded::strokes_js(), embedded::stage_js(),
        embedded::player_js(), embedded::making_js()})
    add(part);
  for (const std::string_view part : own) add(part);
  return text;
}

std::string page(const StudyResult& study, const std::string& kind, const std::string& answer_html,
                 const std::string& stopped, const Json& data, const std::string& scripts) {
  return filled(
      embedded::page_html(),
      {{"scene", escape_html(study.scene)},
       {"kind", kind},
       {"answer", answer_html},
       {"failures",
        stopped.empty() ? "" : "<p class=\"answer failures\">" + marked_up(stopped) + "</p>"},
       {"uplot_license", std::string(embedded::uplot_license())},
       {"uplot_css", std::string(embedded::uplot_css())},
       {"page_css", std::string(embedded::page_css())},
       {"study", island(data)},
       {"uplot_js", std::string(embedded::uplot_js())},
       {"page_js", scripts}});
}

}  // namespace

std::string drift_page(const StudyResult& study) {
  return page(study, study.drift_study ? "Drift of the loops" : "Error against time",
              study.drift_study ? marked_up(answer(study))
                                : paragraphs(reservations(study) + "\n" + advice(study)),
              failures(study), page_data(study),
              script({embedded::table_js(), embedded::history_js(), embedded::scatter_js(),
                      embedded::study_page_js()}));
}

std::string run_page(const StudyResult& study) {
  Json data = page_data(study);
  data["timeline"] = timeline_json(study.runs.front());
  return page(study, "One run", marked_up(answer(study)), failures(study), data,
              script({embedded::timeline_js(), embedded::run_page_js()}));
}

std::string modes_page(const StudyResult& study, const ModesResult& result) {
  Json data = page_data(study);
  Json modes = Json::array();
  for (const Mode& mode : result.spectrum.modes)
    modes.push_back({{"kind", name_of(mode.kind())},
                     {"real", mode.real},
                     {"s", {mode.s.real(), mode.s.imag()}},
                     {"frequency", mode.frequency()},
                     {"damping_ratio", number_or_null(mode.damping_ratio())},
                     {"moves", largest_entries(result, mode)}});
  data["modes"] = std::move(modes);
  data["csv"] = modes_csv(result);
  return page(study, "Small motions", marked_up(modes_in_words(result)), "", data,
              script({embedded::modes_page_js()}));
}

std::string move_page(const StudyResult& study, const MoveResult& result) {
  Json data = page_data(study);
  data["timeline"] = move_charts(result);
  return page(study, "Poses", marked_up(move_in_words(result)), "", data,
              script({embedded::timeline_js(), embedded::run_page_js()}));
}

std::string effort_page(const StudyResult& study, const EffortResult& result) {
  Json data = page_data(study);
  data["timeline"] = effort_charts(result);
  return page(study, result.poses_alone ? "Static balance" : "Inverse dynamics",
              marked_up(effort_in_words(result)), "", data,
              script({embedded::timeline_js(), embedded::run_page_js()}));
}

namespace {

/// A mechanism and, pale, the one before, beside charts.
std::string synthesis_page(const StudyResult& study, const std::string& words, Json charts,
                           const char* title = "Synthesis") {
  Json data = page_data(study);
  data["timeline"] = std::move(charts);
  if (data.contains("picture") && data["picture"].contains("bodies"))
    for (Json& body : data["picture"]["bodies"])
      if (body["name"].get<std::string>().starts_with(before_mark)) body["pale"] = true;
  return page(study, title, marked_up(words), "", data,
              script({embedded::timeline_js(), embedded::run_page_js()}));
}

}  // namespace

std::string fit_page(const StudyResult& study, const FitResult& result, double first) {
  return synthesis_page(study, fit_in_words(result), fit_charts(result, first));
}

std::string least_page(const StudyResult& study, const LeastResult& result, double first) {
  return synthesis_page(study, least_in_words(result), least_charts(result, first));
}

std::string identification_page(const StudyResult& study, const Identification& result) {
  return synthesis_page(study, identification_in_words(result), identification_charts(result),
                        "Identification");
}

std::string view_page(const StudyResult& study, const std::string& words) {
  Json data = page_data(study);
  data["timeline"] = Json::array();
  return page(study, "The mechanism", marked_up(words), "", data,
              script({embedded::timeline_js(), embedded::run_page_js()}));
}

std::string section(const std::string& title, const std::string& inside) {
  return "<section><h2>" + escape_html(title) + "</h2>" + inside + "</section>\n";
}
std::string preformatted(const std::string& text) {
  return "<pre class=\"frame\" tabindex=\"0\">" + escape_html(text) + "</pre>";
}
std::string drawn(const std::string& svg) {
  return "<figure class=\"frame\" tabindex=\"0\">" + svg + "</figure>";
}

std::string how_section(const Environment& environment, const std::string& command) {
  const auto pair = [](const char* what, const std::string& value) {
    return std::string("<dt>") + what + "</dt><dd>" + escape_html(value) + "</dd>";
  };
  std::string versions;
  for (const auto& [name, version] : environment.versions)
    versions += (versions.empty() ? "" : ", ") + name + " " + version;
  return section("How it was made",
                 "<dl>" + pair("Command", command) + pair("Versions", versions) +
                     pair("Compiler", environment.compiler + ", " + environment.flags) +
                     pair("Processor", environment.cpu) + pair("Date", environment.date) + "</dl>");
}

std::string plain_page(const std::string& title, const char* kind, const std::string& answer,
                       const std::string& main) {
  return filled(embedded::stress_html(), {{"title", escape_html(title)},
                                          {"kind", kind},
                                          {"about", kind},
                                          {"answer", answer},
                                          {"main", main},
                                          {"page_css", std::string(embedded::page_css())},
                                          {"stress_css", std::string(embedded::stress_css())}});
}

}  // namespace momenta
