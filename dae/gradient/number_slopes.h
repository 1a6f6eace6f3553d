#pragma once
// The derivative of the augmented Lagrangian L* = T − V + σᵀΦ̇ by the numbers of the mechanism's
// tables, of all bodies, joints, loops and springs at once, along a direction (δq, δu, δσ) at
// (q, u, σ). One sweep outward and one inward serve all of them, in dual numbers of one direction:
//
//   T − V = Σ ½ (m v·v + 2 m c·(v × ω) + ωᵀ J ω) + g·(m r_O + R m c)
//
// is linear in m, m c, J about O, and in g, and each coefficient is of one body. A joint whose
// place in its parent moves by a small screw ξ, fixed in the parent, takes along all that it
// carries:
//
//   ∂L*/∂ξ = T* − Ω × P*,
//
// T*, P* of (27), (26) with the loops' impulses, Ω of the parent. The ends of a loop alike, with
// what its rows hand to one body: f = Σ σ b, ∂L*/∂x_A = ḟ + f × ω_A, and its axes, in which Φ̇ is
// linear. A spring has ∂L*/∂x = ±F e, ∂L*/∂k = −½ (l − rest)², ∂L*/∂rest = k (l − rest). What has
// no potential, dampers and friction, counts as ∂Q/∂number times what its coordinate does along δq:
// what D ∂L*/∂number is of forces that have one.
//
// Derivation: docs/theory/gradients.md, section 7.

#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// One object serves one thread; what adds does not allocate (levels/tangent_sweeps.h, where the
/// numbers are listed).
class NumberSlopes {
 public:
  virtual ~NumberSlopes() = default;
  /// How many numbers there are: those of the tables, then the guess of the start.
  virtual Eigen::Index size() const = 0;
  /// Where places of joints and all that follows begins: bodies and gravity stand before.
  virtual Eigen::Index beyond_inertias() const = 0;
  /// Where q and u (nv each) stand that the scene is assembled from; behind them the length that
  /// slides are counted in there, 0 without slides.
  virtual Eigen::Index guess() const = 0;
  /// Where the numbers of a part stand, and how many they are.
  struct Range {
    Eigen::Index first = 0, count = 0;
  };
  /// What a number of the text changes.
  struct Share {
    std::vector<Range> ranges;  ///< none: not known
    bool of_places = false;     ///< places are among them
  };
  /// Of the number at this place of the text: of "body.crank.mass" the numbers of its body; of
  /// "joint.A.origin.parent.0" all that is counted in the frames of the two bodies it joins; of a
  /// loop or spring its own.
  virtual Share of(const std::string& place) const = 0;
  /// Whether places and lengths are among what the derivatives are right of: not where there are
  /// bushings or forces by formulas, or loops are driven, of curves or formulas.
  virtual bool of_places() const = 0;
  /// And where no such force is a damper between points, a wrench, or has a dead band or stops.
  virtual bool of_plain_places() const = 0;
  /// And numbers of the drives of joints: not where springs along coordinates take a driven one.
  virtual bool of_drives() const = 0;
  /// Where f and ḟ of the drives stand, in the order of the tree's: functions of time, so that they
  /// are to be taken at each.
  virtual Eigen::Index drives() const = 0;
  /// Where the numbers of dampers and friction stand.
  virtual std::vector<Eigen::Index> without_potential() const = 0;
  /// Adds factor D ∂L*/∂number. O(bodies + m)
  virtual void add(double factor, const NumberSweep::Motion& at) = 0;
  /// The same of σᵀΦ̇ alone.
  virtual void add_loop_rates(double factor, const NumberSweep::Motion& at) = 0;
  /// And factor ∂(νᵀΦ)/∂number at (t, q), ν of m numbers.
  virtual void add_loops(double factor, double t, const double* q, const double* nu) = 0;
  /// slopes (size) += all that was added since the last call.
  virtual void finish(Eigen::VectorXd& slopes) = 0;
  /// The numbers of a scene that differs in them alone, places of joints as screws from the own
  /// ones, right to first order; empty where it has others.
  virtual Eigen::VectorXd numbers(const Scene& other) const = 0;
};

/// @pre bodies, no quaternions. The mechanism must outlive it. `with_places` false: no slopes
/// by places of joints and numbers of loops, at less cost.
std::unique_ptr<NumberSlopes> make_number_slopes(const Mechanism& mechanism, bool with_places);

}  // namespace momenta
