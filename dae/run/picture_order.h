#pragma once
// Bodies in the order of pictures: parents first.

#include <momenta/dae/mechanism/mechanism.h>

#include <map>
#include <string>
#include <vector>

namespace momenta {

/// Joints, parents first, and the place of each body in that order.
struct PictureOrder {
  std::vector<const JointSpec*> joints;
  std::map<std::string, int> place{{"ground", -1}};

  explicit PictureOrder(const Mechanism& mechanism) {
    std::map<std::string, const JointSpec*> by_child;
    for (const JointSpec& joint : mechanism.scene().joints) by_child[joint.child] = &joint;
    for (const Tree::Body& body : mechanism.tree().bodies)
      if (!body.name.empty()) {
        place[body.name] = static_cast<int>(joints.size());
        joints.push_back(by_child.at(body.name));
      }
  }
};

}  // namespace momenta
