// projected
//
// Unknowns      q, u
// Equations     (3) as in `acceleration`; after each step, and wherever a state is read,
//                 q ← q + δ,  M δ + Φ_qᵀν = 0,  Φ_q δ = −Φ        repeated: see Iteration
//                 u ← v,      M v + Φ_qᵀν = M u,  Φ_q v = −Φ_t     linear: once
//               These are the nearest states on the manifold in the mass metric.
// Index         an ODE on the manifold Φ = 0, Φ̇ = 0
// Hidden        none after a step; Φ = 0 and Φ̇ = 0 during a step
// Multipliers   λ, a force
// Drifts        nothing: Φ and Φ̇ at rounding after each step. The order of the method is kept: a
//               correction is as large as the local error.
// Iteration     Newton's error after a correction δ is of the order δ²: a correction below 1e-8
//               rad or lengths is the last; a larger one is repeated as long as each is less than
//               half the one before. At a singular pose this fails, and the state is not changed.
// Source        Eich, SIAM J. Numer. Anal. 30 (1993), projection until consistent; Blajer,
//               Multibody System Dynamics 7 (2002), and Terze, Lefeber, Muftić, Multibody System
//               Dynamics 6 (2001), the mass metric.

#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/form_entry.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

class Projected final : public AccelerationForm {
 public:
  Projected(const Mechanism& mechanism, FormOptions options, const Start& start)
      : AccelerationForm("projected", mechanism, always(std::move(options)), start) {}

 protected:
  bool correct(double t, double* q, double* u) override {
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections; ++k) {
      if (!solve_correction(t, q)) return false;
      double length = 0;
      for (std::size_t i = 0; i < delta_.size(); ++i)
        length = std::max(length, std::abs(delta_[i]) / sizes_.way[i]);
      if (k > 0 && !(length < 0.5 * before)) break;
      take_correction(q);
      if (length <= last_correction) break;
      before = length;
    }
    return correct_velocity(t, q, u);
  }

 private:
  static FormOptions always(FormOptions options) {
    options.project = true;
    return options;
  }
};

}  // namespace

FormEntry projected_entry() {
  return {.name = "projected",
          .kind = FormEntry::Kind::ode_one_step,
          .positions = true,
          .bearings = true,
          .colour = 4,
          .place = 4,
          .words = {.x = "u",
                    .solved = "(3) for u̇ and λ; Φ and Φ̇ put to zero after each step",
                    .constraints = {invariant(equation::rates), invariant(equation::positions)}},
          .make = made<Projected>};
}

}  // namespace momenta
