#include <momenta/dae/form/half_explicit_parts.h>
#include <momenta/dae/kkt/kkt.h>
#include <momenta/dae/loop_word.h>

#include <Eigen/Core>
#include <algorithm>

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
/// divided by ε is λ or σ: a larger ε than Newton matrices have. What it costs goes with the change
/// of the multiplier from stage to stage.
HalfExplicitParts::Work& HalfExplicitParts::work() {
  constexpr double softer = 1e3;
  if (!work_) {
    std::vector<double> compliance = newton_regularisation();
    for (double& epsilon : compliance) epsilon *= softer;
    work_ = std::make_shared<Work>(system_, std::move(compliance));
  }
  return *work_;
}

bool HalfExplicitParts::failed(std::string sentence) {
  why_ = std::move(sentence);
  return false;
}

bool HalfExplicitParts::rub(double t, const double* q, const double* u) {
  BearingFriction* friction = work().friction.get();
  return !friction || friction->at(t, q, u) || failed(friction->failure());
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
