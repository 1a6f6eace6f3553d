#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/gradient/acceleration_adjoint.h>
#include <momenta/dae/gradient/adjoint_run.h>
#include <momenta/dae/gradient/differentiable.h>
#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/gradient/law_jumps.h>
#include <momenta/dae/gradient/stage_adjoint.h>
#include <momenta/dae/gradient/start_adjoint.h>
#include <momenta/dae/gradient/tangent_system.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/run/event/scene_inputs.h>
#include <momenta/dae/run/form_runner.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A variable has no effect where dJ/dθ times its size is below this part of J.
constexpr double effect = 1e-10;
/// Least absolute tolerance of tangents: at corners their rates jump.
constexpr double least_of_tangents = 1e-10;

/// Scale of tangents beside y in the norm of the local error.
double tangents_scale_at(double atol) {
  return std::max(1.0, least_of_tangents / std::max(atol, 1e-300));
}

std::unique_ptr<FormAdjoint> form_adjoint(const Mechanism& mechanism, const OdeForm& form,
                                          const std::vector<OtherParameter>& others) {
  if (form.momentum_like()) return std::make_unique<StageAdjoint>(mechanism, form, others);
  return std::make_unique<AccelerationAdjoint>(mechanism, form, others);
}

/// Parts that forward and adjoint share.
struct GradientTask {
  const GradientRequest& request;
  const Mechanism& mechanism;
  const Start& start;
  OdeForm& form;
  const std::vector<OtherParameter>& others;
  const FormOptions& gains;
  StartAdjoint* start_adjoint;  ///< null: the start is differenced
  LawJumps& jumps;
  std::vector<double> stops;  ///< where inputs change [s]
  GradientResult& result;

  IntegrationOptions options() const {
    IntegrationOptions all;
    all.rtol = result.settings.rtol;
    all.atol = result.settings.atol;
    all.step = result.settings.step;
    all.max_cpu_seconds = request.max_cpu_seconds;
    all.stops = stops;
    return all;
  }
  SceneError none(const std::string& why) const {
    return SceneError(mechanism.scene().where({}) + "the run has no gradient: " + why);
  }
  void take(const IntegrationResult& run, const std::vector<double>& passages) {
    for (const double t : passages)
      result.remarks.push_back(
          "about t = " + compact(t, 3) +
          " s the run passes a singular pose, where another motion crosses or meets its own: the "
          "gradient is that of changes which keep it on its own, and numbers that part the two "
          "have "
          "none");
    result.steps = run.counters.steps;
    result.end_time = run.end_time;
  }
  /// dy(0)/dθ
  MatrixXd at_start() const {
    StartTangents tangents =
        start_tangents(mechanism, result.settings.form, gains, result.variables, others);
    for (std::string& remark : tangents.broken) result.remarks.push_back(std::move(remark));
    return std::move(tangents.of_state);
  }
  /// Adds the part of dy(0)/dθ taken at once; rows are those of y(0), or λᵀ.
  void add_start(const MatrixXd& slopes, MatrixXd& rows) {
    for (std::size_t j = 0; j < others.size(); ++j)
      if (others[j].starts_at_once)
        rows.col(static_cast<Eigen::Index>(j)) +=
            start_adjoint->by(result.variables[j], others[j], slopes);
  }
  /// The first jump of a force in a step (law_jumps.h); empty: none.
  std::string jump_in_step(double t0, double t1, const Interpolant& between,
                           std::vector<double>& inside) {
    if (!jumps.any()) return {};
    std::vector<double> rates(inside.size());
    return jumps.in_step(t0, t1, [&](double t, VectorXd& q, VectorXd& u) {
      between(t, inside.data());
      const bool of_form = form.momentum_like() && jumps.takes_rates();
      if (of_form && !form.rhs(t, inside.data(), rates.data())) return false;
      q = Eigen::Map<const VectorXd>(inside.data(), mechanism.nq());
      u = Eigen::Map<const VectorXd>(
          form.momentum_like() ? form.rates().data() : inside.data() + mechanism.nq(),
          mechanism.nv());
      return true;
    });
  }
  void forward();
  void adjoint();
};

