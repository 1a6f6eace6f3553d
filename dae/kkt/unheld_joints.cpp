#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/solver_choice.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/tree_factor.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double motion_part = 1e-9;  // relative to a motion's largest rate
constexpr double held_pivot = 1e-9;   // pivots of Φ_q N, relative to the largest terms of a column

/// M of a Lagrangian may be indefinite: the motion of a lost pivot may have momentum.
void keep_those_without_momentum(const MatrixXd& mass, std::vector<MasslessJoint>& joints) {
  constexpr double rounding = 1e-12;
  std::erase_if(joints, [&](const MasslessJoint& joint) {
    const VectorXd terms = mass.cwiseAbs() * joint.motion.cwiseAbs();
    return !((mass * joint.motion).cwiseAbs().maxCoeff() <= rounding * terms.maxCoeff());
  });
}

/// Columns Y with Φ_q N Y = 0.
MatrixXd left_free(const MatrixXd& constraint, const MatrixXd& motions) {
  MatrixXd a = constraint * motions;
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double size = (constraint.cwiseAbs() * motions.col(k).cwiseAbs()).maxCoeff();
    if (size > 0) a.col(k) /= size;
  }
  // A column is measured by its terms, not by its largest entry: where all cancel, no loop holds.
  MatrixXd y = left_null_space(a.transpose(), held_pivot);
  if (y.cols() == 0) return y;  // all are held
  for (Eigen::Index k = 0; k < a.cols(); ++k) {
    const double size = (constraint.cwiseAbs() * motions.col(k).cwiseAbs()).maxCoeff();
    if (size > 0) y.row(k) /= size;
  }
  return y;
}

/// Whether value i of a formula is the number 0.
bool is_zero(const Expression& formula, std::size_t i) {
  const auto& in = formula.tape()[static_cast<std::size_t>(formula.outputs()[i])];
  return in.operation == formula::Operation::number && in.number == 0;
}

/// A sentence naming a coordinate whose rate no momentum determines; empty: none.
std::string free_coordinate(const LagrangianModel& model, const LagrangianSpec& spec) {
  std::vector<bool> held(spec.coordinates.size(), false);
  for (const auto& place : model.constraint.places)
    held[static_cast<std::size_t>(place.column)] = true;
  for (std::size_t k = 0; k < model.mass.places.size(); ++k) {
    const auto& [row, column] = model.mass.places[k];
    if (is_zero(model.mass.values, k)) continue;
    held[static_cast<std::size_t>(row)] = held[static_cast<std::size_t>(column)] = true;
  }
  for (std::size_t i = 0; i < held.size(); ++i)
    if (!held[i])
      return "coordinate '" + spec.coordinates[i].name + "' has no inertia: " +
             (is_zero(model.momenta, i)
                  ? "its rate is not in the Lagrangian, and it is in no constraint; expected one "
                    "of them"
                  : "the Lagrangian is linear in its rate, and it is in no constraint; expected a "
                    "Lagrangian quadratic in it, or a constraint");
  return "";
}

}  // namespace

UnheldJoints unheld_joints(const Mechanism& mechanism, Evaluation<double>& e, double t,
                           const double* q, bool loops, int known) {
  UnheldJoints found;
  e.place(t, q);
  VectorXd diagonal(mechanism.nv());
  e.mass_diagonal(diagonal.data());
  if (!diagonal.allFinite()) return found;
  MatrixXd mass;
  if (mechanism.nv() <= most_pivots) mass = dense_mass(mechanism, e);
  found.joints = massless_joints(mechanism.tree(), q, diagonal, mass, known);
  if (mass.size() == 0 || found.joints.empty()) return found;
  if (mechanism.scene().lagrangian && known < 0) keep_those_without_momentum(mass, found.joints);
  found.motions.resize(mass.rows(), static_cast<Eigen::Index>(found.joints.size()));
  for (std::size_t k = 0; k < found.joints.size(); ++k)
    found.motions.col(static_cast<Eigen::Index>(k)) = found.joints[k].motion;
  if (!loops || mechanism.m() == 0) return found;
  const MatrixXd y = left_free(dense_constraints(mechanism, e), found.motions);
  std::vector<MasslessJoint> unheld;
  for (Eigen::Index k = 0; k < y.rows(); ++k)
    for (Eigen::Index j = 0; j < y.cols(); ++j)
      if (std::abs(y(k, j)) > motion_part * y.col(j).cwiseAbs().maxCoeff()) {
        unheld.push_back(found.joints[static_cast<std::size_t>(k)]);
        break;
      }
  found.joints = std::move(unheld);
  found.motions = found.motions * y;
  return found;
}

