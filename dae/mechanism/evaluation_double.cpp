// Evaluations in doubles, and the pattern of (7), which they write.

#include <momenta/dae/mechanism/lagrangian_evaluation.h>
#include <momenta/dae/mechanism/sweep_evaluation.h>

namespace momenta {

const KktPattern& Mechanism::kkt_pattern() const {
  constraint_pattern();
  std::call_once(mass_pattern_known_, [&] {
    if (scene_.lagrangian) {
      for (const auto& [row, column] : lagrangian().mass.places)
        pattern_.mass.push_back({row, column});
      return;
    }
    visit([&]<class Space>(const ModelData<Space>& data) {
      SweepEvaluation<Space> e(*this, data);
      e.place(0, tree_.q0.data());
      e.each_mass_entry([&](int i, int j, double) { pattern_.mass.push_back({i, j}); });
    });
  });
  return pattern_;
}

const std::vector<KktPattern::Entry>& Mechanism::constraint_pattern() const {
  std::call_once(constraint_pattern_known_, [&] {
    if (scene_.lagrangian) {
      for (const auto& [row, column] : lagrangian().constraint.places)
        pattern_.constraint.push_back({row, column});
      return;
    }
    visit([&]<class Space>(const ModelData<Space>& data) {
      SweepEvaluation<Space> e(*this, data);
      e.place(0, tree_.q0.data());
      e.each_constraint_entry([&](int i, int j, double) { pattern_.constraint.push_back({i, j}); });
    });
  });
  return pattern_.constraint;
}

template <>
std::unique_ptr<Evaluation<double>> Mechanism::evaluation<double>() const {
  if (scene_.lagrangian) return std::make_unique<LagrangianEvaluation>(lagrangian(), kkt_pattern());
  return visit(
      [&]<class Space>(const ModelData<Space>& data) -> std::unique_ptr<Evaluation<double>> {
        return std::make_unique<SweepEvaluation<Space>>(*this, data);
      });
}

}  // namespace momenta