void GradientTask::forward() {
  const RunSettings& s = result.settings;
  std::optional<Functional> functional;
  if (!request.of.empty()) functional.emplace(request.of, mechanism, result.variables, others);
  std::vector<std::unique_ptr<Functional>> outputs;
  for (const std::string& formula : request.outputs)
    outputs.push_back(std::make_unique<Functional>(formula, mechanism, result.variables, others));
  MatrixXd tangents_at_start = at_start();
  if (start_adjoint) add_start(start_adjoint->rows(form.name() == "momentum"), tangents_at_start);
  for (std::string& remark :
       corners(mechanism.scene(), functional ? functional->corner() : std::string()))
    result.remarks.push_back(std::move(remark));
  FormTangents tangents(mechanism, form, others);
  const auto directions = static_cast<int>(result.variables.size());
  VectorXd sizes(directions);
  for (int j = 0; j < directions; ++j)
    sizes[j] = result.variables[static_cast<std::size_t>(j)].size;
  const bool turns =
      has_corners(mechanism.scene()) || (functional && !functional->corner().empty());
  double tangents_scale = tangents_scale_at(s.atol);
  std::optional<TangentSystem> system;
  std::vector<double> times = request.times;
  if (!outputs.empty()) {
    if (times.front() > start.t) times.insert(times.begin(), start.t);
    result.outputs.resize(static_cast<Eigen::Index>(request.times.size()),
                          static_cast<Eigen::Index>(outputs.size()));
  } else {
    const int samples = request.trajectory ? s.samples : 1;
    for (int i = 0; i <= samples; ++i) times.push_back(s.end_time * i / samples);
  }
  for (const Column& c : mechanism.coordinate_columns()) result.columns.push_back(c.name);
  for (const Column& c : mechanism.rate_columns()) result.columns.push_back(c.name);
  Observer observer;
  TangentSystem::Motion motion;
  std::string lost;
  if (request.trajectory || !outputs.empty())
    observer.sample = [&](double t, const double* y, const double*) {
      if (!outputs.empty() && t < request.times.front()) return true;
      const ObservationGuard looking(*system);
      if (!system->motion(t, y, motion)) {
        lost = system->failure();
        return false;
      }
      if (!outputs.empty()) {
        const auto row = static_cast<Eigen::Index>(result.output_slopes.size());
        MatrixXd& slopes = result.output_slopes.emplace_back(result.outputs.cols(), directions);
        VectorXd by;
        for (Eigen::Index k = 0; k < slopes.rows(); ++k) {
          result.outputs(row, k) = (*outputs[static_cast<std::size_t>(k)])(
              t, motion.q, motion.u, motion.dq, motion.du, by);
          slopes.row(k) = by.transpose();
        }
        return true;
      }
      MatrixXd& d = result.tangents.emplace_back(motion.q.size() + motion.u.size(), directions);
      d << motion.dq, motion.du;
      result.times.push_back(t);
      return true;
    };
  std::vector<double> inside;
  bool ended = false;
  if (request.progress || jumps.any())
    observer.step = [&](double t0, double t1, const Interpolant& between) {
      lost = jump_in_step(t0, t1, between, inside);
      ended = request.progress && !request.progress(t1);
      return lost.empty() && !ended;
    };
  IntegrationResult run;
  // Rates of tangents may jump so far that no step meets the tolerance: it grows.
  for (int i = 0; i < 3 && !run.done; ++i, tangents_scale *= 1e3) {
    if (i > 0 && (!turns || ended || !lost.empty() || !system->lost().empty() ||
                  request.max_cpu_seconds > 0))
      break;
    result.times.clear(), result.tangents.clear(), result.output_slopes.clear();
    system.emplace(form, tangents, request.integral ? &*functional : nullptr, sizes,
                   tangents_scale);
    IntegrationOptions integration = options();
    integration.rtol *= system->tolerance_factor();
    integration.atol *= system->tolerance_factor();
    const std::vector<double> y0 = system->initial(form.initial(start), tangents_at_start);
    inside.resize(y0.size());
    run = integrate(s.integrator, *system, start.t, y0, times, integration, observer);
  }
  if (!run.done)
    throw none(!lost.empty() ? lost : system->lost().empty() ? run.reason : system->lost());
  take(run, system->singular_passages());
  if (request.integral) {
    result.value = system->integral(run.y.data());
    result.gradient = system->integral_tangents(run.y.data());
  } else if (functional) {
    if (!system->motion(run.end_time, run.y.data(), motion)) throw none(system->failure());
    result.value =
        (*functional)(run.end_time, motion.q, motion.u, motion.dq, motion.du, result.gradient);
  }
}