UnheldJoints unheld_by_rounding(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                const double* q, bool loops) {
  if (!inertia_may_be_missing(mechanism.tree())) return {};
  UnheldJoints found = unheld_joints(mechanism, e, t, q, loops);
  // Beyond most_pivots rates it is unknown whether loops hold them.
  if (found.motions.cols() == 0 && loops && mechanism.m() > 0) found.joints.clear();
  return found;
}

std::string in_words(const Mechanism& mechanism, const UnheldJoints& unheld) {
  const VectorXd direction =
      unheld.motions.cols() > 0 ? VectorXd(unheld.motions.col(0)) : VectorXd();
  return in_words(mechanism.tree(), unheld.joints, direction);
}

std::string without_loops_in_words(const Mechanism& mechanism,
                                   const std::vector<MasslessJoint>& joints) {
  if (!mechanism.scene().lagrangian)
    return without_inertia(mechanism.tree(), joints) + " without the loops that hold what is on it";
  std::string names;
  for (const MasslessJoint& joint : joints)
    names += (names.empty() ? "'" : ", '") +
             mechanism.scene().lagrangian->coordinates[static_cast<std::size_t>(joint.rate)].name +
             "'";
  return (joints.size() > 1 ? "coordinates " + names + " have" : "coordinate " + names + " has") +
         " no inertia" + (mechanism.m() > 0 ? " without the constraints" : "");
}

std::string mass_without_inverse(const Mechanism& mechanism, Evaluation<double>& e, double t,
                                 const double* q) {
  const auto& pattern = mechanism.kkt_pattern();
  std::vector<double> values(pattern.mass.size());
  e.place(t, q);
  e.mass_entries(values.data());
  const int rate = TreeFactor(pattern, mechanism.nv()).factor(values);
  const UnheldJoints unheld = rate >= 0 ? unheld_joints(mechanism, e, t, q, false, rate)
                                        : unheld_by_rounding(mechanism, e, t, q, false);
  return unheld.joints.empty() ? "" : without_loops_in_words(mechanism, unheld.joints);
}

