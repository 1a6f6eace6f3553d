#pragma once
// The derivative of the Lagrangian by the inertias of all bodies and by gravity, along a direction
// (δq, δu) at (q, u):
//
//   T − V = Σ ½ (m v·v + 2 m c·(v × ω) + ωᵀ J ω) + g·(m r_O + R m c)
//
// is linear in m, m c, J about O, and in g, so that each coefficient is of one body: one sweep
// outward serves the numbers of all bodies, however many of them a gradient is by. In dual numbers
// of one direction.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <memory>
#include <string>

namespace momenta {

/// One object serves one thread; add() does not allocate (levels/tangent_sweeps.h). Directions may
/// be null: nothing moves along them.
class InertiaSlopes {
 public:
  virtual ~InertiaSlopes() = default;
  /// How many numbers there are: of a body m, m c, J, in space 10, in a plane 4; g.
  virtual Eigen::Index size() const = 0;
  /// Where the numbers of a body stand, and how many they are; none where there is no such body.
  struct Range {
    Eigen::Index first = 0, count = 0;
  };
  virtual Range of(const std::string& body) const = 0;
  /// slopes (size) += factor D ∂(T − V)/∂number at (t, q, u) along (dq, du), nv each. O(bodies)
  virtual void add(double factor, double t, const double* q, const double* u, const double* dq,
                   const double* du, Eigen::VectorXd& slopes) = 0;
  /// The numbers of a scene that differs in inertias and gravity alone.
  virtual Eigen::VectorXd numbers(const Scene& other) const = 0;
};

/// @pre bodies, no quaternions. The mechanism must outlive it.
std::unique_ptr<InertiaSlopes> make_inertia_slopes(const Mechanism& mechanism);

/// Tells scenes that differ from a given one in nothing but inertias and gravity.
class InertiasAlone {
 public:
  explicit InertiasAlone(const Scene& scene);
  /// Whether this one does not. O(text of the scene)
  bool as(Scene other) const;

 private:
  const Scene& scene_;
  std::string text_;
};

}  // namespace momenta
