#pragma once
// The bodies of a tree each with all its velocities, and the joints between them as equations:
//
//   M_k a_k + S_kᵀ y_k − Σ_children 𝒯ᶠ_c S_cᵀ y_c = f_k,    S_k (a_k − 𝒯ⱽ_k a_parent) = 0
//
// d unknowns a_k and s_k unknowns y_k a body, d = 6 or 3, s_k the d − n_k directions in which its
// joint does not move (rows of S_k). Ordered tips first, body before joint, the matrix fills in
// nowhere: its block LDLᵀ costs O(bodies). With A_k for M_k and what children left,
//
//   A = L Lᵀ,  Y = L⁻¹Sᵀ,  YᵀY = R Rᵀ,  B = Y R⁻ᵀ
//   f inward:     h = (1 − B Bᵀ) L⁻¹ f,      f_parent += 𝒯ᶠ Sᵀ R⁻ᵀ Bᵀ L⁻¹ f
//   a outward:    a = L⁻ᵀ (h + B R⁻¹ S 𝒯ⱽ a_parent)
//   to A_parent:  𝒯ᶠ Sᵀ (R Rᵀ)⁻¹ S 𝒯ⱽ
//
// and fᵀ K⁻¹ g = Σ h(f)·h(g), K⁻¹ the a-block of the inverse. A body without inertia in some
// direction (a thin rod about itself, the cross of a universal joint) has no Cholesky factor: SᵀΣS
// is added to its A, which changes y by Σ S 𝒯ⱽ a_parent and no motion, so that Σ is taken off again
// on the way to the parent. A joint that moves nothing by itself hands on A and f as they are.
// Source: Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996.

#include <momenta/core/kernel/sweeps.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

namespace momenta {

template <class Space>
class MaximalTree {
 public:
  static constexpr int d = Space::dimension;
  using Work = Workspace<Space, double>;
  using Motion = typename Space::template Motion<double>;
  using Force = typename Space::template Force<double>;
  using Column = Eigen::Matrix<double, d, 1>;
  using Block = Eigen::Matrix<double, d, d>;

  explicit MaximalTree(const Work& w) : w_(w), joint_(w.body.size()) {
    for (std::size_t k = 0; k < joint_.size(); ++k) joint_[k].light = is_light(k);
    pass_.resize(joint_.size());
  }

  /// Factorises at the edges placed in the workspace. False: stuck() has no inertia to move.
  bool factor() {
    for (std::size_t k = 0; k < joint_.size(); ++k) {
      joint_[k].A = block(w_.inertia(k));
      set_axes(k);
    }
    for (std::size_t k = joint_.size(); k-- > 0;)
      if (!eliminate(k)) {
        stuck_ = static_cast<int>(k);
        return false;
      }
    return true;
  }
  int stuck() const { return stuck_; }

  /// The wrench f on body k into h, and what it leaves to the parent; children first.
  void inward(std::size_t k, Column* f, Column* h) const {
    with_rows(k, [&](auto s) { inward<s.value>(k, f, h); });
  }
  /// h into the rates u (nv) of joints.
  void outward(const Column* h, double* u) {
    for (std::size_t k = 0; k < joint_.size(); ++k)
      with_rows(k, [&](auto s) { outward<s.value>(k, h, u); });
  }

  /// Wrenches on body k and its parent that do the torques r (n_k) at its joint and nothing else.
  void add_torques(std::size_t k, const double* r, Column* f) const {
    const auto& b = w_.model->bodies[k];
    if (b.nv == 1) return add_torque(k, *r, f);
    Column on = Column::Zero();
    for (int i = 0; i < b.nv; ++i) on[d - b.nv + i] = r[i];
    act(k, on, f);
  }
  /// The same at a joint of one degree of freedom.
  void add_torque(std::size_t k, double r, Column* f) const { act(k, r * joint_[k].along, f); }

  static Column column(const Force& f) {
    Column c;
    for (int i = 0; i < d; ++i) c[i] = f[i];
    return c;
  }

 private:
  void act(std::size_t k, const Column& on, Column* f) const {
    const int parent = w_.model->bodies[k].parent;
    f[k] += on;
    if (parent >= 0) f[parent] -= to_parent(k, on);
  }

  struct JointBlocks {
    Block A, L, R, B;               ///< R: s × s, B: d × s, in their first columns
    Eigen::Matrix<double, d, d> S;  ///< s × d, in its first rows
    Column along;                   ///< of a one-dof joint: u = along·(a − 𝒯ⱽ a_parent)
    Column sigma;                   ///< Σ, s of it; zero for bodies with inertia all around
    bool light = false;
  };

