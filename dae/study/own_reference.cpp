#include <momenta/core/scene/formula.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/integrator/extrapolation.h>
#include <momenta/dae/integrator/integrators.h>
#include <momenta/dae/integrator/radau_collocation.h>
#include <momenta/dae/run/force_columns.h>
#include <momenta/dae/run/integrated_work.h>
#include <momenta/dae/run/measure/drive_power.h>
#include <momenta/dae/run/rank_at_start.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/study/own_reference.h>
#include <momenta/dae/study/quad_motion.h>
#include <momenta/dae/topology/cut/integrated_scene.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace momenta {

namespace {

using Rows = std::vector<std::vector<double>>;

constexpr double tight = 1e-22, loose = 1e-18;
/// Tolerances if drives or formulas take t, a double whose rounding is the limit.
constexpr double tight_in_time = 1e-14, loose_in_time = 1e-12;
/// Tolerances of stiff motions, whose estimates are far above their errors.
constexpr double tight_implicit = 1e-17, loose_implicit = 1e-14;
constexpr double shortest = 1e-9;  ///< step, part of the interval

[[noreturn]] void give_up(double t, const std::string& why) {
  char text[48];
  std::snprintf(text, sizeof text, "%.6g", t);
  throw std::runtime_error("the reference in quadruple precision ends at t = " + std::string(text) +
                           " s: " + why);
}

/// Whether t stands in the equations by itself.
bool takes_time(const Mechanism& mechanism) {
  if (mechanism.plan().drives) return true;
  const Scene& scene = mechanism.scene();
  if (scene.lagrangian) return false;  // its plan says so
  const FormulaReader reader(scene);
  const auto takes_it = [](const Formula& formula) {
    return std::any_of(formula.signals.begin(), formula.signals.end(),
                       [](const Signal& s) { return s.kind == Signal::Kind::time; });
  };
  bool takes = false;
  for (const ForceSpec& force : scene.forces) {
    const std::vector<OwnName> own = reader.own_names(force);
    each_formula(force, [&](const std::string&, const std::string& text) {
      takes = takes || takes_it(reader.read(text, own));
    });
  }
  for (const LoopSpec& loop : scene.loops)
    takes = takes || (has_equation(loop) && takes_it(reader.read(loop.equation)));
  return takes;
}

/// Whether stability limits an explicit method at a usual tolerance.
bool is_stiff(const Mechanism& mechanism, const Start& start, double end,
              const std::function<bool(double)>& going_on) {
  FormOptions options;
  options.gauge = parse_gauge("leak");
  const auto form = make_form("momentum", mechanism, options, start);
  IntegrationOptions run;
  run.rtol = run.atol = 1e-8;
  run.until_stiff = true;
  Observer observer;
  if (going_on) observer.step = [&](double, double t, const Interpolant&) { return going_on(t); };
  const auto y0 = form->initial(start);
  return !std::isnan(
      integrate("dop853", *form->ode(), start.t, y0, {end}, run, observer).stiff_from);
}

/// `count` quads as doubles.
Eigen::VectorXd rounded(const Quad* x, Eigen::Index count) {
  Eigen::VectorXd values(count);
  for (Eigen::Index i = 0; i < count; ++i) values[i] = value_of(x[i]);
  return values;
}

/// q, u, λ and the first `impulses` of ∫λ dt at t = 0, end / count, …: as long a step of `method`
/// as converges, never across an output. `forces` (may be null) takes each state.
template <class Method>
Rows solve(const Mechanism& mechanism, const Start& start, double end, int count, double tolerance,
           Method&& method, std::size_t impulses, OwnReferenceForces* forces,
           const std::function<bool(double)>& going_on) {
  const auto motion = make_quad_motion(mechanism);
  const auto size = static_cast<std::size_t>(mechanism.nq() + mechanism.nv());
  std::vector<Quad> y(start.q.begin(), start.q.end());
  y.insert(y.end(), start.u.begin(), start.u.end());
  y.resize(size + impulses, Quad(0));
  Rows rows;
  std::vector<Quad> rates(size);
  const auto keep = [&](double t) {
    if (!motion->rates(t, y.data(), rates.data())) give_up(t, "a joint has no inertia");
    const Eigen::VectorXd q = rounded(y.data(), mechanism.nq()),
                          u = rounded(y.data() + q.size(), mechanism.nv()),
                          udot = rounded(rates.data() + q.size(), mechanism.nv()),
                          lambda = rounded(motion->multipliers(), mechanism.m()),
                          sums = rounded(y.data() + size, static_cast<Eigen::Index>(impulses));
    std::vector<double>& row = rows.emplace_back();
    for (const Eigen::VectorXd& part : {q, u, lambda, sums})
      row.insert(row.end(), part.begin(), part.end());
    if (forces) forces->add(t, q, u, udot, lambda);
  };
  const double interval = end / count;
  double t = start.t, h = interval;
  if (!motion->project(t, y.data())) give_up(t, "a joint has no inertia");
  keep(t);
  for (int i = 1; i <= count; ++i) {
    const double next = i == count ? end : interval * i;
    while (t < next) {
      const bool reaches = t + h >= next * (1 - 1e-14);
      const double step = reaches ? next - t : h;
      if (method.step(t, step, y, tolerance, [&](double at, const Quad* x, Quad* rate) {
            if (!motion->rates(at, x, rate)) return false;
            std::copy_n(motion->multipliers(), impulses, rate + size);
            return true;
          })) {
        t = reaches ? next : t + step;
        if (!motion->project(t, y.data())) give_up(t, "the projection failed");
        h = std::min(2 * step, interval);
      } else {
        h = step / 2;
        if (h < shortest * interval) give_up(t, "no step is short enough for it");
      }
      if (going_on && !going_on(t)) give_up(t, "interrupted");
    }
    keep(t);
  }
  return rows;
}

}  // namespace

