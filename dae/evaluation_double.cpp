// Evaluations in doubles, and the pattern of (7), which they write.

#include <momenta/dae/sweep_evaluation.h>

namespace momenta {

const KktPattern& Mechanism::kkt_pattern() const {
  std::call_once(pattern_known_, [&] {
    const auto analyse = [&]<class Space>(const Cast<Space>& cast) {
      SweepEvaluation<Space, double> e(*this, cast);
      e.place(0, tree_.q0.data());
      e.each_mass_entry([&](int i, int j, double) { pattern_.mass.push_back({i, j}); });
      e.each_constraint_entry([&](int i, int j, double) { pattern_.constraint.push_back({i, j}); });
    };
    if (plan_.planar)
      analyse(std::get<0>(cast_));
    else
      analyse(std::get<1>(cast_));
  });
  return pattern_;
}

template std::unique_ptr<Evaluation<double>> Mechanism::evaluation<double>() const;

}  // namespace momenta