void GradientTask::adjoint() {
  const RunSettings& s = result.settings;
  FunctionalSlopes functional(request.of, mechanism, result.variables, others);
  const std::unique_ptr<FormAdjoint> stages = form_adjoint(mechanism, form, others);
  const MatrixXd tangents_at_start = at_start();
  for (std::string& remark : corners(mechanism.scene(), functional.corner()))
    result.remarks.push_back(std::move(remark));
  // Steps follow one tangent and the integral.
  const std::vector<OtherParameter> no_parameter(1);
  std::optional<FormTangents> tangents;
  std::optional<Functional> integrand;
  std::optional<TangentSystem> followed;
  std::vector<double> y0 = form.initial(start);
  IntegrationOptions integration = options();
  if (s.step == 0 && mechanism.nv() > 0) {
    tangents.emplace(mechanism, form, no_parameter);
    if (request.integral)
      integrand.emplace(request.of, mechanism, std::vector<RunVariable>(1), no_parameter);
    followed.emplace(form, *tangents, integrand ? &*integrand : nullptr, VectorXd::Ones(1),
                     tangents_scale_at(s.atol));
    y0 = followed->initial(y0, any_start_change(mechanism, start, form.momentum_like()));
    integration.rtol *= followed->tolerance_factor();
    integration.atol *= followed->tolerance_factor();
  }
  RecordedRun record(form, followed ? static_cast<OdeSystem&>(*followed) : form, s.step, s.end_time,
                     butcher_tableau(s.integrator).c, request.integral || stages->needs_rates());
  Observer observer;
  std::string lost;
  std::vector<double> inside(static_cast<std::size_t>(record.size()));
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    lost = jump_in_step(t0, t1, between, inside);
    return lost.empty() && (!request.progress || request.progress(0.5 * t1)) && record.keep(t0, t1);
  };
  const IntegrationResult run =
      integrate(s.integrator, record, start.t, y0, {start.t, s.end_time}, integration, observer);
  if (!run.done)
    throw none(!lost.empty() ? lost : record.lost().empty() ? run.reason : record.lost());
  take(run, record.singular_passages());
  if (record.redundant()) stages->by_rows();
  AdjointRun back(form, *stages, functional, request.integral, s.integrator,
                  static_cast<Eigen::Index>(others.size()));
  const auto going = [&](double t) {
    return !request.progress || request.progress(s.end_time - 0.5 * t);
  };
  if (!back.back(record, run.end_time, run.y.data(), going)) throw none(back.failure());
  result.value = back.value();
  result.gradient = back.by_parameters() + tangents_at_start.transpose() * back.by_start();
  stages->finish(result.gradient);
  if (start_adjoint) {
    MatrixXd of_start = MatrixXd::Zero(1, result.gradient.size());
    add_start(start_adjoint->back(back.by_start(), form.momentum_like()).transpose(), of_start);
    result.gradient += of_start.transpose();
  }
  result.products = back.products();
  result.at_once = stages->at_once();
}

}  // namespace

const std::vector<std::string>& gradient_modes() {
  static const std::vector<std::string> names{"automatic", "forward", "adjoint"};
  return names;
}

GradientMode gradient_mode(const std::string& name) {
  const auto found = std::find(gradient_modes().begin(), gradient_modes().end(), name);
  if (found == gradient_modes().end())
    throw std::invalid_argument("mode " + reading::in_quotes(name) +
                                " is not known; expected one of: " + listed(gradient_modes()));
  return static_cast<GradientMode>(found - gradient_modes().begin());
}

