#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/form/hamiltonian_parts.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/kkt/unheld_joints.h>
#include <momenta/dae/mechanism/tree_factor.h>

#include <algorithm>

namespace momenta {
namespace {

/// Least pivot of Φ_q M⁻¹ Φ_qᵀ relative to its group's scale: rounding in dependent rows must ask
/// for no multiplier.
constexpr double dependent_rows = 1e-10;

class MechanismPlace final : public HamiltonianPlace {
 public:
  explicit MechanismPlace(const Mechanism& mechanism)
      : system_(mechanism),
        e_(mechanism.evaluation<double>()),
        factor_(mechanism.kkt_pattern(), mechanism.nv()),
        mass_(mechanism.kkt_pattern().mass.size()),
        work_(static_cast<std::size_t>(mechanism.nv())),
        prescribed_(work_.size()),
        none_(work_.size()),
        right_(static_cast<std::size_t>(mechanism.m())) {
    if (mechanism.m() > 0) kkt_ = make_kkt(mechanism);
  }

  bool at(double t, const double* q) override {
    e_->place(t, q);
    e_->mass_entries(mass_.data());
    if (factor_.factor(mass_) >= 0) return false;
    if (!system_.plan().drives) return true;
    e_->move(nullptr);
    e_->momenta(nullptr, prescribed_.data());
    return true;
  }
  void positions(double* phi) override { e_->positions(phi); }
  void rates(const double* p, const double* sigma, double* u) override {
    for (std::size_t i = 0; i < work_.size(); ++i) u[i] = p[i] - prescribed_[i];
    if (sigma != nullptr) {
      e_->constraint_forces(sigma, work_.data());
      for (std::size_t i = 0; i < work_.size(); ++i) u[i] -= work_[i];
    }
    solve_mass(u);
  }
  void solve_mass(double* x) override {
    factor_.inward(x);
    for (std::size_t i = 0; i < work_.size(); ++i) x[i] *= factor_.inverse_pivots()[i];
    factor_.outward(x);
  }
  void mass_times(const double* x, double* p) override {
    momentum(x, p);
    for (std::size_t i = 0; i < work_.size(); ++i) p[i] -= prescribed_[i];
  }
  void velocities(const double* u, double* rate) override {
    e_->move(u);
    e_->velocities(rate);
  }
  void force(const double* q, const double* u, const double* sigma, double* g) override {
    e_->move(u);
    e_->momenta(sigma, work_.data());
    e_->momentum_rates(q, u, sigma, 0, g);
  }
  void constraint_forces(const double* x, double* result) override {
    e_->constraint_forces(x, result);
  }

  void momentum(const double* u, double* p) override {
    e_->move(u);
    e_->momenta(nullptr, p);
  }
  double energy(const double* q, const double* u) override {
    e_->move(u);
    return e_->kinetic() + e_->potential(q);
  }
  double kinetic() override { return e_->kinetic(); }
  double power(const double* q, const double* u) override { return e_->dissipated_power(q, u); }

  bool factor(double t, const double* q) override {
    return !kkt_ || kkt_->factor(*e_, t, q, dependent_rows);
  }
  bool correction(const double* g, double* delta, double* nu) override {
    for (std::size_t i = 0; i < right_.size(); ++i) right_[i] = -g[i];
    return kkt_->solve(none_.data(), right_.data(), nullptr, delta, nu);
  }

 private:
  const Mechanism& system_;
  std::unique_ptr<Evaluation<double>> e_;
  TreeFactor factor_;
  std::unique_ptr<Kkt> kkt_;  ///< null without loops
  std::vector<double> mass_, work_, prescribed_, none_, right_;
};

}  // namespace

struct HamiltonianParts::Work {
  explicit Work(const Mechanism& mechanism)
      : e(mechanism.evaluation<double>()), motion(mechanism) {}
  std::unique_ptr<Evaluation<double>> e;
  CoordinateMotion motion;
};

HamiltonianParts::Work& HamiltonianParts::parts() {
  if (!parts_) parts_ = std::make_shared<Work>(system_);
  return *parts_;
}

std::string HamiltonianParts::prescribed() const {
  const Scene& scene = system_.scene();
  if (scene.lagrangian)
    return system_.lagrangian().moving ? "a constraint that takes the time" : "";
  if (!system_.plan().drives) return "";
  if (scene.drives.empty()) return "a joint or a loop whose formula takes the time";
  const DriveSpec& drive = scene.drives.front();
  return "the drive of " + (drive.joint.empty() ? "loop " + reading::in_quotes(drive.loop)
                                                : "joint " + reading::in_quotes(drive.joint));
}

std::unique_ptr<HamiltonianPlace> HamiltonianParts::place() const {
  return std::make_unique<MechanismPlace>(system_);
}

std::string HamiltonianParts::without_inverse(double t, const double* q) {
  return mass_without_inverse(system_, *parts().e, t, q);
}

void HamiltonianParts::coordinate_rates(const double* q, const double* u, double* qdot) {
  parts().e->coordinate_rates(q, u, qdot);
}

void HamiltonianParts::move(const double* q, const double* delta, double* moved) {
  parts().motion.move(*parts().e, q, delta, moved);
}

}  // namespace momenta
