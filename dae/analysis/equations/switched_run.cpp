#include <momenta/core/expression/evaluate.h>
#include <momenta/core/expression/input_times.h>
#include <momenta/core/scene/scene.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/equations/equation_system.h>
#include <momenta/dae/analysis/equations/switched_run.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/stopping.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace momenta {
namespace {

constexpr double same_time = 1e-13;  ///< part of the span
/// Largest move of values onto the constraints of a new mode, in tolerances: dense output and the
/// end of a step differ so much. Beyond it values jump.
constexpr double same_value = 1000;

/// Tells from the last step of a failed run which value or rate has no bound.
class Approach {
 public:
  /// `begun`: start time of the run.
  Approach(const EquationFile& file, double begun)
      : file_(file), begun_(begun), before_(file.variables.size()), now_(before_.size()) {}

  void step(double t0, double t1, const Interpolant& between) {
    t0_ = t0, t1_ = t1;
    between(t0, before_.data());
    between(t1, now_.data());
  }
  /// "; x leaves every bound near t = 1"; empty where nothing does.
  std::string in_words(const EquationStart& start, double rtol) const {
    constexpr double without_bound = 1e5;
    // Errors of the run move the pole, by about a hundred tolerances.
    const int digits = std::clamp(static_cast<int>(-std::log10(rtol)) - 2, 1, 6);
    for (const bool of_rate : {false, true})
      for (std::size_t j = 0; j < now_.size(); ++j) {
        const bool smooth = start.index_of[j] == 1, moves = start.appears[j] != 0;
        if (!(of_rate ? moves && smooth : moves || smooth) || !(t1_ > t0_)) continue;
        const double size = std::abs(now_[j]), scale = file_.scales[j] + std::abs(file_.values[j]);
        const double growth = std::abs(now_[j] - before_[j]) / (t1_ - t0_) * (t1_ - begun_);
        if (of_rate ? growth < without_bound * (size + scale)
                    : size < without_bound * scale || growth < without_bound * size)
          continue;
        return std::string("; ") + (of_rate ? "the rate of " : "") + file_.variables[j] +
               " leaves every bound near t = " + compact(t1_, digits);
      }
    return "";
  }

 private:
  const EquationFile& file_;
  double begun_;
  std::vector<double> before_, now_;
  double t0_ = 0, t1_ = 0;
};

}  // namespace

void integrate_piece(const EquationFile& file, const EquationStart& start,
                     const EquationRunRequest& request,
                     const std::function<bool(double, double, const Interpolant&)>& watch,
                     double spent_s, EquationRun& run) {
  EquationSystem system(file, start, request.atol);
  IntegrationOptions options;
  options.rtol = request.rtol;
  options.atol = request.atol;
  options.step = request.step;
  options.max_cpu_seconds = request.max_cpu_seconds;
  options.spent_cpu_seconds = spent_s;
  InputTimes inputs(file.start, request.end);
  for (const EquationFile::Equation& equation : file.equations)
    inputs.add(equation.formula, 0, [&](int i) {
      const int parameter = i - 1 - 2 * file.size();
      return parameter < 0 ? std::nullopt
                           : std::optional(file.parameters[static_cast<std::size_t>(parameter)]);
    });
  options.stops = inputs.all();
  std::vector<double> times;
  for (int k = static_cast<int>(run.t.size()); k <= request.samples; ++k)
    times.push_back(run.output_time(k, request.samples));
  Observer observer;
  observer.sample = [&](double t, const double* y, const double*) {
    run.t.push_back(t);
    run.y.emplace_back(y, y + file.size());
    return true;
  };
  bool interrupted = false;
  Approach approach(file, run.start);
  observer.step = [&](double t0, double t1, const Interpolant& between) {
    approach.step(t0, t1, between);
    interrupted = request.going_on && !request.going_on(t1);
    return !interrupted && (!watch || watch(t0, t1, between));
  };
  IntegrationResult result =
      integrate(request.integrator, system, file.start, times, options, observer);
  run.done = result.done;
  run.reason = interrupted   ? "interrupted"
               : result.done ? result.reason
                             : result.reason + approach.in_words(start, request.rtol);
  run.stopped_at = result.end_time;
  run.counters += result.counters;
  run.linear_solver = result.linear_solver;
  run.last = std::move(result.y);
}

