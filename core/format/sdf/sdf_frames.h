#pragma once
// Frames of an SDF file, by name. Each has a pose in the frame it is relative to,
//
//   X_world,f = X_world,r X_r,f,
//
// and is attached to a link, to the world, or to a frame that is. Names are scoped: "arm" in the
// model "m" is "m::arm"; "m" is the frame of that model, called __model__ in it. sdformat.org,
// "Pose frame semantics".

#include <momenta/core/format/xml/xml_node.h>

#include <Eigen/Geometry>
#include <map>
#include <string>

namespace momenta::reading {

/// x = origin + turn y takes y from the frame to the one around it.
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

/// The pose in an element's <pose>: x y z [m], roll pitch yaw [rad], or degrees by its attribute;
/// or x y z and a quaternion x y z w. Default: zero.
Pose read_pose(const Node& element);
/// The frame of that <pose>, by its attribute.
std::string relative_to(const Node& element, const std::string& otherwise);

struct Frame {
  Pose pose;                ///< in `relative_to`
  std::string relative_to;  ///< a name in the scope of the frame
  std::string attached_to;  ///< the same; empty for a link
  std::string placement;    ///< models: the frame in it that <pose> places; empty: its own
};

class Frames {
 public:
  /// `what`: the element that defines the frame, for complaints. @throws SceneError for a repeated
  /// name
  void add(const std::string& scope, const std::string& name, Frame frame, const Node& what);
  bool has(const std::string& full_name) const { return frames_.contains(full_name); }
  /// Finds the names in the frames, once all are there. @throws SceneError
  void complete();

  /// Full name of `name` in a scope, "" or "model::". @throws SceneError where it is unknown
  std::string full(const std::string& scope, const std::string& name, const Node& asked) const;
  /// Pose in the world. Cost O(log frames) on average. @throws SceneError for a cycle
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
