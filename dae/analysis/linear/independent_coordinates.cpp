#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/linear/independent_coordinates.h>
#include <momenta/dae/analysis/linear/loop_drives.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/run/measure/rank.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::MatrixXd;

std::vector<int> without(const std::vector<int>& all, const std::vector<int>& some) {
  std::vector<int> left;
  for (const int i : all)
    if (std::find(some.begin(), some.end(), i) == some.end()) left.push_back(i);
  return left;
}

/// Independent rows of a, nonholonomic ones first; `idle`: forces of rows that move nothing.
std::vector<int> basis_of_rows(const MatrixXd& a, const std::vector<int>& rows,
                               const std::vector<bool>& nonholonomic, double pivot,
                               RankAndIdle& found) {
  found = rank_and_idle(a(rows, Eigen::all), 0, -1, pivot);
  std::vector<int> first;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (nonholonomic[static_cast<std::size_t>(rows[i])]) first.push_back(static_cast<int>(i));
  MatrixXd left = found.left;
  std::vector<int> dependent;
  for (const int i : reduce(left, first)) dependent.push_back(rows[static_cast<std::size_t>(i)]);
  return without(rows, dependent);
}

/// First `count` pivots of a QR decomposition, among these columns.
std::vector<int> pivots(const MatrixXd& a, const std::vector<int>& columns, std::size_t count) {
  std::vector<int> chosen;
  if (count == 0) return chosen;
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(a(Eigen::all, columns));
  for (std::size_t i = 0; i < count; ++i)
    chosen.push_back(columns[static_cast<std::size_t>(
        qr.colsPermutation().indices()[static_cast<Eigen::Index>(i)])]);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Drives vary alone only if loops follow: νᵀΦ_q = 0 at free rates and at theirs.
void expect_followed(const OperatingPoint& at, const MatrixXd& a, const MatrixXd& left) {
  if (left.cols() == 0 || at.driven.empty()) return;
  const MatrixXd against = left.transpose() * a(Eigen::all, at.driven);
  Eigen::Index force, drive, row;
  if (against.cwiseAbs().maxCoeff(&force, &drive) <= rank_tolerance) return;
  left.col(force).cwiseAbs().maxCoeff(&row);
  const Mechanism& m = *at.freed;
  const std::string name =
      m.rate_columns()[static_cast<std::size_t>(at.driven[static_cast<std::size_t>(drive)])].name;
  throw SceneError(
      m.scene().where({}) + "the drive of '" + name.substr(0, name.rfind('.')) +
      "' cannot be varied by itself: " + row_in_words(m, static_cast<int>(row)) +
      " does not follow it; expected drives that the loops leave free, and a pose that "
      "is no dead point");
}

/// Drives that the other loops follow: νᵀΦ_f = 0.
std::vector<int> followed(const OperatingPoint& at, const Eigen::VectorXd& row_factor,
                          const MatrixXd& left) {
  std::vector<int> drives = drives_of_loops_that_vary(at.freed->scene());
  if (left.cols() == 0 || drives.empty()) return drives;
  const Mechanism& m = *at.freed;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(m.nv()), idle = Eigen::VectorXd::Zero(m.m());
  const LoopDriveColumns columns = loop_drive_columns(m, drives, at.t, at.q, none, none, idle);
  std::vector<int> kept;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const Eigen::VectorXd asked =
        row_factor.cwiseProduct(columns.loops.col(static_cast<Eigen::Index>(k)));
    if ((left.transpose() * asked).cwiseAbs().maxCoeff() <=
        rank_tolerance * asked.cwiseAbs().maxCoeff())
      kept.push_back(drives[k]);
  }
  return kept;
}

void expect_determined(const OperatingPoint& at, const MatrixXd& block,
                       const std::vector<int>& named, std::size_t expected) {
  const Mechanism& m = *at.freed;
  std::vector<std::string> names;
  for (const int i : named)
    names.push_back(displacement_columns(m)[static_cast<std::size_t>(i)].name);
  if (named.size() != expected)
    throw SceneError(m.scene().where({}) + "independent coordinates " +
                     reading::all_in_quotes(names) + " are " + std::to_string(named.size()) +
                     ", expected " + std::to_string(expected) + ", as many as are free");
  if (block.size() == 0) return;
  const Eigen::VectorXd sizes = block.jacobiSvd().singularValues();
  if (sizes[sizes.size() - 1] <= rank_tolerance * sizes[0])
    throw SceneError(m.scene().where({}) + "independent coordinates " +
                     reading::all_in_quotes(names) +
                     " do not determine the others at this pose; expected others");
}

}  // namespace

