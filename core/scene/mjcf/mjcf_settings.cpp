#include <momenta/core/scene/mjcf/mjcf_settings.h>
#include <momenta/core/text/near_name.h>

#include <algorithm>

namespace momenta::reading {

void read_compiler(const Node& node, MjcfSettings& settings) {
  constexpr std::array<std::string_view, 2> units{"degree", "radian"};
  if (node.has("angle"))
    settings.angles.unit = node.word("angle", units, 0) == 1 ? 1 : std::numbers::pi / 180;
  if (node.has("eulerseq")) {
    const std::string order = node.text("eulerseq");
    if (order.size() != 3 || order.find_first_not_of("xyzXYZ") != std::string::npos)
      node.fail("eulerseq", "is " + in_quotes(order) + ", expected three of x y z X Y Z");
    settings.angles.euler_order = order;
  }
  constexpr std::array<std::string_view, 3> sources{"auto", "false", "true"};
  if (node.has("inertiafromgeom")) {
    const std::size_t source = node.word("inertiafromgeom", sources, 0);
    settings.geoms_weigh = source != 1;
    settings.always_geoms = source == 2;
  }
  if (node.has("inertiagrouprange")) {
    const std::vector<double> range = node.numbers("inertiagrouprange", 2);
    settings.least_group = range[0];
    settings.largest_group = range[1];
  }
  if (node.has("assetdir")) settings.meshes = node.text("assetdir", "");
  if (node.has("meshdir")) settings.meshes = node.text("meshdir", "");
  settings.auto_limits = node.flag("autolimits", settings.auto_limits);
  settings.exact_meshes = node.flag("exactmeshinertia", settings.exact_meshes);
  settings.bare_names = node.flag("strippath", settings.bare_names);
  settings.least_mass = node.number("boundmass", settings.least_mass);
  settings.least_moment = node.number("boundinertia", settings.least_moment);
  settings.balances = node.flag("balanceinertia", settings.balances);
  settings.total_mass = std::max(0.0, node.number("settotalmass", settings.total_mass));
  if (node.text("coordinate", "local") != "local")
    node.fail("coordinate", "is not local, expected frames in their parents");
}

}  // namespace momenta::reading
