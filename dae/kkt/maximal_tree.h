#pragma once
// The bodies of a tree each with all its velocities, and the joints between them as equations:
//
//   M_k a_k + S_kᵀ y_k − Σ_children 𝒯ᶠ_c S_cᵀ y_c = f_k,    S_k (a_k − 𝒯ⱽ_k a_parent) = 0
//
// d unknowns a_k and s_k unknowns y_k a body, d = 6 or 3, s_k the d − n_k directions in which its
// joint does not move (rows of S_k). Ordered tips first, body before joint, the matrix fills in
// nowhere: its block LDLᵀ costs O(bodies). With A_k for M_k and what children left,
//
//   A = L Lᵀ,  Y = L⁻¹Sᵀ,  YᵀY = R Rᵀ,  B = R⁻¹Yᵀ,  T = R⁻¹S
//   f inward:     h = (1 − BᵀB) L⁻¹ f,      f_parent += 𝒯ᶠ Tᵀ B L⁻¹ f
//   a outward:    a = L⁻ᵀ (h + Bᵀ T 𝒯ⱽ a_parent)
//   to A_parent:  𝒯ᶠ TᵀT 𝒯ⱽ
//
// and fᵀ K⁻¹ g = Σ h(f)·h(g), K⁻¹ the a-block of the inverse. A body without inertia in some
// direction (a thin rod about itself, the cross of a universal joint) has no Cholesky factor: SᵀΣS
// is added to its A, which changes y by Σ S 𝒯ⱽ a_parent and no motion, so that Σ is taken off again
// on the way to the parent. A joint that moves nothing by itself hands on A and f as they are.
// Source: Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996.
//
// A rotor's inertia I_r (rotor.h) is a row of S that gives way, u = S_d (a − 𝒯ⱽ a_parent) =
// y_d/I_r: YᵀY + diag(0, 1/I_r) = R Rᵀ, and h has one more number, g_d / (R_dd √I_r) with g = B L⁻¹
// f, for the energy of u. A spherical joint's rotor gives way in three rows, and h has three more,
// D^½ R⁻ᵀ g with D = diag(0, 1/I_r 1).

#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/kkt/inertia_blocks.h>

#include <algorithm>
#include <array>
#include <vector>

namespace momenta {

/// `Spare`: the numbers that h has beside d, 3 where a spherical joint has a rotor.
template <class Space, int Spare = 1>
class MaximalTree {
 public:
  static constexpr int d = Space::dimension;
  using Work = Workspace<Space, double>;
  using Motion = typename Space::template Motion<double>;
  using Force = typename Space::template Force<double>;
  using Inertia = typename Space::template ArticulatedInertia<double>;
  /// A wrench, an acceleration, or h; entries beyond d are of h alone.
  using Column = std::array<double, d + Spare>;

  explicit MaximalTree(const Work& w) : w_(w), joint_(w.body.size()), a_(w.body.size()) {
    for (std::size_t k = 0; k < joint_.size(); ++k) {
      Inertia own{};
      Space::add(own, w.model->bodies[k].inertia);
      double all[d][d];
      expand(own, all);
      joint_[k].light = !small::cholesky(all, 1e-12);
    }
  }

  /// Factorises at the edges placed in the workspace. False: singular_joint() has no inertia to
  /// move.
  bool factor() {
    for (std::size_t k = 0; k < joint_.size(); ++k) {
      joint_[k].A = {};
      Space::add(joint_[k].A, w_.inertia(k));
      set_axes(k);
    }
    for (std::size_t k = joint_.size(); k-- > 0;) {
      bool ok = true;
      with_rows(k, [&](auto s, auto gives) { ok = eliminate<s.value, gives.value>(k); });
      if (ok) continue;
      singular_joint_ = static_cast<int>(k);
      return false;
    }
    return true;
  }
  int singular_joint() const { return singular_joint_; }

  /// The wrench f on body k into h, and what it leaves to the parent; children first.
  void inward(std::size_t k, Column* f, Column* h) const {
    with_rows(k, [&](auto s, auto gives) { inward<s.value, gives.value>(k, f, h); });
  }
  /// h into the rates u (nv) of joints.
  void outward(const Column* h, double* u) {
    for (std::size_t k = 0; k < joint_.size(); ++k)
      with_rows(k, [&](auto s, auto gives) { outward<s.value, gives.value>(k, h, u); });
  }

