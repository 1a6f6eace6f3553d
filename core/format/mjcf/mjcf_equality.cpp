// <equality>: connect is a point, weld a weld, joint and fixed tendon a coupler. A spatial tendon
// between two sites is a distance: L = L(qpos0) + c0.

#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <array>

namespace momenta::reading {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The two ends of a constraint: bodies by name in the file, and frames in them.
struct Ends {
  std::string one, two;
  MjcfFrame at_one, at_two;
};

class EqualityReader {
 public:
  EqualityReader(const Node& node, MjcfModel& model) : node_(node), model_(model) {}

  void read() {
    if (!node_.flag("active", true) || !model_.ties)
      return model_.remarks.left_out("equality constraints that are not active");
    loop_.at = node_.at();
    loop_.name = model_.edges.free(node_.text("name", node_.name() + " equality"));
    if (node_.name() == "joint")
      couple_joints();
    else if (node_.name() == "tendon" && !node_.has("tendon2") && tendon("tendon1").ends)
      keep_length(*tendon("tendon1").ends);
    else if (node_.name() == "tendon")
      couple_tendons();
    else
      tie();
    model_.scene.loops.push_back(loop_);
  }

 private:
  const MjcfModel::Site& site(const char* key) const {
    const std::string name = node_.text(key);
    const auto found = model_.sites.find(name);
    if (found == model_.sites.end())
      node_.fail(key, "is " + in_quotes(name) + ", expected the name of a <site>");
    return found->second;
  }

  std::string body(const char* key, const std::string& otherwise) const {
    const std::string name = node_.text(key, otherwise);
    std::vector<std::string_view> known;
    for (const auto& entry : model_.frames) known.push_back(entry.first);
    if (!model_.frames.contains(name))
      node_.fail(key, "is " + in_quotes(name) + ", expected the name of a <body>" +
                          did_you_mean(name, known));
    return name;
  }

  /// Connect: both ends have one point. Weld: R1 quat1 = R2 quat2 besides; the frames are `relpose`
  /// in the first body and the anchor in the second. Defaults are those at qpos0.
  Ends ends() const {
    if (node_.has("site1") || node_.has("site2")) {
      const MjcfModel::Site &one = site("site1"), &two = site("site2");
      return {one.body, two.body, one.frame, two.frame};
    }
    Ends e;
    node_.text("body1");
    e.one = body("body1", "");
    e.two = body("body2", "world");
    const MjcfFrame two_in_one = model_.frames.at(e.one).inverse() * model_.frames.at(e.two);
    if (node_.name() == "connect") {
      e.at_one.at = node_.vector("anchor");
      e.at_two.at = two_in_one.inverse() * e.at_one.at;
      return e;
    }
    e.at_two.at = node_.vector("anchor", Vector3d::Zero());
    e.at_one = {two_in_one * e.at_two.at, two_in_one.turn};
    if (!node_.has("relpose")) return e;
    const std::vector<double> x = node_.numbers("relpose", 7);
    const Quaterniond turn(x[3], x[4], x[5], x[6]);
    if (turn.norm() > 0) e.at_one = {{x[0], x[1], x[2]}, turn.normalized()};
    return e;
  }

  void tie() {
    Ends e = ends();
    const bool turns = node_.name() == "weld" && node_.number("torquescale", 1) != 0;
    loop_.kind = turns ? LoopKind::weld : LoopKind::point;
    if (e.one == e.two) node_.fail("ties a body to itself, expected two bodies");
    if (e.two == "world") {  // the parent is the fixed side
      std::swap(e.one, e.two);
      std::swap(e.at_one, e.at_two);
    }
    loop_.parent = MjcfModel::in_scene(e.one);
    loop_.child = MjcfModel::in_scene(e.two);
    loop_.origin_parent = e.at_one.at;
    loop_.origin_child = e.at_two.at;
    if (turns) loop_.rotation = (e.at_one.turn * e.at_two.turn.conjugate()).normalized();
  }

  /// c0 … c4 of `polycoef`.
  std::array<double, 5> polynomial() const {
    std::array<double, 5> c{0, 1, 0, 0, 0};
    if (!node_.has("polycoef")) return c;
    const std::vector<double> given = node_.numbers("polycoef");
    if (given.size() > c.size())
      node_.fail("polycoef", "has " + std::to_string(given.size()) + " numbers, expected 5");
    std::copy(given.begin(), given.end(), c.begin());
    return c;
  }

