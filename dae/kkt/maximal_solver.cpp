// The forms' right-hand sides in maximal coordinates: with K the matrix of maximal_tree.h, f the
// bodies' wrenches and J_i the wrench of loop i,
//
//   W_ij = h(J_i)·h(J_j),   W λ = Σ h(J_i)·h(f) − g,   a from h(f) − Σ h(J_i) λ_i
//
// Accelerations are counted from those at u̇ = 0, which meet the joints' equations by themselves:
// joints get no right-hand side. W as in dense_kkt.cpp.

#include <momenta/core/kernel/accelerations.h>
#include <momenta/dae/kkt/factor/axis_scale.h>
#include <momenta/dae/kkt/loop_matrix.h>
#include <momenta/dae/kkt/loop_solver.h>
#include <momenta/dae/kkt/maximal_tree.h>
#include <momenta/dae/mechanism/loop/loop_rows.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace momenta {
namespace {

template <class Space, int Spare>
class MaximalSolver final : public LoopSolver {
 public:
  MaximalSolver(const Mechanism& mechanism, Evaluation<double>& e, Model<Space> model)
      : mechanism_(mechanism),
        e_(e),
        model_(std::move(model)),
        loop_model_(build_loops(mechanism.scene(), mechanism.tree(), model_)),
        w_(model_),
        rows_(loop_model_, w_),
        tree_(w_),
        loops_(mechanism),
        axis_scale_(mechanism),
        n_(model_.bodies.size()),
        still_(static_cast<std::size_t>(model_.nv)),
        torque_(still_.size()),
        f_(n_),
        h_(n_),
        d_(static_cast<std::size_t>(mechanism.m())),
        g_(d_.size()),
        phi_(d_.size()),
        nu_(d_.size()) {
    for (const auto& loop : loop_model_.loops)
      for (int row = 0; row < loop.rows; ++row) columns_.push_back(column_of(loop));
  }

  void push(const double*) override {
    throw std::logic_error("maximal coordinates take no forces of joints beside the scene's");
  }
  void soften(std::vector<double> compliance) override { compliance_ = std::move(compliance); }

  bool acceleration(double t, const double* q, const double* u, const double* centre, double alpha,
                    double beta, double* udot, double* lambda) override {
    if (!factor(t, q, fade_evaluation, true)) return false;
    velocities_outward(w_, u);
    rows_.move(u);
    accelerations_outward(w_, u, static_cast<const double*>(nullptr));
    if (model_.has_gravity) gravity_outward(w_);
    apply_forces(w_, model_.has_body_forces());
    for (std::size_t k = 0; k < n_; ++k) {
      const auto& body = w_.body[k];
      auto f = body.T;
      f -= Space::momentum(w_.inertia(k), body.A);
      f -= Space::velocity_wrench(w_.inertia(k), body.V);
      f_[k] = {};
      Tree::add(f, f_[k]);
    }
    if (model_.has_joint_forces)
      for (std::size_t k = 0; k < n_; ++k)
        if (const auto& b = model_.bodies[k]; b.nv == 1)
          tree_.add_torque(k, joint_force(b, q[b.q], u[b.u]), f_.data());
    rows_.accelerate(nullptr);
    rows_.accelerations(g_.data());
    for (double& g : g_) g = -g;
    if (alpha != 0 || beta != 0) {
      rows_.velocities(nu_.data());
      rows_.positions(phi_.data());
      for (std::size_t i = 0; i < g_.size(); ++i)
        g_[i] -= 2 * alpha * nu_[i] + beta * beta * phi_[i];
    }
    return solve(centre, udot, lambda);
  }

  bool momentum(double t, const double* q, const double* p, const double* centre, double fade,
                double leak, double* u, double* sigma, double* pdot) override {
    if (!factor(t, q, fade, true)) return false;
    std::copy_n(p, torque_.size(), torque_.begin());
    std::fill(g_.begin(), g_.end(), 0.0);
    if (mechanism_.plan().drives) {  // less the prescribed part of M u, −Φ_t
      velocities_outward(w_, still_.data());
      rows_.move(nullptr);
      rows_.velocities(g_.data());
      for (double& g : g_) g = -g;
      body_momenta(w_);
      momenta_inward(w_, prescribed_.data());
      for (std::size_t i = 0; i < torque_.size(); ++i) torque_[i] -= prescribed_[i];
    }
    if (beta_ != 0) {
      rows_.positions(phi_.data());
      for (std::size_t i = 0; i < g_.size(); ++i) g_[i] -= beta_ * phi_[i];
    }
    if (!solve_torques(centre, u, sigma)) return false;
    if (pdot) {
      e_.place(t, q);
      e_.move(u);
      e_.momenta(sigma, torque_.data());
      e_.momentum_rates(q, u, sigma, leak, pdot);
    }
    return true;
  }