IndependentCoordinates independent_coordinates(const OperatingPoint& at,
                                               const std::vector<int>& named, double pivot) {
  const Mechanism& mechanism = *at.freed;
  IndependentCoordinates c;
  std::vector<int> all, of_positions;
  const auto& nonholonomic = mechanism.nonholonomic();
  for (int i = 0; i < mechanism.m(); ++i) {
    all.push_back(i);
    if (!nonholonomic[static_cast<std::size_t>(i)]) of_positions.push_back(i);
  }
  c.unique.assign(all.size(), true);
  MatrixXd a(0, mechanism.nv());
  if (mechanism.m() > 0) {
    const auto e = mechanism.evaluation<double>();
    e->place(at.t, at.q.data());
    const ScaledJacobian scaled = scaled_jacobian(mechanism, *e);
    const MatrixXd& whole = scaled.a;
    a = MatrixXd::Zero(whole.rows(), whole.cols());
    a(Eigen::all, at.free) = whole(Eigen::all, at.free);
    RankAndIdle found;
    if (!of_positions.empty())
      c.position_rows = basis_of_rows(a, of_positions, nonholonomic, pivot, found);
    c.rows = c.position_rows;
    if (of_positions.size() < all.size()) {
      std::vector<int> more = c.position_rows;
      for (const int i : without(all, of_positions)) more.push_back(i);
      c.rows = basis_of_rows(a, more, nonholonomic, pivot, found);
    }
    found = rank_and_idle(a, 0, static_cast<int>(c.rows.size()));
    expect_followed(at, whole, found.left);
    c.loop_drives = followed(at, scaled.row_factor, found.left);
    constexpr double takes_part = 1e-9;
    for (int i = 0; i < mechanism.m(); ++i)
      c.unique[static_cast<std::size_t>(i)] =
          found.left.cols() == 0 || found.left.row(i).cwiseAbs().maxCoeff() <= takes_part;
    c.kept = found.singular_values.size() > 0 && found.singular_values[0] > 0
                 ? found.kept / found.singular_values[0]
                 : 0;
  }
  c.left_out = without(all, c.rows);
  const std::size_t positions = c.position_rows.size();
  std::vector<int> dependent = named.empty()
                                   ? pivots(a(c.position_rows, Eigen::all), at.free, positions)
                                   : without(at.free, named);
  if (!named.empty())
    expect_determined(
        at, dependent.size() == positions ? MatrixXd(a(c.position_rows, dependent)) : MatrixXd(),
        named, at.free.size() - positions);
  c.free_positions = without(at.free, dependent);
  const std::vector<int> more(c.rows.begin() + static_cast<std::ptrdiff_t>(positions),
                              c.rows.end());
  if (!more.empty()) {
    MatrixXd left = a(more, Eigen::all);
    if (positions > 0)
      left -= a(more, dependent) * MatrixXd(a(c.position_rows, dependent))
                                       .fullPivLu()
                                       .solve(MatrixXd(a(c.position_rows, Eigen::all)));
    for (const int i : pivots(left, c.free_positions, more.size())) dependent.push_back(i);
  }
  c.dependent = dependent;
  c.free_rates = without(at.free, dependent);
  return c;
}

void expect_regular(const Mechanism& mechanism, const Start& at) {
  if (mechanism.m() == 0) return;
  const RankReport report = rank_report(mechanism, at);
  if (!report.singular_here()) return;
  for (const Dependency& d : report.dependencies)
    if (d.only_here)
      throw SceneError(mechanism.scene().where({}) +
                       "the pose is singular: " + in_words(mechanism, d) +
                       ", at this pose alone, so that motions part here and no linear model has "
                       "them; expected a pose away from it");
}

}  // namespace momenta
