#include <momenta/dae/topology/assembly/stalled_drive.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

namespace momenta {
namespace {

/// The way around a loop: joints of the tree, and bodies between them.
struct Around {
  std::vector<const JointSpec*> joints;
  std::vector<std::string> undriven_bodies;  ///< no driven joint and no driven loop holds them
};

class Ways {
 public:
  explicit Ways(const Scene& scene) : scene_(scene) {
    for (const JointSpec& j : scene.joints) carried_by_.emplace(j.child, &j);
    for (const JointSpec& j : scene.joints) by_name_.emplace(j.name, &j);
  }

  bool is_driven(const std::string& joint) const {
    return std::any_of(scene_.drives.begin(), scene_.drives.end(),
                       [&](const DriveSpec& d) { return d.joint == joint; });
  }
  bool drives_loop(const std::string& loop) const {
    return std::any_of(scene_.drives.begin(), scene_.drives.end(),
                       [&](const DriveSpec& d) { return d.loop == loop; });
  }

  Around around(const LoopSpec& loop) const {
    Around found;
    if (!ties_bodies(loop)) {
      for (const std::string& name : loop.joints)
        if (const auto j = by_name_.find(name); j != by_name_.end())
          found.joints.push_back(j->second);
      return found;
    }
    std::vector<const JointSpec*> sides[2] = {to_ground(loop.parent), to_ground(loop.child)};
    while (!sides[0].empty() && !sides[1].empty() && sides[0].back() == sides[1].back()) {
      sides[0].pop_back();
      sides[1].pop_back();
    }
    for (const auto& side : sides)
      for (std::size_t i = 0; i < side.size(); ++i) {
        found.joints.push_back(side[i]);
        const bool below = i == 0 ? drives_loop(loop.name) : is_driven(side[i - 1]->name);
        if (!below && !is_driven(side[i]->name)) found.undriven_bodies.push_back(side[i]->child);
      }
    return found;
  }

 private:
  /// Joints from a body down to the ground.
  std::vector<const JointSpec*> to_ground(const std::string& body) const {
    std::vector<const JointSpec*> joints;
    for (auto j = carried_by_.find(body); j != carried_by_.end();
         j = carried_by_.find(j->second->parent))
      joints.push_back(j->second);
    return joints;
  }

  const Scene& scene_;
  std::map<std::string, const JointSpec*> carried_by_, by_name_;
};

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 6;
  std::string words;
  for (std::size_t i = 0; i < names.size() && i < most; ++i)
    words += (i == 0 ? "'" : i + 1 == names.size() ? " and '" : ", '") + names[i] + "'";
  return words + (names.size() > most ? " …" : "");
}

}  // namespace

std::string stalled_drive(const Mechanism& mechanism, double t, const Eigen::VectorXd& open) {
  const Scene& scene = mechanism.scene();
  Eigen::Index worst = 0;
  if (open.size() > 0) open.cwiseAbs().maxCoeff(&worst);
  const std::string& name = mechanism.rows()[static_cast<std::size_t>(worst)].loop;
  const auto loop = std::find_if(scene.loops.begin(), scene.loops.end(),
                                 [&](const LoopSpec& l) { return l.name == name; });
  const Ways ways(scene);
  Around way;
  if (loop != scene.loops.end()) way = ways.around(*loop);
  std::vector<std::string> drives;
  for (const JointSpec* j : way.joints)
    if (ways.is_driven(j->name)) drives.push_back(j->name);
  if (ways.drives_loop(name)) drives.push_back(name);
  if (drives.empty())  // loops beyond this one bring the motion
    for (const DriveSpec& d : scene.drives) drives.push_back(d.joint.empty() ? d.loop : d.joint);
  std::sort(drives.begin(), drives.end());
  drives.erase(std::unique(drives.begin(), drives.end()), drives.end());
  char time[32];
  std::snprintf(time, sizeof time, "%.6g", t);
  std::string words = drives.size() == 1 ? "drive of " : "drives of ";
  words += listed(drives) + " cannot go on at t = " + time + " s: loop '" + name +
           "' does not close behind it";
  if (way.undriven_bodies.size() > 1)
    words += " (dead point of " + listed(way.undriven_bodies) + ")";
  return words;
}

}  // namespace momenta
