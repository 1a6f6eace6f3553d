#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/given_motion.h>
#include <momenta/dae/analysis/linear/linear_columns.h>
#include <momenta/dae/analysis/linear/loop_drives.h>
#include <momenta/dae/run/measure/rank.h>

#include <algorithm>
#include <utility>

namespace momenta {
namespace {

std::string before_point(const std::string& name) {
  return name.substr(0, name.rfind('.'));
}

std::vector<Column> among(const std::vector<Column>& all, const std::vector<int>& places) {
  std::vector<Column> some;
  for (const int i : places) some.push_back(all[static_cast<std::size_t>(i)]);
  return some;
}

void add(std::vector<Column>& to, const std::vector<Column>& more) {
  to.insert(to.end(), more.begin(), more.end());
}
void add(std::vector<GroupedColumn>& to, const std::vector<Column>& more, const char* group) {
  for (const Column& c : more) to.push_back({c, group});
}

[[noreturn]] void refuse_unknown(const std::string& what, const std::string& name,
                                 const std::vector<std::string>& known) {
  const std::vector<std::string_view> views(known.begin(), known.end());
  throw SceneError(
      what + " " + reading::in_quotes(name) + " is not known; expected " +
      (known.empty() ? "none, for the model has no " + what : reading::all_in_quotes(known, 12)) +
      reading::did_you_mean(name, views));
}

}  // namespace

LinearColumns linear_columns(const OperatingPoint& at, const IndependentCoordinates& chosen) {
  const Mechanism& m = *at.freed;
  const std::vector<Column> places = displacement_columns(m), rates = m.rate_columns(),
                            forces = force_columns_of(m), rows = m.multiplier_columns();
  std::vector<Column> accelerations;
  for (const Column& rate : rates) accelerations.push_back(acceleration_column(rate));
  LinearColumns c;
  c.free = at.free;
  c.minimal = among(places, chosen.free_positions);
  add(c.minimal, among(rates, chosen.free_rates));
  for (const std::vector<Column>* all : {&places, &rates, &std::as_const(accelerations)})
    add(c.descriptor, among(*all, at.free));
  add(c.descriptor, among(rows, chosen.rows));
  add(c.inputs, among(forces, at.free), "efforts");
  std::vector<Column> drives, efforts;
  for (const int i : at.driven) {
    const auto k = static_cast<std::size_t>(i);
    const std::string name = places[k].name;  // "O.q", "J.q2"
    drives.push_back({name, places[k].unit});
    drives.push_back(rates[k]);
    drives.push_back(accelerations[k]);
    efforts.push_back(
        {before_point(name) + ".effort" + name.substr(name.rfind('.') + 2), forces[k].unit});
  }
  for (const int drive : chosen.loop_drives) add(drives, columns_of_loop_drive(m.scene(), drive));
  add(c.inputs, drives, "drives");
  add(c.outputs, among(places, at.free), "coordinates");
  add(c.outputs, among(rates, at.free), "rates");
  add(c.outputs, among(accelerations, at.free), "accelerations");
  add(c.outputs, m.marker_columns(), "markers");
  add(c.outputs, efforts, "efforts");
  std::vector<int> unique;
  for (int i = 0; i < m.m(); ++i)
    if (chosen.unique[static_cast<std::size_t>(i)]) unique.push_back(i);
  add(c.outputs, among(rows, unique), "multipliers");
  for (const int row : chosen.left_out) c.left_out.push_back(row_in_words(m, row));
  return c;
}

std::vector<int> picked(const std::vector<GroupedColumn>& columns,
                        const std::vector<std::string>& names, const std::string& what) {
  std::vector<int> places;
  std::vector<std::string> known;
  for (const GroupedColumn& c : columns)
    for (const std::string& name : {c.group, before_point(c.column.name), c.column.name})
      if (std::find(known.begin(), known.end(), name) == known.end()) known.push_back(name);
  if (names.empty())
    for (std::size_t i = 0; i < columns.size(); ++i) places.push_back(static_cast<int>(i));
  for (const std::string& name : names) {
    const std::size_t before = places.size();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto& [column, group] = columns[i];
      if (name != column.name && name != group && name != before_point(column.name)) continue;
      if (std::find(places.begin(), places.end(), static_cast<int>(i)) != places.end())
        throw SceneError(what + " " + reading::in_quotes(column.name) +
                         " is chosen twice; expected each once");
      places.push_back(static_cast<int>(i));
    }
    if (places.size() == before) refuse_unknown(what, name, known);
  }
  return places;
}

std::vector<int> independent_places(const OperatingPoint& at,
                                    const std::vector<std::string>& names) {
  const std::vector<Column> all = displacement_columns(*at.freed);
  std::vector<int> places;
  for (const std::string& name : names) {
    const auto found = std::find_if(at.free.begin(), at.free.end(), [&](int i) {
      const std::string& column = all[static_cast<std::size_t>(i)].name;
      return name == column || (name == before_point(column) && column.ends_with(".q"));
    });
    if (found == at.free.end()) {
      std::vector<std::string> known;
      for (const int i : at.free) known.push_back(all[static_cast<std::size_t>(i)].name);
      refuse_unknown("independent coordinate", name, known);
    }
    if (std::find(places.begin(), places.end(), *found) != places.end())
      throw SceneError("independent coordinate " + reading::in_quotes(name) +
                       " is chosen twice; expected each once");
    places.push_back(*found);
  }
  return places;
}

}  // namespace momenta
