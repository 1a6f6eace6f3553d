#pragma once
// The linear system of (7). With other right-hand sides it is that of (3) and of every projection:
//
//   ( M    Φ_qᵀ ) ( u )   ( r )
//   ( Φ_q  0    ) ( σ ) = ( g )
//
// Where loop equations are redundant or the pose is singular, Φ_q loses rank: u stays well defined,
// σ does not. Weak directions of σ therefore fade towards `centre` (σ at the start of the step):
// see dense_kkt.cpp, dae/kkt/factor/filtered_factor.h, and klu_solver.h.

#include <momenta/dae/kkt/factor/faded_pivot.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>
#include <vector>

namespace momenta {

/// A factorised matrix of (7), with its workspace: one object per thread.
class Kkt {
 public:
  virtual ~Kkt() = default;

  /// Assembles and factorises at (t, q), where `e` is placed. False when M is not positive
  /// definite, or when an entry is not finite. Cost: dense O((nv + m)³); sparse O(fill) on a
  /// pattern analysed once.
  virtual bool factor(Evaluation<double>& e, double t, const double* q, double fade) = 0;
  /// From the next factorisation on, −compliance (m) is in place of the zero block, Φ_q u −
  /// compliance (σ − centre) = g, and no row fades. Null: the zero block again.
  void soften(const double* compliance) { compliance_ = compliance; }
  /// Solves for u (nv) and σ (m); r (nv), g (m), centre (m, null: zero). False when the result is
  /// not finite.
  virtual bool solve(const double* r, const double* g, const double* centre, double* u,
                     double* sigma) = 0;

  /// Rows of Φ whose pivots faded at the last factor(): redundant or singular at this pose. KLU
  /// cannot tell them, and lists none.
  const std::vector<int>& faded_rows() const { return faded_rows_; }
  /// The number of faded rows.
  int faded() const { return static_cast<int>(faded_rows_.size()); }
  /// The least pivot at the last factor() of a row of Φ that has not faded, relative to the scale
  /// of its group; 1 where none is known.
  double weakest() const { return weakest_; }
  /// Number of calls of factor() so far.
  long factorizations() const { return factorizations_; }
  /// Place in u of the joint at which the last factor() failed, or −1: something is not finite.
  int singular_joint() const { return singular_joint_; }

 protected:
  std::vector<int> faded_rows_;         ///< faded_rows()
  const double* compliance_ = nullptr;  ///< soften()
  double weakest_ = 1;                  ///< weakest()
  long factorizations_ = 0;             ///< factorizations()
  int singular_joint_ = -1;             ///< singular_joint()
};

/// A solver of (7): dense or sparse by size, or as the mechanism's options say. A sparse one takes
/// the bodies' equations in deep trees, and KLU where joints have no inertia before their loops
/// close. Needs loops (m > 0).
std::unique_ptr<Kkt> make_kkt(const Mechanism& mechanism);
/// For small systems: eliminates u along the tree, then factorises Φ_q M⁻¹ Φ_qᵀ, dense; O((nv +
/// m)³).
std::unique_ptr<Kkt> make_dense_kkt(const Mechanism& mechanism);
/// For large systems: L D Lᵀ of the matrix of the joints' equations, with the pivots of σ filtered;
/// O(fill).
std::unique_ptr<Kkt> make_sparse_kkt(const Mechanism& mechanism);
/// LU of the joints' equations, where joints have no inertia before loops close; no pivot fades.
std::unique_ptr<Kkt> make_klu_kkt(const Mechanism& mechanism);
/// For deep trees: L D Lᵀ of the matrix of the bodies' equations by fronts, with the pivots of σ
/// filtered; O(Σ over the bodies of the squared number of open equations).
std::unique_ptr<Kkt> make_front_kkt(const Mechanism& mechanism);
/// LU of the bodies' equations, for deep trees where joints have no inertia before loops close; no
/// pivot fades.
std::unique_ptr<Kkt> make_body_kkt(const Mechanism& mechanism);

}  // namespace momenta
