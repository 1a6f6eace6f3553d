#include <momenta/core/scene/mjcf/mjcf_settings.h>
#include <momenta/core/text/near_name.h>

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
  settings.exact_meshes = node.flag("exactmeshinertia", settings.exact_meshes);
  settings.bare_names = node.flag("strippath", settings.bare_names);
  for (const char* key : {"boundmass", "boundinertia"})
    if (node.number(key, 0) != 0) node.fail(key, "changes inertias, expected none");
  if (node.number("settotalmass", -1) > 0)
    node.fail("settotalmass", "changes masses, expected none");
  if (node.flag("balanceinertia", false)) node.fail("balanceinertia", "is true, expected false");
  if (node.text("coordinate", "local") != "local")
    node.fail("coordinate", "is not local, expected frames in their parents");
}

}  // namespace momenta::reading
