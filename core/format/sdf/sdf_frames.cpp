#include <momenta/core/format/sdf/sdf_frames.h>
#include <momenta/core/scene/kinds.h>
#include <momenta/core/text/quoting.h>

#include <cmath>
#include <numbers>

namespace momenta::reading {
namespace {

using Eigen::Vector3d;
using Turn = Eigen::AngleAxisd;

constexpr std::string_view model_frame = "__model__";

bool blank(const std::string& text) {
  return text.find_first_not_of(" \t\r\n") == std::string::npos;
}

}  // namespace

Pose read_pose(const Node& element) {
  const auto node = element.child("pose");
  Pose pose;
  if (!node) return pose;
  if (!node->text("frame", "").empty())
    node->fail("frame", "is " + in_quotes(node->text("frame")) +
                            ", which SDF no longer has, expected relative_to");
  constexpr std::array<std::string_view, 2> formats{"euler_rpy", "quat_xyzw"};
  const bool quaternion = node->word("rotation_format", formats, 0) == 1;
  if (blank(node->element().text)) return pose;
  const std::vector<double> x = node->content_numbers(quaternion ? 7 : 6);
  pose.origin = {x[0], x[1], x[2]};
  if (quaternion) {
    const Eigen::Quaterniond turn(x[6], x[3], x[4], x[5]);
    if (!(std::abs(turn.norm() - 1) <= norm_slack))
      node->fail("has a quaternion of norm " + digits(turn.norm()) + ", expected 1 within 1e-6");
    pose.turn = turn.normalized();
    return pose;
  }
  const double unit = node->flag("degrees", false) ? std::numbers::pi / 180 : 1;
  pose.turn = Turn(unit * x[5], Vector3d::UnitZ()) * Turn(unit * x[4], Vector3d::UnitY()) *
              Turn(unit * x[3], Vector3d::UnitX());
  return pose;
}

std::string relative_to(const Node& element, const std::string& otherwise) {
  const auto pose = element.child("pose");
  const std::string said = pose ? pose->text("relative_to", "") : "";
  return said.empty() ? otherwise : said;
}

void Frames::add(const std::string& scope, const std::string& name, Frame frame, const Node& what) {
  if (name == "world") what.fail("is called 'world', which is the ground's name, expected another");
  if (!frames_.emplace(scope + name, Entry{std::move(frame), scope, what}).second)
    what.fail("is the second called " + in_quotes(name) +
              ", expected a name of its own among links, joints, frames and models");
}

void Frames::complete() {
  for (auto& [name, entry] : frames_) {
    Frame& frame = entry.frame;
    for (std::string* other : {&frame.relative_to, &frame.attached_to, &frame.placement})
      if (!other->empty()) *other = full(entry.scope, *other, entry.what);
  }
}

std::string Frames::full(const std::string& scope, const std::string& name,
                         const Node& asked) const {
  if (name == "world") return name;
  std::string found = scope + name;
  if (found.ends_with(model_frame)) {  // "model::__model__" is "model"
    found.erase(found.size() - model_frame.size());
    if (found.ends_with("::")) found.erase(found.size() - 2);
  }
  if (has(found)) return found;
  std::vector<std::string_view> known;
  for (const auto& [other, entry] : frames_)
    if (other.starts_with(scope)) known.push_back(std::string_view(other).substr(scope.size()));
  asked.fail("names " + in_quotes(name) + ", expected a link, joint, frame or model of the file" +
             did_you_mean(name, known));
}

Pose Frames::local(const std::string& name, const Node& asked) const {
  const Frame& frame = at(name);
  if (frame.placement.empty()) return frame.pose;
  return frame.pose * between(name, frame.placement, asked).inverse();
}

/// X_outer,inner, along the way from `inner` outwards. Models are nested, so this and local() end.
Pose Frames::between(const std::string& outer, std::string inner, const Node& asked) const {
  Pose pose;
  for (std::size_t step = 0; inner != outer; ++step) {
    if (inner == "world" || step > frames_.size())
      asked.fail("is placed by a frame that is not relative to it, expected one that is");
    pose = local(inner, asked) * pose;
    inner = at(inner).relative_to;
  }
  return pose;
}

const Pose& Frames::world(const std::string& name, const Node& asked) {
  std::vector<std::string> way;  // outwards, to a frame with a known pose
  for (std::string at = name; !world_.contains(at); at = this->at(at).relative_to) {
    if (way.size() > frames_.size())
      asked.fail(
          "is relative to frames that are relative to each other in a cycle, expected a way "
          "to the world");
    way.push_back(at);
  }
  for (; !way.empty(); way.pop_back())
    world_[way.back()] = world_.at(at(way.back()).relative_to) * local(way.back(), asked);
  return world_.at(name);
}

std::string Frames::link(const std::string& name, const Node& asked) const {
  std::string at = name;
  for (std::size_t step = 0; at != "world"; ++step) {
    if (step > frames_.size())
      asked.fail(
          "is attached to frames that are attached to each other in a cycle, expected a link");
    const std::string& next = this->at(at).attached_to;
    if (next.empty()) return at;
    at = next;
  }
  return at;
}

}  // namespace momenta::reading
