#include <momenta/core/scene/kinds.h>
#include <momenta/core/scene/validate_parts.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <vector>

namespace momenta::reading {
namespace {

/// The names of one namespace, each with its place in the file.
class Names {
 public:
  Names(const Scene& scene, std::string what) : scene_(scene), what_(std::move(what)) {}

  void add(const std::string& kind, const std::string& name, Location at) {
    if (name.empty()) refuse(at, kind + " with an empty name, expected a name");
    const auto is_control = [](char c) {
      return static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    };
    if (std::any_of(name.begin(), name.end(), is_control))
      refuse(at, kind + " " + in_quotes(name) + ": the name has control characters, expected none");
    const auto [known, fresh] = places_.emplace(name, at);
    if (fresh) return;
    std::string sentence = kind + " " + in_quotes(name) + ": the name is taken";
    if (known->second.line > 0) sentence += " since line " + std::to_string(known->second.line);
    refuse(at, sentence + ", expected each name once among " + what_);
  }

 private:
  [[noreturn]] void refuse(Location at, const std::string& sentence) const {
    throw SceneError(scene_.where(at) + sentence);
  }

  const Scene& scene_;
  std::string what_;
  std::map<std::string, Location> places_;
};

template <class Map>
std::string near_key(const std::string& name, const Map& map) {
  std::vector<std::string_view> known;
  for (const auto& entry : map) known.push_back(entry.first);
  return did_you_mean(name, known);
}

}  // namespace

Census::Census(const Scene& scene) : scene_(scene) {
  Names bodies(scene, "bodies");
  for (const BodySpec& body : scene.bodies) {
    if (body.name == "ground")
      throw SceneError(
          scene.where(body.at) +
          "body 'ground': the name is reserved for what does not move, expected another");
    bodies.add("body", body.name, body.at);
    bodies_.emplace(body.name, &body);
  }

  Names edges(scene, "joints and loops");
  for (const JointSpec& joint : scene.joints) {
    edges.add("joint", joint.name, joint.at);
    joints_.emplace(joint.name, &joint);
  }
  for (const LoopSpec& loop : scene.loops) {
    edges.add("loop", loop.name, loop.at);
    loops_.emplace(loop.name, &loop);
  }

  Names markers(scene, "markers");
  for (const MarkerSpec& marker : scene.markers) markers.add("marker", marker.name, marker.at);

  Names functions(scene, "functions");
  for (const FunctionSpec& f : scene.functions) functions.add("function", f.name, f.at);

  Names forces(scene, "forces");
  for (const ForceSpec& force : scene.forces)
    if (!force.name.empty()) forces.add("force", force.name, force.at);

  Names events(scene, "events");
  for (const EventSpec& event : scene.events)
    if (!event.name.empty()) events.add("event", event.name, event.at);
}

void Census::require_body(const std::string& name, bool or_ground, const Subject& who,
                          const std::string& key) const {
  const std::string expected = or_ground ? ", expected a body or \"ground\"" : ", expected a body";
  if (name == "ground") {
    if (or_ground) return;
    who.fail(key + " is \"ground\"" + expected);
  }
  if (bodies_.contains(name)) return;
  who.fail(key + " is " + in_quotes(name) + ", which is no body" + expected +
           near_key(name, bodies_));
}

const JointSpec& Census::require_joint(const std::string& name, const Subject& who) const {
  if (const auto found = joints_.find(name); found != joints_.end()) return *found->second;
  who.fail(in_quotes(name) + (loops_.contains(name) ? " is a loop" : " is no joint") +
           ", expected the name of a [[joint]]" + near_key(name, joints_));
}

const LoopSpec& Census::require_loop(const std::string& name, const Subject& who) const {
  if (const auto found = loops_.find(name); found != loops_.end()) return *found->second;
  who.fail(in_quotes(name) + (joints_.contains(name) ? " is a joint" : " is no loop") +
           ", expected the name of a [[loop]]" + near_key(name, loops_));
}

void Census::require_one_coordinate(const std::string& name, const Subject& who) const {
  const JointKind kind = require_joint(name, who).kind;
  if (!has_one_coordinate(kind))
    who.fail("joint " + in_quotes(name) + " is " + std::string(name_of(kind)) +
             ", expected a revolute, prismatic or helical joint");
}

}  // namespace momenta::reading
