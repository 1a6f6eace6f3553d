#include <momenta/core/scene/bearings_refused.h>
#include <momenta/core/scene/drive.h>
#include <momenta/core/text/near_name.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/gradient/adjoint_run.h>
#include <momenta/dae/gradient/gradient.h>
#include <momenta/dae/gradient/start_adjoint.h>
#include <momenta/dae/gradient/start_tangents.h>
#include <momenta/dae/gradient/tangent_system.h>
#include <momenta/dae/solver/integrators.h>
#include <momenta/dae/study/form_runner.h>
#include <momenta/dae/study/run_form.h>
#include <momenta/dae/text/number_text.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <tuple>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_unknowns = 1000;  ///< nv + m: a dense matrix at each stage
/// A variable has no effect where dJ/dθ times its size is below this part of J.
constexpr double effect = 1e-10;

void expect_differentiable(const RunSettings& s, const Mechanism& mechanism) {
  const std::vector<std::string>& forms = differentiable_forms();
  if (std::find(forms.begin(), forms.end(), s.form) == forms.end())
    throw std::invalid_argument("form '" + s.form +
                                "' has no gradient; expected one of: " + listed(forms));
  const std::vector<std::string> methods{"rk4", "dp5", "dop853", "vern9"};
  if (std::find(methods.begin(), methods.end(), s.integrator) == methods.end())
    throw std::invalid_argument("integrator '" + s.integrator +
                                "' has no gradient; expected one of: " + listed(methods));
  if (const int unknowns = mechanism.nv() + mechanism.m(); unknowns > most_unknowns)
    throw std::invalid_argument("the mechanism has " + std::to_string(unknowns) +
                                " rates and loop equations; expected at most " +
                                std::to_string(most_unknowns) + " for a gradient");
}

/// What of the scene is not smooth everywhere.
std::vector<std::string> corners(const Scene& scene, const std::string& of_functional) {
  std::vector<std::string> remarks;
  const std::string ending =
      " has corners or jumps: the gradient is that of the pieces that the run was on, and what the "
      "time of a jump depends on is not in it";
  if (!of_functional.empty())
    remarks.push_back("'" + of_functional + "' in the functional" + ending);
  for (const DriveSpec& drive : scene.drives)
    if (const std::string corner = law_corner(drive); !corner.empty())
      remarks.push_back("the drive of " +
                        reading::in_quotes(drive.joint.empty() ? drive.loop : drive.joint) +
                        ", by '" + corner + "'," + ending);
  std::vector<std::string> names;
  for (const ParameterSpec& p : scene.parameters) names.push_back(p.name);
  for (const ForceSpec& force : scene.forces) {
    std::vector<std::string> laws{force.law};
    laws.insert(laws.end(), force.force_law.begin(), force.force_law.end());
    laws.insert(laws.end(), force.torque_law.begin(), force.torque_law.end());
    for (const std::string& law : laws)
      for (const char* word : {"if(", "floor(", "sign(", "abs(", "min(", "max("})
        if (law.find(word) != std::string::npos) {
          remarks.push_back("a force by the formula " + reading::in_quotes(law) + ending);
          break;
        }
  }
  return remarks;
}

/// Why a run has no adjoint, one sentence; empty: it has.
std::string no_adjoint(const RunSettings& s, const Mechanism& mechanism, bool trajectory) {
  const std::string instead = "; expected the mode 'forward'";
  if (s.form != "momentum") return "form '" + s.form + "' has no adjoint" + instead;
  if (mechanism.plan().quasi_velocities)
    return "spherical and free joints, whose momenta are not canonical, have no adjoint" + instead;
  if (mechanism.has_nonholonomic())
    return "loops that roll or have an equation of velocities have no adjoint" + instead;
  if (trajectory) return "an adjoint has no derivatives of the trajectory" + instead;
  return "";
}

/// A gradient under way: what forward and adjoint share.
struct Asked {
  const GradientRequest& request;
  const Mechanism& mechanism;
  const Start& start;
  OdeForm& form;
  const std::vector<OtherParameter>& others;
  const FormOptions& gains;
  StartAdjoint* start_adjoint;  ///< null: the start is differenced
  GradientResult& result;

