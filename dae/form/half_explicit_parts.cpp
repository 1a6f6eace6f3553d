#include <momenta/dae/form/acceleration_form.h>
#include <momenta/dae/form/half_explicit_parts.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

HalfExplicitParts::Work::Work(const Mechanism& mechanism, std::vector<double> compliance)
    : e(mechanism.evaluation<double>()),
      ahead(mechanism.evaluation<double>()),
      kkt(mechanism, std::move(compliance)) {
  if (mechanism.m() > 0) solver = make_loop_solver(mechanism, *e);
  friction = bearing_friction(mechanism);
  if (friction) {
    e->push(friction->forces());
    if (solver) solver->push(friction->forces());
  }
  const auto nv = static_cast<std::size_t>(mechanism.nv()),
             m = static_cast<std::size_t>(mechanism.m());
  there.resize(static_cast<std::size_t>(mechanism.nq()));
  for (auto* v : {&u, &delta, &r}) v->resize(nv);
  for (auto* v : {&g, &correction, &centre}) v->resize(m);
}

/// Off the manifold redundant equations contradict each other by the square of the distance, which
/// divided by ε is λ or σ: ε is larger than in Newton matrices. Its error goes with the
/// multiplier's change from stage to stage.
HalfExplicitParts::Work& HalfExplicitParts::work() {
  constexpr double softer = 1e3;
  if (!work_) {
    std::vector<double> compliance = newton_regularisation();
    for (double& epsilon : compliance) epsilon *= softer;
    work_ = std::make_shared<Work>(system_, std::move(compliance));
  }
  return *work_;
}

HalfExplicit::Pivots HalfExplicitParts::pivots() const {
  if (!work_ || !work_->solver) return {};
  const LoopSolver::Pivots last = work_->solver->pivots();
  return {last.weakest, last.faded};
}

bool HalfExplicitParts::failed(std::string sentence) {
  why_ = std::move(sentence);
  return false;
}

bool HalfExplicitParts::add_bearing_friction(double t, const double* q, const double* u) {
  BearingFriction* friction = work().friction.get();
  return !friction || friction->at(t, q, u) || failed(friction->failure());
}

/// A correction below last_correction leaves its square; one that does not shrink tells that the
/// step was too long.
bool HalfExplicitParts::meet_positions(double t, double* q, const NaturalSizes& natural) {
  Work& w = work();
  if (!w.solver) return true;
  normalise(q);
  double before = std::numeric_limits<double>::infinity();
  for (int count = 0; count < most_corrections; ++count) {
    if (!w.solver->position_correction(t, q, w.delta.data()))
      return failed("the correction of positions is not finite");
    w.e->coordinate_rates(q, w.delta.data(), w.there.data());
    double size = 1, change = 0;
    for (std::size_t i = 0; i < w.there.size(); ++i) {
      q[i] += w.there[i];
      size = std::max(size, std::abs(q[i]) / natural.q[i]);
    }
    for (std::size_t i = 0; i < w.delta.size(); ++i)
      change = std::max(change, std::abs(w.delta[i]) / (natural.way[i] * size));
    if (change <= last_correction) return true;
    if (!(change < 0.5 * before)) break;
    before = change;
  }
  return failed("the correction of positions does not converge");
}

bool HalfExplicitParts::meet_velocities(double t, const double* q, double* v) {
  Work& w = work();
  if (!w.solver) return true;
  w.e->place(t, q);
  w.e->move(v);
  w.e->momenta(nullptr, w.r.data());
  if (!w.solver->momentum(t, q, w.r.data(), nullptr, fade_projection, 0, w.u.data(), w.g.data(),
                          nullptr))
    return failed("the correction of velocities is not finite");
  std::copy(w.u.begin(), w.u.end(), v);
  return true;
}

const double* HalfExplicitParts::centre(const double* z) {
  Work& w = work();
  std::copy_n(z, w.centre.size(), w.centre.data());
  return w.centre.data();
}

void HalfExplicitParts::normalise(double* y) {
  if (!system_.plan().quasi_velocities) return;
  for (const auto& b : system_.tree().bodies) {
    if (!b.has_quaternion()) continue;
    Eigen::Map<Eigen::Vector4d>(y + b.q + (b.nq - 4)).normalize();
  }
}

std::string HalfExplicitParts::dependent(double t, const double* y) {
  constexpr double weak = 1e-3;        // pivots fade at ten times this, of their group's mean
  constexpr int most_equations = 600;  // the matrix is dense
  if (system_.m() == 0 || system_.m() > most_equations) return "";
  Work& w = work();
  const auto kkt = make_dense_kkt(system_);
  if (!kkt->factor(*w.e, t, y, weak) || kkt->faded() == 0) return "";
  const RowName& first = system_.rows()[static_cast<std::size_t>(kkt->faded_rows().front())];
  const int others = kkt->faded() - 1;
  return loop_word(system_) + (" '" + first.loop) + "' (" + first.what + ")" +
         (others > 0 ? " and " + std::to_string(others) + " more of the " +
                           std::to_string(system_.m()) + " equations depend"
                     : std::string(" depends")) +
         " on the other equations there, or nearly so, and half-explicit stages need them "
         "independent";
}

}  // namespace momenta
