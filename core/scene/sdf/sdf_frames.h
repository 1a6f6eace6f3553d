#pragma once
// Frames of an SDF file, by name. Each has a pose in the frame that it is relative to,
//
//   X_world,f = X_world,r X_r,f,
//
// and is attached to a link, to the world, or to another frame that is. Names are scoped: "arm" in
// the model "m" is "m::arm", "m" is the frame of that model, which its elements call __model__.
// sdformat.org, "Pose frame semantics".

#include <momenta/core/scene/xml/xml_node.h>

#include <Eigen/Geometry>
#include <map>
#include <string>

namespace momenta::reading {

/// x = origin + turn y takes y from the frame to the one it is given in.
struct Pose {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();

  Pose operator*(const Pose& inner) const {
    return {origin + turn * inner.origin, turn * inner.turn};
  }
  Pose inverse() const {
    const Eigen::Quaterniond back = turn.conjugate();
    return {back * -origin, back};
  }
};

/// The pose in the element's <pose>, in whatever frame: x y z [m], roll pitch yaw [rad], or degrees
/// by its attribute; or x y z and a quaternion x y z w. Zero where there is none.
Pose read_pose(const Node& element);
/// What that <pose> is relative to, by its attribute.
std::string relative_to(const Node& element, const std::string& otherwise);

struct Frame {
  Pose pose;                ///< in `relative_to`
  std::string relative_to;  ///< a name in the scope of the frame
  std::string attached_to;  ///< the same; of a link: empty
  std::string placement;    ///< of a model: the frame in it that <pose> places; empty: its own
};

class Frames {
 public:
  /// `what`: the element that defines it, for complaints. @throws SceneError for a name twice
  void add(const std::string& scope, const std::string& name, Frame frame, const Node& what);
  bool has(const std::string& full_name) const { return frames_.contains(full_name); }
  /// To be called once all frames are there: finds what they name. @throws SceneError
  void complete();

  /// The full name of `name` in a scope, "" or "model::". @throws SceneError where there is none
  std::string full(const std::string& scope, const std::string& name, const Node& asked) const;
  /// The pose in the world. Cost O(log frames) on the mean. @throws SceneError for a cycle
  const Pose& world(const std::string& name, const Node& asked);
  /// The link that a frame is attached to, or "world".
  std::string link(const std::string& name, const Node& asked) const;

 private:
  struct Entry {
    Frame frame;
    std::string scope;
    Node what;
  };
  Pose local(const std::string& name, const Node& asked) const;
  Pose between(const std::string& outer, std::string inner, const Node& asked) const;
  const Frame& at(const std::string& name) const { return frames_.at(name).frame; }

  std::map<std::string, Entry> frames_;
  std::map<std::string, Pose> world_{{"world", {}}};
};

}  // namespace momenta::reading