bool solve_beside(const UnheldJoints& unheld, const Mechanism& mechanism, Evaluation<double>& e,
                  const VectorXd& r, const VectorXd& g, VectorXd& x, VectorXd& lambda) {
  constexpr double powerless = 1e-12;  // relative to the largest force
  const Eigen::Index n = mechanism.nv(), m = g.size();
  const Eigen::Index motions = unheld.motions.cols();
  if ((motions == 0 && !unheld.joints.empty()) || n + m > 2 * most_pivots) return false;
  MatrixXd mass = dense_mass(mechanism, e);
  if (motions > 0) {
    const MatrixXd free = orthogonal_factor(unheld.motions).leftCols(motions);
    if (!((free.transpose() * r).cwiseAbs().maxCoeff() <= powerless * r.cwiseAbs().maxCoeff()))
      return false;
    const double heaviest = mass.diagonal().maxCoeff();
    mass += (heaviest > 0 ? heaviest : 1) * free * free.transpose();
  }
  MatrixXd a = MatrixXd::Zero(n + m, n + m);
  a.topLeftCorner(n, n) = mass;
  if (m > 0) {
    a.bottomLeftCorner(m, n) = dense_constraints(mechanism, e);
    a.topRightCorner(n, m) = a.bottomLeftCorner(m, n).transpose();
  }
  // Scales inertias and rows of Φ to unit size.
  VectorXd scale = VectorXd::Ones(n + m), b(n + m);
  const double least = 1e-12 * mass.diagonal().maxCoeff();  // for rates that loops alone hold
  for (Eigen::Index i = 0; i < n; ++i)
    if (mass(i, i) > 0) scale[i] = 1 / std::sqrt(std::max(mass(i, i), least));
  for (Eigen::Index i = n; i < n + m; ++i) {
    const double size = a.row(i).head(n).cwiseProduct(scale.head(n).transpose()).norm();
    if (size > 0) scale[i] = 1 / size;
  }
  b << r, g;
  a = scale.asDiagonal() * a * scale.asDiagonal();
  DenseLeastSquares system;
  system.compute(a);
  const VectorXd all = scale.asDiagonal() * system.solve(VectorXd(scale.asDiagonal() * b));
  x = all.head(n);
  lambda = all.tail(m);
  return all.allFinite();
}

void blank(const UnheldJoints& unheld, VectorXd& x) {
  for (Eigen::Index k = 0; k < unheld.motions.cols(); ++k) {
    const double largest = unheld.motions.col(k).cwiseAbs().maxCoeff();
    for (Eigen::Index i = 0; i < x.size(); ++i)
      if (std::abs(unheld.motions(i, k)) > motion_part * largest)
        x[i] = std::numeric_limits<double>::quiet_NaN();
  }
}

std::string light_before_loops(const Mechanism& mechanism, int rate) {
  if (mechanism.scene().lagrangian)
    return "coordinate '" +
           mechanism.scene().lagrangian->coordinates[static_cast<std::size_t>(rate)].name +
           "' has no inertia" + (mechanism.m() > 0 ? " before its constraints hold it" : "") +
           ", alone or with those before it";
  for (std::size_t k = 0; k < mechanism.tree().bodies.size(); ++k) {
    const Tree::Body& b = mechanism.tree().bodies[k];
    if (rate >= b.u && rate < b.u + b.nv)
      return mechanism.tree().joint_in_words(static_cast<int>(k)) +
             " has no inertia before its loops close";
  }
  return "";
}

std::string no_inertia(const Mechanism& mechanism, int rate, double t, const double* q,
                       bool by_form) {
  // KLU, which solves (7) all the same, is chosen at the start, and not by a form of its own.
  const bool solved_by_klu = mechanism.m() > 0 && !mechanism.solver().leaves_first();
  const bool asked_dense = mechanism.m() > 0 && mechanism.solver().dense();
  if (mechanism.scene().lagrangian) {
    if (const std::string free =
            free_coordinate(mechanism.lagrangian(), *mechanism.scene().lagrangian);
        !free.empty())
      return free;
    if (rate < 0)
      return "the equations have no finite solution; expected formulas with values there, "
             "and "
             "constraints that hold every coordinate without inertia";
    return light_before_loops(mechanism, rate) +
           "; expected a mass matrix that is positive definite" +
           (solved_by_klu && asked_dense ? ", or --kkt sparse where constraints hold it" : "");
  }
  const auto e = mechanism.evaluation<double>();
  const UnheldJoints unheld = unheld_joints(mechanism, *e, t, q, true, rate);
  if (!unheld.joints.empty()) return in_words(mechanism, unheld);
  if (rate < 0) return "its equations overflow; expected smaller numbers";
  return light_before_loops(mechanism, rate) + "; expected " +
         (solved_by_klu && by_form       ? "another form"
          : solved_by_klu && asked_dense ? "--kkt sparse"
                                         : "a mass or a rotor's inertia there");
}

}  // namespace momenta
