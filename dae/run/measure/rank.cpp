#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/run/measure/rank.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int walks = 4, poses_of_a_walk = 2;
constexpr double way = 0.1;          // step [rad, m]
constexpr double takes_part = 1e-6;  // relative coefficient

class RankScout {
 public:
  RankScout(const Mechanism& mechanism, double t, const VectorXd& q)
      : mechanism_(mechanism), e_(mechanism.evaluation<double>()) {
    VectorXd phi(mechanism.m());
    e_->place(t, q.data());
    e_->positions(phi.data());
    closed_ = std::max(1e-10, 4 * phi.cwiseAbs().maxCoeff());
  }

  ScaledJacobian scaled(double t, const VectorXd& q) {
    e_->place(t, q.data());
    return scaled_jacobian(mechanism_, *e_);
  }

  LoopRank judged(double t, const VectorXd& q) {
    e_->place(t, q.data());
    return loop_rank(mechanism_, *e_);
  }

  /// M u
  VectorXd momentum(double t, const VectorXd& q, const VectorXd& u) {
    VectorXd p(mechanism_.nv());
    e_->place(t, q.data());
    e_->move(u.data());
    e_->momenta(nullptr, p.data());
    return p;
  }

  /// A pose on Φ = 0 about `way` from q; empty: none found.
  VectorXd nearby(double t, const VectorXd& q, const VectorXd& momentum) {
    const int nv = mechanism_.nv();
    VectorXd u(nv);
    solver_ = make_loop_solver(mechanism_, *e_);
    if (!solver_->free_velocity(t, q.data(), momentum.data(), u.data()) || !u.allFinite())
      return {};
    const double fastest = u.size() > 0 ? u.cwiseAbs().maxCoeff() : 0;
    if (!(fastest > 1e-9)) return {};
    u *= way / fastest;
    VectorXd next = moved(t, q, u);
    VectorXd phi(mechanism_.m()), delta(nv);
    for (int pass = 0; pass < 20; ++pass) {
      e_->place(t, next.data());
      e_->positions(phi.data());
      if (phi.cwiseAbs().maxCoeff() < 1e-14 * (1 + next.cwiseAbs().maxCoeff())) break;
      if (!solver_->position_correction(t, next.data(), delta.data()) || !delta.allFinite())
        return {};
      next = moved(t, next, delta);
    }
    e_->place(t, next.data());
    e_->positions(phi.data());
    if (!(phi.cwiseAbs().maxCoeff() < closed_)) return {};
    return (next - q).norm() > 0.1 * way ? next : VectorXd();
  }

 private:
  VectorXd moved(double t, const VectorXd& q, const VectorXd& u) {
    VectorXd qdot = VectorXd::Zero(mechanism_.nq());
    e_->place(t, q.data());
    e_->coordinate_rates(q.data(), u.data(), qdot.data());
    VectorXd next = q + qdot;
    mechanism_.tree().normalise(next);
    return next;
  }

  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  std::unique_ptr<LoopSolver> solver_;
  double closed_;  ///< |Φ|∞: rounding, or gap of redundant equations
};

/// A loop with some of its rows alone.
struct Simplification {
  LoopKind from;
  const char* to;
  std::vector<int> rows;  ///< kept rows, counted within the loop
};
const std::vector<Simplification>& in_space() {
  static const std::vector<Simplification> all{{LoopKind::weld, "revolute", {0, 1, 2, 4, 5}},
                                               {LoopKind::weld, "prismatic", {0, 1, 3, 4, 5}},
                                               {LoopKind::weld, "cylindrical", {0, 1, 4, 5}},
                                               {LoopKind::weld, "universal", {0, 1, 2, 5}},
                                               {LoopKind::weld, "planar", {2, 4, 5}},
                                               {LoopKind::weld, "point", {0, 1, 2}},
                                               {LoopKind::revolute, "cylindrical", {0, 1, 3, 4}},
                                               {LoopKind::revolute, "universal", {0, 1, 2, 3}},
                                               {LoopKind::revolute, "planar", {2, 3, 4}},
                                               {LoopKind::revolute, "point", {0, 1, 2}},
                                               {LoopKind::prismatic, "cylindrical", {0, 1, 3, 4}},
                                               {LoopKind::universal, "point", {0, 1, 2}}};
  return all;
}
const std::vector<Simplification>& in_plane() {
  static const std::vector<Simplification> all{{LoopKind::weld, "revolute", {0, 1}}};
  return all;
}