  int rows(std::size_t k) const { return d - w_.model->bodies[k].nv; }
  /// Calls with the number of rows of S as a constant.
  template <class F>
  void with_rows(std::size_t k, F&& f) const {
    switch (rows(k)) {
      case 0:
        return f(std::integral_constant<int, 0>());
      case d - 1:
        return f(std::integral_constant<int, d - 1>());
      case d:
        return f(std::integral_constant<int, d>());
      default:
        return f(std::integral_constant<int, 3>());
    }
  }

  template <class Inertia>
  static Block block(const Inertia& rigid) {
    Block m;
    for (int j = 0; j < d; ++j) {
      Motion unit{};
      unit[j] = 1;
      m.col(j) = column(Space::momentum(rigid, unit));
    }
    return m;
  }
  /// Whether the body alone resists nothing in some direction.
  bool is_light(std::size_t k) const {
    Block m = block(w_.model->bodies[k].inertia);
    const Column diagonal = m.diagonal();
    if (!(diagonal.minCoeff() > 0)) return true;
    const Column scale = diagonal.cwiseSqrt().cwiseInverse();
    m = scale.asDiagonal() * m * scale.asDiagonal();
    const Eigen::LDLT<Block> ldlt(m);
    return !(ldlt.vectorD().minCoeff() > 1e-12);
  }

  /// S and `along` at the present edge: unit directions but for screws.
  void set_axes(std::size_t k) {
    const auto& b = w_.model->bodies[k];
    auto& j = joint_[k];
    if (b.nv != 1) {
      j.S.setIdentity();  // of balls the first three rows, of driven joints and welds all
      return;
    }
    int row = 0;
    j.S.setZero();
    j.along.setZero();
    if constexpr (d == 3) {
      if (b.kind == JointKind::revolute) {
        j.along[2] = b.edge.sign;
        j.S(0, 0) = j.S(1, 1) = 1;
      } else {
        const auto& slide = w_.body[k].edge.slide;
        j.along << slide[0], slide[1], 0;
        j.S(0, 0) = -slide[1];
        j.S(0, 1) = slide[0];
        j.S(1, 2) = 1;
      }
    } else {
      const int moved = b.kind == JointKind::prismatic ? 2 : 5;
      j.along[moved] = 1;
      for (int i = 0; i < d; ++i)
        if (i != moved) j.S(row++, i) = 1;
      if (b.kind == JointKind::helical) j.S(2, 5) = -b.pitch;  // v_z − pitch ω_z
    }
  }

  bool eliminate(std::size_t k) {
    bool ok = true;
    with_rows(k, [&](auto s) { ok = eliminate<s.value>(k); });
    return ok;
  }
  template <int s>
  bool eliminate(std::size_t k) {
    const auto& b = w_.model->bodies[k];
    auto& j = joint_[k];
    Block handed_on = j.A;
    if constexpr (s < d) {
      const auto S = j.S.template topRows<s>();
      if constexpr (s > 0)
        if (j.light) {
          const double least = 1e-3 * j.A.trace() / d;
          j.sigma.template head<s>() = (S * j.A * S.transpose()).diagonal().cwiseMax(least);
          j.A += S.transpose() * j.sigma.template head<s>().asDiagonal() * S;
        }
      const Eigen::LLT<Block> body(j.A);
      if (body.info() != Eigen::Success || !j.A.allFinite()) return false;
      j.L = body.matrixL();
      if (j.light)  // rounding may pass for inertia
        for (int i = 0; i < d; ++i)
          if (!(j.L(i, i) * j.L(i, i) > 1e-13 * j.A(i, i))) return false;
      if constexpr (s > 0) {
        Eigen::Matrix<double, d, s> Y = S.transpose();
        body.matrixL().solveInPlace(Y);
        const Eigen::Matrix<double, s, s> C = Y.transpose() * Y;
        const Eigen::LLT<Eigen::Matrix<double, s, s>> held(C);
        if (held.info() != Eigen::Success) return false;
        j.R.template topLeftCorner<s, s>() = held.matrixL();
        held.matrixL().transpose().template solveInPlace<Eigen::OnTheRight>(Y);
        j.B.template leftCols<s>() = Y;
        if (b.parent < 0) return true;
        Eigen::Matrix<double, s, s> inverse = Eigen::Matrix<double, s, s>::Identity();
        held.solveInPlace(inverse);
        if (j.light) inverse.diagonal() -= j.sigma.template head<s>();
        handed_on = S.transpose() * inverse * S;
      } else {
        return true;
      }
    }
    if (b.parent >= 0) joint_[static_cast<std::size_t>(b.parent)].A += to_parent(k, handed_on);
    return true;
  }

