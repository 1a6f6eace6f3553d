#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/analysis/linear/operating_point.h>
#include <momenta/dae/analysis/linear/pose_motion.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/study/modes_study.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Checks, along three directions, that the linearised equations are constant in time.
void expect_constant(const Mechanism& mechanism, const Equilibrium& at) {
  constexpr double same = 1e-7;
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  MatrixXd X(mechanism.nv(), 3);
  for (Eigen::Index j = 0; j < X.cols(); ++j)
    for (Eigen::Index i = 0; i < X.rows(); ++i) X(i, j) = normal(random);
  const VectorXd rest = VectorXd::Zero(mechanism.nv());
  const auto e = mechanism.evaluation<double>();
  const auto forces = [&](double t) {
    VectorXd r(mechanism.nv());
    e->place(t, at.q.data());
    e->move(rest.data());
    e->joint_forces(at.q.data(), rest.data(), nullptr, at.lambda.data(), r.data());
    return r;
  };
  const Linearisation first = linearise(mechanism, at.t, at.q, at.lambda, X);
  const VectorXd here = forces(at.t), scales = force_scales(mechanism, *e);
  const auto differs = [&](const MatrixXd& a, const MatrixXd& b) {
    return !((a - b).cwiseAbs().maxCoeff() <= same * (1e-300 + a.cwiseAbs().maxCoeff()));
  };
  for (const double later : {0.31, 1.7}) {
    const double t = at.t + later;
    const Linearisation other = linearise(mechanism, t, at.q, at.lambda, X);
    const bool moves = (forces(t) - here).cwiseQuotient(scales).cwiseAbs().maxCoeff() > same ||
                       differs(first.M, other.M) || differs(first.K, other.K) ||
                       (!first.C.isZero(0) && differs(first.C, other.C)) ||
                       (mechanism.m() > 0 && differs(first.loops, other.loops));
    if (moves && mechanism.scene().lagrangian)
      throw SceneError(mechanism.scene().where(mechanism.scene().lagrangian->at) +
                       "lagrangian: its formulas change the equations of small motions with time, "
                       "expected formulas without t");
    if (moves)
      throw SceneError(mechanism.scene().where({}) +
                       "the drives change the equations of small motions with time: expected "
                       "drives that turn the mechanism as a whole at constant speed, or to be held "
                       "(--drives held)");
  }
}

/// Largest entry of a shape, in rad or lengths of the scene.
double largest_in_units(const Mechanism& mechanism, const VectorXd& shape) {
  return shape.cwiseQuotient(natural_units(mechanism)).cwiseAbs().maxCoeff();
}

}  // namespace

int ModesResult::growing() const {
  return static_cast<int>(std::count_if(spectrum.modes.begin(), spectrum.modes.end(),
                                        [](const Mode& m) { return m.s.real() > 0; }));
}
int ModesResult::rigid() const {
  return static_cast<int>(
      std::count_if(spectrum.modes.begin(), spectrum.modes.end(),
                    [](const Mode& m) { return m.kind() == Mode::Kind::rigid; }));
}
const char* ModesResult::nature() const {
  if (spectrum.mobility == 0) return "fixed";
  return growing() > 0 ? "unstable" : rigid() > 0 ? "neutral" : "stable";
}

