#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/study/section_study.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace momenta {
namespace {

/// Place of a coordinate in q, or of a rate in u.
struct Place {
  bool rate = false;
  Eigen::Index at = 0;
};
Place place_of(const Mechanism& mechanism, const std::string& name, bool rates_alone) {
  std::vector<std::string> known;
  for (const bool rate : {false, true}) {
    if (!rate && rates_alone) continue;
    const std::vector<Column> columns =
        rate ? mechanism.rate_columns() : mechanism.coordinate_columns();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].name == name) return {rate, static_cast<Eigen::Index>(i)};
      known.push_back(columns[i].name);
    }
  }
  const std::vector<std::string_view> views(known.begin(), known.end());
  throw std::invalid_argument(reading::in_quotes(name) +
                              (rates_alone ? " is no rate" : " is no coordinate and no rate") +
                              " of the scene, expected one of: " + reading::listed(views));
}

/// Starts of one energy.
class Starts {
 public:
  Starts(const Mechanism& mechanism, const SectionRequest& request)
      : mechanism_(mechanism), e_(mechanism.evaluation<double>()), own_(assemble(mechanism).start) {
    if (!request.varied.empty()) varied_ = place_of(mechanism, request.varied, false);
    leads_ = !request.led.empty();
    if (leads_) led_ = place_of(mechanism, request.led, true).at;
    wanted_ = energy(own_);
  }

  const Start& own() const { return own_; }
  double energy(const Start& s) const {
    e_->place(s.t, s.q.data());
    e_->move(s.u.data());
    return e_->kinetic() + e_->potential(s.q.data());
  }
  /// Start with the value; `left_out`: why there is none.
  Start with(double value, std::string& left_out) const {
    Eigen::VectorXd q = own_.q, u = own_.u;
    (varied_.rate ? u : q)[varied_.at] = value;
    if (!leads_) return assemble(mechanism_, own_.t, q, u).start;
    const auto at = [&](double rate) {
      u[led_] = rate;
      return energy(assemble(mechanism_, own_.t, q, u, Assembled::rates).start);
    };
    const double low = at(-1), c = at(0), high = at(1);
    const double a = 0.5 * (low + high) - c, b = 0.5 * (high - low);
    const double root = b * b - 4 * a * (c - wanted_);
    if (!(a > 0) || !(root >= 0)) {
      left_out = "no rate there has the energy of the scene's start, " + compact(wanted_, 6) + " J";
      return own_;
    }
    const double sign = own_.u[led_] < 0 ? -1 : 1,
                 half = -0.5 * (b + (b < 0 ? -1 : 1) * std::sqrt(root));
    const double one = half / a, other = half == 0 ? one : (c - wanted_) / half;
    u[led_] = sign > 0 ? std::max(one, other) : std::min(one, other);
    return assemble(mechanism_, own_.t, q, u).start;
  }

 private:
  const Mechanism& mechanism_;
  std::unique_ptr<Evaluation<double>> e_;
  Start own_;
  Place varied_;
  bool leads_ = false;
  Eigen::Index led_ = 0;
  double wanted_ = 0;
};

}  // namespace

std::vector<SectionOrbit> section(const Mechanism& mechanism, const SectionRequest& request) {
  if (mechanism.scene().events.size() != 1)
    throw std::invalid_argument("a section is of one event, found " +
                                std::to_string(mechanism.scene().events.size()));
  const Starts starts(mechanism, request);
  std::vector<SectionOrbit> orbits;
  const std::size_t count = request.varied.empty() ? 1 : request.values.size();
  for (std::size_t k = 0; k < count; ++k) {
    SectionOrbit orbit;
    Start start = starts.own();
    if (!request.varied.empty()) {
      orbit.value = request.values[k];
      start = starts.with(orbit.value, orbit.left_out);
    }
    orbit.energy = starts.energy(start);
    if (orbit.left_out.empty()) {
      RunRequest run;
      run.settings = request.settings;
      run.settings.samples = 100;  // for energy and drift; no point is one of them
      run.keep_trajectory = run.events = true;
      run.max_cpu_seconds = request.max_cpu_seconds;
      if (request.progress) {
        run.progress = [&](double) { return request.progress(k); };
        run.going_on = [&] { return request.progress(k); };
      }
      orbit.run = run_form(mechanism, start, run);
    }
    orbits.push_back(std::move(orbit));
    if (request.progress && !request.progress(k)) break;
  }
  return orbits;
}

}  // namespace momenta
