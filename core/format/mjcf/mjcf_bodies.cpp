// <worldbody>: nested bodies. A body with several joints becomes a chain of joints and massless
// bodies, all with the body's frame at zero; q of a hinge or slide counts from its `ref`.

#include <momenta/core/format/mjcf/mjcf_inertia.h>
#include <momenta/core/format/mjcf/mjcf_parts.h>
#include <momenta/core/format/mjcf/mjcf_visuals.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;

constexpr std::array<std::string_view, 4> joint_types{"hinge", "slide", "ball", "free"};
constexpr std::array kind_of_type{JointKind::revolute, JointKind::prismatic, JointKind::spherical,
                                  JointKind::free};

/// The place of a body in the tree.
struct Place {
  std::string parent;  ///< name in the file
  MjcfFrame at;        ///< frame of the parent at qpos0
  std::string active;  ///< class of defaults
  bool moves = false;  ///< some joint lies between the parent and the ground
};

class BodyReader {
 public:
  explicit BodyReader(MjcfModel& model) : model_(model) {}

  void children_of(const Node& node, const Place& place) {
    children_of(parts_of(node, place.active, model_), place);
  }

 private:
  void children_of(const std::vector<MjcfPart>& parts, const Place& place) {
    for (const MjcfPart& part : parts) {
      const SettingsOf settings(part, model_);
      const std::string& what = part.node.name();
      if (what == "body")
        body(part, place);
      else if (what == "site")
        site(part, place);
      else if (what == "geom")
        draw_geom(part, MjcfModel::in_scene(place.parent), model_);
      else if (what == "camera" || what == "light")
        model_.remarks.left_out(what + "s");
    }
  }

  void site(const MjcfPart& part, const Place& place) {
    const Node& node = part.node;
    const Element full = model_.defaults.with_defaults(node, "site", part.active);
    const std::string name = node.text("name", "");
    const Node site(full, "site " + in_quotes(name), model_.scene.file);
    if (name.empty()) return;
    const auto [known, fresh] = model_.sites.emplace(
        name, MjcfModel::Site{place.parent, part.in * read_frame(site, model_.angles)});
    if (!fresh) site.fail("has a name that is taken, expected each name once among sites");
  }

  void body(const MjcfPart& part, const Place& place) {
    const Node& node = part.node;
    ++count_;
    const bool named = node.has("name");
    const std::string name =
        named ? node.text("name") : model_.bodies.free("body" + std::to_string(count_));
    const Node self = node.of("body " + in_quotes(name));
    if (name == "world") self.fail("has the name of the ground, expected another");
    if (named) model_.bodies.take(name);

    Place inside{name, {}, model_.defaults.active_class(self, part.active), place.moves};
    const MjcfFrame frame =
        part.in * MjcfFrame{self.vector("pos", Vector3d::Zero()), read_turn(self, model_.angles)};
    inside.at = place.at * frame;
    if (!model_.frames.emplace(name, inside.at).second)
      self.fail("has a name that is taken, expected each name once among bodies");
    const std::vector<MjcfPart> parts = parts_of(self, inside.active, model_);
    std::vector<MjcfPart> joints;
    for (const MjcfPart& inner : parts)
      if (inner.node.name() == "joint" || inner.node.name() == "freejoint") joints.push_back(inner);
    inside.moves |= !joints.empty();

    BodySpec spec;
    spec.name = name;
    spec.at = self.at();
    weigh_body(spec, self, parts, frame, inside);
    hang(self, joints, frame, place, inside);
    model_.scene.bodies.push_back(spec);
    const double lifted = self.number("gravcomp", 0);
    if (lifted != 0 && inside.moves && (model_.springs || model_.dampers))
      take_back_weight(name, spec.com, lifted * spec.mass, self.at(), model_.scene);
    if (self.flag("mocap", false)) model_.remarks.count("left at rest: bodies of motion capture");
    children_of(parts, inside);
  }

