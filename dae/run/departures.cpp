#include <momenta/core/text/number_text.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/departures.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace momenta {

namespace {

constexpr double tolerances = 10;  // how many may add up in an energy of the state
constexpr double way_at_rest = 1e-3;

}  // namespace

Departures::Departures(const Mechanism& mechanism, const RunSettings& settings, double span)
    : mechanism_(mechanism), of_state_(tolerances * std::max(settings.rtol, settings.atol)) {
  const Scene& scene = mechanism.scene();
  const double length = length_of(scene);
  double mass = 0;
  for (const BodySpec& body : scene.bodies) mass += body.mass;
  still_ = way_at_rest / span;
  at_rest_ = mass * length * (of_state_ * scene.gravity.norm() + length * still_ * still_);
}

void Departures::look_at_energy(double t, double in_state, double exchanged, double flow,
                                double off) {
  largest_energy_ = std::max(largest_energy_, in_state);
  exchanged_ = std::fmax(exchanged_, exchanged);
  turned_over_ = exchanged_ + flow;
  const double scale = std::max(turned_over_, floor());
  beyond_told_.look(t, off > energy.told * scale);
  beyond_apart_.look(t, off > energy.apart * scale);
}

void Departures::look_at_rates(double t, double opening, Eigen::Index row, double fastest) {
  fastest_ = std::max(fastest_, fastest);
  if (opening <= opening_) return;
  opening_ = opening;
  row_ = row;
  at_ = t;
}

void Departures::judge(RunResult& run) const {
  if (!finished(run)) return;
  judge_energy(run);
  if (finished(run) && mechanism_.m() > 0) judge_rates(run);
}

void Departures::judge_energy(RunResult& run) const {
  constexpr std::size_t enough = 20;  // samples, for the largest exchange of a tree
  if (mechanism_.m() == 0 && run.series.t.size() < enough) return;
  const bool at_rest = mechanism_.m() > 0 && fastest_ <= still_;
  const double scale =
                   std::max({turned_over_, floor(), at_rest ? way_at_rest * largest_energy_ : 0}),
               off = run.energy_error_max;
  if (!(off > energy.told * scale)) return;
  const bool apart = off > energy.apart * scale;
  const double from = (apart ? beyond_apart_ : beyond_told_).from;
  const std::string sentence =
      "from t = " + compact(from, 6) + " s on the balance of energy is off by more than " +
      (apart ? "a quarter" : "a twentieth") + " of the " + compact(scale, 3) +
      " J turned over, by " + compact(off, 3) + " J at the most";
  if (!apart) {
    run.departure = sentence;
    return;
  }
  run.status = "came apart";
  run.reason = sentence;
  run.stopped_at = from;
}

void Departures::judge_rates(RunResult& run) const {
  const double share = opening_ / std::max(fastest_, still_);
  if (!(share > rates.told)) return;
  const std::string sentence = "at t = " + compact(at_, 6) + " s " + loop_word(mechanism_) + " '" +
                               mechanism_.rows()[static_cast<std::size_t>(row_)].loop +
                               "' opens at " + compact(share, 2) +
                               " of the rate of the fastest joint, where it ought to stay closed";
  if (share > rates.apart) {
    run.status = "came apart";
    run.reason = sentence;
    run.stopped_at = at_;
  } else if (run.departure.empty()) {
    run.departure = sentence;
  }
}

Ambiguity ambiguity_of(const std::vector<RunResult>& runs) {
  constexpr double another = 0.1;  // pose; no tolerance leaves as much where there is one motion
  double tightest = std::numeric_limits<double>::infinity();
  for (const RunResult& run : runs)
    if (!(run.settings.step > 0)) tightest = std::min(tightest, run.settings.rtol);
  Ambiguity found;
  const RunResult* first = nullptr;
  for (const RunResult& run : runs) {
    const bool rung = run.settings.step > 0 ? std::isinf(tightest) : run.settings.rtol == tightest;
    if (!rung || !reliable(run) || run.status != "done" || run.last_pose.empty()) continue;
    for (const auto& crossing : run.singular_crossings)
      found.from = std::fmin(found.from, crossing.t);
    if (first == nullptr) first = &run;
    for (std::size_t i = 0; i < std::min(run.last_pose.size(), first->last_pose.size()); ++i)
      found.apart = std::max(found.apart, std::abs(run.last_pose[i] - first->last_pose[i]));
  }
  found.differ = !std::isnan(found.from) && found.apart > another;
  return found;
}

std::string in_words(const Ambiguity& ambiguity) {
  return "the motion is ambiguous from t = " + compact(ambiguity.from, 4) +
         " s: past the singular pose there runs ended on different branches, in poses " +
         compact(ambiguity.apart, 2) +
         " rad or lengths of the scene apart, and none is compared with another";
}

}  // namespace momenta
