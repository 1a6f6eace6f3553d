// URDF+: <loop> closes a loop by a joint between two links, <coupling> is a gear.
// arXiv 2411.19753.

#include <momenta/core/format/urdf/urdf.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>
#include <set>

namespace momenta::reading {
namespace {

constexpr std::array<std::string_view, 6> loop_tags{"revolute",  "continuous", "prismatic",
                                                    "spherical", "fixed",      "planar"};
constexpr std::array kind_of_loop_tag{LoopKind::revolute,  LoopKind::revolute, LoopKind::prismatic,
                                      LoopKind::spherical, LoopKind::weld,     LoopKind::planar};

std::string link_of(const Node& end, const Scene& scene) {
  const std::string link = end.text("link");
  const auto is_it = [&](const BodySpec& body) { return body.name == link; };
  const bool known =
      link == "ground" || std::any_of(scene.bodies.begin(), scene.bodies.end(), is_it);
  if (!known) end.fail("link", "is " + in_quotes(link) + ", expected the name of a link");
  return link;
}

/// Joints from the ground to a link, inmost first; ends at a cycle, refused elsewhere.
std::vector<const JointSpec*> way_to(const std::string& link, const Scene& scene) {
  std::vector<const JointSpec*> way;
  std::string at = link;
  while (at != "ground" && way.size() <= scene.joints.size()) {
    const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                    [&](const JointSpec& j) { return j.child == at; });
    if (joint == scene.joints.end()) break;
    way.push_back(&*joint);
    at = joint->parent;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

}  // namespace

/// Frames 1 and 2, turned by R1 and R2 in their links, share the axis a. A loop of a scene has its
/// frame R in the parent and the axes of the child, hence the child's axis R2 a and R = R1 R2ᵀ.
void read_loop_tag(const Node& node, Scene& scene, FreeNames& edges) {
  LoopSpec loop;
  loop.at = node.at();
  const Node from = node.required("predecessor"), to = node.required("successor");
  const Origin one = read_origin(from), two = read_origin(to);
  node.text("type");
  loop.kind = kind_of_loop_tag[node.word("type", loop_tags, 0)];
  loop.name = edges.free(node.text("name"));
  loop.parent = link_of(from, scene);
  loop.child = link_of(to, scene);
  loop.origin_parent = one.xyz;
  loop.origin_child = two.xyz;
  const auto axis = node.child("axis");
  const Eigen::Vector3d along = axis ? axis->direction("xyz", Eigen::Vector3d::UnitX())
                                     : Eigen::Vector3d(Eigen::Vector3d::UnitX());
  if (has_axis(loop.kind)) loop.axis = two.turn * along;
  loop.rotation = one.turn * two.turn.conjugate();
  if (loop.child == "ground") {  // the parent is the fixed side
    std::swap(loop.parent, loop.child);
    std::swap(loop.origin_parent, loop.origin_child);
    loop.rotation = loop.rotation.conjugate();
    if (has_axis(loop.kind)) loop.axis = one.turn * along;
  }
  scene.loops.push_back(loop);
}

/// ratio · Σ q − Σ q = 0, over the joints from the last common link of the ends to the predecessor
/// and to the successor.
void read_coupling_tag(const Node& node, Scene& scene, FreeNames& edges) {
  LoopSpec loop;
  loop.kind = LoopKind::coupler;
  loop.at = node.at();
  loop.name = edges.free(node.text("name"));
  const double ratio = node.required("ratio").number("value");
  if (ratio == 0) node.required("ratio").fail("value", "is 0, expected another number");
  auto from = way_to(link_of(node.required("predecessor"), scene), scene);
  auto to = way_to(link_of(node.required("successor"), scene), scene);
  std::size_t common = 0;
  while (common < from.size() && common < to.size() && from[common] == to[common]) ++common;
  const auto add = [&](const std::vector<const JointSpec*>& way, double factor) {
    for (std::size_t i = common; i < way.size(); ++i) {
      if (way[i]->kind == JointKind::weld) continue;
      if (!has_one_coordinate(way[i]->kind))
        node.fail("goes through joint " + in_quotes(way[i]->name) +
                  ", expected revolute and prismatic joints alone");
      loop.joints.push_back(way[i]->name);
      loop.ratios.push_back(factor);
    }
  };
  add(from, ratio);
  add(to, -1);
  if (loop.joints.empty()) node.fail("couples no joint, expected links that move against another");
  scene.loops.push_back(loop);
}

}  // namespace momenta::reading
