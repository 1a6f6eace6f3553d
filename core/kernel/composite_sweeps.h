#pragma once
// Not for trees with user joints: rows are summed along axes at rest in their bodies.
//
// Composite rigid bodies in space, (q, u, τ, t) → u̇ by M itself: fast on small trees, and on trees
// that branch early.
//
//   bias      what inverse_dynamics_sweeps.h takes τ to be at u̇ = 0
//   outward   axes X, Y, Z and the step from parent to child, in axes all bodies of a tree share:
//             those of its first body
//   inward    subtrees: c and Σ about O by the screws of the frames; M E of a revolute joint is the
//   momentum
//             of its subtree, turned as one body:
//               f = z × c = (−c_y, c_x, 0),  n = (−Σ_xz, −Σ_yz, Σ_xx + Σ_yy)
//             in the shared axes it goes to the ancestors, and gives an entry of M at each:
//               n_L = n + step × f,  M_LK = Z_L · n_L
//             17 operations an entry; moving it by the screws of the frames takes 20
//             (right angles) to 32.
//   M = Lᵀ D L, Lᵀ y = τ − bias, L u̇ = D⁻¹ y
//
// M_ij ≠ 0 only where one dof lies on the other's way to the root, and no other entry arises when
// dofs are eliminated from the leaves inward (Featherstone: branch-induced sparsity). Row k holds
// the entries of the ancestors of k, the root's first, and its own last. The row of an ancestor i
// matches the part of row k up to i entry for entry: eliminating k subtracts a piece of row k from
// row i without index look-ups.
//
// The masses given to the parent in inverse_dynamics_sweeps.h move with it as with the body, so M
// follows from these moments too; c and Σ pass revolute and spherical joints without mass.
//
// O(n d²) for n dofs of depth d, O(n d) memory.

#include <momenta/core/kernel/composite_moments.h>
#include <momenta/core/kernel/inverse_dynamics_sweeps.h>

#include <limits>
#include <vector>

namespace momenta {

template <class Space, class S>
class CompositeSweeps;

template <class S>
class CompositeSweeps<Spatial, S> {
 public:
  using Space = Spatial;
  explicit CompositeSweeps(const LinkTree& tree);

  /// u̇ (nv) from (q, u, t) and all generalised forces τ (nv) but weights. In and Out index like
  /// pointers to S. False when M is not positive definite: singular_joint(). O(dofs · depth²).
  template <class In, class InTau, class Out>
  bool operator()(const S& t, const In& q, const In& u, const InTau& tau, Out udot) {
    dynamics_.place(t, q);
    singular_joint_ = tree_->singular_joint;
    if (singular_joint_ >= 0) return false;
    dynamics_.bias(u, right_.data());
    for (std::size_t i = 0; i < dofs_.size(); ++i) right_[i] = tau[static_cast<int>(i)] - right_[i];
    axes_outward();
    rows_inward();
    if (!eliminate()) return false;
    solve(udot);
    return true;
  }

  /// Calls entry(row, column, value) for the upper triangle of M at (q, t), for each pair of dofs
  /// on one path to the root. O(dofs · depth).
  template <class In, class Entry>
  void mass_matrix(const S& t, const In& q, Entry&& entry) {
    dynamics_.place(t, q);
    axes_outward();
    rows_inward();
    for (std::size_t k = 0; k < dofs_.size(); ++k)
      for (int p = 0; p <= dofs_[k].depth; ++p)
        entry(way_[start(k) + static_cast<std::size_t>(p)].dof, static_cast<int>(k),
              rows_[start(k) + static_cast<std::size_t>(p)]);
  }

  int singular_joint() const { return singular_joint_; }
  /// Number of entries stored: one triangle of M.
  std::size_t entries() const { return rows_.size(); }

 private:
  struct Dof {
    int body, depth;    ///< depth: dofs on the way to the root
    std::size_t start;  ///< start of its row
  };
  struct Ancestor {
    int dof;
  };
  /// A body in the tree's axes, for the inward sweep.
  struct Station {
    Vec3<S> step, Z, X, Y;
  };
  struct Place {
    int parent;
    LinkKind kind;
    int u, nv;
  };
  struct Column {
    S fx, fy, fz, nx, ny, nz;
  };

  void axes_outward();
  void rows_inward();
  bool eliminate();
  template <class Out>
  void solve(Out udot);
  void inward_from(std::size_t k, Column F, S* row) const;
  __attribute__((noinline)) void any_axes(std::size_t k);
  __attribute__((noinline)) void any_rows(std::size_t k, const CompositeMoments<S>& m);
  __attribute__((noinline)) void any_inward(std::size_t k, CompositeMoments<S>& m) const;
  std::size_t start(std::size_t dof) const { return dofs_[dof].start; }
  const Model<Spatial>::Body& body(std::size_t k) const { return tree_->model->bodies[k]; }

