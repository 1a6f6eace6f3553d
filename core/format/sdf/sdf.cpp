// <sdf>: worlds, models and links. Frames and links of all models are taken first, then joints,
// which may name any.

#include <momenta/core/format/sdf/sdf.h>
#include <momenta/core/format/sdf/sdf_model.h>
#include <momenta/core/format/xml/known_elements.h>
#include <momenta/core/scene/validate.h>
#include <momenta/core/text/quoting.h>

namespace momenta::reading {
namespace {

using Scoped = std::pair<std::string, Node>;

/// Elements that are read once all frames are known.
struct Waiting {
  std::vector<Scoped> joints;  ///< with their scopes
  std::vector<Scoped> links,
      canonical;  ///< links with full names; models that name their canonical link
};

Node called(const Node& node, const char* title) {
  const std::string* name = node.element().find("name");
  return node.of(std::string(title) + " " + in_quotes(name ? *name : "without a name"));
}

/// @returns whether the flag is there and set
bool flagged(const Node& node, const char* name) {
  const auto flag = node.child(name);
  return flag && flag->content_flag();
}

void refuse(const Node& node, std::initializer_list<const char*> names, const char* expected) {
  for (const char* name : names)
    if (const auto found = node.children(name); !found.empty())
      found.front().fail("is not read, expected " + std::string(expected));
}

void weigh_link(const Node& link, BodySpec& body, Remarks& remarks) {
  const auto inertial = link.child("inertial");
  if (!inertial) {
    weigh(body, 1, Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), link, remarks);
    remarks.count("taken as SDF has it: 1 kg and 1 kg m² of links without <inertial>");
    return;
  }
  if (inertial->flag("auto", false))
    inertial->fail("auto", "is true, expected a mass and an inertia");
  refuse(*inertial, {"fluid_added_mass"}, "the inertia of the link alone");
  if (const std::string frame = relative_to(*inertial, ""); !frame.empty())
    inertial->required("pose").fail("relative_to", "is " + in_quotes(frame) + ", expected none");
  const Pose pose = read_pose(*inertial);
  const auto mass = inertial->child("mass"), moments = inertial->child("inertia");
  const auto entry = [&](const char* name, double otherwise) {
    const auto node = moments ? moments->child(name) : std::nullopt;
    return node ? node->content_number() : otherwise;
  };
  Eigen::Matrix3d inertia = symmetric(entry("ixx", 1), entry("iyy", 1), entry("izz", 1),
                                      entry("ixy", 0), entry("ixz", 0), entry("iyz", 0));
  const Eigen::Matrix3d turn = pose.turn.toRotationMatrix();
  if (turn != Eigen::Matrix3d::Identity()) {
    const Eigen::Matrix3d turned = turn * inertia * turn.transpose();
    inertia = 0.5 * (turned + turned.transpose());
  }
  weigh(body, mass ? mass->content_number() : 1, pose.origin, inertia, mass ? *mass : *inertial,
        remarks);
}

void read_link(const Scoped& scoped, SdfModel& model) {
  const auto& [name, link] = scoped;
  BodySpec body;
  body.name = model.body_of.at(name);
  body.at = link.at();
  if (flagged(link, "kinematic")) link.child("kinematic")->fail("is true, expected false");
  for (const char* kind : {"collision", "sensor", "plugin"})
    for (const Node& part : link.children(kind))
      model.remarks.left_out(part.name() + (part.name() == "collision" ? " shapes" : "s"));
  draw_sdf_link(link, body.name, model);
  weigh_link(link, body, model.remarks);
  if (const auto gravity = link.child("gravity");
      gravity && !gravity->content_flag() && !model.fixed.contains(body.name))
    take_back_weight(body.name, body.com, body.mass, gravity->at(), model.scene);
  model.poses[body.name] = model.frames.world(name, link);
  model.scene.bodies.push_back(body);
}

/// The frame names are relative to by default.
const char* own_frame(const std::string& scope) {
  return scope.empty() ? "world" : "__model__";
}

/// Whether a link is the ground: `world` without inertia; the name is reserved from 1.7 on.
bool is_ground(const Node& link, SdfModel& model) {
  if (!model.older_than(7) || link.text("name") != "world" || link.child("inertial")) return false;
  model.remarks.count("taken as the ground: links called world without <inertial>");
  return true;
}

void take_frames(const Node& owner, const std::string& scope, bool still, SdfModel& model,
                 Waiting& waiting);

/// Takes a model in `scope`; `still`: in a static one.
void take_model(const Node& node, const std::string& scope, bool still, SdfModel& model,
                Waiting& waiting) {
  const std::string name = node.text("name"), inside = scope + name + "::";
  refuse(node, {"drake:joint", "drake:linear_bushing_rpy", "drake:ball_constraint"}, "<joint>s");
  still |= flagged(node, "static");
  std::vector<Node> links = node.children("link");
  const std::vector<Node> nested = node.children("model");
  std::erase_if(links, [&](const Node& link) { return is_ground(link, model); });
  if (links.empty() && nested.empty()) node.fail("has no <link>, expected at least one");

  const std::string first = (links.empty() ? nested : links).front().text("name");
  const std::string canonical = node.text("canonical_link", ""),
                    placement = node.text("placement_frame", "");
  Frame frame{read_pose(node), relative_to(node, own_frame(scope)),
              name + "::" + (canonical.empty() ? first : canonical),
              placement.empty() ? "" : name + "::" + placement};
  model.frames.add(scope, name, frame, node);
  if (!canonical.empty()) waiting.canonical.emplace_back(scope + name, node);
  for (const Node& link : links) {
    const Node mine = called(link, "link");
    const std::string full = inside + link.text("name");
    model.frames.add(inside, link.text("name"),
                     {read_pose(mine), relative_to(link, "__model__"), "", ""}, mine);
    const std::string body = model.bodies.free(model.in_scene(full));
    if (body.starts_with("ground ") && full.ends_with("::ground"))
      model.remarks.say("called " + in_quotes(body) +
                        ", as ground is what does not move: link 'ground'");
    model.body_of[full] = body;
    if (still) model.fixed.insert(body);
    waiting.links.emplace_back(full, mine);
  }
  take_frames(node, inside, still, model, waiting);
}

/// Takes <model>, <frame> and <joint> of a model or a world, with their content.
void take_frames(const Node& owner, const std::string& scope, bool still, SdfModel& model,
                 Waiting& waiting) {
  for (const Node& node : owner.children("model"))
    take_model(called(node, "model"), scope, still, model, waiting);
  for (const Node& node : owner.children("frame")) {
    const Node mine = called(node, "frame");
    const std::string to = node.text("attached_to", own_frame(scope));
    model.frames.add(scope, node.text("name"), {read_pose(mine), relative_to(mine, to), to, ""},
                     mine);
  }
  for (const Node& node : owner.children("joint")) {
    const Node mine = called(node, "joint");
    const std::string child = mine.required("child").content();
    std::string name = node.text("name");
    if (model.older_than(7) && model.frames.has(scope + name)) name += " joint";
    model.frames.add(scope, name, {read_pose(mine), relative_to(mine, child), child, ""}, mine);
    waiting.joints.emplace_back(scope, mine);
  }
}

void read_world(const Node& world, SdfModel& model) {
  const auto gravity_of = [&](const Node& owner) {
    if (const auto gravity = owner.child("gravity")) {
      const std::vector<double> g = gravity->content_numbers(3);
      model.scene.gravity = {g[0], g[1], g[2]};
    }
  };
  for (const Node& physics : world.children("physics")) gravity_of(physics);
  gravity_of(world);
  refuse(world, {"population", "actor"}, "models alone");
}

}  // namespace

