#include <momenta/core/format/xml/made_scene.h>
#include <momenta/core/scene/shapes.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>

namespace momenta::reading {

void Remarks::count(const std::string& sentence) {
  const auto known = std::find_if(counts_.begin(), counts_.end(),
                                  [&](const auto& entry) { return entry.first == sentence; });
  if (known != counts_.end())
    ++known->second;
  else
    counts_.emplace_back(sentence, 1);
}

void Remarks::not_drawn(const std::exception& wrong) {
  say("not drawn: " + std::string(wrong.what()));
}

std::vector<std::string> Remarks::sentences() const {
  std::vector<std::string> all;
  for (const auto& [sentence, count] : counts_)
    all.push_back(on_one_line(sentence) +
                  (count > 0 ? " (" + std::to_string(count) + ")" : std::string()));
  return all;
}

std::string FreeNames::free(const std::string& wish) {
  std::string name = wish;
  for (int i = 2; !taken_.insert(name).second; ++i) name = wish + " " + std::to_string(i);
  return name;
}

void weigh(BodySpec& body, double mass, const Eigen::Vector3d& com, const Eigen::Matrix3d& inertia,
           const Node& node, Remarks& remarks) {
  if (mass < 0) node.fail("gives the mass " + digits(mass) + ", expected a number >= 0 [kg]");
  body.mass = mass;
  body.com = com;
  body.inertia = inertia;
  if (inertia_fault(inertia).empty()) return;
  body.any_inertia = true;
  remarks.count("taken as written: inertias that no rigid body has");
}

void take_back_weight(const std::string& body, const Eigen::Vector3d& point, double mass,
                      const Location& at, Scene& scene) {
  if (mass == 0 || scene.gravity.isZero()) return;
  ForceSpec lift;
  lift.at = at;
  lift.kind = "wrench";
  lift.body = body;
  lift.point = point;
  lift.force = -mass * scene.gravity;
  scene.forces.push_back(lift);
}

Eigen::Matrix3d symmetric(double xx, double yy, double zz, double xy, double xz, double yz) {
  Eigen::Matrix3d m;
  m << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return m;
}

}  // namespace momenta::reading