SwitchedRun::SwitchedRun(const EquationFile& file, const EquationRunRequest& request)
    : file_(file),
      request_(request),
      switches_(static_cast<int>(file.arguments())),
      held_(file),
      tolerance_(same_time * (request.end - file.start)),
      y_(file.variables.size()) {
  for (int i = 0; i < file.size(); ++i) {
    Expression& formula = held_.equations[static_cast<std::size_t>(i)].formula;
    formula = switches_.held(formula);
    equation_of_.resize(switches_.size(), i);
  }
  std::size_t longest = 0;
  for (std::size_t k = 0; k < switches_.size(); ++k) {
    longest = std::max(longest, switches_.argument(k).tape().size());
    for (const int v : switches_.argument(k).variables())
      of_rates_ |= v > file.size() && v <= 2 * file.size();
  }
  held_.parameters.resize(file.parameters.size() + switches_.size());
  held_.held.assign(held_.held.size(), 0);
  x_.resize(held_.arguments());
  line_.resize(longest);
  crossings_.assign(switches_.size(), Crossings(tolerance_));
}

double SwitchedRun::argument(std::size_t k, double t, const double* y) {
  x_[0] = t;
  std::copy_n(y, y_.size(), x_.begin() + 1);
  std::copy(held_.parameters.begin(), held_.parameters.end(),
            x_.end() - static_cast<std::ptrdiff_t>(held_.parameters.size()));
  double value;
  evaluate(switches_.argument(k), x_.data(), line_.data(), &value);
  return value;
}

bool SwitchedRun::run(const EquationStart& first, EquationRun& run) {
  if (switches_.size() == 0 || of_rates_) return false;
  const double begun = thread_seconds();
  const auto spent = [&] { return thread_seconds() - begun; };
  EquationStart start = first;
  held_.values.assign(start.point.y.begin(), start.point.y.end());
  held_.rates.assign(start.point.ydot.begin(), start.point.ydot.end());
  for (std::size_t k = 0; k < switches_.size(); ++k)
    mode(k) = switches_.mode(k, argument(k, held_.start, held_.values.data()));
  Turns last{-std::numeric_limits<double>::infinity(), {}, {}};
  while (piece(start, spent(), run)) {
    const bool at_once = turns_.t <= last.t + 10 * tolerance_;
    if (!at_once) last = {turns_.t, {}, {}};
    const auto turned_before = [&](std::size_t k) {
      return std::find(last.which.begin(), last.which.end(), k) != last.which.end();
    };
    const bool back = std::any_of(turns_.which.begin(), turns_.which.end(), turned_before);
    last.which.insert(last.which.end(), turns_.which.begin(), turns_.which.end());
    run.switchings += turns_.t > run.start;
    held_.start = turns_.t;
    if (back) {
      if (!as_written(spent(), run))
        return stop(turns_.t,
                    "no consistent start where " + in_words(turns_.which.front()) + " turns", run);
      if (!run.done && run.reason != "interrupted")
        run.reason += "; from t = " + compact(turns_.t, 6) + " on " +
                      in_words(turns_.which.front()) +
                      " turns back and forth: expected a law without jumps there";
      return true;
    }
    for (std::size_t i = 0; i < turns_.which.size(); ++i) mode(turns_.which[i]) = turns_.modes[i];
    bool jumps = false;
    const std::string why = begin_anew(start, jumps);
    if (!why.empty()) return (!jumps && as_written(spent(), run)) || stop(turns_.t, why, run);
  }
  if (run.done || run.reason == "interrupted" || run.reason.rfind("time limit", 0) == 0)
    return true;
  const EquationRun stopped = run;
  held_.start = run.stopped_at;
  held_.values = run.last;
  if (!as_written(spent(), run) || (!run.done && run.stopped_at <= stopped.stopped_at + tolerance_))
    run = stopped;
  return true;
}

bool SwitchedRun::stop(double t, const std::string& why, EquationRun& run) {
  run.done = false;
  run.reason = stop_sentence(request_.integrator, t, why);
  run.stopped_at = t;
  run.last = held_.values;
  return true;
}

bool SwitchedRun::as_written(double spent_s, EquationRun& run) {
  EquationFile written = file_;
  written.start = held_.start;
  written.values = held_.values;
  written.rates = held_.rates;
  written.held = held_.held;
  try {
    const EquationStart start = equation_start(written);
    if (!start.point.why.empty() || start.point.found.index > most_index() || jumping(start) >= 0)
      return false;
    integrate_piece(written, start, request_, {}, spent_s, run);
  } catch (const SceneError&) {
    return false;
  }
  return true;
}

