#include <momenta/core/format/mjcf/mjcf_defaults.h>
#include <momenta/core/format/mjcf/mjcf_frames.h>
#include <momenta/core/text/quoting.h>

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

namespace {

bool is_orientation(const std::string& name) {
  return std::find(orientation_keys.begin(), orientation_keys.end(), name) !=
         orientation_keys.end();
}

/// `over` written over `under`.
std::vector<Attribute> overlaid(std::vector<Attribute> under, const std::vector<Attribute>& over) {
  const bool turned = std::any_of(over.begin(), over.end(),
                                  [](const Attribute& a) { return is_orientation(a.name); });
  if (turned) std::erase_if(under, [](const Attribute& a) { return is_orientation(a.name); });
  for (const Attribute& a : over) {
    const auto same = std::find_if(under.begin(), under.end(),
                                   [&](const Attribute& b) { return b.name == a.name; });
    if (same == under.end())
      under.push_back(a);
    else
      same->text = a.text;
  }
  return under;
}

}  // namespace

void MjcfDefaults::take(const Node& node) {
  const std::string name = node.text("class", main_class);
  take(node, main_class);
  if (name != main_class) classes_[name] = classes_[main_class];
}

void MjcfDefaults::take(const MjcfDefaults& attached, const std::string& prefix) {
  for (const auto& [name, attributes] : attached.classes_) classes_[prefix + name] = attributes;
}

void MjcfDefaults::take(const Node& node, const std::string& name) {
  for (const Node& part : node.children())
    if (part.name() != "default") {
      Attributes& all = classes_[name][part.name()];
      all = overlaid(all, part.element().attributes);
    }
  for (const Node& nested : node.children("default")) {
    const std::string inner = nested.text("class");
    if (classes_.contains(inner))
      nested.fail("class", "is " + in_quotes(inner) + " once more, expected each class once");
    classes_[inner] = classes_[name];
    take(nested, inner);
  }
}

auto MjcfDefaults::known(const Node& node, const char* attribute, const std::string& name) const
    -> const Class& {
  if (const auto found = classes_.find(name); found != classes_.end()) return found->second;
  std::vector<std::string_view> names;
  for (const auto& entry : classes_) names.push_back(entry.first);
  node.fail(attribute, "is " + in_quotes(name) + ", expected a class of <default>" +
                           did_you_mean(name, names));
}

Element MjcfDefaults::with_defaults(const Node& node, const std::string& kind,
                                    const std::string& active) const {
  Element element = node.element();
  const Class& from = known(node, "class", node.text("class", active));
  if (const auto found = from.find(kind); found != from.end())
    element.attributes = overlaid(found->second, element.attributes);
  return element;
}

std::string MjcfDefaults::active_class(const Node& body, const std::string& around) const {
  if (!body.has("childclass")) return around;
  const std::string name = body.text("childclass");
  known(body, "childclass", name);
  return name;
}

}  // namespace momenta::reading