  /// Adds the wrenches on body k and its parent of torques r (n_k) at its joint.
  void add_torques(std::size_t k, const double* r, Column* f) const {
    const auto& b = w_.model->bodies[k];
    if (b.nv == 1) return add_torque(k, *r, f);
    Force on{};
    for (int i = 0; i < b.nv; ++i) on[d - b.nv + i] = r[i];
    act(k, on, f);
  }
  /// The same at a joint of one degree of freedom.
  void add_torque(std::size_t k, double r, Column* f) const {
    Force on{};
    on[joint_[k].moved] = r * joint_[k].along;
    act(k, on, f);
  }

  static void add(const Force& f, Column& to) {
    for (int i = 0; i < d; ++i) to[static_cast<std::size_t>(i)] += f[i];
  }
  static double inner(const Column& a, const Column& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  }

 private:
  /// Row i of S is e_(held i) + slant_i e_moved. u = along (a − 𝒯ⱽ a_parent)_moved where one
  /// degree of freedom is.
  struct JointBlocks {
    Inertia A;
    double L[d][d], B[d][d], T[d][d];  ///< B and T: s rows
    double slant[d];
    int held[d];
    int moved = -1;
    double along = 1;
    /// For a rotor: the part of R⁻¹ in the rows that give way, over √I_r; 1/(R_dd √I_r) for one
    /// row.
    double give[Spare][Spare];
    bool light = false;  ///< the body alone resists nothing in some direction
  };

  /// Calls f with the numbers of rows of S and of the last that give way, as constants.
  template <class F>
  void with_rows(std::size_t k, F&& f) const {
    const std::integral_constant<int, 0> none;
    if (w_.model->bodies[k].has_rotor()) {
      if constexpr (Spare == 3)
        if (w_.model->bodies[k].nv == 3)
          return f(std::integral_constant<int, d>(), std::integral_constant<int, 3>());
      return f(std::integral_constant<int, d>(), std::integral_constant<int, 1>());
    }
    switch (d - w_.model->bodies[k].nv) {
      case d - 1:
        return f(std::integral_constant<int, d - 1>(), none);
      case d:
        return f(std::integral_constant<int, d>(), none);
      case 0:
        return f(std::integral_constant<int, 0>(), none);
      default:
        return f(std::integral_constant<int, 3>(), none);
    }
  }

  void set_axes(std::size_t k) {
    const auto& b = w_.model->bodies[k];
    auto& j = joint_[k];
    j.moved = d;
    j.along = 1;
    double slope = 0;  // motion beside the moved direction, over that along it
    if constexpr (d == 6)
      if (b.law) return set_user_axes(k);
    if (b.nv == 1) {
      if constexpr (d == 3) {
        j.moved = 2;
        j.along = b.edge.sign;
        if (b.kind == JointKind::prismatic) {
          const auto& prismatic = w_.body[k].edge.prismatic;
          j.moved = std::abs(prismatic[0]) >= std::abs(prismatic[1]) ? 0 : 1;
          j.along = 1 / prismatic[j.moved];
          slope = prismatic[1 - j.moved] * j.along;
        }
      } else {
        j.moved = b.kind == JointKind::prismatic ? 2 : 5;
        if (b.kind == JointKind::helical) slope = b.pitch;  // v_z = pitch ω_z
      }
    }
    // Held directions: the first three at balls, all at driven joints and welds.
    int row = 0;
    for (int i = 0; i < d; ++i)
      if (i != j.moved) {
        const bool slanted = d == 3 ? i < 2 : i == 2;
        j.held[row] = i;
        j.slant[row++] = slanted ? -slope : 0;
      }
  }

  /// For a user joint of one coordinate, E = (E_i): the largest moves, e_i − (E_i / E_moved)
  /// e_moved are held.
  void set_user_axes(std::size_t k) {
    auto& j = joint_[k];
    const auto& E = w_.body[k].edge.own->E[0];
    j.moved = 0;
    for (int i = 1; i < d; ++i)
      if (std::abs(E[i]) > std::abs(E[j.moved])) j.moved = i;
    j.along = 1 / E[j.moved];
    int row = 0;
    for (int i = 0; i < d; ++i)
      if (i != j.moved) {
        j.held[row] = i;
        j.slant[row++] = -E[i] * j.along;
      }
  }

