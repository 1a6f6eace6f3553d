#include <momenta/core/massless_joints.h>

#include <algorithm>
#include <limits>

namespace momenta {
namespace {

// Of M_jj. What is left of a row that is lost is rounding of what it was made of, arms much longer
// than those of M_jj among it.
constexpr double lost_pivot = 1e-11;
constexpr std::size_t most_named = 6;

int body_of(const Tree& tree, int rate) {
  int k = 0;
  for (const Tree::Body& b : tree.bodies) {
    if (rate >= b.u && rate < b.u + b.nv) return k;
    ++k;
  }
  return -1;
}

/// A mass on the axis is off it by rounding: of M_jj its square is left, beside the largest of the
/// slides or of the turns.
std::vector<bool> weightless(const Tree& tree, const Eigen::VectorXd& diagonal) {
  constexpr double off_axis = 64 * std::numeric_limits<double>::epsilon();
  constexpr double lost = off_axis * off_axis;
  double largest[2]{};
  for (const Tree::Body& b : tree.bodies)
    for (int i = 0; i < b.nv; ++i)
      largest[b.is_length(i)] = std::max(largest[b.is_length(i)], diagonal[b.u + i]);
  std::vector<bool> none(static_cast<std::size_t>(diagonal.size()));
  for (const Tree::Body& b : tree.bodies)
    for (int i = 0; i < b.nv; ++i)
      none[static_cast<std::size_t>(b.u + i)] =
          !(diagonal[b.u + i] > lost * largest[b.is_length(i)]);
  return none;
}

/// "its axis" of one coordinate, or what joints of several have.
const char* along(const Tree::Body& b) {
  if (b.nv > 1 || b.law)
    return b.kind == JointKind::spherical ? "about some axis through it" : "in some direction";
  return b.kind == JointKind::prismatic ? "along its axis" : "about its axis";
}

/// Of each joint of the scene among them one body of the tree.
std::vector<int> one_a_joint(const Tree& tree, const std::vector<MasslessJoint>& joints) {
  std::vector<int> bodies;
  for (const MasslessJoint& joint : joints) {
    const int k = body_of(tree, joint.rate);
    if (bodies.empty() || tree.bodies[static_cast<std::size_t>(bodies.back())].joint !=
                              tree.bodies[static_cast<std::size_t>(k)].joint)
      bodies.push_back(k);
  }
  return bodies;
}

}  // namespace

std::vector<MasslessJoint> massless_joints(const Tree& tree, const Eigen::VectorXd& diagonal,
                                           const Eigen::MatrixXd& mass, int known) {
  std::vector<bool> lost = weightless(tree, diagonal);
  const std::vector<bool> none = lost;
  if (known >= 0) lost[static_cast<std::size_t>(known)] = true;
  Eigen::MatrixXd m = mass;
  for (Eigen::Index k = m.rows(); k-- > 0;) {
    const double pivot = m(k, k);
    if (lost[static_cast<std::size_t>(k)] || !(pivot > lost_pivot * diagonal[k])) {
      lost[static_cast<std::size_t>(k)] = true;
      continue;
    }
    const Eigen::VectorXd row = m.row(k).head(k).transpose();
    m.topLeftCorner(k, k) -= row * (row / pivot).transpose();
  }
  std::vector<MasslessJoint> all;
  for (std::size_t i = 0; i < lost.size(); ++i)
    if (lost[i]) all.push_back({static_cast<int>(i), none[i]});
  return all;
}

std::string without_inertia(const Tree& tree, const std::vector<MasslessJoint>& joints) {
  const std::vector<int> bodies = one_a_joint(tree, joints);
  if (bodies.size() == 1) return tree.joint_in_words(bodies[0]) + " has no inertia";
  std::string names;
  for (std::size_t i = 0; i < bodies.size() && i < most_named; ++i)
    names += (i == 0 ? "'" : ", '") + tree.bodies[static_cast<std::size_t>(bodies[i])].joint + "'";
  if (bodies.size() > most_named) names += ", … (" + std::to_string(bodies.size()) + ")";
  return "joints " + names + " have no inertia";
}

std::string in_words(const Tree& tree, const std::vector<MasslessJoint>& joints) {
  const std::vector<int> bodies = one_a_joint(tree, joints);
  const bool weightless =
      std::all_of(joints.begin(), joints.end(), [](const auto& joint) { return joint.weightless; });
  const std::string who = without_inertia(tree, joints) + ": ";
  if (bodies.size() > 1)
    return who + "the bodies on them " +
           (weightless
                ? "and what those carry have none along their freedoms"
                : "have none along their freedoms that the joints they carry do not move alone") +
           "; expected masses, rotors' inertias, or fixed joints";
  const Tree::Body& b = tree.bodies[static_cast<std::size_t>(bodies.front())];
  const auto carried = static_cast<std::size_t>(tree.carried_by(b.joint));
  const std::string body = "body '" + tree.bodies[carried].name + "'";
  const bool carries_none =
      std::none_of(tree.bodies.begin(), tree.bodies.end(),
                   [&](const auto& other) { return other.parent == static_cast<int>(carried); });
  return who +
         (weightless || carries_none
              ? body + " and what it carries have none " + along(b)
              : body + " has none " + along(b) + " that the joints it carries do not move alone") +
         "; expected a mass, a rotor's inertia, or a fixed joint";
}

}  // namespace momenta
