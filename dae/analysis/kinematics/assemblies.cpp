#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/analysis/kinematics/assemblies.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/homotopy.h>
#include <momenta/dae/analysis/kinematics/loop_polynomials.h>
#include <momenta/dae/analysis/kinematics/pose_space.h>
#include <momenta/dae/topology/assembly/closing.h>
#include <momenta/dae/topology/assembly/turned_loops.h>

#include <Eigen/QR>
#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double free_value = 1e-9;  // relative singular values of freedoms

class Search {
 public:
  Search(const Mechanism& mechanism, double t, const VectorXd& own,
         const AssembliesRequest& request)
      : mechanism_(mechanism), t_(t), own_(own), request_(request), loops_(mechanism) {
    for (const std::string& name : request.hold) held_.push_back(coordinate_named(mechanism, name));
    for (const auto& [q, u] : held_) loops_.columns[static_cast<std::size_t>(u)] = false;
    if (request.by_homotopy) spins_ = idle_spins(mechanism, t, own, held_rates());
    expect_no_freedom();
    space_.emplace(mechanism, t, own, loops_);
  }

  Assemblies run() {
    Assemblies found = request_.by_homotopy ? by_homotopy() : by_search();
    std::stable_sort(found.all.begin(), found.all.end(),
                     [](const auto& a, const auto& b) { return a.apart < b.apart; });
    return found;
  }

 private:
  std::vector<bool> held_rates() const {
    std::vector<bool> held(static_cast<std::size_t>(mechanism_.nv()), false);
    for (const auto& [q, u] : held_) held[static_cast<std::size_t>(u)] = true;
    return held;
  }

  Assemblies by_homotopy() {
    if (std::find(loops_.columns.begin(), loops_.columns.end(), true) == loops_.columns.end()) {
      // No equation is left: one solution, the pose itself.
      Assemblies own;
      own.paths = {.paths = 1, .finite = 1, .real = 1};
      add(own, own_, 1);
      return own;
    }
    const auto polynomials = loop_polynomials(mechanism_, t_, own_, held_rates());
    const HomotopyEnds ends =
        solve_by_homotopy(polynomials->system(), request_.seed, request_.threads);
    Assemblies found;
    PathCount count{ends.paths, 0, ends.infinite, ends.singular, ends.lost, 0};
    add(found, own_, 0);
    LeastNorm steps(loops_.pattern(), mechanism_.m(), mechanism_.nv());
    Closing closing(loops_, steps, t_);
    constexpr double moved_on = 1e-5;  // by Newton's method, at the most
    for (const Eigen::VectorXcd& x : ends.finite) {
      if (!polynomials->is_solution(x)) {
        ++count.infinite;
        continue;
      }
      ++count.finite;
      const std::optional<VectorXd> pose = polynomials->pose(x);
      if (!pose) continue;
      const Closing::Pose closed = closing.beside(*pose);
      if (!closed.is_closed || space_->apart(closed.q, *pose) > moved_on ||
          !turned_loops(mechanism_, t_, closed.q).empty()) {
        ++count.lost;  // a solution that is no assembly proves an error
        continue;
      }
      ++count.real;
      add(found, closed.q, 1);
    }
    count.count_copies_once(polynomials->copies());
    found.paths = count;
    return found;
  }

  Assemblies by_search() {
    Assemblies found;
    found.starts = request_.starts;
    std::vector<bool> held(static_cast<std::size_t>(mechanism_.nq()), false);
    for (const auto& [q, u] : held_) held[static_cast<std::size_t>(q)] = true;
    std::vector<std::optional<VectorXd>> poses(static_cast<std::size_t>(request_.starts));
    {
      std::atomic<std::size_t> next{0};
      std::vector<std::jthread> workers;
      for (int k = 0; k < std::max(1, request_.threads); ++k)
        workers.emplace_back([&] {
          ScaledLoops loops(mechanism_);
          loops.columns = loops_.columns;
          LeastNorm steps(loops.pattern(), mechanism_.m(), mechanism_.nv());
          Closing closing(loops, steps, t_);
          for (std::size_t i; (i = next++) < poses.size();) {
            const Closing::Pose pose = closing.beside(space_->start(request_.seed, i, held));
            if (pose.is_closed) poses[i] = pose.q;
          }
        });
    }
    add(found, own_, 0);
    for (const auto& pose : poses) {
      if (!pose) continue;
      if (!turned_loops(mechanism_, t_, *pose).empty()) {
        ++found.turned;
        continue;
      }
      ++found.closed;
      add(found, *pose, 1);
    }
    return found;
  }

