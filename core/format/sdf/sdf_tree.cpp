// Joints of the scene and loops. The tree is built breadth first from the ground, then from the
// links that carry floating parts. Joints without a loop form (screws, springs, dampers, gears)
// come into it before all others; each further joint is a loop.
//
// In the pose of the file, X_P and X_C of two bodies, a joint at the point o with the axis a has
//
//   origin_parent = X_P⁻¹ o,  origin_child = X_C⁻¹ o,  rotation = R_Pᵀ R_C,  axis = R_Cᵀ a.
//
// Where the tree goes from a child to its parent, coordinates stay if axes are reversed:
// (R(a1, q1) R(a2, q2))⁻¹ = R(−a2, q2) R(−a1, q1).

#include <momenta/core/format/sdf/sdf_model.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <numeric>
#include <queue>

namespace momenta::reading {
namespace {

/// Disjoint sets of bodies, 0 the ground.
class Sets {
 public:
  explicit Sets(std::size_t count) : up_(count), members_(count) {
    std::iota(up_.begin(), up_.end(), 0U);
    for (std::size_t i = 0; i < count; ++i) members_[i] = {i};
  }
  std::size_t of(std::size_t i) const { return up_[i]; }
  const std::vector<std::size_t>& members(std::size_t i) const { return members_[up_[i]]; }
  /// Unites two sets; false: they were one. Cost O(members of the smaller)
  bool join(std::size_t a, std::size_t b) {
    a = up_[a], b = up_[b];
    if (a == b) return false;
    if (members_[a].size() < members_[b].size()) std::swap(a, b);
    for (const std::size_t i : members_[b]) up_[i] = a;
    members_[a].insert(members_[a].end(), members_[b].begin(), members_[b].end());
    members_[b].clear();
    return true;
  }

 private:
  std::vector<std::size_t> up_;
  std::vector<std::vector<std::size_t>> members_;
};

class TreeMaker {
 public:
  explicit TreeMaker(SdfModel& model)
      : model_(model), sets_(model.scene.bodies.size() + 1), inside_(model.joints.size()) {
    number_["ground"] = 0;
    for (const BodySpec& body : model.scene.bodies) number_.emplace(body.name, number_.size());
    touching_.resize(number_.size());
    for (std::size_t j = 0; j < model.joints.size(); ++j)
      for (const std::string& end : {model.joints[j].parent, model.joints[j].child})
        touching_[number_.at(end)].push_back(j);
  }

  void make() {
    for (const std::string& body : model_.fixed) {
      sets_.join(0, number_.at(body));
      hang(body, JointKind::weld, body + " static");
    }
    for (std::size_t j = 0; j < model_.joints.size(); ++j) {
      const SdfJoint& joint = model_.joints[j];
      if (!joint.carries) continue;
      if (!sets_.join(number_.at(joint.parent), number_.at(joint.child)))
        joint.node->fail(
            "closes a loop of joints that all have springs, dampers, rotors, gears or screws, "
            "expected one in the loop without");
      inside_[j] = true;
    }
    grow(0);
    orient(0);
    std::vector<std::string> first = model_.canonical;
    for (const BodySpec& body : model_.scene.bodies) first.push_back(body.name);
    for (const std::string& body : first) {
      const std::size_t number = number_.at(body);
      if (!sets_.join(0, number)) continue;
      hang(body, JointKind::free, "root");
      grow(number);
      orient(number);
    }
    for (std::size_t j = 0; j < model_.joints.size(); ++j)
      if (!inside_[j]) model_.scene.loops.push_back(loop(model_.joints[j]));
  }
  bool reversed(std::size_t joint) const { return reversed_.contains(joint); }

 private:
  void hang(const std::string& body, JointKind kind, const std::string& name) {
    JointSpec joint;
    joint.name = model_.edges.free(name);
    joint.kind = kind;
    joint.child = body;
    const Pose& pose = model_.poses.at(body);
    if (kind == JointKind::free) {
      const Eigen::Vector3d &p = pose.origin, v = pose.turn.vec();
      joint.position = {p[0], p[1], p[2], pose.turn.w(), v[0], v[1], v[2]};
    } else {
      joint.origin_parent = pose.origin;
      joint.rotation = pose.turn;
    }
    model_.scene.joints.push_back(joint);
  }

  /// Takes joints into the tree, breadth first from the set of `root`.
  void grow(std::size_t root) {
    std::queue<std::size_t> left;
    for (const std::size_t body : sets_.members(root)) left.push(body);
    for (; !left.empty(); left.pop())
      for (const std::size_t j : touching_[left.front()]) {
        const SdfJoint& joint = model_.joints[j];
        const std::size_t p = number_.at(joint.parent), c = number_.at(joint.child);
        if (inside_[j] || sets_.of(p) == sets_.of(c)) continue;
        const std::size_t there = sets_.of(p) == sets_.of(left.front()) ? c : p;
        for (const std::size_t body : sets_.members(there)) left.push(body);
        sets_.join(p, c);
        inside_[j] = true;
      }
  }