/// Loops, last first, each with the fewest rows that keep the rank of `a`.
std::vector<SimplerLoop> simpler_loops(const Mechanism& mechanism, const MatrixXd& a, int rank,
                                       const std::vector<bool>& involved) {
  const auto& rows = mechanism.rows();
  std::vector<bool> kept(rows.size(), true);
  const double largest = a.norm();
  const auto rank_of = [&](const std::vector<bool>& which) {
    MatrixXd part(std::count(which.begin(), which.end(), true), a.cols());
    Eigen::Index k = 0;
    for (std::size_t i = 0; i < which.size(); ++i)
      if (which[i]) part.row(k++) = a.row(static_cast<Eigen::Index>(i));
    return rank_and_idle(part, largest).rank;
  };
  std::vector<SimplerLoop> found;
  const auto& loops = mechanism.scene().loops;
  int end = static_cast<int>(rows.size());
  for (auto loop = loops.rbegin(); loop != loops.rend(); ++loop) {
    int begin = end;
    while (begin > 0 && rows[static_cast<std::size_t>(begin - 1)].loop == loop->name) --begin;
    const int count = end - begin;
    end = begin;
    const bool driven =
        std::any_of(mechanism.scene().drives.begin(), mechanism.scene().drives.end(),
                    [&](const DriveSpec& d) { return d.loop == loop->name; });
    if (driven || std::none_of(involved.begin() + begin, involved.begin() + begin + count,
                               [](bool b) { return b; }))
      continue;
    std::vector<std::pair<std::string, std::vector<int>>> candidates{{"", {}}};
    for (const Simplification& s : mechanism.plan().planar ? in_plane() : in_space())
      if (s.from == loop->kind) candidates.push_back({s.to, s.rows});
    std::stable_sort(candidates.begin(), candidates.end(), [](const auto& x, const auto& y) {
      return x.second.size() < y.second.size();
    });
    for (const auto& [kind, chosen] : candidates) {
      std::vector<bool> fewer = kept;
      for (int i = 0; i < count; ++i)
        fewer[static_cast<std::size_t>(begin + i)] =
            std::find(chosen.begin(), chosen.end(), i) != chosen.end();
      if (rank_of(fewer) < rank) continue;
      kept = fewer;
      found.push_back({loop->name, kind, count - static_cast<int>(chosen.size())});
      break;
    }
  }
  std::reverse(found.begin(), found.end());
  return found;
}

}  // namespace

bool RankReport::unique(int row) const {
  for (Eigen::Index k = 0; k < idle.cols(); ++k) {
    const VectorXd work = idle.col(k).cwiseProduct(units);  // forces and moments compare
    if (std::abs(work[row]) > takes_part * work.cwiseAbs().maxCoeff()) return false;
  }
  return true;
}

