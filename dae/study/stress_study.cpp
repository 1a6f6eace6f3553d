#include <momenta/core/open_chain/parallel_for.h>
#include <momenta/core/scene/validate.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stopping.h>
#include <momenta/dae/study/environment.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/run_record.h>
#include <momenta/dae/study/stress_study.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <mutex>
#include <stdexcept>

namespace momenta {
namespace {

constexpr int reference_rows = 50;

std::string digits(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// "1e6": ladders are read by their exponents.
std::string power_of_ten(double x) {
  const int exponent = static_cast<int>(std::lround(std::log10(x)));
  return std::abs(exponent) > 2 && std::abs(std::pow(10.0, exponent) / x - 1) < 1e-9
             ? "1e" + std::to_string(exponent)
             : digits(x);
}

/// A rung made ready, for all contestants.
struct Ground {
  std::unique_ptr<Mechanism> mechanism;
  std::unique_ptr<Start> start;
  std::unique_ptr<IntegratedScene> integrated;
  std::unique_ptr<Reference> reference;
  double accuracy = not_measured;
  double length = 1, mass = 1;
  std::string refused;
};

Ground prepare(const Rung& rung, const std::string& name, const StressRequest& request,
               const std::function<bool()>& going_on) {
  Ground g;
  try {
    validate(rung.scene);
    g.mechanism = std::make_unique<Mechanism>(rung.scene, rung.options);
    g.start = std::make_unique<Start>(assemble(*g.mechanism).start);
    g.integrated = std::make_unique<IntegratedScene>(*g.mechanism, *g.start);
  } catch (const SceneError& e) {
    g.refused = e.what();
    return g;
  }
  g.length = length_of(rung.scene);
  g.mass = 0;
  for (const BodySpec& b : rung.scene.bodies) g.mass += b.mass;
  if (!(request.reference_cpu_limit > 0)) return g;
  const std::string key = "reference " + name;
  auto own = recall<OwnReference>(request.journal, key);
  if (!own) {
    own.emplace().accuracy = not_measured;  // too long, or no such solution: judged without
    const double from = thread_seconds();
    try {
      own = own_reference(
          *g.mechanism, *g.start, rung.scene.run.end_time, reference_rows, [&](double) {
            return thread_seconds() - from < request.reference_cpu_limit && going_on();
          });
    } catch (const std::runtime_error&) {
    }
    if (request.journal && going_on()) request.journal->add(key, record_of(*own));
  }
  // A reference whose two tolerances disagree is not used.
  if (own->accuracy < 1e-3 * request.bound) {
    own->reference.bind(trajectory_columns(*g.mechanism));
    g.accuracy = own->accuracy;
    g.reference = std::make_unique<Reference>(std::move(own->reference));
  }
  return g;
}

/// Settings as the theory of a form recommends: a one-step method resets the gauge and corrects
/// positions, a multistep one leaks, or shifts what it remembers.
RunSettings settings_of(const Contestant& c, const Mechanism& mechanism, double rtol) {
  const RunDefaults& defaults = mechanism.scene().run;
  const bool dae = is_dae_form(c.form), loops = mechanism.m() > 0;
  const Integrator& method = integrator(c.integrator);
  RunSettings s;
  s.form = c.form;
  s.integrator = c.integrator;
  const std::string leak = defaults.leak ? Gauge{Gauge::Kind::leak, *defaults.leak}.text() : "leak";
  if (takes_gauge(c.form) && loops)
    s.gauge = (dae || method.multistep) && !method.resets ? leak : "reset";
  s.project = !dae && loops && method.projects && c.form == "momentum";
  s.rtol = s.atol = rtol;
  if (method.step == Integrator::Step::fixed)
    s.step = defaults.step.value_or(defaults.end_time / 5000);
  s.end_time = defaults.end_time;
  s.samples = std::min(defaults.samples, 200);
  return s;
}

/// Time at which a series first passes a limit [s].
double first_beyond(const Series& s, const std::vector<double>& values, double limit) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(values[i]) > limit) return s.t[i];
  return not_measured;
}

void judge(StressRun& r, const Ground& ground, double bound, double cpu_limit) {
  const RunResult& run = r.run;
  // Where nothing moves, rounding is no failure: a millionth of its length over the run is rest.
  const double rest = 1e-6 * ground.length / run.settings.end_time;
  const double energy_scale = std::max(run.energy_scale, 0.5 * ground.mass * rest * rest);
  const double speed = std::sqrt(2 * run.kinetic_energy_max / ground.mass);
  const bool lengths = run.drift_unit != "rad";
  r.position_drift = run.position_drift_max / (lengths ? ground.length : 1);
  r.velocity_drift = run.velocity_drift_max / speed * (lengths ? 1 : ground.length);
  r.angle_drift = run.angle_drift_max;
  r.angle_rate_drift = run.angle_rate_drift_max / speed * ground.length;
  r.energy = run.energy_error_max / energy_scale;
  r.error = run.position_error_max;
  if (run.status == "time limit") {
    r.verdict = Verdict::slow;
    r.at = run.stopped_at;
    r.cause = "reached t = " + digits(run.stopped_at) + " s of " + digits(run.settings.end_time) +
              " s in " + digits(cpu_limit) + " s of processor time, " +
              std::to_string(run.counters.steps) + " steps";
    return;
  }
  // An error before the stop is the cause.
  struct Measure {
    const std::vector<double>& values;
    double scale;
    const char *what, *unit;
  };
  const Series& s = run.series;
  double earliest = std::numeric_limits<double>::infinity();
  for (const Measure& m :
       {Measure{s.position_error, 1, "error against the reference ", ""},
        Measure{s.position_drift, lengths ? ground.length : 1, "loops open by ",
                lengths ? " of its length" : " rad"},
        Measure{s.angle_drift, 1, "axes of loops apart by ", " rad"},
        Measure{s.energy_error, energy_scale, "energy off by ", " of what is exchanged"}}) {
    const double at = first_beyond(s, m.values, bound * m.scale);
    if (!(at < earliest)) continue;
    earliest = at;
    double largest = 0;
    for (double x : m.values) largest = std::max(largest, std::isnan(x) ? 0 : std::abs(x));
    r.verdict = Verdict::wrong;
    r.at = at;
    r.cause = m.what + digits(largest / m.scale) + m.unit +
              " at the most, beyond the bound from t = " + digits(at) + " s";
  }
  for (const RunResult::SingularCrossing& crossing : run.singular_crossings)
    if (r.verdict == Verdict::wrong && crossing.ambiguous && crossing.t <= r.at) {
      r.verdict = Verdict::stopped;  // the run reported the crossing
      r.at = crossing.t;
      r.cause = ambiguous_from(crossing.t);
    }
  if (r.verdict != Verdict::untried) return;
  if (run.status != "done") {
    r.verdict = Verdict::stopped;
    r.at = run.stopped_at;
    r.cause = run.reason;
    return;
  }
  r.verdict = Verdict::survived;
}

bool competes(const Contestant& c, const Mechanism& mechanism) {
  // Without loops all forms are one of two ODEs.
  return mechanism.m() > 0 || c.form == "momentum" || c.form == "acceleration";
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::survived:
      return "survived";
    case Verdict::wrong:
      return "wrong";
    case Verdict::stopped:
      return "stopped";
    case Verdict::slow:
      return "slow";
    case Verdict::untried:
      return "untried";
  }
  return "";
}