  bool free_velocity(double t, const double* q, const double* p, double* u) override {
    if (!factor(t, q, fade_evaluation, true)) return false;
    std::copy_n(p, torque_.size(), torque_.begin());
    std::fill(g_.begin(), g_.end(), 0.0);
    return solve_torques(nullptr, u, nu_.data());
  }

  bool position_correction(double t, const double* q, double* delta) override {
    if (!factor(t, q, fade_projection, false)) return false;
    std::fill(torque_.begin(), torque_.end(), 0.0);
    rows_.positions(g_.data());
    for (double& g : g_) g = -g;
    return solve_torques(nullptr, delta, nu_.data());
  }

  const std::vector<int>& faded_rows() override { return loops_.faded_rows(); }
  Pivots pivots() const override {
    return {loops_.weakest(), static_cast<int>(loops_.faded_rows().size())};
  }
  bool remembers() const override { return false; }

 private:
  using Tree = MaximalTree<Space, Spare>;
  using Columns = std::vector<typename Tree::Column>;
  /// h of a loop's row, zero but on the ways from its bodies to the ground.
  struct LoopColumn {
    std::vector<std::size_t> bodies;  ///< ascending
    Columns h;                        ///< by body
  };

  LoopColumn column_of(const typename LoopModel<Space>::Loop& loop) const {
    std::vector<char> on_way(n_);
    const auto climb = [&](int k) {
      for (; k >= 0; k = model_.bodies[static_cast<std::size_t>(k)].parent)
        on_way[static_cast<std::size_t>(k)] = 1;
    };
    climb(loop.a);
    climb(loop.b);
    for (const auto& coupled : loop.joints) climb(coupled.body);
    if (loop.is_equation())
      for (const int k : loop_model_.equations[static_cast<std::size_t>(loop.equation)]->bodies)
        climb(k);
    LoopColumn column;
    for (std::size_t k = 0; k < n_; ++k)
      if (on_way[k]) column.bodies.push_back(k);
    column.h.assign(n_, {});
    return column;
  }

