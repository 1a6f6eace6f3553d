#pragma once
// The parts of the Hamiltonian of a mechanism, for RATTLE and the energy-momentum scheme: a base
// class of the form `momentum`. M⁻¹ by the factors of M along the tree, Σ depth²; multipliers by
// the matrix of (7), dense or sparse by size, as everywhere (kkt.h). It takes no memory before its
// first use.

#include <momenta/dae/form/coordinate_motion.h>
#include <momenta/dae/integrator/constrained_hamiltonian.h>

#include <memory>

namespace momenta {

class HamiltonianParts : public ConstrainedHamiltonian {
 public:
  explicit HamiltonianParts(const Mechanism& mechanism) : system_(mechanism) {}

  int coordinates() const override { return system_.nq(); }
  int momenta() const override { return system_.nv(); }
  int multipliers() const override { return system_.m(); }
  std::string prescribed() const override;
  std::unique_ptr<HamiltonianPlace> place() const override;
  std::string without_inverse(double t, const double* q) override;
  void coordinate_rates(const double* q, const double* u, double* qdot) override;
  void move(const double* q, const double* delta, double* moved) override;

 private:
  struct Work;
  Work& parts();

  const Mechanism& system_;
  std::shared_ptr<Work> parts_;
};

}  // namespace momenta
