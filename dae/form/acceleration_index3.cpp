// acceleration-index3
//
// Unknowns      q, v; λ
// Equations     q̇ = v,  (1a): M v̇ + Φ_qᵀλ = Q + L_q − Ṁ v,  Φ = 0
// Index         3
// Hidden        Φ̇ = 0 and Φ̈ = 0
// Multipliers   λ, a force
// Drifts        Φ at the Newton tolerance; Φ̇ at the local error of v, one power of the step worse
// Source        paper, eqs. (1)-(3); Brenan, Campbell, Petzold, Numerical Solution of
//               Initial-Value Problems in DAEs

#include <momenta/dae/form/coordinate_motion.h>
#include <momenta/dae/form/dae_form.h>
#include <momenta/dae/form/form_entry.h>
#include <momenta/dae/form/penalty.h>
#include <momenta/dae/integrator/system.h>

namespace momenta {
namespace {

class AccelerationIndex3 final : public DaeFormOf<AccelerationIndex3>, public SecondOrder {
 public:
  AccelerationIndex3(const Mechanism& mechanism, const FormOptions& options, const Start& start)
      : DaeFormOf("acceleration-index3", mechanism,
                  {mechanism.nq(), mechanism.nv(), mechanism.m(), false, false, 2}, options, start,
                  Unknowns::velocities),
        penalty_(options.penalty),
        start_(start) {}

  template <class S>
  void rows(DaeScratch<S>& s, double t, const S* y, const S* ydot, S* r) {
    position_rows(s, acceleration_rows(s, t, y, ydot, r));
  }

  int coordinates() const override { return layout_.nq; }
  int rates() const override { return layout_.nv; }
  int multipliers() const override { return layout_.m; }
  void coordinate_rates(const double* q, const double* v, double* qdot) override {
    e_->coordinate_rates(q, v, qdot);
  }
  void move(const double* q, const double* delta, double* moved) override {
    motion_.move(*e_, q, delta, moved);
  }
  void constraints(double t, const double* q, double* phi) override {
    e_->place(t, q);
    e_->positions(phi);
  }
  void constraint_rates(double t, const double* q, const double* v, double* rate) override {
    e_->place(t, q);
    e_->move(v);
    e_->velocities(rate);
  }
  void constraint_accelerations(double t, const double* q, const double* v, const double* vdot,
                                double* rate) override {
    e_->place(t, q);
    e_->move(v);
    e_->joint_forces(q, v, vdot, nullptr, forces_.data());
    e_->accelerations(rate);
  }
  const std::vector<double>& compliance() override {
    if (compliance_.empty()) compliance_ = penalty_compliance(mechanism_, *e_, penalty_, start_);
    return compliance_;
  }

 protected:
  bool rate_is_tested() const override { return false; }  // BDF converges for v one order late

 private:
  std::unique_ptr<Evaluation<double>> e_ = mechanism_.evaluation<double>();
  CoordinateMotion motion_{mechanism_};
  double penalty_;
  Start start_;
  std::vector<double> compliance_,
      forces_ = std::vector<double>(static_cast<std::size_t>(mechanism_.nv()));
};

}  // namespace

FormEntry acceleration_index3_entry() {
  return {.name = "acceleration-index3",
          .kind = FormEntry::Kind::dae,
          .positions = true,
          .bearings = true,
          .lower_on_rates = true,
          .colour = 3,
          .place = 11,
          .words = {.x = "v",
                    .s = "λ",
                    .constraints = {given(equation::positions), hidden(1, equation::velocities, ""),
                                    hidden(2, equation::accelerations, "λ")}},
          .make = made<AccelerationIndex3>};
}

}  // namespace momenta