  /// Σ ratios₁ q − c0 − Σ c_k (Σ ratios₂ q)^k: the scene's q, and here the file's lengths and
  /// joints, count from qpos0. `what`: joint or tendon.
  void couple(std::map<std::string, double> one, const std::map<std::string, double>& two,
              const char* what) {
    const std::array<double, 5> c = polynomial();
    loop_.kind = LoopKind::coupler;
    loop_.offset = c[0];
    const bool curved = !two.empty() && (c[2] != 0 || c[3] != 0 || c[4] != 0);
    if (curved && two.size() > 1)
      node_.fail("polycoef",
                 "has powers above the first of a sum of joints, expected a linear coupling");
    for (const auto& [joint, ratio] : two) {
      if (curved && one.contains(joint))
        node_.fail(std::string("ties a ") + what + " to itself, expected two of them");
      if (c[1] != 0) one[joint] -= c[1] * ratio;
    }
    std::erase_if(one, [](const auto& term) { return term.second == 0; });
    const std::string last = curved ? two.begin()->first : "";
    for (const auto& [joint, ratio] : one) {
      if (joint == last) continue;
      loop_.joints.push_back(joint);
      loop_.ratios.push_back(ratio);
    }
    if (curved) {
      const double r = two.begin()->second;
      loop_.joints.push_back(last);
      loop_.ratios.push_back(c[1] == 0 ? 0 : -c[1] * r);
      loop_.powers = {-c[2] * r * r, -c[3] * r * r * r, -c[4] * r * r * r * r};
      while (loop_.powers.back() == 0) loop_.powers.pop_back();
    }
    if (loop_.joints.empty())
      node_.fail(std::string("ties a ") + what + " to itself, expected two of them");
  }

  void couple_joints() {
    const std::string one = coordinate_of(node_, "joint1", model_);
    std::map<std::string, double> two;
    if (node_.has("joint2")) {
      two[coordinate_of(node_, "joint2", model_)] = 1;
      if (two.contains(one)) node_.fail("ties a joint to itself, expected two joints");
    }
    couple({{one, 1.0}}, two, "joint");
  }

  void couple_tendons() {
    const std::map<std::string, double>& one = ratios("tendon1");
    couple(one, node_.has("tendon2") ? ratios("tendon2") : std::map<std::string, double>{},
           "tendon");
  }

  void keep_length(std::pair<MjcfModel::Site, MjcfModel::Site> ends) {
    auto& [one, two] = ends;
    if (one.body == two.body) node_.fail("keeps the length of a tendon in one body, expected two");
    const auto place = [&](const MjcfModel::Site& s) -> Vector3d {
      return model_.frames.at(s.body) * s.frame.at;
    };
    loop_.kind = LoopKind::distance;
    loop_.length = (place(one) - place(two)).norm() + polynomial()[0];
    if (!(loop_.length > 0))
      node_.fail("keeps a tendon at the length " + digits(loop_.length) +
                 ", expected one above 0, or a <connect>");
    if (two.body == "world") std::swap(one, two);  // the parent is the fixed side
    loop_.parent = MjcfModel::in_scene(one.body);
    loop_.child = MjcfModel::in_scene(two.body);
    loop_.origin_parent = one.frame.at;
    loop_.origin_child = two.frame.at;
  }

  const MjcfModel::Tendon& tendon(const char* key) const {
    const std::string name = node_.text(key);
    const auto found = model_.tendons.find(name);
    if (found == model_.tendons.end())
      node_.fail(key, "is " + in_quotes(name) + ", expected the name of a tendon");
    return found->second;
  }
  const std::map<std::string, double>& ratios(const char* key) const {
    const MjcfModel::Tendon& found = tendon(key);
    if (found.ratios.empty())
      node_.fail(key, "is " + in_quotes(node_.text(key)) +
                          ", expected a fixed tendon, or alone one between two sites");
    return found.ratios;
  }

  const Node& node_;
  MjcfModel& model_;
  LoopSpec loop_;
};

}  // namespace

void read_equality(const Node& equality, MjcfModel& model) {
  for (const Node& part : equality.children()) {
    constexpr std::array<std::string_view, 4> kinds{"connect", "weld", "joint", "tendon"};
    if (std::find(kinds.begin(), kinds.end(), part.name()) == kinds.end())
      part.of("equality").fail("is not read, expected one of: " + listed(kinds));
    const Element full = model.defaults.with_defaults(part, "equality", MjcfDefaults::main_class);
    const std::string name = part.text("name", "");
    const Node node(full, name.empty() ? std::string("equality") : "equality " + in_quotes(name),
                    model.scene.file);
    EqualityReader(node, model).read();
  }
}

}  // namespace momenta::reading
