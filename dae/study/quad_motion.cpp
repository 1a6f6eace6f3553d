#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/scene/bearings_refused.h>
#include <momenta/dae/kkt/sweeps/levels/loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/planar_loop_sweeps.h>
#include <momenta/dae/kkt/sweeps/spatial_loop_sweeps.h>
#include <momenta/dae/mechanism/lagrangian_rows.h>
#include <momenta/dae/study/quad_motion.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace momenta {

namespace {

/// Pivots this far below their scale are those of redundant rows.
constexpr double fade = 1e-20;
/// Newton steps from the 1e-16 of starts to below 1e-32.
constexpr int newton_steps = 2;

struct In {
  const Quad* x;
  const Quad& operator[](int i) const { return x[i]; }
};
struct Out {
  Quad* x;
  Quad& operator[](int i) const { return x[i]; }
};

/// The plan. @throws std::runtime_error where more equations are open than the sweeps have slots
LoopPlan fitting(LoopPlan plan) {
  if (plan.slots > LoopPlan::most_slots)
    throw std::runtime_error("a reference in quadruple precision takes at most " +
                             std::to_string(LoopPlan::most_slots) +
                             " loop equations open at once, found " + std::to_string(plan.slots));
  return plan;
}

template <class Space, class Tree>
class QuadSweeps final : public QuadMotion {
 public:
  QuadSweeps(const Mechanism& mechanism, Model<Space> model)
      : mechanism_(mechanism),
        model_(std::move(model)),
        links_(build_links(model_)),
        loops_(in_link_frames(build_loops(mechanism.scene(), mechanism.tree(), model_), links_)),
        plan_(fitting(plan_loops(model_, loops_))),
        e_(mechanism.evaluation<Quad>()),
        accelerations_(links_, loops_, plan_),
        corrections_(links_, loops_, plan_),
        tau_(static_cast<std::size_t>(mechanism.nv())),
        work_(tau_.size()),
        sigma_(static_cast<std::size_t>(mechanism.m())),
        delta_(static_cast<std::size_t>(mechanism.nq())) {}

  bool rates(double t, const Quad* y, Quad* ydot) override {
    const Quad *q = y, *u = y + mechanism_.nq();
    Quad* udot = ydot + mechanism_.nq();
    e_->applied_forces(t, q, u, tau_.data());
    RightSide<Quad> right;
    right.fade = fade;
    if (!accelerations_(Quad(t), In{q}, In{u}, In{tau_.data()}, right, Out{udot},
                        Out{sigma_.data()}, Out{udot}))
      return false;
    e_->coordinate_rates(q, u, ydot);
    return true;
  }

  const Quad* multipliers() const override { return sigma_.data(); }

  bool project(double t, Quad* y) override {
    Quad *q = y, *u = y + mechanism_.nq();
    normalise(q);
    if (mechanism_.m() == 0) return true;
    RightSide<Quad> right;
    right.fade = fade;
    for (int k = 0; k < newton_steps; ++k) {
      std::fill(tau_.begin(), tau_.end(), Quad(0));
      right.drives = false;
      right.positions = 1;
      if (!solve(t, q, tau_.data(), right, work_.data())) return false;
      e_->place(t, q);
      e_->coordinate_rates(q, work_.data(), delta_.data());
      for (std::size_t i = 0; i < delta_.size(); ++i) q[i] += delta_[i];
    }
    e_->place(t, q);
    e_->move(u);
    e_->momenta(nullptr, tau_.data());
    right.drives = true;
    right.positions = 0;
    return solve(t, q, tau_.data(), right, u);
  }