namespace {

/// Refuses parameters that the scene's own end of the run follows: the end stays where it is. One
/// reading of the scene with all of them moved, and one for each where the end moves.
void expect_end_stays(const SceneText& scene, const Scene& own,
                      const std::vector<RunVariable>& variables) {
  const auto moves = [&](const std::vector<Setting>& settings) {
    try {
      return scene.scene(settings).run.end_time != own.run.end_time;
    } catch (const SceneError&) {  // other parts of the scene have no such neighbour
      return settings.size() > 1;
    }
  };
  std::vector<Setting> all;
  for (const RunVariable& v : variables)
    if (v.kind == RunVariable::Kind::parameter)
      all.push_back({v.name, v.value + sixth_order::part * v.size});
  if (all.empty() || !moves(all)) return;
  for (const Setting& one : all)
    if (moves({one}))
      throw SceneError(own.where({}) + "run.end follows " + reading::in_quotes(one.place) +
                       ", and derivatives are at a fixed time; expected an end that is given apart "
                       "(--end), or another parameter");
}

GradientResult by_one_run(const SceneText& scene, const GradientRequest& request,
                          bool& at_corners) {
  const Mechanism mechanism(scene.scene(), scene.options);
  GradientResult result;
  expect_smooth_motion(mechanism.scene());
  result.scene = mechanism.scene().name;
  result.of = request.of;
  result.integral = request.integral;
  result.settings = request.settings;
  result.variables = run_variables(scene, mechanism, request.by);
  RunSettings& s = result.settings;
  if (request.times.empty() && s.end_time == mechanism.scene().run.end_time)
    expect_end_stays(scene, mechanism.scene(), result.variables);
  s.when_stiff.clear();
  if (s.integrator.empty()) s.integrator = default_integrator(s.form, s.rtol);
  expect_differentiable(s, mechanism);
  if (!request.outputs.empty()) {
    if (request.of.empty() && request.integral)
      throw std::invalid_argument("an integral without its formula; expected one");
    if (request.times.empty() || !std::is_sorted(request.times.begin(), request.times.end()) ||
        request.times.front() < 0)
      throw std::invalid_argument(
          "times of the outputs are missing, before the start or not in their order; expected "
          "ascending times from 0 on");
    s.end_time = request.times.back();
  }
  const bool turns = has_corners(mechanism.scene()) && s.step == 0;
  const std::string refused = no_adjoint(mechanism, request.trajectory || !request.outputs.empty());
  if (request.mode == GradientMode::adjoint && !refused.empty())
    throw std::invalid_argument(refused);
  result.adjoint = request.mode == GradientMode::adjoint ||
                   (request.mode == GradientMode::automatic && refused.empty() && !turns &&
                    result.variables.size() > most_forward);
  at_corners = has_corners(mechanism.scene()) && (s.step > 0 || result.adjoint);

  const Start start = assemble(mechanism).start;
  FormRunner runner(mechanism, start, s, request.max_cpu_seconds);  // completes the settings
  auto& form = dynamic_cast<OdeForm&>(runner.form());
  FormOptions options;
  options.gauge = form.gauge();
  options.project = form.corrects_positions();
  std::tie(options.baumgarte_alpha, options.baumgarte_beta) = form.baumgarte_gains();
  options.beta = form.beta();
  // σ at the start with a leak (λ/κ), and on accelerations, is differenced. On accelerations second
  // derivatives by all numbers have no part in time.
  std::optional<StartAdjoint> start_adjoint;
  TakenAtOnce at_once;
  const bool leaks = form.gauge().kind == Gauge::Kind::leak;
  if ((result.adjoint || !leaks) && !mechanism.scene().lagrangian &&
      !mechanism.plan().quasi_velocities && !mechanism.has_nonholonomic() &&
      (form.momentum_like() || !result.adjoint || !mechanism.plan().drives)) {
    start_adjoint.emplace(mechanism, start);
    at_once.slopes = &start_adjoint->numbers();
    at_once.slopes_of_start = !leaks;
    at_once.starts = !leaks && start_adjoint->follows_assembly();
    at_once.plain_forces = !(result.adjoint && form.momentum_like());
    const auto asks = [&](const std::string& name) {
      return request.of.find(name) != std::string::npos ||
             std::any_of(request.outputs.begin(), request.outputs.end(),
                         [&](const std::string& of) { return of.find(name) != std::string::npos; });
    };
    // On accelerations forward tangents take rows alone.
    at_once.makes_all = (!result.adjoint && !form.momentum_like()) || asks("energy");
    for (const Column& marker : mechanism.marker_columns())
      at_once.makes_places |= asks(marker.name);
  }
  const std::vector<OtherParameter> others =
      other_parameters(scene, mechanism, result.variables, at_once);
  std::vector<Scene> near;  // scenes near θ, where numbers decide on moments of jumps
  for (const RunVariable& v : result.variables)
    if (v.kind == RunVariable::Kind::parameter && has_corners(mechanism.scene())) try {
        near.push_back(scene.scene({{v.name, v.value + 1e-9 * v.size}}));
      } catch (const SceneError&) {  // no neighbour: no formula differs
      }
  const std::vector<double> inputs = input_times(mechanism.scene(), start.t, s.end_time);
  LawJumps jumps(mechanism, near, !form.momentum_like(), inputs);
  GradientTask task{request,
                    mechanism,
                    start,
                    form,
                    others,
                    options,
                    start_adjoint ? &*start_adjoint : nullptr,
                    jumps,
                    s.step == 0 ? inputs : std::vector<double>{},
                    result};
  if (result.adjoint)
    task.adjoint();
  else
    task.forward();
  if (!std::isfinite(result.value) || !result.gradient.allFinite())
    throw SceneError(mechanism.scene().where({}) + reading::in_quotes(request.of) +
                     " or its gradient is not a finite number; expected a formula that has a value "
                     "and derivatives along the motion");
  for (std::size_t j = 0; j < result.variables.size(); ++j) {
    const RunVariable& v = result.variables[j];
    result.digits.push_back(others[j].near ? others[j].near->digits() : 16);
    if (result.gradient.size() > 0 &&
        std::abs(result.gradient[static_cast<Eigen::Index>(j)]) * v.size <=
            effect * std::abs(result.value))
      result.without_effect.push_back(v.name);
  }
  return result;
}

/// Checks the largest derivatives, as many as a forward mode takes, at corners that steps do not
/// follow: against those of half the step or, after a sweep back, tangents that steps follow.
void check_corners(const SceneText& scene, const GradientRequest& request, GradientResult& result) {
  constexpr double told = 1e-4, refused = 1e-2;
  std::vector<Eigen::Index> order(result.variables.size());
  std::iota(order.begin(), order.end(), 0);
  const auto effect_of = [&](Eigen::Index j) {
    return result.variables[static_cast<std::size_t>(j)].size * std::abs(result.gradient[j]);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](Eigen::Index i, Eigen::Index j) { return effect_of(i) > effect_of(j); });
  order.resize(std::min<std::size_t>(order.size(), most_forward));
  const bool fixed = request.settings.step > 0;
  GradientRequest other = request;
  other.by.clear();
  for (const Eigen::Index j : order)
    other.by.push_back(result.variables[static_cast<std::size_t>(j)].name);
  other.mode = fixed && result.adjoint ? GradientMode::adjoint : GradientMode::forward;
  other.settings.step /= 2;
  other.trajectory = false;
  other.progress = {};
  if (request.progress) other.progress = [&](double) { return request.progress(result.end_time); };
  bool ignored = false;
  const Eigen::VectorXd expected = by_one_run(scene, other, ignored).gradient;
  // Small derivatives are compared with a part of the largest effect.
  const double least = 1e-3 * effect_of(order.front());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const RunVariable& variable = result.variables[static_cast<std::size_t>(order[k])];
    const double found = result.gradient[order[k]], right = expected[static_cast<Eigen::Index>(k)],
                 size = std::max(std::abs(right), least / variable.size),
                 apart = std::abs(found - right);
    if (!(apart > told * size)) continue;
    std::string sentence =
        "the derivative by " + reading::in_quotes(variable.name) + " is " + compact(found, 6) +
        ", but " + compact(right, 6) + (fixed ? " with half the step" : " by the mode 'forward'") +
        ", as the motion passes corners (stops, dead bands, friction, laws), where derivatives "
        "turn; expected " +
        (fixed ? "shorter steps or a method with error control" : "that mode, or less tolerance");
    if (apart > refused * size) throw SceneError(scene.scene().where({}) + sentence);
    result.remarks.push_back(std::move(sentence));
  }
}

}  // namespace

GradientResult gradient(const SceneText& scene, const GradientRequest& request) {
  bool at_corners = false;
  GradientResult result = by_one_run(scene, request, at_corners);
  if (at_corners && result.gradient.size() > 0) check_corners(scene, request, result);
  return result;
}

}  // namespace momenta