ModesResult find_modes(const Mechanism& mechanism, const Start& start,
                       const ModesRequest& request) {
  refuse_bearings(mechanism.scene(), "an analysis of small motions");
  constexpr int most_saddles = 8;
  constexpr double aside = 0.05;  // [rad or lengths of the scene]
  ModesResult result;
  result.scene = mechanism.scene().name;
  result.of_formulas = mechanism.scene().lagrangian.has_value();
  result.coordinates = mechanism.coordinate_columns();
  result.shapes = displacement_columns(mechanism);
  Equilibrium& at = result.equilibrium;
  if (request.search == Search::steady) {
    expect_between_stops(mechanism, start.q);
    result.spectrum = steady_spectrum(mechanism, start, result.steady.emplace());
    at.t = start.t;
    at.q = start.q;
    at.lambda = start.lambda;
    result.drives_run = mechanism.plan().drives;
    return result;
  }
  at = find_equilibrium(mechanism, start, request.search);
  for (int saddles = 0;; ++saddles) {
    result.spectrum = spectrum(mechanism, at, request.count, request.route);
    const auto& modes = result.spectrum.modes;
    if (request.search != Search::settle || at.steps == 0 || saddles == most_saddles ||
        modes.empty() || !(modes.front().s.real() > 0) ||
        (!has_potential(mechanism) && modes.front().kind() != Mode::Kind::growth))
      break;
    VectorXd way = modes.front().shape.real();
    way *= aside / largest_in_units(mechanism, way);
    const int steps = at.steps;
    const VectorXd saddle = at.q;
    at = settle_from(mechanism, at, way);
    at.steps += steps;
    // The mode grows, but not downhill: a negative damper, say.
    if ((at.q - saddle).cwiseAbs().maxCoeff() < 1e-3 * aside) saddles = most_saddles - 1;
  }
  expect_between_stops(mechanism, at.q);
  if (start.q.size() > 0) at.moved = (at.q - start.q).cwiseAbs().maxCoeff();
  // Rates of drives show in what prescribed motion alone moves.
  if (mechanism.plan().drives && mechanism.nv() > 0) {
    result.drives_run = has_running_drive(mechanism.scene());
    if (mechanism.scene().lagrangian) result.drives_run = mechanism.lagrangian().in_time;
    if (result.drives_run) expect_constant(mechanism, at);
  }
  if (!result.spectrum.dependent_rows.empty() && mechanism.m() <= 200 && mechanism.nv() <= 200) {
    Start here;
    here.t = at.t;
    here.q = at.q;
    here.u = VectorXd::Zero(mechanism.nv());
    result.rank_nearby = rank_report(mechanism, here).rank_nearby;
  }
  return result;
}

Film swing(const Mechanism& mechanism, const ModesResult& result, const Mode& mode) {
  constexpr int intervals = 32, most_halvings = 5;
  constexpr double largest_turn = 0.35, largest_way = 0.15, probe = 1e-4;
  const Equilibrium& at = result.equilibrium;
  const auto frame_of = [](const VectorXd& q) { return std::vector<double>(q.begin(), q.end()); };
  PoseMotion poses(mechanism);
  const auto delta = [&](double amplitude, int k) -> VectorXd {
    if (mode.real) return amplitude * (-1 + 2.0 * k / intervals) * mode.shape.real();
    return amplitude * (mode.shape * std::polar(1.0, 2 * std::numbers::pi * k / intervals)).real();
  };
  // Motion of the bodies at a small amplitude.
  const double unit = probe / std::max(1e-300, largest_in_units(mechanism, mode.shape.cwiseAbs()));
  const Picture picture = picture_of(mechanism);
  Film probing{at.t, 0, {frame_of(at.q)}};
  for (const int k : {intervals, 0, intervals / 4}) {
    VectorXd q;
    if (poses.move(at.t, at.q, delta(unit, k), q)) probing.frames.push_back(frame_of(q));
  }
  const Motion probed = motion_of(mechanism, probing);
  const auto rest = places(picture, probed.frames.front());
  double turn = 0, way = 0, extent = picture.length;
  for (std::size_t k = 0; k < rest.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      extent = std::max(extent,
                        (rest[k] * picture.bodies[k].com - rest[j] * picture.bodies[j].com).norm());
  for (const Motion::Frame& frame : probed.frames) {
    const auto there = places(picture, frame);
    for (std::size_t k = 0; k < rest.size(); ++k) {
      turn = std::max(turn, Eigen::Quaterniond(there[k].linear())
                                .angularDistance(Eigen::Quaterniond(rest[k].linear())));
      way = std::max(way,
                     (there[k] * picture.bodies[k].com - rest[k] * picture.bodies[k].com).norm());
    }
  }
  double amplitude = unit / std::max({turn / largest_turn, way / (largest_way * extent), probe});
  Film film{at.t, 0, {}};
  for (int halving = 0; halving < most_halvings; ++halving, amplitude *= 0.5) {
    film.frames.clear();
    for (int k = 0; k <= intervals; ++k) {
      VectorXd q;
      if (!poses.move(at.t, at.q, delta(amplitude, k), q)) break;
      film.frames.push_back(frame_of(q));
    }
    if (film.frames.size() == intervals + 1) return film;
  }
  film.frames.assign(intervals + 1, frame_of(at.q));
  return film;
}

}  // namespace momenta
