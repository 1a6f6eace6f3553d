// <tendon>: a fixed tendon is a sum of joint coordinates, L = Σ coef q; with stiffness or damping
// it is a coordinate spring. A spatial tendon between two sites is a spring-damper. The scene's L
// counts from qpos0: L_file − Σ coef ref. Without `springlength` a spring rests with every joint at
// its `springref`; with two lengths it has a dead band between them.

#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>

namespace momenta::reading {
namespace {

class TendonReader {
 public:
  TendonReader(const Node& node, MjcfModel& model)
      : node_(node),
        model_(model),
        stiffness_(model.springs ? node.number("stiffness", 0) : 0),
        damping_(model.dampers ? node.number("damping", 0) : 0) {}

  void read() {
    if (node_.number("armature", 0) != 0)
      node_.fail("armature", "is not zero, expected a tendon without inertia");
    if (node_.number("frictionloss", 0) != 0) model_.remarks.left_out("friction of tendons");
    const MjcfModel::Tendon tendon = node_.name() == "fixed" ? fixed() : spatial();
    const std::string name = node_.text("name", "");
    if (!name.empty() && !model_.tendons.emplace(name, tendon).second)
      node_.fail("has a name that is taken, expected each name once among tendons");
  }

 private:
  bool acts() const { return stiffness_ != 0 || damping_ != 0; }
  bool limited() const {
    constexpr std::array<std::string_view, 3> words{"auto", "false", "true"};
    const std::size_t limited = node_.word("limited", words, 0);
    return model_.limits && node_.has("range") && limited != 1 &&
           (limited == 2 || model_.auto_limits);
  }
  /// Takes `range`, counted from `shift`.
  void limits(double shift, ForceSpec& f) const {
    if (!limited()) return;
    const std::vector<double> range = node_.numbers("range", 2);
    if (!(range[0] < range[1]))
      node_.fail("range",
                 "has its first number not below its second, expected limits of the tendon");
    f.limits = {range[0] - shift, range[1] - shift};
  }

  /// Takes `springlength` less `shift`; default: `otherwise`, the length at the springrefs.
  void rest(double shift, double otherwise, ForceSpec& f) {
    f.rest = otherwise;
    if (!node_.has("springlength")) return;
    const std::vector<double> x = node_.numbers("springlength");
    if (x.empty() || x.size() > 2 || x.back() < x.front())
      node_.fail("springlength",
                 "is no length and no two, expected one, or the least and the "
                 "largest without force");
    if (x[0] == -1 && x.back() == -1) return;
    f.rest = x[0] - shift;
    f.dead_band = x.back() - x[0];
    if (f.dead_band > 0 && f.stiffness != 0)
      model_.remarks.count("taken with corners rounded over a twentieth: dead bands of tendons");
  }

  ForceSpec force(const char* kind) const {
    ForceSpec f;
    f.at = node_.at();
    f.kind = kind;
    f.name = node_.text("name", "");
    f.stiffness = stiffness_;
    f.damping = damping_;
    return f;
  }

  MjcfModel::Tendon fixed() {
    MjcfModel::Tendon tendon;
    tendon.at = node_.at();
    for (const Node& part : node_.children()) {
      if (part.name() != "joint") part.fail("is not read in a fixed tendon, expected joint");
      const std::string joint = coordinate_of(part, "joint", model_);
      const double coef = part.number("coef");
      if (coef == 0) continue;
      tendon.ratios[joint] += coef;
      if (const auto ref = model_.refs.find(joint); ref != model_.refs.end())
        tendon.ref += coef * ref->second;
    }
    std::erase_if(tendon.ratios, [](const auto& term) { return term.second == 0; });
    if ((!acts() && !limited()) || tendon.ratios.empty()) return tendon;
    ForceSpec f = force("coordinate-spring");
    for (const auto& [joint, ratio] : tendon.ratios) {
      f.joints.push_back(joint);
      f.ratios.push_back(ratio);
    }
    double at_springrefs = 0;
    for (const auto& [joint, ratio] : tendon.ratios)
      if (const auto at = model_.rests.find(joint); at != model_.rests.end())
        at_springrefs += ratio * at->second;
    rest(tendon.ref, at_springrefs, f);
    limits(tendon.ref, f);
    model_.scene.forces.push_back(f);
    return tendon;
  }

