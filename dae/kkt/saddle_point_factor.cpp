#include <momenta/dae/kkt/body_matrix.h>
#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/factor/body_fronts.h>
#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/kkt/factor/filtered_factor.h>
#include <momenta/dae/kkt/saddle_point_factor.h>
#include <momenta/dae/kkt/solver_choice.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace momenta {

namespace {

class OfJoints final : public SaddlePointFactor {
 public:
  explicit OfJoints(const Mechanism& mechanism)
      : scale_(mechanism),
        diagonal_of_mass_(mechanism.kkt_pattern(), mechanism.nv()),
        factor_(mechanism.kkt_pattern(), mechanism.nv(), mechanism.row_groups()),
        mass_(mechanism.kkt_pattern().mass.size()),
        constraint_(mechanism.kkt_pattern().constraint.size()),
        tau_(static_cast<std::size_t>(mechanism.m())) {}

  bool factor(Evaluation<double>& e, double, const double*, const double* compliance,
              double fade) override {
    e.mass_entries(mass_.data());
    e.constraint_entries(constraint_.data());
    return scale_.fade_groups(diagonal_of_mass_.of(mass_), constraint_, compliance, fade, tau_) &&
           factor_.factor(mass_, constraint_, compliance, tau_.data());
  }
  void solve(double* x) override { factor_.solve(x); }
  const std::vector<double>& pivots() const override { return factor_.pivots(); }
  const std::vector<double>& fading() const override { return tau_; }
  const double* constraint() override { return constraint_.data(); }
  int singular_joint() const override { return factor_.singular_joint(); }

 private:
  AxisScale scale_;
  MassDiagonal diagonal_of_mass_;
  FilteredFactor factor_;
  std::vector<double> mass_, constraint_, tau_;
};

template <class Space>
class OfBodies final : public SaddlePointFactor {
 public:
  OfBodies(const Mechanism& mechanism, std::unique_ptr<BodyMatrix<Space>> equations)
      : equations_(std::move(equations)),
        scale_(mechanism),
        inertia_(static_cast<std::size_t>(mechanism.nv())),
        constraint_(mechanism.constraint_pattern().size()),
        tau_(static_cast<std::size_t>(mechanism.m())),
        fronts_(equations_->tree(), equations_->entries(), mechanism.row_groups()) {}

  bool factor(Evaluation<double>& e, double t, const double* q, const double* compliance,
              double fade) override {
    equations_->place(t, q);
    std::size_t i = 0;
    equations_->each_entry([&](int, int, double x) { fronts_.values()[i++] = x; });
    e.mass_diagonal(inertia_.data());
    e.constraint_entries(constraint_.data());
    return scale_.fade_groups(inertia_, constraint_, compliance, fade, tau_) &&
           fronts_.factor(compliance, tau_.data());
  }
  void solve(double* x) override { fronts_.solve(x); }
  const std::vector<double>& pivots() const override { return fronts_.pivots(); }
  const std::vector<double>& fading() const override { return tau_; }
  const double* constraint() override { return constraint_.data(); }
  int singular_joint() const override { return fronts_.singular_joint(); }

 private:
  std::unique_ptr<BodyMatrix<Space>> equations_;
  AxisScale scale_;
  std::vector<double> inertia_, constraint_, tau_;
  BodyFronts fronts_;
};

}  // namespace

std::unique_ptr<SaddlePointFactor> joint_matrix(const Mechanism& mechanism) {
  return std::make_unique<OfJoints>(mechanism);
}

std::unique_ptr<SaddlePointFactor> front_matrix(const Mechanism& mechanism) {
  return with_body_matrix(
      mechanism,
      [&]<class Space>(
          std::unique_ptr<BodyMatrix<Space>> equations) -> std::unique_ptr<SaddlePointFactor> {
        return std::make_unique<OfBodies<Space>>(mechanism, std::move(equations));
      });
}

std::unique_ptr<SaddlePointFactor> saddle_point_factor(const Mechanism& mechanism) {
  return solved_by_bodies(mechanism) ? front_matrix(mechanism) : joint_matrix(mechanism);
}

namespace {

constexpr int poses = 3;
constexpr int motions_tried = 4;  // per pose: rounding in a single one may be small by chance
constexpr double way = 0.2;       // from pose to pose [rad, lengths of the scene]

class EliminationError {
 public:
  EliminationError(const Mechanism& mechanism, Evaluation<double>& e, const LeavesFirst& solve)
      : mechanism_(mechanism),
        e_(e),
        solve_(solve),
        pattern_(mechanism.constraint_pattern()),
        size_(static_cast<std::size_t>(mechanism.nv()), 1),
        inertia_(size_.size()),
        v_(size_.size()),
        v0_(size_.size()),
        p_(size_.size()),
        held_(size_.size()),
        sigma_(static_cast<std::size_t>(mechanism.m())),
        entries_(pattern_.size()) {
    const double length = length_of(mechanism.scene());
    for (const auto& b : mechanism.tree().bodies)
      for (int i = 0; i < b.nv; ++i)
        if (b.is_length(i)) size_[static_cast<std::size_t>(b.u + i)] = length;
  }