Ladder ladder_of(const Scene& scene, Extreme extreme, const std::vector<double>& factors) {
  Ladder ladder{std::string(name_of(extreme)), {}, true};
  for (const double f : factors)
    ladder.rungs.push_back({"×" + power_of_ten(f), driven_to(scene, extreme, f), {}});
  return ladder;
}

StressResult run_stress_study(const StressRequest& request) {
  StressResult result;
  result.bound = request.bound;
  result.cpu_limit = request.cpu_limit;
  result.rtol = request.rtol;
  for (Contestant c : request.contestants) {
    if (c.integrator.empty()) c.integrator = default_integrator(c.form, request.rtol);
    const Integrator& method = integrator(c.integrator);
    const bool dae = is_dae_form(c.form);
    if (!method.takes_form(c.form, dae) || (method.multistep && needs_one_step_method(c.form)))
      throw std::invalid_argument("form '" + c.form + "' does not run on '" + c.integrator +
                                  "', expected another integrator");
    result.contestants.push_back(std::move(c));
  }
  const std::size_t contestants = result.contestants.size();

  std::mutex turn;
  int finished = 0, total = 0;
  std::atomic<bool> going{true};
  const auto tell = [&](const std::string& what, int steps) {
    const std::lock_guard lock(turn);
    if (request.progress && going) going = request.progress(finished, total, what);
    finished += steps;
    return going.load();
  };

  struct Place {
    std::size_t ladder, rung;
  };
  std::vector<Place> places;
  std::vector<std::vector<Ground>> grounds;
  for (std::size_t i = 0; i < request.ladders.size(); ++i) {
    const Ladder& ladder = request.ladders[i];
    LadderResult row;
    row.name = ladder.name;
    row.rising = ladder.rising;
    row.runs.resize(contestants);
    for (std::size_t k = 0; k < ladder.rungs.size(); ++k) {
      row.rungs.push_back(ladder.rungs[k].label);
      row.end_time.push_back(ladder.rungs[k].scene.run.end_time);
      places.push_back({i, k});
    }
    row.refused.resize(ladder.rungs.size());
    row.reference.resize(ladder.rungs.size(), not_measured);
    grounds.emplace_back(ladder.rungs.size());
    result.ladders.push_back(std::move(row));
  }
  total = static_cast<int>(places.size() * (1 + contestants));

  parallel_for(request.threads, places.size(), [&](std::size_t i) {
    const auto [l, k] = places[i];
    const Rung& rung = request.ladders[l].rungs[k];
    const std::string name = request.ladders[l].name + " " + rung.label;
    if (!tell(name + ": reference", 1)) return;
    Ground& g = grounds[l][k] = prepare(rung, name, request, [&] { return going.load(); });
    result.ladders[l].refused[k] = g.refused;
    result.ladders[l].reference[k] = g.accuracy;
  });

  parallel_for(request.threads, result.ladders.size() * contestants, [&](std::size_t i) {
    const std::size_t l = i / contestants, c = i % contestants;
    const Contestant& contestant = result.contestants[c];
    std::vector<StressRun>& climb = result.ladders[l].runs[c];
    const int rungs = static_cast<int>(grounds[l].size());
    int k = 0;
    for (; k < rungs; ++k) {
      const Ground& g = grounds[l][static_cast<std::size_t>(k)];
      if (!g.refused.empty() || !g.mechanism) continue;
      if (!competes(contestant, *g.mechanism)) continue;
      const std::string name =
          result.ladders[l].name + " " + result.ladders[l].rungs[static_cast<std::size_t>(k)];
      if (!tell(name + ": " + contestant.form + " " + contestant.integrator, 1)) return;
      RunRequest run;
      run.settings = settings_of(contestant, *g.mechanism, request.rtol);
      run.reference = g.reference.get();
      run.integrated = g.integrated.get();
      run.max_cpu_seconds = request.cpu_limit;
      run.progress = [&](double) { return going.load(); };
      const std::string key = name + key_of(run.settings);
      auto r = recall<StressRun>(request.journal, key);
      if (!r) {
        r.emplace().run = run_form(*g.mechanism, *g.start, run);
        if (!going) return;
        judge(*r, g, request.bound, request.cpu_limit);
        r->run.series = {};
        if (request.journal) request.journal->add(key, record_of(*r));
      }
      r->contestant = contestant;
      r->rung = k;
      climb.push_back(*std::move(r));
      if (request.ladders[l].rising && climb.back().verdict != Verdict::survived) break;
    }
    const std::lock_guard lock(turn);
    finished += std::max(0, rungs - k - 1);
  });
  result.complete = going;
  result.environment = environment();
  return result;
}

}  // namespace momenta
