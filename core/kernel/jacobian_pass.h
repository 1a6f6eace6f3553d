#pragma once
// Exact derivatives of (q̇, ṗ) by dual numbers through the recursion, using the structure of
// Hamilton's equations where they hold. In canonical coordinates q̇ = ∂H/∂p, ṗ = −∂H/∂q + Q, hence
//
//   ∂q̇/∂p = M⁻¹,  ∂ṗ/∂p = −(∂q̇/∂q)ᵀ + ∂Q/∂p,  ∂Q/∂p = −C M⁻¹ for dampers C on the joints,
//
// so only the nq directions of q need dual numbers, W of them in the lanes of a register, and on
// trees of revolute joints M⁻¹ comes from as many solves at once with the M* of the pass. With
// quasi-velocities, dampers between bodies or other joints all directions are dual.

#include <momenta/core/kernel/momentum_recursion.h>

#include <vector>

namespace momenta {

/// The recursion along N directions at once; S: scalar of the dual numbers.
template <class Space, int N, class S = double>
class DirectionalPass {
 public:
  using D = Dual<S, N>;
  using Links = decltype(build_links(std::declval<const Model<Space>&>()));

  explicit DirectionalPass(const Links& links)
      : q(static_cast<std::size_t>(links.model->nq)),
        p(static_cast<std::size_t>(links.model->nv)),
        u(p.size()),
        pdot(p.size()),
        qdot(q.size()),
        sweeps_(links),
        w_(*links.model) {}

  /// Sets values of q and p, all directions zero.
  void set(const double* q_values, const double* p_values) {
    for (std::size_t i = 0; i < q.size(); ++i) q[i] = D(q_values[i]);
    for (std::size_t i = 0; i < p.size(); ++i) p[i] = D(p_values[i]);
  }
  /// Computes qdot and pdot with derivatives along the directions in q and p.
  bool operator()(double t) {
    if (!momentum_recursion(sweeps_, w_, D(t), q.data(), p.data(), u.data(), pdot.data()))
      return false;
    coordinate_rates(*w_.model, static_cast<const D*>(q.data()), static_cast<const D*>(u.data()),
                     qdot.data());
    return true;
  }
  /// M⁻¹ x at the state of the last pass. @pre revolute joints alone.
  void inverse_mass_times(MassSolution<Space, S>& solution, const S* x, S* result) {
    sweeps_.template inverse_mass_times<S>(solution, x, result);
  }

  int singular_joint() const { return sweeps_.singular_joint(); }

  std::vector<D> q, p, u, pdot, qdot;

 private:
  MomentumSweeps<Space, D> sweeps_;
  Workspace<Space, D> w_;
};

/// Whether the structure above holds for the model.
template <class Space>
bool is_hamiltonian(const Model<Space>& model) {
  for (const auto& b : model.bodies)
    if (b.nq != b.nv || b.is_curved) return false;
  for (const auto& spring : model.springs)
    if (spring.damping != 0) return false;
  for (const auto& bushing : model.bushings)
    if (bushing.damping != 0 || bushing.rotational_damping != 0) return false;
  for (const auto& spring : model.coordinate_springs)
    if (spring.damping != 0) return false;
  if (!model.formula_forces.empty()) return false;  // may take rates
  return model.wrenches.empty();  // in body axes, or with a torque, need not have a potential
}
/// The same, with revolute joints alone. Out of line: compiled for any machine.
bool is_hamiltonian_on_revolutes(const LinkTree& tree);
bool is_hamiltonian_on_revolutes(const PlanarTree& tree);

/// ∂(q̇, ṗ)/∂(q, p), W directions a pass. Cost ⌈nq/W⌉ dual evaluations and ⌈nv/W⌉ solves with W
/// right-hand sides with the structure on revolute joints, else ⌈(nq + nv)/W⌉ evaluations.
template <class Space, class Lanes>
class JacobianPass;

template <class Space, int W, int L>
class JacobianPass<Space, Pack<W, L>> {
  using Lanes = Pack<W, L>;
  using Pass = DirectionalPass<Space, 1, Lanes>;

 public:
  explicit JacobianPass(const typename Pass::Links& links)
      : model_(links.model),
        structured_(is_hamiltonian_on_revolutes(links)),
        pass_(links),
        solution_(links),
        x_(pass_.p.size()),
        result_(x_.size()) {}

  /// Writes into columns of nq + nv numbers, `stride` apart. False as for the recursion.
  bool operator()(double t, const double* q, const double* p, double* J, std::ptrdiff_t stride) {
    const int nq = model_->nq, nv = model_->nv;
    const int directions = structured_ ? nq : nq + nv;
    for (int first = 0; first < directions; first += W) {
      const int here = first + W <= directions ? W : directions - first;
      pass_.set(q, p);
      for (int lane = 0; lane < here; ++lane) {
        const int at = first + lane;
        auto& x = at < nq ? pass_.q[static_cast<std::size_t>(at)]
                          : pass_.p[static_cast<std::size_t>(at - nq)];
        x.b[0].set_lane(lane, 1);
      }
      if (!pass_(t)) return false;
      double* const block = J + first * stride;
      for (int i = 0; i < nq; ++i)
        to_row(pass_.qdot[static_cast<std::size_t>(i)].b[0], here, block + i, stride);
      for (int i = 0; i < nv; ++i)
        to_row(pass_.pdot[static_cast<std::size_t>(i)].b[0], here, block + nq + i, stride);
      if (!structured_) continue;
      for (int i = 0; i < nv; ++i)  // ∂ṗ/∂p = −(∂q̇/∂q)ᵀ; the dampers' part follows
        to_column(-pass_.qdot[static_cast<std::size_t>(i)].b[0], here,
                  J + (nq + i) * stride + nq + first);
    }
    if (structured_) inverse_mass(J + nq * stride, stride);
    return true;
  }
  int singular_joint() const { return pass_.singular_joint(); }

 private:
  /// Writes M⁻¹ into the first nv rows of as many columns, adds −C M⁻¹ to the next.
  void inverse_mass(double* J, std::ptrdiff_t stride) {
    const int nv = model_->nv;
    for (int first = 0; first < nv; first += W) {
      const int here = first + W <= nv ? W : nv - first;
      for (auto& x : x_) x = Lanes();
      for (int lane = 0; lane < here; ++lane)
        x_[static_cast<std::size_t>(first + lane)].set_lane(lane, 1);
      pass_.inverse_mass_times(solution_, x_.data(), result_.data());
      for (int i = 0; i < nv; ++i)  // M⁻¹ is symmetric: its rows are its columns
        to_column(result_[static_cast<std::size_t>(i)], here, J + i * stride + first);
      for (const auto& b : model_->bodies)
        if (b.damping != 0)
          for (int lane = 0; lane < here; ++lane)
            J[(first + lane) * stride + nv + b.u] -=
                b.damping * result_[static_cast<std::size_t>(b.u)].lane(lane);
    }
  }
  static void to_row(const Lanes& x, int count, double* at, std::ptrdiff_t stride) {
    for (int lane = 0; lane < count; ++lane) at[lane * stride] = x.lane(lane);
  }
  static void to_column(const Lanes& x, int count, double* at) {
    if (count == W) return x.store(at);
    for (int lane = 0; lane < count; ++lane) at[lane] = x.lane(lane);
  }

  const Model<Space>* model_;
  bool structured_;
  Pass pass_;
  MassSolution<Space, Lanes> solution_;
  std::vector<Lanes> x_, result_;
};

}  // namespace momenta