  IntegrationOptions options() const {
    IntegrationOptions all;
    all.rtol = result.settings.rtol;
    all.atol = result.settings.atol;
    all.step = result.settings.step;
    all.max_cpu_seconds = request.max_cpu_seconds;
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
  /// What the start has that is taken at once: rows are those of y(0), or λᵀ.
  void add_start(const MatrixXd& slopes, MatrixXd& rows) {
    for (std::size_t j = 0; j < others.size(); ++j)
      if (others[j].starts_at_once)
        rows.col(static_cast<Eigen::Index>(j)) +=
            start_adjoint->by(result.variables[j], others[j], slopes);
  }
  void forward();
  void adjoint();
};

void Asked::forward() {
  const RunSettings& s = result.settings;
  Functional functional(request.of, mechanism, result.variables, others);
  MatrixXd tangents_at_start = at_start();
  if (start_adjoint) add_start(start_adjoint->rows(form.name() == "momentum"), tangents_at_start);
  for (std::string& remark : corners(mechanism.scene(), functional.corner()))
    result.remarks.push_back(std::move(remark));
  FormTangents tangents(mechanism, form, others);
  const auto directions = static_cast<int>(result.variables.size());
  TangentSystem system(form, tangents, request.integral ? &functional : nullptr, directions);
  const std::vector<double> y0 = system.initial(form.initial(start), tangents_at_start);
  IntegrationOptions integration = options();
  integration.rtol *= system.tolerance_factor();
  integration.atol *= system.tolerance_factor();
  std::vector<double> times;
  const int samples = request.trajectory ? s.samples : 1;
  for (int i = 0; i <= samples; ++i) times.push_back(s.end_time * i / samples);
  for (const Column& c : mechanism.coordinate_columns()) result.columns.push_back(c.name);
  for (const Column& c : mechanism.rate_columns()) result.columns.push_back(c.name);
  Observer observer;
  TangentSystem::Motion motion;
  std::string lost;
  if (request.trajectory)
    observer.sample = [&](double t, const double* y, const double*) {
      const Looking looking(system);
      if (!system.motion(t, y, motion)) {
        lost = system.failure();
        return false;
      }
      MatrixXd& d = result.tangents.emplace_back(motion.q.size() + motion.u.size(), directions);
      d << motion.dq, motion.du;
      result.times.push_back(t);
      return true;
    };
  if (request.progress)
    observer.step = [&](double, double t, const Interpolant&) { return request.progress(t); };
  const IntegrationResult run =
      integrate(s.integrator, system, start.t, y0, times, integration, observer);
  if (!run.done)
    throw none(!lost.empty() ? lost : system.lost().empty() ? run.reason : system.lost());
  take(run, system.singular_passages());
  if (request.integral) {
    result.value = system.integral(run.y.data());
    result.gradient = system.integral_tangents(run.y.data());
  } else {
    if (!system.motion(run.end_time, run.y.data(), motion)) throw none(system.failure());
    result.value =
        functional(run.end_time, motion.q, motion.u, motion.dq, motion.du, result.gradient);
  }
}

void Asked::adjoint() {
  const RunSettings& s = result.settings;
  FunctionalSlopes functional(request.of, mechanism, result.variables, others);
  StageAdjoint stages(mechanism, form, others);
  const MatrixXd tangents_at_start = at_start();
  for (std::string& remark : corners(mechanism.scene(), functional.corner()))
    result.remarks.push_back(std::move(remark));
  RecordedRun record(form, s.step, s.end_time, butcher_tableau(s.integrator).c);
  Observer observer;
  bool ended = false;
  observer.step = [&](double t0, double t1, const Interpolant&) {
    ended = request.progress && !request.progress(0.5 * t1);
    return !ended && record.keep(t0, t1);
  };
  const IntegrationResult run = integrate(s.integrator, record, start.t, form.initial(start),
                                          {start.t, s.end_time}, options(), observer);
  if (!run.done) throw none(record.lost().empty() ? run.reason : record.lost());
  take(run, record.singular_passages());
  if (record.redundant()) stages.by_rows();
  AdjointRun back(form, stages, functional, request.integral, s.integrator,
                  static_cast<Eigen::Index>(others.size()));
  const auto going = [&](double t) {
    return !request.progress || request.progress(s.end_time - 0.5 * t);
  };
  if (!back.back(record, run.end_time, run.y.data(), going)) throw none(back.failure());
  result.value = back.value();
  result.gradient = back.by_parameters() + tangents_at_start.transpose() * back.by_start();
  stages.finish(result.gradient);
  if (start_adjoint) {
    MatrixXd of_start = MatrixXd::Zero(1, result.gradient.size());
    add_start(start_adjoint->back(back.by_start()).transpose(), of_start);
    result.gradient += of_start.transpose();
  }
  result.products = back.products();
  result.at_once = stages.at_once();
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

GradientResult gradient(const SceneText& scene, const GradientRequest& request) {
  const Mechanism mechanism(scene.scene(), scene.options);
  GradientResult result;
  refuse_bearings(mechanism.scene(), "a gradient");
  result.scene = mechanism.scene().name;
  result.of = request.of;
  result.integral = request.integral;
  result.settings = request.settings;
  result.variables = run_variables(scene, mechanism, request.by);
  RunSettings& s = result.settings;
  s.when_stiff.clear();
  if (s.integrator.empty()) s.integrator = default_integrator(s.form, s.rtol);
  expect_differentiable(s, mechanism);
  const std::string refused = no_adjoint(s, mechanism, request.trajectory);
  if (request.mode == GradientMode::adjoint && !refused.empty())
    throw std::invalid_argument(refused);
  result.adjoint = request.mode == GradientMode::adjoint ||
                   (request.mode == GradientMode::automatic && refused.empty() &&
                    result.variables.size() > most_forward);

  const Start start = assemble(mechanism).start;
  FormRunner runner(mechanism, start, s, request.max_cpu_seconds);  // completes the settings
  auto& form = dynamic_cast<OdeForm&>(runner.form());
  FormOptions options;
  options.gauge = form.gauge();
  options.project = form.corrects_positions();
  std::tie(options.baumgarte_alpha, options.baumgarte_beta) = form.baumgarte_gains();
  options.beta = form.beta();
  // The σ that a leak begins with is λ/κ, and that of accelerations: differenced.
  std::optional<StartAdjoint> start_adjoint;
  TakenAtOnce at_once;
  const bool leaks = form.gauge().kind == Gauge::Kind::leak;
  if ((result.adjoint || !leaks) && !mechanism.scene().lagrangian &&
      !mechanism.plan().quasi_velocities && !mechanism.has_nonholonomic()) {
    start_adjoint.emplace(mechanism, start);
    at_once.slopes = &start_adjoint->numbers();
    at_once.slopes_of_start = !leaks;
    at_once.starts = !leaks && start_adjoint->follows_assembly();
    at_once.makes_all = !result.adjoint || request.of.find("energy") != std::string::npos;
    for (const Column& marker : mechanism.marker_columns())
      at_once.makes_places |= request.of.find(marker.name) != std::string::npos;
  }
  const std::vector<OtherParameter> others =
      other_parameters(scene, mechanism, result.variables, at_once);
  Asked asked{
      request, mechanism, start, form, others, options, start_adjoint ? &*start_adjoint : nullptr,
      result};
  if (result.adjoint)
    asked.adjoint();
  else
    asked.forward();
  if (!std::isfinite(result.value) || !result.gradient.allFinite())
    throw SceneError(mechanism.scene().where({}) + reading::in_quotes(request.of) +
                     " or its gradient is not a finite number; expected a formula that has a value "
                     "and derivatives along the motion");
  for (std::size_t j = 0; j < result.variables.size(); ++j) {
    const RunVariable& v = result.variables[j];
    if (std::abs(result.gradient[static_cast<Eigen::Index>(j)]) * v.size <=
        effect * std::abs(result.value))
      result.without_effect.push_back(v.name);
  }
  return result;
}

}  // namespace momenta