bool SwitchedRun::piece(const EquationStart& start, double spent_s, EquationRun& run) {
  for (Crossings& c : crossings_) c.restart();
  turns_.which.clear();
  if (request_.max_cpu_seconds > 0 && spent_s > request_.max_cpu_seconds) {
    run.done = false;
    run.reason = time_limit_sentence(request_.integrator, request_.max_cpu_seconds, held_.start);
    return false;
  }
  integrate_piece(
      held_, start, request_,
      [&](double t0, double t1, const Interpolant& between) {
        find_turns(t0, t1, between);
        if (turns_.which.empty()) return true;
        while (run.output_time(static_cast<int>(run.t.size()), request_.samples) <= turns_.t) {
          run.t.push_back(run.output_time(static_cast<int>(run.t.size()), request_.samples));
          between(run.t.back(), run.y.emplace_back(y_.size()).data());
        }
        if (turns_.t > held_.start) between(turns_.t, held_.values.data());
        return false;
      },
      spent_s, run);
  return !turns_.which.empty();
}

void SwitchedRun::find_turns(double t0, double t1, const Interpolant& between) {
  turns_ = {t1, {}, {}};
  std::array<std::vector<double>, Crossings::points> states;
  for (std::size_t i = 0; i < states.size(); ++i) {
    states[i].resize(y_.size());
    between(Crossings::point(t0, t1, i), states[i].data());
  }
  std::vector<Crossing> found;
  for (std::size_t k = 0; k < switches_.size(); ++k) {
    Crossings::Values values;
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = margin(k, Crossings::point(t0, t1, i), states[i].data());
    const auto at = [&](double t) {
      between(t, y_.data());
      return margin(k, t, y_.data());
    };
    found.clear();
    crossings_[k].step(t0, t1, values, at, found);
    double t = std::numeric_limits<double>::infinity(), taken = 0;
    for (const Crossing& c : found)
      if (!c.up) t = std::min(t, c.t);
    if (found.empty() && values.back() < 0) {
      // A mode that is wrong without a crossing was so from where the margin was zero.
      t = t0 == held_.start ? t0 : t1;
      taken = switches_.mode(k, argument(k, t1, states.back().data()));
    } else if (t <= t1) {
      between(t, y_.data());
      taken = switches_.turned(k, mode(k), argument(k, t, y_.data()));
    }
    if (t > turns_.t + tolerance_) continue;
    if (t < turns_.t - tolerance_) turns_ = {t, {}, {}};
    turns_.which.push_back(k);
    turns_.modes.push_back(taken);
  }
  if (turns_.t >= request_.end - 10 * tolerance_) turns_.which.clear();
}

std::string SwitchedRun::begin_anew(EquationStart& start, bool& jumps) {
  const std::string where = in_words(turns_.which.front());
  try {
    start = equation_start(held_);
  } catch (const SceneError& e) {
    return e.what();
  }
  if (!start.point.why.empty())
    return "no consistent start where " + where + " turns: " + start.point.why;
  if (start.point.found.index > most_index())
    return "where " + where + " turns the index becomes " +
           std::to_string(start.point.found.index) + ", expected up to " +
           std::to_string(most_index());
  if (const int j = jumping(start); j >= 0) {
    jumps = true;
    const auto at = static_cast<std::size_t>(j);
    return where + " makes " + held_.variables[at] + " jump from " + compact(held_.values[at], 6) +
           " to " + compact(start.point.y[j], 6) +
           ", where its rate has no value; expected no jump in what ties variables that have rates";
  }
  held_.values.assign(start.point.y.begin(), start.point.y.end());
  held_.rates.assign(start.point.ydot.begin(), start.point.ydot.end());
  return "";
}

int SwitchedRun::jumping(const EquationStart& start) const {
  for (int j = 0; j < held_.size(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    const double from = held_.values[at];
    if (start.appears[at] && start.index_of[at] == 1 &&
        std::abs(start.point.y[j] - from) >
            same_value * (request_.rtol * std::abs(from) + request_.atol * held_.scales[at]))
      return j;
  }
  return -1;
}

std::string SwitchedRun::in_words(std::size_t k) const {
  return reading::in_quotes(switches_.name(k)) + " of " + file_.name_of(equation_of_[k]) + ",";
}

}  // namespace momenta