  double least() {
    Eigen::VectorXd q = mechanism_.tree().q0;
    bool there = close(q);
    double error = std::numeric_limits<double>::infinity();
    for (int pose = 0; there && pose < poses; ++pose) {
      const double here = worst_at(q.data());
      error = std::min(error, here);
      there = std::isfinite(here) && error > most_elimination_error && move(q);
    }
    return error;
  }

 private:
  double worst_at(const double* q) {
    double worst = 0;
    for (int motion = 0; motion < motions_tried && std::isfinite(worst); ++motion)
      worst = std::max(worst, at(q));
    return worst;
  }

  double at(const double* q) {
    e_.place(0, q);
    e_.mass_diagonal(inertia_.data());
    e_.constraint_entries(entries_.data());
    const double any = static_cast<double>(std::mt19937::max());
    for (std::size_t i = 0; i < v0_.size(); ++i)
      v0_[i] = size_[i] * (2 * static_cast<double>(random_()) / any - 1);
    momentum_of(v0_, nullptr, p_);
    const auto solved = solve_(q, p_.data(), 0, fade_evaluation, v_.data(), sigma_.data());
    if (!solved) return 0;
    if (!*solved) return std::numeric_limits<double>::infinity();
    e_.place(0, q);
    momentum_of(v_, sigma_.data(), held_);
    std::vector<double> terms(v_.size()), row(sigma_.size(), 0.0), row_terms(sigma_.size(), 0.0);
    for (std::size_t i = 0; i < v_.size(); ++i)
      terms[i] = inertia_[i] * (std::abs(v_[i]) + std::abs(v0_[i]));
    for (std::size_t k = 0; k < entries_.size(); ++k) {
      const auto of = static_cast<std::size_t>(pattern_[k].row),
                 i = static_cast<std::size_t>(pattern_[k].column);
      terms[i] += std::abs(entries_[k] * sigma_[of]);
      row[of] += entries_[k] * v_[i];
      row_terms[of] += std::abs(entries_[k]) * (std::abs(v_[i]) + std::abs(v0_[i]));
    }
    double error = 0;
    const auto take = [&](double off, double size) {
      if (!std::isfinite(off)) error = std::numeric_limits<double>::infinity();
      if (size > 0) error = std::max(error, std::abs(off) / size);
    };
    for (std::size_t i = 0; i < v_.size(); ++i) take(held_[i] - p_[i], terms[i]);
    for (std::size_t k = 0; k < row.size(); ++k) take(row[k], row_terms[k]);
    return error;
  }

  /// M v + Φ_qᵀσ without what drives prescribe.
  void momentum_of(const std::vector<double>& v, const double* sigma, std::vector<double>& p) {
    std::vector<double> prescribed(p.size());
    e_.move(nullptr);
    e_.momenta(nullptr, prescribed.data());
    e_.move(v.data());
    e_.momenta(sigma, p.data());
    for (std::size_t i = 0; i < p.size(); ++i) p[i] -= prescribed[i];
  }

  /// Steps q along v and closes the loops.
  bool move(Eigen::VectorXd& q) {
    const double rate = fastest();
    if (!(rate > 0)) return false;
    step(q, way / rate);
    return close(q);
  }

  /// Largest |v_i| in its unit; NaN where one is NaN.
  double fastest() const {
    double most = 0;
    for (std::size_t i = 0; i < v_.size(); ++i)
      most = std::abs(v_[i]) / size_[i] <= most ? most : std::abs(v_[i]) / size_[i];
    return most;
  }

  /// Newton's method onto the loops, until the next step would be rounding.
  bool close(Eigen::VectorXd& q) {
    constexpr int corrections = 6;
    constexpr double next_is_rounding = 1e-8;
    const std::vector<double> none(v_.size(), 0.0);
    for (int k = 0; k < corrections; ++k) {
      const auto solved =
          solve_(q.data(), none.data(), 1, fade_projection, v_.data(), sigma_.data());
      if (!solved || !*solved) return false;
      step(q, 1);
      if (fastest() < next_is_rounding) break;
    }
    return q.allFinite();
  }

  void step(Eigen::VectorXd& q, double by) {
    Eigen::VectorXd rates(q.size());
    e_.place(0, q.data());
    e_.coordinate_rates(q.data(), v_.data(), rates.data());
    q += by * rates;
    mechanism_.tree().normalise(q);
  }

  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  const LeavesFirst& solve_;
  const std::vector<KktPattern::Entry>& pattern_;
  std::vector<double> size_;  ///< units of rates: 1 rad/s or a length of the scene per second
  std::vector<double> inertia_, v_, v0_, p_, held_, sigma_, entries_;
  std::mt19937 random_{1};  // the same motions every time
};

}  // namespace

double elimination_error(const Mechanism& mechanism, Evaluation<double>& e,
                         const LeavesFirst& solve) {
  return EliminationError(mechanism, e, solve).least();
}

}  // namespace momenta