  template <int s, int gives>
  bool eliminate(std::size_t k) {
    constexpr int hard = s - gives;
    const auto& b = w_.model->bodies[k];
    auto& j = joint_[k];
    if constexpr (hard == d) {
      if (b.parent >= 0) hand_on(k, j.A);
      return true;
    } else {
      expand(j.A, j.L);
      double stiffened[d] = {};
      if (j.light) stiffen<hard>(j, stiffened);
      if (!small::cholesky(j.L, j.light ? 1e-13 : 0)) return false;
      if constexpr (s > 0) {
        // the joint: Y = L⁻¹Sᵀ, YᵀY = R Rᵀ
        double Y[d][s] = {}, R[s][s];
        const bool slanted = j.moved < d;
        for (int i = 0; i < hard; ++i) {
          Y[j.held[i]][i] = 1;
          if (slanted) Y[j.moved][i] = j.slant[i];
        }
        if constexpr (gives == 1) Y[j.moved][hard] = j.along;
        if constexpr (gives == 3)
          for (int i = hard; i < s; ++i) Y[j.held[i]][i] = 1;
        small::forward(j.L, Y);
        for (int i = 0; i < s; ++i)
          for (int l = 0; l <= i; ++l) {
            double sum = 0;
            for (int r = 0; r < d; ++r) sum += Y[r][i] * Y[r][l];
            R[i][l] = sum;
          }
        for (int i = hard; i < s; ++i) R[i][i] += 1 / b.rotor;
        if (!small::cholesky(R, 0)) return false;
        // for solutions: B = R⁻¹Yᵀ, T = R⁻¹S
        for (int i = 0; i < s; ++i)
          for (int r = 0; r < d; ++r) j.B[i][r] = Y[r][i], j.T[i][r] = 0;
        small::forward(R, j.B);
        double inverse[s][s] = {};
        for (int i = 0; i < s; ++i) inverse[i][i] = 1;
        small::forward(R, inverse);
        for (int i = 0; i < gives; ++i)
          for (int l = 0; l <= i; ++l)
            j.give[i][l] = inverse[hard + i][hard + l] / std::sqrt(b.rotor);
        for (int i = 0; i < s; ++i)
          for (int l = 0; l <= i; ++l) {
            if (gives == 1 && l == hard) {
              j.T[i][j.moved] += inverse[i][l] * j.along;
              continue;
            }
            j.T[i][j.held[l]] = inverse[i][l];
            if (slanted) j.T[i][j.moved] += inverse[i][l] * j.slant[l];
          }
        if (b.parent < 0) return true;
        // for the parent: TᵀT, less Σ
        double left[d][d];
        for (int a = 0; a < d; ++a)
          for (int c = 0; c < d; ++c) {
            double sum = 0;
            for (int i = 0; i < s; ++i) sum += j.T[i][a] * j.T[i][c];
            left[a][c] = sum;
          }
        if (j.light) add_held<hard>(j, stiffened, -1, left);
        hand_on(k, compress<Inertia>(left));
      }
      return true;
    }
  }
  void hand_on(std::size_t k, const Inertia& m) {
    const auto& b = w_.model->bodies[k];
    joint_[static_cast<std::size_t>(b.parent)].A +=
        Space::to_parent(b.edge, b.kind, w_.body[k].edge, m);
  }

  /// m += factor SᵀΣS
  template <int s>
  static void add_held(const JointBlocks& j, const double* sigma, double factor,
                       double (&m)[d][d]) {
    for (int i = 0; i < s; ++i) {
      const double value = factor * sigma[i];
      const int at = j.held[i];
      m[at][at] += value;
      if (j.moved == d) continue;
      m[at][j.moved] += value * j.slant[i];
      m[j.moved][at] += value * j.slant[i];
      m[j.moved][j.moved] += value * j.slant[i] * j.slant[i];
    }
  }
  /// Adds SᵀΣS; Σ: A along the rows of S, at least a small part of its trace.
  template <int s>
  static void stiffen(JointBlocks& j, double* sigma) {
    double trace = 0;
    for (int i = 0; i < d; ++i) trace += j.L[i][i];
    for (int i = 0; i < s; ++i) {
      double along = j.L[j.held[i]][j.held[i]];
      if (j.moved < d)
        along += j.slant[i] * (2 * j.L[j.held[i]][j.moved] + j.slant[i] * j.L[j.moved][j.moved]);
      sigma[i] = std::max(along, 1e-3 * trace / d);
    }
    add_held<s>(j, sigma, 1, j.L);
  }