  /// Makes the joints of the scene, from `root` outwards.
  void orient(std::size_t root) {
    std::queue<std::size_t> left;
    left.push(root);
    if (root == 0)
      for (const std::string& body : model_.fixed) left.push(number_.at(body));
    for (; !left.empty(); left.pop())
      for (const std::size_t j : touching_[left.front()]) {
        if (!inside_[j] || !done_.insert(j).second) continue;
        const bool back = number_.at(model_.joints[j].child) == left.front();
        if (back) reversed_.insert(j);
        model_.scene.joints.push_back(joint(model_.joints[j], back));
        left.push(number_.at(back ? model_.joints[j].parent : model_.joints[j].child));
      }
  }

  template <class Edge>
  void frames(const SdfJoint& from, bool back, Edge& edge) const {
    edge.parent = back ? from.child : from.parent;
    edge.child = back ? from.parent : from.child;
    const Pose p = pose(edge.parent), c = pose(edge.child);
    edge.origin_parent = (p.inverse() * Pose{from.origin, {1, 0, 0, 0}}).origin;
    edge.origin_child = (c.inverse() * Pose{from.origin, {1, 0, 0, 0}}).origin;
    edge.rotation = p.turn.conjugate() * c.turn;
    const bool two = from.spec.kind == JointKind::universal;
    const auto turned = [&](const Eigen::Vector3d& axis) -> Eigen::Vector3d {
      return c.turn.conjugate() * (back ? Eigen::Vector3d(-axis) : axis);
    };
    if (has_axis(from.spec.kind)) edge.axis = turned(back && two ? from.axis2 : from.axis);
    if (two) edge.axis2 = turned(back ? from.axis : from.axis2);
  }
  Pose pose(const std::string& body) const {
    return body == "ground" ? Pose{} : model_.poses.at(body);
  }

  JointSpec joint(const SdfJoint& from, bool back) const {
    JointSpec joint = from.spec;
    if (joint.friction != 0) model_.remarks.count("taken as smooth friction: friction of joints");
    frames(from, back, joint);
    return joint;
  }
  LoopSpec loop(const SdfJoint& from) const {
    static const std::map<JointKind, LoopKind> kinds{{JointKind::revolute, LoopKind::revolute},
                                                     {JointKind::prismatic, LoopKind::prismatic},
                                                     {JointKind::universal, LoopKind::universal},
                                                     {JointKind::spherical, LoopKind::spherical},
                                                     {JointKind::weld, LoopKind::weld}};
    LoopSpec loop;
    loop.name = from.spec.name;
    loop.at = from.spec.at;
    if (from.spec.limits) model_.remarks.left_out("limits of joints that close loops");
    if (from.spec.friction != 0) model_.remarks.left_out("friction of joints that close loops");
    loop.kind = kinds.at(from.spec.kind);
    frames(from, from.child == "ground", loop);  // the parent is the fixed side
    return loop;
  }

  SdfModel& model_;
  std::map<std::string, std::size_t> number_;
  std::vector<std::vector<std::size_t>> touching_;  ///< joints of each body
  Sets sets_;
  std::vector<bool> inside_;  ///< joints of the tree
  std::set<std::size_t> done_, reversed_;
};

}  // namespace

void make_tree(SdfModel& model, const std::vector<SdfCoupler>& couplers) {
  std::map<std::string, std::size_t> place;
  for (std::size_t j = 0; j < model.joints.size(); ++j) place[model.joints[j].scoped] = j;
  const auto joint_of = [&](const SdfCoupler& coupler, const SdfTerm& term) {
    auto at = place.find(term.joint);
    if (term.axis == 1 && place.contains(term.joint + " axis2"))
      at = place.find(term.joint + " axis2");
    if (at == place.end())
      coupler.node->fail("names " + in_quotes(term.joint) + ", expected a joint");
    return at->second;
  };
  for (const SdfCoupler& coupler : couplers)
    for (const SdfTerm& term : coupler.terms) model.joints[joint_of(coupler, term)].carries = true;
  TreeMaker tree(model);
  tree.make();
  for (const SdfCoupler& coupler : couplers) {
    LoopSpec loop;
    loop.kind = LoopKind::coupler;
    loop.at = coupler.node->at();
    loop.name = coupler.name;
    loop.offset = coupler.offset;
    for (const SdfTerm& term : coupler.terms) {
      const std::size_t j = joint_of(coupler, term);
      const bool two = model.joints[j].spec.kind == JointKind::universal;
      loop.joints.push_back(model.joints[j].spec.name);
      loop.coordinates.push_back(two && tree.reversed(j) ? 1 - term.axis : two ? term.axis : 0);
      loop.ratios.push_back(term.factor);
    }
    model.scene.loops.push_back(loop);
  }
}

}  // namespace momenta::reading