  /// Frame of a body with every joint at its springref.
  MjcfFrame at_rest(const std::string& body) const {
    MjcfFrame frame;
    std::string name = body;
    while (name != "world" && name != "ground") {
      const auto joint = std::find_if(model_.scene.joints.begin(), model_.scene.joints.end(),
                                      [&](const JointSpec& j) { return j.child == name; });
      const JointSpec& j = *joint;
      const auto rest = model_.rests.find(j.name);
      const double q = rest == model_.rests.end() ? 0 : rest->second;
      MjcfFrame moved;
      if (j.kind == JointKind::revolute)
        moved.turn = Eigen::AngleAxisd(q, j.axis);
      else if (j.kind == JointKind::prismatic)
        moved.at = q * j.axis;
      else if (j.kind == JointKind::free)
        moved = {{j.position[0], j.position[1], j.position[2]},
                 Eigen::Quaterniond(j.position[3], j.position[4], j.position[5], j.position[6])};
      frame = MjcfFrame{j.origin_parent, j.rotation} * moved *
              MjcfFrame{-j.origin_child, Eigen::Quaterniond::Identity()} * frame;
      name = j.parent;
    }
    return frame;
  }

  MjcfModel::Tendon spatial() {
    MjcfModel::Tendon tendon;
    tendon.at = node_.at();
    std::vector<const MjcfModel::Site*> sites;
    for (const Node& part : node_.children()) {
      if (part.name() == "site") {
        const std::string name = part.text("site");
        const auto found = model_.sites.find(name);
        if (found == model_.sites.end())
          part.fail("site", "is " + in_quotes(name) + ", expected the name of a <site>");
        sites.push_back(&found->second);
      } else if (acts()) {
        part.fail("is not read in a tendon with stiffness or damping, expected two sites alone");
      }
    }
    if (sites.size() != 2) {
      if (acts())
        node_.fail("has stiffness or damping and goes by " + std::to_string(sites.size()) +
                   " sites, expected two: a spring here is straight");
      if (limited()) model_.remarks.left_out("limits of tendons by more than two sites");
      model_.remarks.left_out("spatial tendons without spring or damper");
      return tendon;
    }
    tendon.ends = {*sites[0], *sites[1]};
    if (!acts() && !limited()) {
      if (!model_.held_tendons.contains(node_.text("name", "")))
        model_.remarks.left_out("spatial tendons without spring or damper");
      return tendon;
    }
    const auto place = [&](const MjcfModel::Site& s) { return at_rest(s.body) * s.frame.at; };
    const MjcfModel::Site *one = sites[0], *two = sites[1];
    if (one->body == two->body) return tendon;  // of constant length
    const double length = (place(*one) - place(*two)).norm();
    if (two->body == "world") std::swap(one, two);
    ForceSpec f = force("spring-damper");
    f.parent = MjcfModel::in_scene(one->body);
    f.child = MjcfModel::in_scene(two->body);
    f.origin_parent = one->frame.at;
    f.origin_child = two->frame.at;
    rest(0, length, f);
    limits(0, f);
    model_.scene.forces.push_back(f);
    return tendon;
  }

  const Node& node_;
  MjcfModel& model_;
  double stiffness_, damping_;
};

}  // namespace

std::string coordinate_of(const Node& node, const char* key, const MjcfModel& model) {
  const std::string name = node.text(key);
  for (const JointSpec& j : model.scene.joints)
    if (j.name == name) {
      if (has_one_coordinate(j.kind)) return name;
      node.fail(key, "is " + in_quotes(name) + ", expected a hinge or a slide");
    }
  node.fail(key, "is " + in_quotes(name) + ", expected the name of a joint");
}

void read_tendons(const Node& tendons, MjcfModel& model) {
  for (const Node& part : tendons.children()) {
    const std::string& kind = part.name();
    if (kind != "fixed" && kind != "spatial")
      part.of("tendon").fail("is not read, expected fixed or spatial");
    const Element full = model.defaults.with_defaults(part, "tendon", MjcfDefaults::main_class);
    const std::string name = part.text("name", "");
    const Node node(full, name.empty() ? std::string("tendon") : "tendon " + in_quotes(name),
                    model.scene.file);
    TendonReader(node, model).read();
  }
}

}  // namespace momenta::reading
