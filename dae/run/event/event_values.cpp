#include <momenta/core/expression/evaluate.h>
#include <momenta/core/scene/lagrangian/lagrangian_formulas.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/run/event/event_values.h>

#include <algorithm>
#include <limits>

namespace momenta {

using Kind = Signal::Kind;

EventValues::EventValues(const Mechanism& mechanism, const std::vector<EventSpec>& events)
    : mechanism_(mechanism) {
  const Scene& scene = mechanism.scene();
  const auto fail = [&](std::size_t i, const std::string& why) {
    throw SceneError(scene.where(events[i].at) + "event " +
                     reading::in_quotes(name_of(events[i], i)) + ": " + why);
  };
  for (std::size_t i = 0; i < events.size(); ++i)
    if (const std::string& d = events[i].direction; d != "up" && d != "down" && d != "both")
      fail(i, "direction is " + reading::in_quotes(d) + ", expected up, down or both");
  if (scene.lagrangian) {
    take_lagrangian(events);
    return;
  }
  const FormulaReader reader(scene);
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::string when = "when, " + reading::in_quotes(events[i].when.text);
    try {
      Formula formula = reader.read(events[i].when.text);
      if (const std::string fault = event_fault(formula); !fault.empty())
        fail(i, when + ", " + fault);
      Event event{std::move(formula.expression), {}};
      for (const Signal& signal : formula.signals) {
        event.inputs.push_back(input_of(signal));
        takes_rates_ |= is_rate(signal.kind);
      }
      events_.push_back(std::move(event));
    } catch (const ExpressionError& e) {
      fail(i, when + ": " + e.what());
    }
  }
  if (points_.empty()) return;
  Scene open = scene;
  open.loops.clear();
  open.forces.clear();
  open.events.clear();
  std::erase_if(open.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
  open.markers = points_;
  places_.resize(6 * points_.size());
  open_ = std::make_unique<Mechanism>(std::move(open));
  e_ = open_->evaluation<double>();
}

void EventValues::take_lagrangian(const std::vector<EventSpec>& events) {
  Scene scene = mechanism_.scene();
  scene.events = events;
  const LagrangianFormulas formulas(scene);
  const int n = mechanism_.nq();
  std::vector<Input> inputs;
  for (int i = 0; i < n; ++i) inputs.push_back({Input::Of::q, i});
  for (int i = 0; i < n; ++i) inputs.push_back({Input::Of::u, i});
  inputs.push_back({Input::Of::time});
  for (const ParameterSpec& p : scene.parameters)
    inputs.push_back({Input::Of::number, 0, 0, p.value});
  for (const Expression& formula : formulas.events) {
    for (const int v : formula.variables()) takes_rates_ |= v >= n && v < 2 * n;
    events_.push_back({formula, inputs});
  }
}

EventValues::Input EventValues::coordinate(const std::string& joint, int component, bool rate) {
  using Of = Input::Of;
  const Tree& tree = mechanism_.tree();
  const Tree::Body& b = tree.bodies[static_cast<std::size_t>(tree.part_of(joint, component))];
  if (b.drive < 0) return rate ? Input{Of::u, b.u} : Input{Of::q, b.q};
  laws_.push_back(tree.drives[static_cast<std::size_t>(b.drive)]);
  return {rate ? Of::law_rate : Of::law, static_cast<int>(laws_.size()) - 1};
}

int EventValues::point(const std::string& body, const Eigen::Vector3d& at) {
  MarkerSpec marker;
  marker.name = std::to_string(points_.size());
  marker.body = body;
  marker.point = at;
  points_.push_back(std::move(marker));
  return static_cast<int>(points_.size()) - 1;
}

EventValues::Input EventValues::input_of(const Signal& signal) {
  using Of = Input::Of;
  const Scene& scene = mechanism_.scene();
  const auto which = static_cast<std::size_t>(signal.which);
  const bool rate = is_rate(signal.kind);
  switch (signal.kind) {
    case Kind::time:
      return {Of::time};
    case Kind::coordinate:
    case Kind::rate:
      return coordinate(scene.joints[which].name, signal.component, rate);
    case Kind::position:
    case Kind::velocity: {
      const MarkerSpec& marker = scene.markers[which];
      return {rate ? Of::velocity : Of::place, point(marker.body, marker.point), signal.component};
    }
    case Kind::length:
    case Kind::length_rate: {
      const ForceSpec& spring = scene.forces[which];
      if (spring.kind != "coordinate-spring") {
        const int child = point(spring.child, spring.origin_child);
        return {rate ? Of::length_rate : Of::length, child,
                point(spring.parent, spring.origin_parent)};
      }
      Input sum{Of::sum};
      for (std::size_t i = 0; i < spring.joints.size(); ++i)
        sum.terms.emplace_back(
            spring.ratios[i],
            coordinate(spring.joints[i], spring.coordinates.empty() ? 0 : spring.coordinates[i],
                       rate));
      return sum;
    }
  }
  return {};
}

double EventValues::value(const Input& input, double t, const Eigen::VectorXd& q,
                          const Eigen::VectorXd& u) const {
  using Of = Input::Of;
  const auto vector = [&](int point, bool rate) {
    return Eigen::Map<const Eigen::Vector3d>(places_.data() + 6 * point + (rate ? 3 : 0));
  };
  switch (input.of) {
    case Of::number:
      return input.number;
    case Of::time:
      return t;
    case Of::q:
      return q[input.which];
    case Of::u:
      return u[input.which];
    case Of::law:
    case Of::law_rate: {
      double f = 0, rate = 0, second = 0;
      laws_[static_cast<std::size_t>(input.which)].evaluate(t, f, rate, second);
      return input.of == Of::law ? f : rate;
    }
    case Of::place:
    case Of::velocity:
      return vector(input.which, input.of == Of::velocity)[input.component];
    case Of::length:
    case Of::length_rate: {
      const Eigen::Vector3d d = vector(input.which, false) - vector(input.component, false);
      if (input.of == Of::length) return d.norm();
      return d.dot(vector(input.which, true) - vector(input.component, true)) / d.norm();
    }
    case Of::sum: {
      double sum = 0;
      for (const auto& [ratio, term] : input.terms) sum += ratio * value(term, t, q, u);
      return sum;
    }
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void EventValues::at(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& u, double* values) {
  if (e_) {
    e_->place(t, q.data());
    e_->move(takes_rates_ ? u.data() : nullptr);
    e_->markers(places_.data());
  }
  for (const Event& event : events_) {
    x_.clear();
    for (const Input& input : event.inputs) x_.push_back(value(input, t, q, u));
    if (line_.size() < event.formula.tape().size()) line_.resize(event.formula.tape().size());
    evaluate(event.formula, x_.data(), line_.data(), values++);
  }
}

}  // namespace momenta
