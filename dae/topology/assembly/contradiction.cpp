#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/topology/assembly/contradiction.h>

#include <algorithm>

namespace momenta {

Contradiction contradiction(ScaledLoops& loops, double t, const Eigen::VectorXd& q, double pivot) {
  constexpr double elsewhere = 100;
  constexpr double rounding = 1e-14;  // singular values, relative to the largest
  const Mechanism& mechanism = loops.mechanism();
  Contradiction found{Eigen::VectorXd::Zero(mechanism.m()), pivot, 0};
  if (mechanism.m() == 0 || mechanism.nv() == 0) return found;
  const Eigen::VectorXd gap = loops.gap(t, q);
  const double open = gap.cwiseAbs().maxCoeff();
  LeastNorm steps(loops.pattern(), mechanism.m(), mechanism.nv());
  const LoopRank judged = steps.judge(loops.jacobian(), Judged::dependence);
  if (judged.rank == std::count(loops.rows.begin(), loops.rows.end(), true)) return found;
  if (open > std::max(1e-12, loops.units().rounding) && open <= left_by_files) {
    found.open = gap;
    found.left = elsewhere * open;
  }
  if (judged.singular_values.size() == 0) return found;
  const double seems = judged.dropped / judged.singular_values[0];
  if (!(seems > rounding)) return found;
  found.pivot = std::max(pivot, elsewhere * seems);
  found.left = std::max(found.left, elsewhere * judged.dropped);
  return found;
}

}  // namespace momenta
