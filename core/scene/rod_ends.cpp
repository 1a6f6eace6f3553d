#include <momenta/core/scene/rod_ends.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace momenta {
namespace {

constexpr double same = 1e-6;  // relative to a rod's length

/// Places of each body's pins along its rod [m].
class Pins {
 public:
  explicit Pins(const Scene& scene) {
    for (const BodySpec& body : scene.bodies)
      if (body.shape.kind == "rod") rods_[body.name].rod = &body;
    const auto take = [&](const auto& tie) {
      add(tie.parent, tie.origin_parent);
      add(tie.child, tie.origin_child);
    };
    for (const JointSpec& joint : scene.joints) take(joint);
    for (const LoopSpec& loop : scene.loops)
      if (loop.kind == LoopKind::slot || loop.kind == LoopKind::rolling)
        add(loop.child, loop.origin_child);
      else if (ties_bodies(loop) && !has_curves(loop))
        take(loop);
    for (const ForceSpec& force : scene.forces)
      if (force.kind == "spring-damper") take(force);
  }

  std::vector<std::string> sentences(const Scene& scene) const {
    std::vector<std::string> all;
    for (const BodySpec& body : scene.bodies) {
      const auto found = rods_.find(body.name);
      if (found == rods_.end() || found->second.pins.size() < 2) continue;
      const auto& pins = found->second.pins;
      const double length = body.shape.size.x(), last = *std::max_element(pins.begin(), pins.end());
      if (std::abs(last - length) > same * length)
        all.push_back("rod " + reading::in_quotes(body.name) + " is " + reading::digits(length) +
                      " m long, its last pin is at " + reading::digits(last) + " m");
    }
    return all;
  }

 private:
  struct Rod {
    const BodySpec* rod = nullptr;
    std::vector<double> pins;
  };
  void add(const std::string& body, const Eigen::Vector3d& point) {
    const auto found = rods_.find(body);
    if (found == rods_.end()) return;
    auto& [rod, pins] = found->second;
    const Eigen::Vector3d& axis = rod->shape.axis;
    const double length = rod->shape.size.x(), along = axis.dot(point);
    const auto near = [&](double pin) { return std::abs(pin - along) <= same * length; };
    if ((point - along * axis).norm() <= same * length &&
        std::none_of(pins.begin(), pins.end(), near))
      pins.push_back(along);
  }

  std::map<std::string, Rod> rods_;
};

}  // namespace

std::vector<std::string> rods_that_miss_their_pins(const Scene& scene) {
  return Pins(scene).sentences(scene);
}

}  // namespace momenta