 private:
  bool solve(double t, const Quad* q, const Quad* p, const RightSide<Quad>& right, Quad* u) {
    return corrections_(Quad(t), In{q}, In{p}, In{p}, right, Out{u}, Out{sigma_.data()}, Out{u});
  }
  void normalise(Quad* q) const {
    for (const auto& b : mechanism_.tree().bodies) {
      if (!b.has_quaternion()) continue;
      Quad* quaternion = q + b.q + (b.nq - 4);
      Quad norm = 0;
      for (int i = 0; i < 4; ++i) norm += quaternion[i] * quaternion[i];
      norm = sqrt(norm);
      for (int i = 0; i < 4; ++i) quaternion[i] /= norm;
    }
  }

  const Mechanism& mechanism_;
  Model<Space> model_;
  Tree links_;
  LoopModel<Space> loops_;
  LoopPlan plan_;
  std::unique_ptr<Evaluation<Quad>> e_;
  LoopSweeps<Space, Quad, LoopPlan::most_slots, false> accelerations_;
  LoopSweeps<Space, Quad, LoopPlan::most_slots, true> corrections_;
  std::vector<Quad> tau_, work_, sigma_, delta_;
};

}  // namespace

std::unique_ptr<QuadMotion> make_quad_motion(const Mechanism& mechanism) {
  refuse_bearings(mechanism.scene(), "integration in quadruple precision");
  if (mechanism.scene().lagrangian) return make_quad_lagrangian(mechanism);
  const Tree& tree = mechanism.tree();
  for (const auto& b : tree.bodies)
    if (b.law)
      throw std::runtime_error("joint '" + b.joint +
                               "' is a user joint, whose formula has no values in quadruple "
                               "precision; expected a reference from a file");
  if (mechanism.plan().planar)
    return std::make_unique<QuadSweeps<Planar, PlanarTree>>(
        mechanism, build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return std::make_unique<QuadSweeps<Spatial, LinkTree>>(
      mechanism, build_spatial_model(tree, mechanism.scene()));
}

namespace {

/// A x = b by elimination with full pivoting. Where pivots vanish, as with redundant constraints,
/// the unknowns left are zero.
class FullPivoting {
 public:
  explicit FullPivoting(std::size_t n) : n_(n), a_(n * n), b_(n), found_(n), row_(n), column_(n) {}

  void clear() { std::fill(a_.begin(), a_.end(), Quad(0)); }
  Quad& a(std::size_t i, std::size_t j) { return a_[i * n_ + j]; }
  Quad& b(std::size_t i) { return b_[i]; }

  /// All unknowns of the last solution.
  const Quad* found() const { return found_.data(); }
  /// The first `count` unknowns of x; false if not finite or not all determined.
  bool solve(std::size_t count, Quad* x) {
    constexpr double vanishes = 1e-20;  // part of the largest pivot
    for (std::size_t i = 0; i < n_; ++i) row_[i] = column_[i] = i;
    double largest = 0;
    std::size_t rank = 0;
    for (; rank < n_; ++rank) {
      std::size_t best_row = rank, best_column = rank;
      double best = -1;
      for (std::size_t i = rank; i < n_; ++i)
        for (std::size_t j = rank; j < n_; ++j)
          if (const double size = std::abs(value_of(a(row_[i], column_[j]))); !(size <= best))
            best = size, best_row = i, best_column = j;
      if (!std::isfinite(best)) return false;
      largest = std::max(largest, best);
      if (!(best > vanishes * largest)) break;
      std::swap(row_[rank], row_[best_row]);
      std::swap(column_[rank], column_[best_column]);
      eliminate(rank);
    }
    for (std::size_t k = rank; k < n_; ++k)
      if (column_[k] < count) return false;
    std::vector<Quad>& all = found_;
    all.assign(n_, Quad(0));
    for (std::size_t k = rank; k-- > 0;) {
      Quad sum = b_[row_[k]];
      for (std::size_t j = k + 1; j < rank; ++j) sum -= a(row_[k], column_[j]) * all[column_[j]];
      all[column_[k]] = sum / a(row_[k], column_[k]);
    }
    std::copy_n(all.begin(), count, x);
    return true;
  }

 private:
  void eliminate(std::size_t k) {
    const Quad pivot = a(row_[k], column_[k]);
    for (std::size_t i = k + 1; i < n_; ++i) {
      const Quad l = a(row_[i], column_[k]) / pivot;
      for (std::size_t j = k + 1; j < n_; ++j) a(row_[i], column_[j]) -= l * a(row_[k], column_[j]);
      b_[row_[i]] -= l * b_[row_[k]];
    }
  }

  std::size_t n_;
  std::vector<Quad> a_, b_, found_;
  std::vector<std::size_t> row_, column_;
};

class QuadLagrangian final : public QuadMotion {
 public:
  explicit QuadLagrangian(const Mechanism& mechanism)
      : model_(mechanism.lagrangian()),
        rows_(model_),
        n_(static_cast<std::size_t>(model_.n)),
        m_(static_cast<std::size_t>(model_.m)),
        matrix_(n_ + m_),
        mass_(model_.mass.places.size()),
        constraint_(model_.constraint.places.size()),
        r_(n_),
        rest_(n_),
        g_(m_),
        delta_(n_) {}

  bool rates(double t, const Quad* y, Quad* ydot) override {
    const Quad *q = y, *u = y + n_;
    rows_.place(t, q);
    rows_.move(u);
    rows_.joint_forces(q, u, nullptr, nullptr, r_.data());
    rows_.accelerations(g_.data());
    for (Quad& r : r_) r = -r;
    std::copy_n(u, n_, ydot);
    return solve(ydot + n_);
  }

  const Quad* multipliers() const override { return matrix_.found() + n_; }

  bool project(double t, Quad* y) override {
    if (m_ == 0) return true;
    Quad *q = y, *u = y + n_;
    for (int k = 0; k < newton_steps; ++k) {
      rows_.place(t, q);
      rows_.positions(g_.data());
      std::fill(r_.begin(), r_.end(), Quad(0));
      if (!solve(delta_.data())) return false;
      for (std::size_t i = 0; i < n_; ++i) q[i] += delta_[i];
    }
    rows_.place(t, q);
    rows_.move(u);
    rows_.momenta(nullptr, r_.data());
    rows_.move(nullptr);
    rows_.momenta(nullptr, rest_.data());
    for (std::size_t i = 0; i < n_; ++i) r_[i] -= rest_[i];
    rows_.velocities(g_.data());
    return solve(u);
  }

 private:
  /// M x + Φ_qᵀν = r, Φ_q x = −g at the configuration placed.
  bool solve(Quad* x) {
    rows_.mass_values(mass_.data());
    rows_.constraint_values(constraint_.data());
    matrix_.clear();
    for (std::size_t k = 0; k < mass_.size(); ++k) {
      const auto i = static_cast<std::size_t>(model_.mass.places[k].row),
                 j = static_cast<std::size_t>(model_.mass.places[k].column);
      matrix_.a(i, j) = matrix_.a(j, i) = mass_[k];
    }
    for (std::size_t k = 0; k < constraint_.size(); ++k) {
      const auto i = n_ + static_cast<std::size_t>(model_.constraint.places[k].row),
                 j = static_cast<std::size_t>(model_.constraint.places[k].column);
      matrix_.a(i, j) = matrix_.a(j, i) = constraint_[k];
    }
    for (std::size_t i = 0; i < n_; ++i) matrix_.b(i) = r_[i];
    for (std::size_t i = 0; i < m_; ++i) matrix_.b(n_ + i) = -g_[i];
    return matrix_.solve(n_, x);
  }

  const LagrangianModel& model_;
  LagrangianRows<Quad> rows_;
  std::size_t n_, m_;
  FullPivoting matrix_;
  std::vector<Quad> mass_, constraint_, r_, rest_, g_, delta_;
};

}  // namespace

std::unique_ptr<QuadMotion> make_quad_lagrangian(const Mechanism& mechanism) {
  return std::make_unique<QuadLagrangian>(mechanism);
}

}  // namespace momenta
