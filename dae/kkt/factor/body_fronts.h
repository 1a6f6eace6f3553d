#pragma once
// The bodies' equations (dae/kkt/body_matrix.h) factorised by fronts, pivots of σ filtered. From
// the tips to the ground a body k has a front, what is left of the equations of its subtree in Ω_k
// and in the σ of the loops that are open there:
//
//   ( M*  C ) ( Ω )   ( y )
//   ( Cᵀ −W ) ( σ ) = ( s )
//
// Loops whose ends have all come together close here, row by row, by the pivot −w, w inverted as
// f(w) = w³/(w⁴ + τ⁴) (sweeps/front.h, filtered_factor.h). Then Ω_k = 𝒯 Ω_p + E u takes P* out, and
// u goes by its pivots D = Eᵀ M* E + I_r, articulated inertias; with h the column of u, (M* E, Cᵀ E
// + R),
//
//   A −= h D⁻¹ hᵀ,     A_p += (𝒯 ⊕ 1)ᵀ A (𝒯 ⊕ 1).
//
// These are the sweeps, for any number of open loops and with the blocks as matrices: a front of k
// equations costs O(k²), a body what its front does, whatever its depth. At the ground fronts of
// the roots are gathered one after the other, last root first, loops close as soon as no other is
// to come. Multifrontal: fronts wait on a stack until that of their parent takes them. Source:
// Duff, Reid, ACM TOMS 9 (1983) 302; Featherstone, Rigid Body Dynamics Algorithms, ch. 7.

#include <momenta/dae/mechanism/kkt_pattern.h>

#include <vector>

namespace momenta {

class BodyFronts {
 public:
  /// Bodies, each after its parent (−1: the ground), depth first, and places of unknowns: Ω_k at d
  /// k, P*_k at d (bodies + k), then u, then σ.
  struct Bodies {
    int d = 0;                ///< size of a motion: 3 or 6
    std::vector<int> parent;  ///< per body
    std::vector<int> rate;    ///< per body: its first place in u
    std::vector<int> rates;   ///< per body: number of its rates
    int nv = 0;
  };

  /// `entries`: of the matrix, one of each pair of places; `groups` (m): Mechanism::row_groups.
  BodyFronts(const Bodies& bodies, const std::vector<KktPattern::Entry>& entries,
             const std::vector<int>& groups);

  /// Values to write, in the order of the entries; those of one place add up.
  std::vector<double>& values() { return given_; }
  /// Factorises values() with E (m, null: 0) and τ (m). False where a pivot of u, at place
  /// singular_joint(), is not positive or a number is not finite. O(Σ over the bodies of (d + open
  /// equations)² (rates + closing equations)), no allocation.
  bool factor(const double* compliance, const double* tau);
  /// x (nv + m) ← A⁻¹ x, of u and σ.
  void solve(double* x);

  int singular_joint() const { return singular_joint_; }
  /// w of each row of Φ (m) when it was closed.
  const std::vector<double>& pivots() const { return pivot_; }

 private:
  /// A front: of a body, or (d = 0) of the ground, once a root has come.
  struct Front {
    int d = 0, above = 0;  ///< size of Ω here, and of the parent's
    int body = -1;         ///< −1: the ground
    int rate = 0, rates = 0;
    int parent = -1;                  ///< index of a front, −1: none
    std::size_t below = 0, last = 0;  ///< into below_: fronts that wait for this one
    std::size_t row = 0;              ///< into row_: rows that go on, then those that close
    int go_on = 0, close = 0;
    std::size_t mass = 0, transfer = 0, axes = 0, rotors = 0;  ///< into value_
    std::size_t end = 0, ends = 0;                             ///< into ends_
    std::size_t tie = 0, ties = 0;                             ///< into ties_
    std::size_t column = 0;   ///< into column_: of closing rows, then of u
    std::size_t pivot = 0;    ///< into inverse_, likewise
    std::size_t coupled = 0;  ///< into column_: D (rates × rates)
    std::size_t up = 0;       ///< into up_: places of the rows that go on, at the parent
    int size() const { return d + go_on + close; }
    int left() const { return d + go_on; }
    int passed() const { return above + go_on; }
  };
  struct End {
    int at;             ///< place of the row in the front
    std::size_t value;  ///< its wrench (d)
  };
  struct Tie {
    int at, rate;  ///< places of the row in the front and of the rate among the front's u
    std::size_t value;
  };
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  struct Structure;  // body_fronts_structure.cpp

  void assemble(const Front& f, const double* compliance);
  bool close(const Front& f, const double* tau);
  bool eliminate(const Front& f);
  void pass_on(const Front& f);

  std::vector<Front> fronts_;  ///< in the order of elimination
  std::vector<int> row_, below_, up_;
  std::vector<int> group_;  ///< per row of Φ: its loop
  std::vector<End> ends_;
  std::vector<Tie> ties_;
  struct Target {
    std::size_t at, again;  ///< into value_; another where it stands on both sides of a diagonal
  };
  std::vector<Target> target_;  ///< per entry
  std::vector<double> given_, value_, column_, inverse_, pivot_;
  std::vector<int> turn_;     ///< per pivot: the row that goes in that turn
  std::vector<double> a_;     ///< the front under way, column by column
  std::vector<double> work_;  ///< a column, or a square of d
  std::vector<double> stack_;
  std::size_t top_ = 0;
  std::vector<double> motion_;  ///< for solve(): by front (d) y, then Ω
  int nv_ = 0, d_ = 0, singular_joint_ = -1;
};

}  // namespace momenta
