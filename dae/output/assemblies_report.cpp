#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/assemblies_report.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/figure.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/run/motion.h>

#include <algorithm>

namespace momenta {
namespace {

std::string counted(int n, const std::string& what) {
  return std::to_string(n) + " " + what + (n == 1 ? "" : "s");
}

double value_ratio(const FoundAssembly& a) {
  return a.most_value > 0 ? a.least_value / a.most_value : 1;
}

std::string paths_in_words(const PathCount& c) {
  std::string text = ", of " + counted(static_cast<int>(c.finite), "solution") +
                     " over the complex numbers; " + counted(static_cast<int>(c.paths), "path") +
                     ": " + std::to_string(c.finite) + " to these, " + std::to_string(c.infinite) +
                     " to infinity";
  if (c.singular > 0) text += ", " + std::to_string(c.singular) + " to singular solutions";
  if (c.lost > 0) text += ", " + std::to_string(c.lost) + " lost";
  if (c.is_complete())
    return text + ".\nEvery path was followed to its end: there are no others.\n\n";
  return text + ".\nNot complete: " +
         (c.lost > 0 ? "of paths that were lost the ends are not known"
                     : "behind singular solutions there may be assemblies that meet or move") +
         ".\n\n";
}

std::string assembly_name(std::size_t assembly) {
  return assembly == 0 ? "own" : std::to_string(assembly);
}

}  // namespace

std::string assemblies_in_words(const Mechanism& mechanism, const AssembliesRequest& request,
                                const Assemblies& found) {
  std::string text = mechanism.scene().name + ": ";
  text += std::to_string(found.all.size()) + (found.all.size() == 1 ? " assembly" : " assemblies");
  for (std::size_t i = 0; i < request.hold.size(); ++i)
    text += (i == 0 ? " with " : ", ") + request.hold[i];
  text += request.hold.empty() ? "" : " held";
  if (found.paths) return text + paths_in_words(*found.paths);
  text +=
      ", from " + counted(found.starts, "start") + ": " + std::to_string(found.closed) + " closed";
  if (found.turned > 0) text += ", " + std::to_string(found.turned) + " with axes turned";
  text += ", " + std::to_string(found.starts - found.closed - found.turned) + " did not close.\n";
  text += "A search proves no completeness: ";
  if (found.met_once() == 0)
    text += "each was met more than once, or is the scene's own";
  else
    text +=
        std::to_string(found.met_once()) + (found.met_once() == 1 ? " was" : " were") +
        " met once, so that one more start that closes meets a new one with a chance of about " +
        compact(static_cast<double>(found.met_once()) / found.closed, 2);
  return text + ".\n\n";
}

std::string assemblies_table(const Mechanism& mechanism, const Assemblies& found) {
  std::vector<std::vector<std::string>> rows{{"", "met", "apart", "least/largest value"}};
  for (const Column& c : mechanism.coordinate_columns()) rows[0].push_back(c.label());
  for (std::size_t i = 0; i < found.all.size(); ++i) {
    const FoundAssembly& a = found.all[i];
    rows.push_back(
        {assembly_name(i), std::to_string(a.met), compact(a.apart, 4), compact(value_ratio(a), 3)});
    for (const double x : a.q) rows.back().push_back(compact(x, 6));
  }
  return in_columns(rows);
}

std::string assemblies_csv(const Mechanism& mechanism, const Assemblies& found) {
  std::vector<std::string> head{"assembly", "met", "apart", "least_singular_value",
                                "largest_singular_value"};
  for (const Column& c : mechanism.coordinate_columns()) head.push_back(c.label());
  std::string text = csv_line(head);
  for (std::size_t i = 0; i < found.all.size(); ++i) {
    const FoundAssembly& a = found.all[i];
    std::vector<std::string> cells{assembly_name(i), std::to_string(a.met)};
    for (const double x : {a.apart, a.least_value, a.most_value}) cells.push_back(round_trip(x));
    for (const double x : a.q) cells.push_back(round_trip(x));
    text += csv_line(cells);
  }
  return text;
}

nlohmann::ordered_json assemblies_json(const Mechanism& mechanism, const AssembliesRequest& request,
                                       const Assemblies& found) {
  nlohmann::ordered_json j;
  j["scene"] = mechanism.scene().name;
  j["held"] = request.hold;
  j["seed"] = request.seed;
  if (found.paths) {
    const PathCount& c = *found.paths;
    j["paths"] = {{"followed", c.paths},        {"finite", c.finite}, {"infinite", c.infinite},
                  {"singular", c.singular},     {"lost", c.lost},     {"real", c.real},
                  {"complete", c.is_complete()}};
  } else {
    j["starts"] = found.starts;
    j["closed"] = found.closed;
    j["turned"] = found.turned;
    j["met_once"] = found.met_once();
  }
  j["assemblies"] = nlohmann::ordered_json::array();
  const std::vector<Column> columns = mechanism.coordinate_columns();
  for (const FoundAssembly& one : found.all) {
    nlohmann::ordered_json q;
    for (std::size_t i = 0; i < columns.size(); ++i)
      q[columns[i].label()] = one.q[static_cast<Eigen::Index>(i)];
    j["assemblies"].push_back({{"own", j["assemblies"].empty()},
                               {"met", one.met},
                               {"apart", one.apart},
                               {"least_singular_value", one.least_value},
                               {"largest_singular_value", one.most_value},
                               {"q", q}});
  }
  return j;
}

std::string assemblies_page(const Mechanism& mechanism, const AssembliesRequest& request,
                            const Assemblies& found, const Environment& environment,
                            const std::string& command) {
  std::string pictures;
  const bool drawn =
      !mechanism.scene().lagrangian && mechanism.scene().bodies.size() <= most_bodies_drawn;
  if (drawn) {
    Film film;
    for (std::size_t i = 0; i < std::min(found.all.size(), most_assemblies_drawn); ++i)
      film.frames.emplace_back(found.all[i].q.begin(), found.all[i].q.end());
    const Picture picture = picture_of(mechanism);
    const Motion motion = motion_of(mechanism, film);
    for (std::size_t i = 0; i < motion.frames.size(); ++i)
      pictures += "<figure><figcaption>" + assembly_name(i) + "</figcaption>" +
                  mechanism_svg(picture, motion.frames[i]) + "</figure>\n";
  }
  const std::string style =
      "<style>.beside { display: grid; gap: 16px; grid-template-columns: "
      "repeat(auto-fill, minmax(min(300px, 100%), 1fr)); }\n"
      ".beside figure { margin: 0; } .beside svg { width: 100%; height: auto; background: #fff; }"
      "</style>\n";
  std::string words = assemblies_in_words(mechanism, request, found);
  while (words.ends_with('\n')) words.pop_back();
  std::string main;
  if (!pictures.empty())
    main += section("Assemblies", style + "<div class=\"beside\">" + pictures + "</div>");
  if (drawn && found.all.size() > most_assemblies_drawn)
    main += "<p>The " + std::to_string(most_assemblies_drawn) +
            " nearest to the own one are drawn.</p>";
  main += section("Coordinates", preformatted(assemblies_table(mechanism, found)));
  return plain_page(mechanism.scene().name, "assemblies", escape_html(words),
                    main + how_section(environment, command));
}

}  // namespace momenta
