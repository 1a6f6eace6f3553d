#include <momenta/core/open_chain/poses.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/lanczos_spectrum.h>
#include <momenta/dae/analysis/linear/local_pencil.h>
#include <momenta/dae/analysis/linear/reduced_spectrum.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_units.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_dense = 400;    // rates, or loop equations, for singular values
constexpr int most_reduced = 300;  // up to which all modes are found
constexpr int usual_count = 20;    // modes found of more

/// Φ_q at the equilibrium in the units of kkt/loop_units.h: D^(−1/2) Φ_q diag(M)^(−1/2).
struct LoopsThere {
  std::vector<double> values;  ///< by the mechanism's pattern
  VectorXd column;             ///< diag(M)^(−1/2), rates without inertia as the heaviest
};

LoopsThere loops_there(const Mechanism& mechanism, const Equilibrium& at) {
  const auto e = mechanism.evaluation<double>();
  e->place(at.t, at.q.data());
  VectorXd inertia(mechanism.nv());
  e->mass_diagonal(inertia.data());
  const double heaviest = std::max(inertia.maxCoeff(), std::numeric_limits<double>::min());
  LoopsThere s;
  s.column = inertia.unaryExpr([&](double x) { return 1 / std::sqrt(x > 0 ? x : heaviest); });
  if (mechanism.m() == 0) return s;
  const auto& pattern = mechanism.constraint_pattern();
  s.values.resize(pattern.size());
  e->constraint_entries(s.values.data());
  const std::vector<double> rows = row_scales(mechanism, *e);
  for (std::size_t i = 0; i < s.values.size(); ++i) {
    s.values[i] *=
        s.column[pattern[i].column] / std::sqrt(rows[static_cast<std::size_t>(pattern[i].row)]);
  }
  return s;
}

/// Motions that loops allow: right singular vectors of singular value zero, Φ_q having this rank.
MatrixXd motions_dense(const Mechanism& mechanism, const LoopsThere& s, int rank) {
  const int nv = mechanism.nv(), m = mechanism.m();
  if (m == 0) return MatrixXd::Identity(nv, nv);
  MatrixXd a = MatrixXd::Zero(m, nv);
  const auto& pattern = mechanism.constraint_pattern();
  for (std::size_t i = 0; i < pattern.size(); ++i)
    a(pattern[i].row, pattern[i].column) = s.values[i];
  return s.column.asDiagonal() * SingularValues(a).v.rightCols(nv - rank);
}

/// The same, by projection of as many random vectors.
MatrixXd motions_by_projection(const Mechanism& mechanism, const Equilibrium& at,
                               const LoopsThere& s, const std::vector<int>& dependent,
                               int mobility) {
  LocalPencil pencil(mechanism);
  pencil.leave_out(dependent);
  const auto e = mechanism.evaluation<double>();
  const VectorXd rest = VectorXd::Zero(mechanism.nv());
  e->place(at.t, at.q.data());
  e->move(rest.data());
  const VectorXd natural =
      force_scales(mechanism, *e).cwiseProduct(s.column).cwiseProduct(s.column);
  if (!pencil.factor(at.t, at.q, at.lambda, std::max(natural.maxCoeff(), 1e-12), 0))
    throw SceneError(mechanism.scene().where({}) +
                     "the linearised equations are singular: expected inertia in every motion");
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  MatrixXd scaled(mechanism.nv(), mobility);
  for (int k = 0; k < mobility; ++k) {
    VectorXd x(mechanism.nv()), g = VectorXd::Zero(mechanism.m());
    for (int i = 0; i < mechanism.nv(); ++i) x[i] = normal(random) / s.column[i];
    pencil.solve(x, g);
    scaled.col(k) = x.cwiseQuotient(s.column);
  }
  const Eigen::HouseholderQR<MatrixXd> qr(scaled);
  const MatrixXd orthonormal = qr.householderQ() * MatrixXd::Identity(scaled.rows(), mobility);
  return s.column.asDiagonal() * orthonormal;
}

/// A spring of no length has no direction, and no stiffness.
void refuse_springs_without_length(const Mechanism& mechanism, const Equilibrium& at) {
  const Scene& scene = mechanism.scene();
  const auto is_spring = [](const ForceSpec& f) { return f.kind == "spring-damper"; };
  if (std::none_of(scene.forces.begin(), scene.forces.end(), is_spring)) return;
  const auto poses = Poses(mechanism.tree(), scene)(at.t, at.q.data());
  const auto place = [&](const std::string& body, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    const int k = body == "ground" ? -1 : mechanism.tree().body(body);
    return k < 0 ? point : Eigen::Vector3d(poses[static_cast<std::size_t>(k)] * point);
  };
  for (const ForceSpec& f : scene.forces) {
    if (!is_spring(f) || (f.stiffness == 0 && f.damping == 0 && f.law.empty())) continue;
    const double length =
        (place(f.child, f.origin_child) - place(f.parent, f.origin_parent)).norm();
    if (length <= 1e-9 * length_of(scene))
      throw SceneError(scene.where(f.at) + with_ends("spring", f) +
                       " has no length at the equilibrium, so that its direction is not "
                       "determined; expected ends that are apart there");
  }
}

}  // namespace

Mode::Kind Mode::kind() const {
  if (s == 0.0) return Kind::rigid;
  if (s.imag() != 0) return Kind::oscillation;
  return s.real() > 0 ? Kind::growth : Kind::decay;
}

double Mode::frequency() const {
  return s.imag() / (2 * std::numbers::pi);
}

double Mode::damping_ratio() const {
  if (s == 0.0) return std::numeric_limits<double>::quiet_NaN();
  return s.real() == 0 ? 0 : -s.real() / std::abs(s);
}

const char* name_of(Mode::Kind kind) {
  switch (kind) {
    case Mode::Kind::oscillation:
      return "oscillation";
    case Mode::Kind::rigid:
      return "rigid";
    case Mode::Kind::growth:
      return "growth";
    case Mode::Kind::decay:
      break;
  }
  return "decay";
}

Spectrum spectrum(const Mechanism& mechanism, const Equilibrium& at, int count, Route route) {
  Spectrum found;
  found.mobility = mechanism.nv();
  if (mechanism.nv() == 0) return found;
  refuse_springs_without_length(mechanism, at);
  const LoopsThere scaled = loops_there(mechanism, at);
  if (mechanism.m() > 0) {
    const auto e = mechanism.evaluation<double>();
    e->place(at.t, at.q.data());
    LoopRank loops = loop_rank(mechanism, *e, Judged::singular_values, at.pivot);
    found.rank = loops.rank;
    found.dependent_rows = std::move(loops.dependent);
  }
  found.mobility = mechanism.nv() - found.rank;
  found.dense =
      route == Route::dense ||
      (route == Route::automatic && mechanism.nv() <= most_dense && mechanism.m() <= most_dense);
  if (found.dense) {
    const MatrixXd N = motions_dense(mechanism, scaled, found.rank);
    reduced_spectrum(mechanism, at, N, found);
  } else {
    if (found.mobility <= most_reduced) {
      reduced_spectrum(
          mechanism, at,
          motions_by_projection(mechanism, at, scaled, found.dependent_rows, found.mobility),
          found);
    } else {
      lanczos_spectrum(mechanism, at, count > 0 ? count : usual_count, found);
    }
  }
  if (count > 0 && found.modes.size() > static_cast<std::size_t>(count)) {
    // Growing modes, then those nearest to s = 0.
    found.modes.resize(static_cast<std::size_t>(count));
    found.complete = false;
  }
  return found;
}

}  // namespace momenta