  template <int s>
  void inward(std::size_t k, Column* f, Column* h) const {
    const auto& j = joint_[k];
    const int parent = w_.model->bodies[k].parent;
    if constexpr (s == d) {
      h[k].setZero();
      if (parent >= 0) f[parent] += to_parent(k, f[k]);
    } else {
      h[k] = f[k];
      j.L.template triangularView<Eigen::Lower>().solveInPlace(h[k]);
      if constexpr (s > 0) {
        const auto B = j.B.template leftCols<s>();
        Eigen::Matrix<double, s, 1> g = B.transpose() * h[k];
        h[k].noalias() -= B * g;
        if (parent < 0) return;
        j.R.template topLeftCorner<s, s>()
            .template triangularView<Eigen::Lower>()
            .transpose()
            .solveInPlace(g);
        f[parent] += to_parent(k, Column(j.S.template topRows<s>().transpose() * g));
      }
    }
  }

  template <int s>
  void outward(std::size_t k, const Column* h, double* u) {
    const auto& b = w_.model->bodies[k];
    const auto& j = joint_[k];
    Column& a = pass_[k];
    const Column carried =
        b.parent < 0 ? Column::Zero() : to_child(k, pass_[static_cast<std::size_t>(b.parent)]);
    if constexpr (s == d) {
      a = carried;
    } else {
      a = h[k];
      if constexpr (s > 0) {
        Eigen::Matrix<double, s, 1> g = j.S.template topRows<s>() * carried;
        j.R.template topLeftCorner<s, s>().template triangularView<Eigen::Lower>().solveInPlace(g);
        a.noalias() += j.B.template leftCols<s>() * g;
      }
      j.L.template triangularView<Eigen::Lower>().transpose().solveInPlace(a);
      const Column own = a - carried;
      if (b.nv == 1)
        u[b.u] = j.along.dot(own);
      else
        for (int i = 0; i < b.nv; ++i) u[b.u + i] = own[d - b.nv + i];
    }
  }

  Column to_child(std::size_t k, const Column& v) const {
    const auto& b = w_.model->bodies[k];
    Motion m;
    for (int i = 0; i < d; ++i) m[i] = v[i];
    m = Space::to_child(b.edge, b.kind, w_.body[k].edge, m);
    Column out;
    for (int i = 0; i < d; ++i) out[i] = m[i];
    return out;
  }
  Column to_parent(std::size_t k, const Column& v) const {
    const auto& b = w_.model->bodies[k];
    Force f;
    for (int i = 0; i < d; ++i) f[i] = v[i];
    return column(Space::to_parent(b.edge, b.kind, w_.body[k].edge, f));
  }
  /// 𝒯ᶠ m 𝒯ⱽ
  Block to_parent(std::size_t k, const Block& m) const {
    const auto& b = w_.model->bodies[k];
    typename Space::template ArticulatedInertia<double> a;
    if constexpr (d == 3) {
      a = {m(0, 0), m(0, 1), m(1, 1), {{m(0, 2), m(1, 2)}}, m(2, 2)};
      a = Space::to_parent(b.edge, b.kind, w_.body[k].edge, a);
      Block out;
      out << a.xx, a.xy, a.H[0], a.xy, a.yy, a.H[1], a.H[0], a.H[1], a.I;
      return out;
    } else {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          if (i <= j) a.A(i, j) = m(i, j);
          if (i <= j) a.I(i, j) = m(3 + i, 3 + j);
          a.H(i, j) = m(i, 3 + j);
        }
      a = Space::to_parent(b.edge, b.kind, w_.body[k].edge, a);
      Block out;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          out(i, j) = a.A(i, j);
          out(3 + i, 3 + j) = a.I(i, j);
          out(i, 3 + j) = out(3 + j, i) = a.H(i, j);
        }
      return out;
    }
  }

  const Work& w_;
  std::vector<JointBlocks> joint_;
  std::vector<Column> pass_;  ///< a of each body
  int stuck_ = -1;
};

}  // namespace momenta
