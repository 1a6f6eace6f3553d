#pragma once
// The derivative of the augmented Lagrangian L* = T − V + σᵀΦ̇ by the numbers of the mechanism's
// tables, all at once, along a direction (δq, δu, δσ) at (q, u, σ). One sweep outward and one
// inward serve all, in dual numbers of one direction:
//
//   T − V = Σ ½ (m v·v + 2 m c·(v × ω) + ωᵀ J ω) + g·(m r_O + R m c)
//
// is linear in m, m c, J about O, and in g, each coefficient of one body. A joint whose place in
// its parent moves by a small screw ξ, fixed in the parent, takes along all that it carries:
//
//   ∂L*/∂ξ = T* − Ω × P*,
//
// T*, P* of (27), (26) with the loops' impulses, Ω of the parent. The ends of a loop have ∂L*/∂x_A
// = ḟ + f × ω_A, with the force f = Σ σ b of its rows on one body; in its axes Φ̇ is linear. A
// spring has ∂L*/∂x = ±F e, ∂L*/∂k = −½ (l − rest)², ∂L*/∂rest = k (l − rest). Dampers and friction
// count as ∂Q/∂number times the change of their coordinate along δq, which is D ∂L*/∂number of
// forces with a potential.
//
// Derivation: docs/theory/gradients.md, section 7.

#include <momenta/dae/gradient/levels/tangent_sweeps.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace momenta {

/// One object serves one thread; add…() do not allocate. Numbers: levels/tangent_sweeps.h.
class NumberSlopes {
 public:
  virtual ~NumberSlopes() = default;
  /// Numbers of the tables, and of the guess of the start.
  virtual Eigen::Index size() const = 0;
  /// First number after bodies and gravity.
  virtual Eigen::Index beyond_inertias() const = 0;
  /// First number of the guess q, u (nv each); the unit of length of slides in the assembly
  /// follows, 0 without slides.
  virtual Eigen::Index guess() const = 0;
  struct Range {
    Eigen::Index first = 0, count = 0;
  };
  /// Numbers that one of the text changes.
  struct Share {
    std::vector<Range> ranges;  ///< none: not known
    bool of_places = false;     ///< places are among them
  };
  /// Share of the number at this place of the text: "body.crank.mass" has the numbers of its body;
  /// "joint.A.origin.parent.0" all in the frames of the two bodies it joins; a loop or spring its
  /// own.
  virtual Share of(const std::string& place) const = 0;
  /// Whether derivatives by places and lengths are right: not with bushings, forces by formulas, or
  /// loops that are driven, of curves or formulas.
  virtual bool of_places() const = 0;
  /// The same, without dampers between points, wrenches, dead bands and stops.
  virtual bool of_plain_places() const = 0;
  /// The same for drives of joints: not where coordinate springs take a driven one.
  virtual bool of_drives() const = 0;
  /// First of f and ḟ of the tree's drives, in order: functions of time, to be taken at each time.
  virtual Eigen::Index drives() const = 0;
  /// Places of the numbers of dampers and friction.
  virtual std::vector<Eigen::Index> without_potential() const = 0;
  /// Adds factor D ∂L*/∂number. O(bodies + m)
  virtual void add(double factor, const NumberSweep::Motion& at) = 0;
  /// The same for σᵀΦ̇ alone.
  virtual void add_loop_rates(double factor, const NumberSweep::Motion& at) = 0;
  /// Adds factor ∂(νᵀΦ)/∂number at (t, q), ν of m numbers.
  virtual void add_loops(double factor, double t, const double* q, const double* nu) = 0;
  /// slopes (size) += all since the last finish().
  virtual void finish(Eigen::VectorXd& slopes) = 0;
  /// Numbers of a scene that differs in them alone, places of joints as screws from the own ones,
  /// to first order; empty for other scenes.
  virtual Eigen::VectorXd numbers(const Scene& other) const = 0;
};

/// @pre bodies, no quaternions. The mechanism must outlive it. Without `with_places` no slopes by
/// places of joints and numbers of loops, at less cost.
std::unique_ptr<NumberSlopes> make_number_slopes(const Mechanism& mechanism, bool with_places);

}  // namespace momenta