RankReport rank_report(const Mechanism& mechanism, const Start& start) {
  const double t = start.t;
  const VectorXd& q = start.q;
  RankReport report;
  if (mechanism.m() == 0) return report;
  RankScout scout(mechanism, t, q);
  const auto [here, factor] = scout.scaled(t, q);
  const LoopRank verdict = scout.judged(t, q);
  RankAndIdle own = rank_and_idle(here, 0, verdict.rank);
  report.rank = report.rank_nearby = own.rank;
  report.kept = own.kept;
  report.dropped = own.dropped;

  MatrixXd elsewhere = here;
  MatrixXd left_elsewhere = own.left;
  std::mt19937 random(1);  // fixed seed
  VectorXd from, u(mechanism.nv());
  std::normal_distribution<double> normal;
  for (int i = 0; i < walks * poses_of_a_walk; ++i) {
    // Motions part at a singular pose, some to poses of lower rank. The first follows the
    // mechanism.
    if (i % poses_of_a_walk == 0) from = q;
    if (i == 0 && !start.u.isZero(0))
      u = start.u;
    else if (i != 1 || start.u.isZero(0))
      for (double& x : u) x = normal(random);
    const VectorXd pose = scout.nearby(t, from, scout.momentum(t, from, u));
    if (pose.size() == 0) continue;
    from = pose;
    ++report.poses;
    const MatrixXd a = scout.scaled(t, pose).a;
    RankAndIdle there = rank_and_idle(a);
    if (there.rank > report.rank_nearby || (report.poses == 1 && there.rank >= report.rank)) {
      report.rank_nearby = there.rank;
      elsewhere = a;
      left_elsewhere = std::move(there.left);
    }
  }

  const std::vector<int> rows = reduce(own.left);
  const std::vector<int> everywhere = reduce(left_elsewhere, rows);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    Dependency d;
    d.row = rows[k];
    const auto column = own.left.col(static_cast<Eigen::Index>(k));
    const double largest = column.cwiseAbs().maxCoeff();
    for (int i = 0; i < mechanism.m(); ++i)
      if (i != d.row && std::abs(column[i]) > takes_part * largest) d.on.push_back(i);
    d.only_here = std::find(everywhere.begin(), everywhere.end(), d.row) == everywhere.end();
    report.dependencies.push_back(std::move(d));
  }
  std::sort(report.dependencies.begin(), report.dependencies.end(),
            [](const Dependency& a, const Dependency& b) { return a.row < b.row; });
  report.idle = factor.asDiagonal() * own.left;
  report.units = factor.cwiseInverse();

  std::vector<bool> involved(static_cast<std::size_t>(mechanism.m()));
  for (Eigen::Index k = 0; k < left_elsewhere.cols(); ++k)
    for (int i = 0; i < mechanism.m(); ++i)
      if (std::abs(left_elsewhere(i, k)) > takes_part * left_elsewhere.col(k).cwiseAbs().maxCoeff())
        involved[static_cast<std::size_t>(i)] = true;
  if (!everywhere.empty())
    report.simpler = simpler_loops(mechanism, elsewhere, report.rank_nearby, involved);
  return report;
}

namespace {

/// Row within its loop, from 1.
int number_of(const std::vector<RowName>& rows, int row) {
  int k = row;
  while (k > 0 &&
         rows[static_cast<std::size_t>(k - 1)].loop == rows[static_cast<std::size_t>(row)].loop)
    --k;
  return row - k + 1;
}

}  // namespace

std::string row_in_words(const Mechanism& mechanism, int row) {
  const auto& rows = mechanism.rows();
  const RowName& own = rows[static_cast<std::size_t>(row)];
  if (mechanism.scene().lagrangian) return "constraint '" + own.loop + "'";
  return "loop '" + own.loop + "' row " + std::to_string(number_of(rows, row)) + ", " + own.what;
}

std::string in_words(const Mechanism& mechanism, const Dependency& dependency) {
  const auto& rows = mechanism.rows();
  if (mechanism.scene().lagrangian && !dependency.on.empty()) {
    std::string text = row_in_words(mechanism, dependency.row) + " follows from ";
    for (std::size_t i = 0; i < dependency.on.size(); ++i)
      text += (i > 0 ? ", '" : "'") + rows[static_cast<std::size_t>(dependency.on[i])].loop + "'";
    return text;
  }
  const auto number = [&](int row) { return number_of(rows, row); };
  std::string text = row_in_words(mechanism, dependency.row);
  if (dependency.on.empty()) return text + ", asks for nothing that the others do not grant";
  text += ", follows from ";
  std::string loop;
  int of_loop = 0;
  std::string numbers;
  const auto flush = [&](bool first) {
    if (loop.empty()) return;
    text += std::string(first ? "" : ", ") + "loop '" + loop + "' row" +
            (of_loop > 1 ? "s " : " ") + numbers;
  };
  bool first = true;
  for (const int row : dependency.on) {
    const auto& name = rows[static_cast<std::size_t>(row)].loop;
    if (name != loop) {
      flush(first);
      first = first && loop.empty();
      loop = name;
      of_loop = 0;
      numbers.clear();
    }
    numbers += (of_loop++ == 0 ? "" : ", ") + std::to_string(number(row));
  }
  flush(first);
  return text;
}

}  // namespace momenta
