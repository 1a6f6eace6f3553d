#pragma once
// Rounding lost in the places of bodies on the way out from the ground.
//
// x_K = x_L + d_K is rounded to the size of x_K, however short the step d_K from the parent's
// origin: kilometres from the ground, two points of one revolute joint lie 10⁻¹² m apart by
// rounding alone. Φ has to be right to the size of its loop instead: the impulses that Newton's
// method answers it with are Φ over a step, and what they leave in p is as large at every step. So
// the rest is carried beside the places,
//
//   ℓ_K = ℓ_L + (d_K − (x_K − x_L)),        D = (x_A − x_B) + (ℓ_A − ℓ_B),
//
// x_K + ℓ_K right to roundings of the steps d. Common ancestors of A and B are in both, and go out
// to the last digit.

#include <momenta/core/kernel/points.h>

namespace momenta {

template <class Space>
class CompensatedPositions {
 public:
  using Vector = typename Space::template Vector<double>;

  explicit CompensatedPositions(std::size_t bodies) : lost_(bodies) {}

  /// Needs poses. O(bodies)
  void outward(const Workspace<Space, double>& w) {
    for (std::size_t k = 0; k < lost_.size(); ++k) {
      const auto& b = w.model->bodies[k];
      lost_[k] = of_body(b.parent) + (step(w, k) - (w.body[k].pose.origin - origin(w, b.parent)));
    }
  }
  /// Rounding lost at a point of body k placed at x, `arm` from its origin, in ground axes.
  Vector of_point(const Workspace<Space, double>& w, int k, const Vector& arm,
                  const Vector& x) const {
    return of_body(k) + (arm - (x - origin(w, k)));
  }

 private:
  Vector of_body(int k) const { return k < 0 ? Vector{} : lost_[static_cast<std::size_t>(k)]; }
  /// Step from the parent's origin to that of body k, in ground axes.
  static Vector step(const Workspace<Space, double>& w, std::size_t k) {
    if constexpr (Space::dimension == 3)
      return w.body[k].edge.r;
    else
      return w.body[k].step;
  }

  std::vector<Vector> lost_;
};

}  // namespace momenta