Scene read_sdf(const Element& element, const std::string& file) {
  SdfModel model;
  model.scene.file = file;
  const Element whole = with_sdf_includes(element, file, model.scene.included);
  const Node sdf(whole, "", file);
  refuse_misspelt(sdf, sdf_elements());
  model.scene.gravity = {0, 0, -9.8};
  model.bodies.take("ground");
  model.version = read_sdf_version(sdf);
  const std::vector<Node> worlds = sdf.children("world"), models = sdf.children("model");
  if (worlds.size() + models.size() != 1)
    sdf.fail("has " + std::to_string(worlds.size()) + " <world> and " +
             std::to_string(models.size()) + " <model>, expected one of them");
  const Node& top = worlds.empty() ? sdf : worlds.front();
  if (!worlds.empty()) read_world(top, model);
  model.scene.name = (worlds.empty() ? models.front() : top).text("name", "");

  Waiting waiting;
  model.one_model = top.children("model").size() == 1;
  take_frames(top, "", false, model, waiting);
  model.frames.complete();
  for (const Scoped& link : waiting.links) read_link(link, model);
  for (const auto& [name, node] : waiting.canonical)
    model.canonical.push_back(model.body_of.at(model.frames.link(name, node)));
  std::vector<SdfCoupler> couplers;
  for (const auto& [scope, joint] : waiting.joints) read_sdf_joint(joint, scope, model, couplers);
  for (const auto& [scope, gear] : model.gears)
    couplers.push_back(read_sdf_gearbox(gear, scope, model));
  if (model.scene.bodies.empty()) sdf.fail("has no <link>, expected at least one");
  make_tree(model, couplers);
  tell_unread(sdf, sdf_elements(), model.remarks);
  model.scene.remarks = model.remarks.sentences();
  validate(model.scene);
  return std::move(model.scene);
}

}  // namespace momenta::reading