  void weigh_body(BodySpec& spec, const Node& self, const std::vector<MjcfPart>& parts,
                  const MjcfFrame& frame, const Place& inside) {
    const auto inertial = self.child("inertial");
    MjcfInertia sum;
    if (inertial && !model_.always_geoms) {
      sum = read_inertial(*inertial, model_.angles);
    } else if (model_.geoms_weigh) {
      for (const MjcfPart& part : parts) {
        if (part.node.name() != "geom") continue;
        const SettingsOf settings(part, model_);
        const Element full = model_.defaults.with_defaults(part.node, "geom", part.active);
        const Node geom(full, self.owner(), model_.scene.file);
        const double group = geom.number("group", 0);
        if (group < model_.least_group || group > model_.largest_group) continue;
        const bool counts = inside.moves || model_.total_mass > 0;
        sum.add(part.in * read_geom(geom, model_.angles, !counts, model_.meshes, model_.remarks));
      }
    }
    if (sum.mass == 0 && inertial) sum = read_inertial(*inertial, model_.angles);
    if (sum.mass == 0 && !inertial) sum.com = frame.at;  // MuJoCo puts raised masses there
    sum = bounded(sum, model_);
    weigh(spec, sum.mass, sum.com, sum.inertia, inertial ? *inertial : self, model_.remarks);
  }

  /// Adds the joints between a body and its parent, the first next to the parent; none: a weld.
  void hang(const Node& self, const std::vector<MjcfPart>& joints, const MjcfFrame& frame,
            const Place& place, const Place& inside) {
    std::string parent = MjcfModel::in_scene(place.parent);
    if (joints.empty()) {
      JointSpec weld;
      weld.at = self.at();
      weld.kind = JointKind::weld;
      weld.name = model_.edges.free(inside.parent + " weld");
      weld.parent = parent;
      weld.child = inside.parent;
      weld.origin_parent = frame.at;
      weld.rotation = frame.turn;
      model_.scene.joints.push_back(weld);
    }
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const bool first = i == 0, last = i + 1 == joints.size();
      const Node& tag = joints[i].node;
      const SettingsOf settings(joints[i], model_);
      const bool free_tag = tag.name() == "freejoint";
      const Element full =
          free_tag ? tag.element() : model_.defaults.with_defaults(tag, "joint", joints[i].active);
      const Node written(full, self.owner(), model_.scene.file);
      const std::size_t type = free_tag ? 3 : written.word("type", joint_types, 0);
      JointSpec joint;
      joint.at = written.at();
      joint.kind = kind_of_type[type];
      joint.name = written.has("name")
                       ? written.text("name")
                       : model_.edges.free(inside.parent + " " + std::string(joint_types[type]));
      if (written.has("name")) model_.edges.take(joint.name);
      const Node node(full, "joint " + in_quotes(joint.name), model_.scene.file);
      joint.parent = parent;
      joint.child = last ? inside.parent : model_.bodies.free(inside.parent + " at " + joint.name);
      if (joint.kind == JointKind::free) {
        if (place.parent != "world" || joints.size() > 1)
          node.fail("is free, expected such a joint alone, on a body of the world");
        const Eigen::Quaterniond& q = inside.at.turn;
        const Vector3d& x = inside.at.at;
        joint.position = {x[0], x[1], x[2], q.w(), q.x(), q.y(), q.z()};
      } else {
        const Vector3d anchor = joints[i].in * node.vector("pos", Vector3d::Zero());
        joint.origin_child = anchor;
        joint.origin_parent = first ? frame * anchor : anchor;
        if (first) joint.rotation = frame.turn;
      }
      read_mechanics(node, joint, model_);
      if (has_axis(joint.kind)) joint.axis = joints[i].in.turn * joint.axis;
      if (!model_.from_attached.empty())
        model_.joint_of_attached[joint.name] = model_.from_attached;
      model_.refs[joint.name] =
          node.number("ref", 0) * (joint.kind == JointKind::revolute ? model_.angles.unit : 1);
      if (!last) {
        BodySpec between;
        between.name = joint.child;
        between.at = joint.at;
        model_.scene.bodies.push_back(between);
      }
      parent = joint.child;
      model_.scene.joints.push_back(joint);
    }
  }

  MjcfModel& model_;
  int count_ = 0;  ///< bodies so far: names those without a name
};

}  // namespace

void read_worldbody(const Node& world, MjcfModel& model) {
  BodyReader(model).children_of(world,
                                {"world", {}, model.defaults.active_class(world, "main"), false});
}

}  // namespace momenta::reading