  template <int s, int gives>
  void inward(std::size_t k, Column* f, Column* h) const {
    const auto& j = joint_[k];
    const int parent = w_.model->bodies[k].parent;
    if constexpr (s == d && gives == 0) {
      h[k] = {};
      if (parent >= 0) add(to_parent(k, f[k]), f[parent]);
    } else {
      h[k] = f[k];
      small::forward(j.L, h[k].data());
      double g[d];
      for (int i = 0; i < s; ++i) {
        g[i] = 0;
        for (int r = 0; r < d; ++r) g[i] += j.B[i][r] * h[k][static_cast<std::size_t>(r)];
      }
      for (int l = 0; l < gives; ++l) {
        double spare = 0;
        for (int i = l; i < gives; ++i) spare += j.give[i][l] * g[s - gives + i];
        h[k][static_cast<std::size_t>(d + l)] = spare;
      }
      Column left{};
      for (int i = 0; i < s; ++i)
        for (int r = 0; r < d; ++r) {
          h[k][static_cast<std::size_t>(r)] -= g[i] * j.B[i][r];
          left[static_cast<std::size_t>(r)] += g[i] * j.T[i][r];
        }
      if (s > 0 && parent >= 0) add(to_parent(k, left), f[parent]);
    }
  }

  template <int s, int gives>
  void outward(std::size_t k, const Column* h, double* u) {
    const auto& b = w_.model->bodies[k];
    const auto& j = joint_[k];
    Column& a = a_[k];
    const Column carried =
        b.parent < 0 ? Column{} : to_child(k, a_[static_cast<std::size_t>(b.parent)]);
    if constexpr (s == d && gives == 0) {
      a = carried;
    } else {
      a = h[k];
      for (int i = 0; i < s; ++i) {
        double g = 0;
        for (int r = 0; r < d; ++r) g += j.T[i][r] * carried[static_cast<std::size_t>(r)];
        for (int r = 0; r < d; ++r) a[static_cast<std::size_t>(r)] += g * j.B[i][r];
      }
      small::backward(j.L, a.data());
      if (b.nv == 1) {
        const auto moved = static_cast<std::size_t>(j.moved);
        u[b.u] = j.along * (a[moved] - carried[moved]);
      } else {
        for (int i = 0; i < b.nv; ++i) {
          const auto at = static_cast<std::size_t>(d - b.nv + i);
          u[b.u + i] = a[at] - carried[at];
        }
      }
    }
  }

  void act(std::size_t k, const Force& on, Column* f) const {
    const auto& b = w_.model->bodies[k];
    add(on, f[k]);
    if (b.parent < 0) return;
    Force back = Space::to_parent(b.edge, b.kind, w_.body[k].edge, on);
    for (int i = 0; i < d; ++i) back[i] = -back[i];
    add(back, f[b.parent]);
  }
  Column to_child(std::size_t k, const Column& v) const {
    const auto& b = w_.model->bodies[k];
    Motion m;
    for (int i = 0; i < d; ++i) m[i] = v[static_cast<std::size_t>(i)];
    m = Space::to_child(b.edge, b.kind, w_.body[k].edge, m);
    Column out;
    for (int i = 0; i < d; ++i) out[static_cast<std::size_t>(i)] = m[i];
    return out;
  }
  Force to_parent(std::size_t k, const Column& v) const {
    const auto& b = w_.model->bodies[k];
    Force f;
    for (int i = 0; i < d; ++i) f[i] = v[static_cast<std::size_t>(i)];
    return Space::to_parent(b.edge, b.kind, w_.body[k].edge, f);
  }

  const Work& w_;
  std::vector<JointBlocks> joint_;
  std::vector<Column> a_;  ///< accelerations of bodies
  int singular_joint_ = -1;
};

}  // namespace momenta
