#pragma once
// Remarks of a reader on what it leaves out or interprets: one counted sentence a kind, in order of
// occurrence.

#include <momenta/core/format/xml/xml_node.h>
#include <momenta/core/scene/scene.h>

#include <exception>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace momenta::reading {

class Remarks {
 public:
  void count(const std::string& sentence);
  /// Adds a sentence without a count.
  void say(const std::string& sentence) { counts_.emplace_back(sentence, 0); }
  /// Counts a shape or colour with a fault. It has no effect on motion: it is left out of pictures.
  void not_drawn(const std::exception& wrong);
  /// `kind` is a plural: "joint limits".
  void left_out(const std::string& kind) { count("left out: " + kind); }
  /// "left out: joint limits (12)".
  std::vector<std::string> sentences() const;

 private:
  std::vector<std::pair<std::string, int>> counts_;
};

// Common to the readers of robots: free names, and bodies with their inertia.

/// Names taken so far among joints and loops, or among bodies.
class FreeNames {
 public:
  void take(const std::string& name) { taken_.insert(name); }
  /// `wish`, or with a number behind it where that is taken; then taken too.
  std::string free(const std::string& wish);

 private:
  std::set<std::string> taken_;
};

/// Gives a body its mass, and its inertia about the centre of mass, body axes. One that no rigid
/// body has is kept, with a remark. @throws SceneError for a negative mass
void weigh(BodySpec& body, double mass, const Eigen::Vector3d& com, const Eigen::Matrix3d& inertia,
           const Node& node, Remarks& remarks);

/// Adds the constant force −m g at a point of a body, which cancels the weight of a mass m there;
/// none for zero.
void take_back_weight(const std::string& body, const Eigen::Vector3d& point, double mass,
                      const Location& at, Scene& scene);

/// The matrix of xx, yy, zz, xy, xz, yz.
Eigen::Matrix3d symmetric(double xx, double yy, double zz, double xy, double xz, double yz);

}  // namespace momenta::reading