  bool factor(double t, const double* q, double fade, bool softens) {
    ++solutions_;
    poses_outward(w_, t, q, true);
    rows_.place(t, q);
    singular_joint_ = -1;
    if (!tree_.factor()) {
      singular_joint_ = model_.bodies[static_cast<std::size_t>(tree_.singular_joint())].u;
      return false;
    }
    if (g_.empty()) return true;
    if (natural_.empty()) measure(t, q);
    std::size_t row = 0;
    for (std::size_t i = 0; i < loop_model_.loops.size(); ++i)
      for (int r = 0; r < loop_model_.loops[i].rows; ++r, ++row)
        if (!idle_[row]) place_column(i, r, columns_[row]);
    for (std::size_t i = 0; i < columns_.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        loops_.at(static_cast<int>(i), static_cast<int>(j)) =
            inner(columns_[i].bodies.size() < columns_[j].bodies.size() ? columns_[i].bodies
                                                                        : columns_[j].bodies,
                  columns_[i].h, columns_[j].h);
    return loops_.eliminate(axis_scale_.fading(fade), natural_.data(),
                            softens && !compliance_.empty() ? compliance_.data() : nullptr);
  }
  static double inner(const std::vector<std::size_t>& bodies, const Columns& a, const Columns& b) {
    double sum = 0;
    for (const std::size_t k : bodies) sum += Tree::inner(a[k], b[k]);
    return sum;
  }
  /// Finds natural sizes of rows of axes at the first configuration, and the rows that no joint can
  /// move: those of a loop between welded bodies, the angle between slides. Joints take their
  /// wrenches: h is rounding there, no scale for anything.
  void measure(double t, const double* q) {
    std::vector<double> inertia(still_.size()), entries(mechanism_.constraint_pattern().size());
    natural_.resize(g_.size());
    e_.place(t, q);
    e_.mass_diagonal(inertia.data());
    axis_scale_.measure(inertia, natural_);
    e_.constraint_entries(entries.data());
    idle_.clear();
    for (const auto& loop : loop_model_.loops)
      for (int row = 0; row < loop.rows; ++row)
        idle_.push_back(natural_[idle_.size()] == 0 && !loop.is_coupler());
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (entries[i] != 0)
        idle_[static_cast<std::size_t>(mechanism_.constraint_pattern()[i].row)] = 0;
  }

  void place_column(std::size_t loop, int row, LoopColumn& column) {
    const auto& l = loop_model_.loops[loop];
    for (const std::size_t k : column.bodies) f_[k] = {};
    typename Space::template Force<double> on_a{}, on_b{};
    rows_.unit_wrench(loop, row, on_a, on_b);
    if (l.a >= 0) Tree::add(on_a, f_[static_cast<std::size_t>(l.a)]);
    if (l.b >= 0) Tree::add(on_b, f_[static_cast<std::size_t>(l.b)]);
    rows_.each_point_wrench(
        l, [&](int k, const auto& f) { Tree::add(f, f_[static_cast<std::size_t>(k)]); });
    for (const auto& coupled : l.joints)
      tree_.add_torque(static_cast<std::size_t>(coupled.body), rows_.ratio(coupled), f_.data());
    for (std::size_t i = column.bodies.size(); i-- > 0;)
      tree_.inward(column.bodies[i], f_.data(), column.h.data());
  }

  bool solve_torques(const double* centre, double* u, double* sigma) {
    for (auto& f : f_) f = {};
    for (std::size_t k = 0; k < n_; ++k)
      if (model_.bodies[k].nv > 0)
        tree_.add_torques(k, torque_.data() + model_.bodies[k].u, f_.data());
    return solve(centre, u, sigma);
  }

  /// x (nv) and s (m) from the wrenches f_ and from g_.
  bool solve(const double* centre, double* x, double* s) {
    for (std::size_t k = n_; k-- > 0;) tree_.inward(k, f_.data(), h_.data());
    if (centre) take(centre);
    for (std::size_t i = 0; i < columns_.size(); ++i)
      d_[i] = inner(columns_[i].bodies, columns_[i].h, h_) - g_[i];
    if (!columns_.empty()) loops_.solve(d_.data(), s);
    take(s);
    tree_.outward(h_.data(), x);
    double sum = 0;
    for (int i = 0; i < model_.nv; ++i) sum += 0 * x[i];
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (centre) s[i] += centre[i];
      sum += 0 * s[i];
    }
    return sum == 0;
  }
  void take(const double* s) {
    for (std::size_t i = 0; i < columns_.size(); ++i)
      for (const std::size_t k : columns_[i].bodies)
        for (std::size_t r = 0; r < h_[k].size(); ++r) h_[k][r] -= s[i] * columns_[i].h[k][r];
  }

  const Mechanism& mechanism_;
  Evaluation<double>& e_;
  Model<Space> model_;
  LoopModel<Space> loop_model_;
  Workspace<Space, double> w_;
  LoopRows<Space, double> rows_;
  Tree tree_;
  LoopMatrix loops_;
  AxisScale axis_scale_;
  std::size_t n_;
  std::vector<double> still_, torque_, prescribed_ = std::vector<double>(still_.size());
  Columns f_, h_;
  std::vector<double> d_, g_, phi_, nu_, natural_, compliance_;
  std::vector<char> idle_;  ///< rows that no joint can move
  std::vector<LoopColumn> columns_;
};

}  // namespace

std::unique_ptr<LoopSolver> make_maximal_solver(const Mechanism& mechanism, Evaluation<double>& e) {
  const auto& plan = mechanism.plan();
  if (plan.planar)
    return std::make_unique<MaximalSolver<Planar, 1>>(
        mechanism, e, build_planar_model(mechanism.tree(), mechanism.scene(), plan.basis));
  for (const auto& b : mechanism.tree().bodies)
    if (b.law && b.nv > 1)
      throw std::invalid_argument(
          "maximal coordinates take user joints of one coordinate, but joint '" + b.joint +
          "' has " + std::to_string(b.nv) + "; expected another form");
  auto model = build_spatial_model(mechanism.tree(), mechanism.scene());
  if (std::any_of(model.bodies.begin(), model.bodies.end(),
                  [](const auto& b) { return b.nv == 3 && b.has_rotor(); }))
    return std::make_unique<MaximalSolver<Spatial, 3>>(mechanism, e, std::move(model));
  return std::make_unique<MaximalSolver<Spatial, 1>>(mechanism, e, std::move(model));
}

}  // namespace momenta
