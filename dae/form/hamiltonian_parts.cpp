#include <momenta/dae/form/hamiltonian_parts.h>

namespace momenta {

struct HamiltonianParts::Work {
  explicit Work(const Mechanism& mechanism)
      : e(mechanism.evaluation<double>()),
        motion(mechanism),
        entries(std::max(mechanism.kkt_pattern().mass.size(),
                         mechanism.kkt_pattern().constraint.size())),
        p(static_cast<std::size_t>(mechanism.nv())) {}
  std::unique_ptr<Evaluation<double>> e;
  CoordinateMotion motion;
  std::vector<double> entries, p;
};

HamiltonianParts::Work& HamiltonianParts::parts() {
  if (!parts_) parts_ = std::make_shared<Work>(system_);
  return *parts_;
}

void HamiltonianParts::place(double t, const double* q, PlacedHamiltonian& placed) {
  Work& w = parts();
  w.e->place(t, q);
  w.e->mass_entries(w.entries.data());
  placed.mass.setZero();
  const double* value = w.entries.data();
  for (const auto& entry : system_.kkt_pattern().mass)
    placed.mass(entry.row, entry.column) = placed.mass(entry.column, entry.row) = *value++;
  placed.constraint.setZero();
  if (system_.m() > 0) {
    w.e->constraint_entries(w.entries.data());
    value = w.entries.data();
    for (const auto& entry : system_.kkt_pattern().constraint)
      placed.constraint(entry.row, entry.column) = *value++;
    w.e->positions(placed.phi.data());
  }
  w.e->move(nullptr);
  w.e->momenta(nullptr, placed.prescribed.data());
  if (system_.m() > 0) w.e->velocities(placed.phi_t.data());
}

void HamiltonianParts::force(const double* q, const double* u, double* g) {
  Work& w = parts();
  w.e->move(u);
  w.e->momenta(nullptr, w.p.data());
  w.e->momentum_rates(q, u, nullptr, 0, g);
}

void HamiltonianParts::coordinate_rates(const double* q, const double* u, double* qdot) {
  parts().e->coordinate_rates(q, u, qdot);
}

void HamiltonianParts::move(const double* q, const double* delta, double* moved) {
  parts().motion.move(*parts().e, q, delta, moved);
}

}  // namespace momenta
