#include <momenta/core/text/number_text.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/output/run_label.h>

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace momenta {

namespace {

std::array<std::string, 5> details(const RunSettings& s) {
  return {s.integrator, s.gauge, tolerance_text(s), s.project ? "projected" : "", s.kkt};
}

}  // namespace

std::string tolerance_text(const RunSettings& s) {
  if (s.step > 0) return "h = " + compact(s.step, 4) + " s";
  const std::string relative = scientific(s.rtol, 3);
  return s.rtol == s.atol ? relative : relative + '/' + scientific(s.atol, 3);
}

std::vector<std::string> run_labels(const StudyResult& study, bool with_tolerance) {
  const auto& runs = study.runs;
  std::vector<std::string> labels;
  for (const RunResult& run : runs) {
    const auto own = details(run.settings);
    std::string label = run.settings.form;
    for (std::size_t k = 0; k < own.size(); ++k) {
      const bool differs = std::any_of(runs.begin(), runs.end(), [&](const RunResult& other) {
        return other.settings.form == run.settings.form && details(other.settings)[k] != own[k];
      });
      if (differs && !own[k].empty() && (with_tolerance || k != 2)) {
        label += ", ";
        if (k == 1 && own[k] == "none") label += "gauge ";
        label += own[k];
      }
    }
    labels.push_back(label);
  }
  return labels;
}

std::vector<std::size_t> ladders(const StudyResult& study) {
  const auto key = [](const RunResult& run) {
    const RunSettings& s = run.settings;
    return std::tie(s.form, s.integrator, s.gauge, s.project);
  };
  std::vector<std::size_t> first(study.runs.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::size_t j = 0;
    while (key(study.runs[j]) != key(study.runs[i])) ++j;
    first[i] = j;
  }
  return first;
}

std::vector<std::size_t> runs_with_curves(const StudyResult& study) {
  const auto first = ladders(study);
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    if (study.drift_study || first[i] == i) drawn.push_back(i);
  }
  return drawn;
}

namespace {

const std::array<std::vector<double>, 6> dashes{
    {{}, {9, 5}, {2, 4}, {12, 4, 2, 4}, {16, 6}, {2, 8}}};
constexpr std::array<const char*, 6> markers{"circle",  "square", "triangle",
                                             "diamond", "plus",   "star"};

/// Where the form chooses its colour.
int place(const std::string& form) {
  const FormEntry* known = find_form(form);
  return known ? known->place : FormEntry().place;
}

template <class List>
void add_once(List& list, const std::string& name) {
  if (std::find(list.begin(), list.end(), name) == list.end()) list.push_back(name);
}

}  // namespace

std::vector<Sign> signs_of(const StudyResult& study) {
  std::vector<std::string> forms, integrators;
  for (const RunResult& run : study.runs) {
    add_once(forms, run.settings.form);
    add_once(integrators, run.settings.integrator);
  }
  std::stable_sort(forms.begin(), forms.end(),
                   [](const std::string& a, const std::string& b) { return place(a) < place(b); });
  std::array<std::size_t, palette.size()> uses{};
  std::map<std::string, std::pair<int, std::size_t>> colour_and_round;
  for (const std::string& form : forms) {
    const FormEntry* entry = find_form(form);
    const bool known = entry && entry->colour >= 0;
    auto colour = static_cast<std::size_t>(known ? entry->colour : 0);
    const auto least = std::min_element(uses.begin(), uses.end());
    if (uses[colour] > 0 && (*least == 0 || !known))
      colour = static_cast<std::size_t>(least - uses.begin());
    colour_and_round[form] = {static_cast<int>(colour), uses[colour]++};
  }
  const auto ladder = ladders(study);
  std::map<std::string, std::size_t> variants;
  std::vector<Sign> signs(study.runs.size());
  for (std::size_t i = 0; i < signs.size(); ++i) {
    if (ladder[i] != i && !study.drift_study) {
      signs[i] = signs[ladder[i]];
      continue;
    }
    const RunSettings& s = study.runs[i].settings;
    const std::size_t variant = variants[s.form + " " + s.integrator]++;
    const auto [colour, round] = colour_and_round[s.form];
    const auto marker = static_cast<std::size_t>(
        std::find(integrators.begin(), integrators.end(), s.integrator) - integrators.begin());
    signs[i] = {colour, dashes[(round + 2 * variant) % dashes.size()],
                markers[marker % markers.size()]};
  }
  return signs;
}

Sign sign_in_turn(std::size_t i) {
  return {static_cast<int>(i % palette.size()), dashes[i / palette.size() % dashes.size()],
          "circle"};
}

}  // namespace momenta
