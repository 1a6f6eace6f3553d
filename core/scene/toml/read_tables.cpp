// [[marker]], [[event]], [run].

#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/scene/toml/read_tables.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>
#include <cmath>

namespace momenta::reading {

MarkerSpec read_marker(const Fields& table) {
  table.allow({"name", "body", "point"});
  MarkerSpec marker;
  marker.at = table.at();
  marker.name = table.text("name");
  marker.body = table.text("body");
  marker.point = table.vector("point", {"m"}, marker.point);
  return marker;
}

EventSpec read_event(const Fields& table) {
  table.allow({"name", "when", "direction", "stop"});
  EventSpec event;
  event.at = table.at();
  event.name = table.text("name", "");
  if (table.has("name") && event.name.empty())
    table.fail_key("name", "is empty, expected a name or no such key");
  event.when.text = table.text("when");
  event.when.at = table.find("when")->at;
  if (table.has("direction"))
    event.direction = event_directions[read_kind(table, event_directions, "direction")];
  event.stop = table.flag("stop", false);
  return event;
}

RunDefaults read_run(const Fields& table) {
  table.allow({"end", "step", "leak", "samples", "project"});
  RunDefaults run;
  run.end_time = table.number("end", {"s", Bound::positive}, run.end_time);
  if (table.has("step")) run.step = table.number("step", {"s", Bound::positive});
  if (table.has("leak")) run.leak = table.number("leak", {"1/s", Bound::positive});
  run.samples = table.count("samples", run.samples);
  run.project = table.flag("project", run.project);
  return run;
}

}  // namespace momenta::reading
