// A mechanism made of a Lagrangian: patterns, names and units of its coordinates and constraints,
// and what is asked of its formulas at the start.

#include <momenta/dae/mechanism/model_data.h>

#include <cmath>

namespace momenta {
namespace {

/// Refuses a scene whose formulas are not finite at the start.
class StartCheck {
 public:
  StartCheck(const Mechanism& mechanism)
      : scene_(mechanism.scene()),
        spec_(*scene_.lagrangian),
        m_(mechanism.m()),
        e_(mechanism.evaluation<double>()),
        values_(static_cast<std::size_t>(std::max(mechanism.nv(), m_))) {
    e_->place(0, mechanism.tree().q0.data());
    e_->move(mechanism.tree().u0.data());
    constraints("has the value", [&] { e_->positions(values_.data()); });
    constraints("has the rate", [&] { e_->velocities(values_.data()); });
    constraints("has the second derivative by time", [&] {
      e_->joint_forces(nullptr, nullptr, nullptr, nullptr, values_.data());
      e_->accelerations(values_.data());
    });
    e_->momenta(nullptr, values_.data());
    coordinates("its derivative by the rate of ");
    e_->applied_forces(0, mechanism.tree().q0.data(), mechanism.tree().u0.data(), values_.data());
    forces();
    e_->momentum_rates(nullptr, nullptr, nullptr, 0, values_.data());
    coordinates("its derivative by ");
    e_->joint_forces(nullptr, nullptr, nullptr, nullptr, values_.data());
    coordinates("the derivative by time of its derivative by the rate of ");
  }

 private:
  [[noreturn]] void refuse(Location at, const std::string& who, const std::string& what, double x) {
    throw SceneError(scene_.where(at) + who + ": " + what + " " +
                     (std::isnan(x) ? "nan" : "infinite") +
                     " at the start, expected a finite number");
  }
  template <class Evaluate>
  void constraints(const std::string& what, Evaluate&& evaluate) {
    if (m_ == 0) return;
    evaluate();
    for (std::size_t i = 0; i < spec_.constraints.size(); ++i)
      if (!std::isfinite(values_[i]))
        refuse(spec_.constraints[i].equation.at, "constraint '" + spec_.constraints[i].name + "'",
               what, values_[i]);
  }
  void forces() {
    for (const auto& f : spec_.forces)
      for (std::size_t i = 0; i < spec_.coordinates.size(); ++i)
        if (spec_.coordinates[i].name == f.coordinate && !std::isfinite(values_[i]))
          refuse(f.value.at, "force on '" + f.coordinate + "'", "is", values_[i]);
  }
  void coordinates(const std::string& what) {
    const bool whole = !spec_.lagrangian.text.empty();
    for (std::size_t i = 0; i < spec_.coordinates.size(); ++i)
      if (!std::isfinite(values_[i]))
        refuse(whole ? spec_.lagrangian.at : spec_.kinetic.at,
               whole ? "lagrangian" : "kinetic - potential",
               what + "'" + spec_.coordinates[i].name + "' is", values_[i]);
  }

  const Scene& scene_;
  const LagrangianSpec& spec_;
  int m_;
  std::unique_ptr<Evaluation<double>> e_;
  std::vector<double> values_;
};

/// Least scale of each constraint's row, a part of its scale at the start: where the gradient
/// vanishes, as where a curve crosses itself, the row has none of its own.
std::vector<double> scales_of_constraints(const Mechanism& mechanism,
                                          const LagrangianModel& model) {
  constexpr double part = 0.1;
  const auto e = mechanism.evaluation<double>();
  e->place(0, mechanism.tree().q0.data());
  std::vector<double> inertia(static_cast<std::size_t>(model.n)),
      slopes(model.constraint.places.size()), scales(static_cast<std::size_t>(model.m));
  e->mass_diagonal(inertia.data());
  e->constraint_entries(slopes.data());
  for (std::size_t k = 0; k < slopes.size(); ++k) {
    const auto& [row, column] = model.constraint.places[k];
    const double own = inertia[static_cast<std::size_t>(column)];
    if (own > 0) scales[static_cast<std::size_t>(row)] += part * slopes[k] * slopes[k] / own;
  }
  return scales;
}

}  // namespace

const LagrangianModel& Mechanism::lagrangian() const {
  return *models_->lagrangian;
}

void Mechanism::take_lagrangian() {
  const LagrangianModel& model = models_->lagrangian.emplace(build_lagrangian_model(scene_));
  plan_.drives = model.in_time || model.linear;
  int group = 0;
  for (const auto& c : scene_.lagrangian->constraints) {
    row_names_.push_back({c.name, "its equation"});
    row_groups_.push_back(group + c.angle);
    angle_rows_.push_back(c.angle);
    group += 2;
  }
  rows_ = static_cast<int>(row_names_.size());
  least_scales_.assign(row_names_.size(), 0.0);
  nonholonomic_.assign(row_names_.size(), false);
  plan_.loops = rows_ > 0;
  StartCheck{*this};
  least_scales_ = scales_of_constraints(*this, model);
}

}  // namespace momenta
