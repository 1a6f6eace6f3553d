#include <momenta/core/kernel/massless_joints.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace momenta {
namespace {

constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
constexpr std::size_t most_named = 6;

int body_of(const Tree& tree, int rate) {
  int k = 0;
  for (const Tree::Body& b : tree.bodies) {
    if (rate >= b.u && rate < b.u + b.nv) return k;
    ++k;
  }
  return -1;
}

/// Σ m, Σ m r and Σ (tr I + m r²) of all that a body carries, about its origin.
struct Carried {
  double mass = 0, first = 0, second = 0;
};

/// How far the joint's coordinate shifts the body's origin.
double slide(const Tree::Body& b, const double* q) {
  if (b.nq == 7) return Eigen::Vector3d(q[b.q], q[b.q + 1], q[b.q + 2]).norm();
  if (b.nq != 1 || b.law) return 0;
  const bool slides = b.kind == JointKind::prismatic || b.kind == JointKind::helical;
  return slides ? std::abs((b.kind == JointKind::helical ? b.pitch : 1) * q[b.q]) : 0;
}

/// s (nv); |M_jj| for a Lagrangian and for user joints, whose rates say nothing of lengths.
Eigen::VectorXd sizes(const Tree& tree, const double* q, const Eigen::VectorXd& diagonal) {
  Eigen::VectorXd size = diagonal.cwiseAbs();
  std::vector<Carried> all(tree.bodies.size());
  for (std::size_t k = all.size(); k-- > 0;) {
    const Tree::Body& b = tree.bodies[k];
    Carried& c = all[k];
    const double arm = b.com.norm();
    c.mass += b.mass;
    c.first += b.mass * arm;
    c.second += b.mass * arm * arm + b.inertia.cwiseAbs().diagonal().sum();
    for (int i = 0; i < b.nv && !b.law; ++i)
      size[b.u + i] = b.rotor + (b.is_length(i) ? c.mass : c.second) + b.pitch * b.pitch * c.mass;
    if (b.parent < 0) continue;
    Carried& p = all[static_cast<std::size_t>(b.parent)];
    const double way = b.placement.translation().norm() + slide(b, q);
    p.mass += c.mass;
    p.first += c.first + way * c.mass;
    p.second += c.second + 2 * way * c.first + way * way * c.mass;
  }
  return size;
}

/// Velocity and angular velocity of a body's frame, in its own axes, at unit rates of a joint.
using Motions = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// The motions of the frame on a joint; unknown for user joints.
Motions own_motions(const Tree::Body& b) {
  Motions g = Motions::Zero(6, b.nv);
  if (b.nv == 6) return Motions::Identity(6, 6);
  if (b.nv == 3)
    g.bottomRows<3>().setIdentity();
  else if (b.kind == JointKind::prismatic)
    g(2, 0) = 1;
  else
    g(5, 0) = 1, g(2, 0) = b.pitch;
  return g;
}

/// Joint-space mass matrix of one body under motions g of its frame.
Eigen::MatrixXd energy(const Tree::Body& b, const Motions& g) {
  const Eigen::MatrixXd turns = g.bottomRows(3);
  Eigen::MatrixXd com = g.topRows(3);
  for (Eigen::Index i = 0; i < g.cols(); ++i)
    com.col(i) += Eigen::Vector3d(turns.col(i)).cross(b.com);
  return b.mass * com.transpose() * com + turns.transpose() * b.inertia * turns;
}

/// Whether a joint's own body, with what is welded to it, has inertia along it, by place in u.
std::vector<bool> has_own_inertia(const Tree& tree) {
  const std::size_t count = tree.bodies.size();
  std::vector<Motions> motions(count);
  std::vector<std::size_t> mover(count);  // the joint that moves what is welded together
  std::vector<Eigen::MatrixXd> own(count);
  std::vector<Carried> made_of(count);
  for (std::size_t k = 0; k < count; ++k) {
    const Tree::Body& b = tree.bodies[k];
    mover[k] = k;
    if (b.nv > 0 && !b.law) {
      motions[k] = own_motions(b);
      own[k] = b.rotor * Eigen::MatrixXd::Identity(b.nv, b.nv);
    } else if (b.nv == 0 && b.kind == JointKind::weld && b.parent >= 0) {
      const auto parent = static_cast<std::size_t>(b.parent);
      const Motions& g = motions[parent];
      mover[k] = mover[parent];
      motions[k].resize(6, g.cols());
      const Eigen::Matrix3d back = b.placement.linear().transpose();
      for (Eigen::Index i = 0; i < g.cols(); ++i) {
        const Eigen::Vector3d v = g.col(i).head<3>(), turn = g.col(i).tail<3>();
        motions[k].col(i) << back * (v + turn.cross(b.placement.translation())), back * turn;
      }
    }
    if (motions[k].cols() == 0) continue;
    own[mover[k]] += energy(b, motions[k]);
    const double arm = motions[k].topRows<3>().norm() + b.com.norm();
    made_of[mover[k]].mass += b.mass;
    made_of[mover[k]].second += b.mass * arm * arm + b.inertia.cwiseAbs().diagonal().sum();
  }
  std::vector<bool> has(static_cast<std::size_t>(tree.nv), false);
  for (std::size_t k = 0; k < count; ++k) {
    const Tree::Body& b = tree.bodies[k];
    if (b.nv == 0 || b.law) continue;
    Eigen::VectorXd scale(b.nv);
    for (int i = 0; i < b.nv; ++i) {
      const double size = b.rotor + (b.is_length(i) ? made_of[k].mass : made_of[k].second) +
                          b.pitch * b.pitch * made_of[k].mass;
      scale[i] = size > 0 ? 1 / std::sqrt(size) : 0;
    }
    const Eigen::MatrixXd scaled = scale.asDiagonal() * own[k] * scale.asDiagonal();
    if (scaled.ldlt().vectorD().minCoeff() > rounding) std::fill_n(has.begin() + b.u, b.nv, true);
  }
  return has;
}

/// Where a joint lacks inertia: its one axis, or a direction of several.
const char* along(const Tree::Body& b) {
  if (b.nv > 1 || b.law)
    return b.kind == JointKind::spherical ? "about some axis through it" : "in some direction";
  return b.kind == JointKind::prismatic ? "along its axis" : "about its axis";
}

/// ", as at rates 1 of joint 'a', -0.5 of joint 'b' no mass moves"; empty for a single rate.
std::string rates_in_words(const Tree& tree, const Eigen::VectorXd& motion) {
  constexpr double takes_part = 1e-6;
  if (motion.size() == 0) return "";
  Eigen::Index at = 0;
  const double largest = motion.cwiseAbs().maxCoeff(&at);
  const Eigen::VectorXd unit = motion / motion[at];
  std::string words;
  std::size_t joints = 0;
  for (std::size_t k = 0; k < tree.bodies.size() && largest > 0; ++k) {
    const Tree::Body& b = tree.bodies[k];
    if (b.nv == 0 || !(unit.segment(b.u, b.nv).cwiseAbs().maxCoeff() > takes_part)) continue;
    if (++joints > most_named) return words + ", … no mass moves";
    words += joints == 1 ? ", as at rates " : ", ";
    for (int i = 0; i < b.nv; ++i) {
      const double rate = unit[b.u + i];
      char text[32];
      std::snprintf(text, sizeof text, "%.3g", std::abs(rate) > takes_part ? rate : 0);
      words += (i > 0 ? ", " : b.nv > 1 ? "(" : "") + std::string(text);
    }
    words += (b.nv > 1 ? ") of " : " of ") + tree.joint_in_words(static_cast<int>(k));
  }
  const bool one_rate = joints == 1 && words.find('(') == std::string::npos;
  return one_rate ? "" : words + " no mass moves";
}

/// One body of the tree for each joint of the scene among `joints`.
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

bool inertia_may_be_missing(const Tree& tree) {
  const std::vector<bool> own = has_own_inertia(tree);
  return std::find(own.begin(), own.end(), false) != own.end();
}

std::vector<MasslessJoint> massless_joints(const Tree& tree, const double* q,
                                           const Eigen::VectorXd& diagonal,
                                           const Eigen::MatrixXd& mass, int known) {
  const bool formulas = tree.bodies.empty();  // M of a Lagrangian need not be positive
  const Eigen::VectorXd size = sizes(tree, q, diagonal), root = size.cwiseSqrt();
  const std::vector<bool> own = has_own_inertia(tree);
  std::vector<MasslessJoint> all;
  std::vector<bool> lost(static_cast<std::size_t>(diagonal.size()));
  Eigen::MatrixXd m = mass;  // row k, once eliminated: L_k D_k
  for (Eigen::Index k = diagonal.size(); k-- > 0;) {
    const bool weightless = !formulas && !(diagonal[k] > rounding * size[k]);
    Eigen::VectorXd motion;
    bool is_lost = weightless || k == known;
    if (m.size() > 0) {
      motion = Eigen::VectorXd::Zero(m.rows());
      motion[k] = 1;
      for (Eigen::Index j = k + 1; j < m.rows(); ++j)
        if (!lost[static_cast<std::size_t>(j)])
          motion[j] = -m.row(j).segment(k, j - k).dot(motion.segment(k, j - k)) / m(j, j);
      const double terms = motion.cwiseAbs().dot(root);
      const double pivot = formulas ? std::abs(m(k, k)) : m(k, k);
      is_lost |= !own[static_cast<std::size_t>(k)] && !(pivot > rounding * terms * terms);
    }
    if (is_lost) {
      lost[static_cast<std::size_t>(k)] = true;
      all.push_back({static_cast<int>(k), weightless, std::move(motion)});
    } else if (m.size() > 0) {
      const Eigen::VectorXd row = m.row(k).head(k).transpose();
      m.topLeftCorner(k, k) -= row * (row / m(k, k)).transpose();
    }
  }
  std::reverse(all.begin(), all.end());
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

std::string in_words(const Tree& tree, const std::vector<MasslessJoint>& joints,
                     const Eigen::VectorXd& direction) {
  const std::vector<int> bodies = one_a_joint(tree, joints);
  const bool weightless =
      std::all_of(joints.begin(), joints.end(), [](const auto& joint) { return joint.weightless; });
  const std::string who = without_inertia(tree, joints) + ": ";
  const std::string rates =
      rates_in_words(tree, direction.size() > 0 ? direction : joints.front().motion);
  if (bodies.size() > 1)
    return who + "the bodies on them " +
           (weightless
                ? "and what those carry have none along their freedoms"
                : "have none along their freedoms that the joints they carry do not move alone" +
                      rates) +
           "; expected masses, rotors' inertias, or fixed joints";
  const Tree::Body& b = tree.bodies[static_cast<std::size_t>(bodies.front())];
  const auto carried = static_cast<std::size_t>(tree.carried_by(b.joint));
  const std::string body = "body '" + tree.bodies[carried].name + "'";
  const bool carries_none =
      std::none_of(tree.bodies.begin(), tree.bodies.end(),
                   [&](const auto& other) { return other.parent == static_cast<int>(carried); });
  return who +
         (weightless || carries_none
              ? body + " and what it carries have none " + along(b) + (weightless ? "" : rates)
              : body + " has none " + along(b) + " that the joints it carries do not move alone" +
                    rates) +
         "; expected a mass, a rotor's inertia, or a fixed joint";
}

}  // namespace momenta