OwnReference own_reference(const Mechanism& mechanism, const Start& start, double end, int count,
                           const std::function<bool(double)>& going_on, bool forces) {
  if (has_rigid_stops(mechanism.scene()))
    throw std::invalid_argument(
        "the scene has rigid stops (restitution), whose impacts a reference of its own knows "
        "nothing of: expected --reference FILE, or stops that give way (stop_stiffness)");
  std::vector<double> times;
  for (int i = 0; i <= count; ++i) times.push_back(i == count ? end : end / count * i);
  std::vector<std::string> columns;
  for (const auto& c : mechanism.coordinate_columns()) columns.push_back(c.label());
  for (const auto& c : mechanism.rate_columns()) columns.push_back(c.label());
  for (const auto& c : mechanism.multiplier_columns()) columns.push_back(c.label());
  // λ of redundant rows need not be continuous.
  const bool impulses =
      forces && mechanism.m() > 0 && rank_at(mechanism, start).rank == mechanism.m();
  if (impulses)
    for (const auto& c : impulse_columns(mechanism)) columns.push_back(c.label());
  const auto more = impulses ? static_cast<std::size_t>(mechanism.m()) : 0,
             size = static_cast<std::size_t>(mechanism.nq() + mechanism.nv()) + more;
  const bool in_time = takes_time(mechanism), implicit = is_stiff(mechanism, start, end, going_on);
  const auto solved = [&](double quad, double in_steps, double of_time, OwnReferenceForces* told) {
    const double least = in_time ? of_time : 0;
    return implicit ? solve(mechanism, start, end, count, std::max(in_steps, least),
                            OdeRadauCollocation<Quad>(size), more, told, going_on)
                    : solve(mechanism, start, end, count, std::max(quad, least),
                            Extrapolation<Quad>(size), more, told, going_on);
  };
  std::optional<OwnReferenceForces> others;
  if (forces) others.emplace(mechanism);
  Rows rows = solved(tight, tight_implicit, tight_in_time, others ? &*others : nullptr);
  Rows check = solved(loose, loose_implicit, loose_in_time, nullptr);
  const std::size_t compared = columns.size();
  if (others) others->append(columns, rows);
  OwnReference own{Reference("quadruple precision", columns, times, rows), 0, implicit};
  std::vector<std::string> bound{"t [s]"};
  bound.insert(bound.end(), columns.begin(), columns.end());
  own.reference.bind(bound);
  for (std::size_t i = 0; i < check.size(); ++i) {
    std::vector<double> row{times[i]};
    row.insert(row.end(), check[i].begin(), check[i].end());
    row.resize(row.size() + columns.size() - compared);
    own.accuracy = std::max(own.accuracy, own.reference.error(i, row).position);
  }
  own.reference.bind(measured_columns(mechanism));
  return own;
}

std::string in_words(const OwnReference& own) {
  return std::string("quadruple precision: acceleration form projected at each step, ") +
         (own.implicit ? "Radau IIA of order 17, for it is stiff" : "extrapolation") +
         "; two tolerances agree to " + scientific(own.accuracy, 2);
}

OwnReferenceForces::OwnReferenceForces(const Mechanism& mechanism)
    : mechanism_(mechanism),
      e_(mechanism.evaluation<double>()),
      solver_(mechanism.m() > 0 ? make_loop_solver(mechanism, *e_) : nullptr),
      forces_(mechanism, *e_, solver_.get(), true),
      works_(IntegratedWork::has_any(mechanism) || DrivePower(mechanism, *e_, solver_.get()).any()),
      momenta_(static_cast<std::size_t>(mechanism.nv())) {
  for (const Column& c : mechanism.effort_columns()) columns_.push_back(c.label());
  const std::vector<std::string> without = trajectory_columns(mechanism),
                                 with = trajectory_columns(mechanism, true);
  columns_.insert(columns_.end(), with.begin() + static_cast<std::ptrdiff_t>(without.size()),
                  with.end());
  for (const Column& c : momentum_columns(mechanism)) columns_.push_back(c.label());
  columns_.emplace_back("work [J]");
}

void OwnReferenceForces::add(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                             const Eigen::VectorXd& udot, const Eigen::VectorXd& lambda) {
  forces_.solve(t, q, u);
  forces_.take(udot, lambda);
  std::vector<double> all;
  std::vector<std::size_t> open;  // not a number: reactions and efforts
  forces_.append(all, open);
  e_->place(t, q.data());
  e_->move(u.data());
  e_->momenta(nullptr, momenta_.data());
  all.insert(all.end(), momenta_.begin(), momenta_.end());
  all.push_back(e_->kinetic() + e_->potential(q.data()));
  // λ and how many are not unique come first.
  all.erase(all.begin(), all.end() - static_cast<std::ptrdiff_t>(columns_.size()));
  rows_.push_back(std::move(all));
}

void OwnReferenceForces::append(std::vector<std::string>& columns,
                                std::vector<std::vector<double>>& rows) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const bool work = c + 1 == columns_.size();
    const auto everywhere = [&](auto&& is) {
      return std::all_of(rows_.begin(), rows_.end(),
                         [&](const std::vector<double>& row) { return is(row[c]); });
    };
    if (work ? !works_ : !everywhere([](double x) { return std::isfinite(x); })) continue;
    const bool load = columns_[c].find(".force_") != std::string::npos ||
                      columns_[c].find(".torque_") != std::string::npos;
    if (load && mechanism_.plan().planar && everywhere([](double x) { return x == 0; })) continue;
    columns.push_back(columns_[c]);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows[i].push_back(rows_[i][c] - (work ? rows_.front()[c] : 0));
  }
}

}  // namespace momenta
