#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <vector>

namespace momenta::reading {
namespace {

constexpr std::size_t most_named = 8;

/// joints 'a', 'b' form a cycle: x -> y -> x; make one of them a [[loop]]
std::string cycle_sentence(const std::vector<const JointSpec*>& cycle) {
  std::string joints, bodies;
  for (std::size_t i = 0; i < cycle.size(); ++i) {
    if (i == most_named) {
      joints += " and " + std::to_string(cycle.size() - i) + " more";
      bodies += "... -> ";
      break;
    }
    joints += (i == 0 ? "" : ", ") + in_quotes(cycle[i]->name);
    bodies += on_one_line(cycle[i]->parent) + " -> ";
  }
  return "joints " + joints + " form a cycle: " + bodies + on_one_line(cycle.front()->parent) +
         ", expected a tree; make one of them a [[loop]]";
}

}  // namespace

void check_tree(const Scene& scene) {
  // by body: the joint that carries it
  std::map<std::string, const JointSpec*> inward;
  for (const JointSpec& joint : scene.joints) {
    const auto [known, fresh] = inward.emplace(joint.child, &joint);
    if (!fresh)
      throw SceneError(scene.where(joint.at) + "body " + in_quotes(joint.child) +
                       " is the child of joints " + in_quotes(known->second->name) + " and " +
                       in_quotes(joint.name) +
                       ", expected exactly one; make one of them a [[loop]]");
  }
  for (const BodySpec& body : scene.bodies)
    if (!inward.contains(body.name))
      throw SceneError(scene.where(body.at) + "body " + in_quotes(body.name) +
                       ": the child of no joint, expected exactly one [[joint]] (of kind free "
                       "where nothing holds it)");

  // Walk from each body towards the ground, until a body seen before; in the same walk it closes a
  // cycle. Every joint is passed once: O(n log n).
  std::map<const JointSpec*, std::size_t> walk_of;
  std::size_t walk = 0;
  for (const JointSpec& start : scene.joints) {
    ++walk;
    const JointSpec* joint = &start;
    while (walk_of.emplace(joint, walk).second) {
      if (joint->parent == "ground") break;
      joint = inward.at(joint->parent);
    }
    if (joint->parent == "ground" || walk_of.at(joint) != walk) continue;

    // walked inwards; listed outwards, from parent to child
    std::vector<const JointSpec*> cycle;
    const JointSpec* member = joint;
    do {
      cycle.push_back(member);
      member = inward.at(member->parent);
    } while (member != joint);
    std::reverse(cycle.begin(), cycle.end());
    throw SceneError(scene.where(joint->at) + cycle_sentence(cycle));
  }
}

}  // namespace momenta::reading