  /// D⁻¹ Φ_q C in the free columns; `rates`: their indices.
  MatrixXd free_columns(const VectorXd& q, std::vector<int>& rates) {
    loops_.gap(t_, q);  // places the loops at q
    const std::vector<double> entries = loops_.jacobian();
    MatrixXd all = MatrixXd::Zero(mechanism_.m(), mechanism_.nv());
    for (std::size_t k = 0; k < entries.size(); ++k)
      all(loops_.pattern()[k].row, loops_.pattern()[k].column) = entries[k];
    rates.clear();
    for (int u = 0; u < mechanism_.nv(); ++u)
      if (loops_.columns[static_cast<std::size_t>(u)]) rates.push_back(u);
    MatrixXd chosen(mechanism_.m(), static_cast<int>(rates.size()));
    for (std::size_t k = 0; k < rates.size(); ++k)
      chosen.col(static_cast<int>(k)) = all.col(rates[k]);
    return chosen;
  }

  void expect_no_freedom() {
    std::vector<int> rates;
    const MatrixXd j = free_columns(own_, rates);
    if (j.cols() == 0) return;
    MatrixXd null = MatrixXd::Identity(j.cols(), j.cols());
    if (j.rows() > 0) {
      const SingularValues svd(j);
      null = svd.v.rightCols(j.cols() - svd.rank(free_value));
    }
    const Eigen::Index freedoms = null.cols() - spins_;
    if (freedoms <= 0) return;
    const std::vector<std::string> names = coordinates_of(null, rates, freedoms);
    const auto left = freedoms - static_cast<Eigen::Index>(names.size());
    throw SceneError(
        "what is held leaves " + std::to_string(freedoms) +
        (freedoms == 1 ? " degree" : " degrees") +
        " of freedom, and assemblies that are no isolated poses; expected " +
        (left == 0       ? "as many coordinates held, such as " + reading::all_in_quotes(names)
         : names.empty() ? "other joints: coordinates of spherical and free joints cannot be held"
                         : "other joints: coordinates of spherical and free joints cannot be held, "
                           "and with " +
                               reading::all_in_quotes(names) + " held " + std::to_string(left) +
                               (left == 1 ? " is left" : " are left")));
  }

  /// Coordinates that can be held and have rates that span the freedoms, or as many of them as can
  /// be: pivots of the null space `null` of columns with these rates.
  std::vector<std::string> coordinates_of(const MatrixXd& null, const std::vector<int>& rates,
                                          Eigen::Index freedoms) const {
    std::vector<std::string> all, chosen;
    std::vector<int> rows;
    for (std::size_t k = 0; k < rates.size(); ++k)
      if (std::string name = coordinate_of_rate(mechanism_, rates[k]); !name.empty()) {
        all.push_back(std::move(name));
        rows.push_back(static_cast<int>(k));
      }
    if (rows.empty()) return {};
    Eigen::ColPivHouseholderQR<MatrixXd> pivots;
    pivots.setThreshold(free_value);
    pivots.compute(MatrixXd(null(rows, Eigen::all)).transpose());
    for (Eigen::Index k = 0; k < std::min(pivots.rank(), freedoms); ++k)
      chosen.push_back(all[static_cast<std::size_t>(pivots.colsPermutation().indices()[k])]);
    return chosen;
  }

  void add(Assemblies& found, const VectorXd& q, int met) {
    for (FoundAssembly& known : found.all)
      if (space_->apart(known.q, q) < Assemblies::same) {
        known.met += met;
        return;
      }
    FoundAssembly other;
    other.q = space_->nearest(q);
    other.met = met;
    other.apart = space_->apart(q, own_);
    std::vector<int> rates;
    const MatrixXd j = free_columns(q, rates);
    if (j.cols() > 0) {
      const VectorXd values = Eigen::JacobiSVD<MatrixXd>(j).singularValues();
      other.most_value = values[0];
      other.least_value = values[j.cols() - 1 - spins_];
    }
    found.all.push_back(std::move(other));
  }

  const Mechanism& mechanism_;
  double t_;
  VectorXd own_;
  const AssembliesRequest& request_;
  ScaledLoops loops_;
  std::vector<std::pair<int, int>> held_;
  int spins_ = 0;  ///< freedoms of legs, not in solutions
  std::optional<PoseSpace> space_;
};

}  // namespace

void PathCount::count_copies_once(long copies) {
  lost += finite % copies;
  finite /= copies;
  real /= copies;
}

int Assemblies::met_once() const {
  return static_cast<int>(
      std::count_if(all.begin(), all.end(), [](const FoundAssembly& a) { return a.met == 1; }));
}

Assemblies find_assemblies(const Mechanism& mechanism, double t, const VectorXd& q,
                           const AssembliesRequest& request) {
  if (mechanism.has_nonholonomic())
    throw SceneError(
        "rows of rates alone hold no pose: expected loops of positions, whose assemblies are told");
  return Search(mechanism, t, q, request).run();
}

}  // namespace momenta