  const LinkTree* tree_;
  InverseDynamicsSweeps<Spatial, S> dynamics_;
  std::vector<Dof> dofs_;
  std::vector<Ancestor> way_;  ///< dof of each entry of rows_
  std::vector<Place> places_;
  std::vector<Station> stations_;
  std::vector<CompositeMoments<S>> slots_;
  std::vector<S> rows_, right_, scale_;
  int singular_joint_ = -1;
};

template <class S>
CompositeSweeps<Spatial, S>::CompositeSweeps(const LinkTree& tree)
    : tree_(&tree),
      dynamics_(tree),
      dofs_(static_cast<std::size_t>(tree.model->nv)),
      places_(tree.links.size()),
      stations_(tree.links.size()),
      slots_(static_cast<std::size_t>(tree.slots)),
      right_(dofs_.size()),
      scale_(dofs_.size()) {
  std::vector<Ancestor> last(places_.size());  // nearest dof of each body, on its way to the root
  std::size_t entries = 0;
  for (std::size_t k = 0; k < places_.size(); ++k) {
    const auto& b = body(k);
    places_[k] = {b.parent, tree.links[k].kind, b.u, b.nv};
    int before = b.parent < 0 ? -1 : last[static_cast<std::size_t>(b.parent)].dof;
    for (int i = b.u; i < b.u + b.nv; before = i++) {
      const int depth = before < 0 ? 0 : dofs_[static_cast<std::size_t>(before)].depth + 1;
      dofs_[static_cast<std::size_t>(i)] = {static_cast<int>(k), depth, entries};
      entries += static_cast<std::size_t>(depth) + 1;
    }
    last[k].dof = before;
  }
  way_.resize(entries);
  rows_.resize(entries);
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    way_[start(k) + depth].dof = static_cast<int>(k);
    if (depth == 0) continue;
    // The parent dof is the one before in the same joint, or the last of the nearest ancestor with
    // any.
    const auto here = static_cast<std::size_t>(dofs_[k].body);
    const bool inside = static_cast<int>(k) > body(here).u;
    const int parent =
        inside ? static_cast<int>(k) - 1 : last[static_cast<std::size_t>(body(here).parent)].dof;
    for (std::size_t p = 0; p < depth; ++p)
      way_[start(k) + p] = way_[start(static_cast<std::size_t>(parent)) + p];
  }
}

// Eliminates dof k, with a_i = M_ki / M_kk: M_ij −= a_i M_kj for all ancestors j ≤ i, right_i −=
// a_i right_k. Row k then holds L and 1 / D.
template <class S>
bool CompositeSweeps<Spatial, S>::eliminate() {
  constexpr double rounding = 16 * std::numeric_limits<double>::epsilon();
  S* rows = rows_.data();
  S* right = right_.data();
  for (std::size_t k = dofs_.size(); k-- > 0;) {
    S* __restrict row = rows + start(k);
    const Ancestor* way = way_.data() + start(k);
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    if (!all_positive(row[depth] - rounding * scale_[k])) {
      singular_joint_ = dofs_[k].body;
      return false;
    }
    const S inverse = S(1.0) / row[depth], own = right[k];
    row[depth] = inverse;
    for (std::size_t p = depth; p-- > 0;) {
      const auto i = static_cast<std::size_t>(way[p].dof);
      const S a = row[p] * inverse;
      S* __restrict to = rows + start(i);
      for (std::size_t j = 0; j <= p; ++j) to[j] = to[j] - a * row[j];
      row[p] = a;
      right[i] = right[i] - a * own;
    }
  }
  return true;
}

template <class S>
template <class Out>
void CompositeSweeps<Spatial, S>::solve(Out udot) {
  for (std::size_t k = 0; k < dofs_.size(); ++k) {
    const S* row = rows_.data() + start(k);
    const Ancestor* way = way_.data() + start(k);
    const auto depth = static_cast<std::size_t>(dofs_[k].depth);
    S x = right_[k] * row[depth];
    for (std::size_t p = 0; p < depth; ++p)
      x = x - row[p] * right_[static_cast<std::size_t>(way[p].dof)];
    right_[k] = x;
    udot[static_cast<int>(k)] = x;
  }
}

}  // namespace momenta

#include <momenta/core/kernel/composite_rows.h>
