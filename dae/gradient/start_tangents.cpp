#include <momenta/core/text/near_name.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/assembly/scaled_loops.h>
#include <momenta/dae/gradient/stage_matrix.h>
#include <momenta/dae/gradient/start_tangents.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_units.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::VectorXd;

/// The start of this guess, loops closed to rounding.
Start closed_start(const Mechanism& mechanism, const VectorXd& q, const VectorXd& u) {
  Assembly a = assemble(mechanism, 0, q, u);
  if (mechanism.m() == 0 || a.start.residue.size() > 0) return a.start;
  ScaledLoops loops(mechanism);
  loops.hold_joints();
  LeastNorm steps(loops.pattern(), mechanism.m(), mechanism.nv());
  VectorXd pose = a.start.q;
  for (int pass = 0; pass < 2; ++pass) {
    const VectorXd gap = loops.gap(0, pose);
    steps.factor(loops.jacobian());
    pose = loops.moved(pose, -steps.solve(gap));
  }
  return assemble(mechanism, 0, pose, u).start;
}

}  // namespace

StartTangents start_tangents(const Mechanism& mechanism, const std::string& form,
                             const FormOptions& options, const std::vector<RunVariable>& variables,
                             const std::vector<OtherParameter>& others) {
  StartTangents tangents;
  tangents.of_state.setZero(mechanism.nq() + mechanism.nv(),
                            static_cast<Eigen::Index>(variables.size()));
  for (std::size_t j = 0; j < variables.size(); ++j) {
    const RunVariable& v = variables[j];
    const OtherParameter& other = others[j];
    if (other.starts_at_once) continue;
    double size = 1;
    const double widest = other.by_mechanisms ? other.near->h() : other.h;
    const sixth_order::Slope slope = sixth_order::slope_of(
        widest, sixth_order::iterated, [&](std::size_t k, double h) -> VectorXd {
          const Mechanism& made = other.by_mechanisms ? other.near->mechanism(k, h) : mechanism;
          VectorXd q = made.tree().q0, u = made.tree().u0;
          const double change = sixth_order::k_of(k) * h;
          if (v.kind == RunVariable::Kind::position) q[v.place] += change;
          if (v.kind == RunVariable::Kind::rate) u[v.place] += change;
          const Start start = closed_start(made, q, u);
          const std::vector<double> y = make_form(form, made, options, start)->initial(start);
          const Eigen::Map<const VectorXd> state(y.data(), tangents.of_state.rows());
          size = std::max(size, state.cwiseAbs().maxCoeff());
          return state;
        });
    tangents.of_state.col(static_cast<Eigen::Index>(j)) = slope.by;
    // For a smooth start the formulas differ by h⁴, else by about 1/h.
    if (!(slope.apart <= 1e-3 * (size / v.size + slope.by.cwiseAbs().maxCoeff())))
      tangents.broken.push_back("the start changes too abruptly with " +
                                reading::in_quotes(v.name) + " for a derivative: within " +
                                reading::digits(3 * widest) +
                                " of its value the scene is assembled otherwise");
  }
  return tangents;
}

Eigen::MatrixXd any_start_change(const Mechanism& mechanism, const Start& start, bool momenta) {
  const int nq = mechanism.nq(), nv = mechanism.nv(), m = mechanism.m();
  const auto e = mechanism.evaluation<double>();
  e->place(start.t, start.q.data());
  StageMatrix matrix(mechanism);
  matrix.factor(*e);
  using Eigen::MatrixXd, Eigen::VectorXd;
  const VectorXd units = LoopUnits(mechanism).rates;
  VectorXd change(nv), right = VectorXd::Zero(nv + m), still(m), momentum(nv), resting(nv);
  for (int i = 0; i < nv; ++i) change[i] = units[i] * (i % 3 == 1 ? -1 : 1);
  e->move(nullptr);
  if (m > 0) e->velocities(still.data());
  e->momenta(nullptr, resting.data());
  e->move(change.data());
  if (m > 0) e->velocities(right.data() + nv);
  right.tail(m) = still - right.tail(m);
  change += matrix.solve(right).col(0).head(nv);
  MatrixXd dy(nq + nv, 1);
  e->coordinate_rates(start.q.data(), change.data(), dy.data());
  e->move(change.data());
  e->momenta(nullptr, momentum.data());
  dy.bottomRows(nv) = momenta ? momentum - resting : change;
  return dy;
}

}  // namespace momenta
