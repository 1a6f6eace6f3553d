#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/output/csv.h>
#include <momenta/dae/output/json.h>
#include <momenta/dae/output/move_report.h>
#include <momenta/dae/output/sampled_curves.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace momenta {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

const Column& swept(const MoveResult& r) {
  return r.coordinates[r.swept];
}

/// Range of a rate, at unit rate of the swept coordinate.
std::pair<double, double> ratios(const MoveResult& r, std::size_t rate) {
  double least = none, most = none;
  for (const MovedPose& pose : r.poses)
    if (pose.u.size() > 0) {
      const double u = pose.u[static_cast<Eigen::Index>(rate)];
      least = std::isnan(least) ? u : std::min(least, u);
      most = std::isnan(most) ? u : std::max(most, u);
    }
  return {least, most};
}

/// "[rad/rad]".
std::string by_swept(const MoveResult& r, const std::string& rate_unit, int order) {
  std::string unit = rate_unit;
  if (unit.ends_with("/s")) unit.resize(unit.size() - 2);
  return " [" + unit + "/" + swept(r).unit + (order == 2 ? "^2]" : "]");
}

/// Way of the swept coordinate to each pose, back and forth.
std::vector<double> travel_of(const MoveResult& r) {
  std::vector<double> travel;
  for (std::size_t i = 0; i < r.poses.size(); ++i)
    travel.push_back(i == 0 ? 0 : travel.back() + std::abs(r.poses[i].s - r.poses[i - 1].s));
  return travel;
}

const Column& output(const MoveResult& r) {
  return r.coordinates[static_cast<std::size_t>(r.output)];
}
/// "[1/m]" for a unit moment, "[1]" for a unit force.
std::string by_effort(const MoveResult& r) {
  return output(r).unit == "rad" ? " [1/m]" : " [1]";
}
/// Effort on the output for unit effort of the swept coordinate, without losses: dq/ds⁻¹.
double advantage(const MoveResult& r, const MovedPose& pose) {
  return pose.u.size() > 0 ? 1 / pose.u[r.output_rate] : none;
}
std::string advantage_heading(const MoveResult& r) {
  return output(r).name + ".advantage [" + swept(r).unit + "/" + output(r).unit + "]";
}

std::string place_of(const MoveResult& r, const MoveResult::Extreme& at) {
  return swept(r).name + " = " + compact(r.start + at.s, 5) + " " + swept(r).unit;
}

/// Transmission angle and joint force of the output.
std::string transmission_in_words(const MoveResult& r) {
  if (r.output < 0) return "";
  const auto degrees = [&](const MoveResult::Extreme& at) {
    return compact(at.value * 180 / std::numbers::pi, 4) + "° at " + place_of(r, at);
  };
  std::string text = std::isnan(r.passed.least_angle.value)
                         ? "No one point of the output link of " + output(r).name +
                               " takes the whole force: it has no transmission angle."
                         : "The transmission angle of " + output(r).name + " is least, " +
                               degrees(r.passed.least_angle) + ", and largest, " +
                               degrees(r.passed.largest_angle) + ".";
  const MoveResult::Extreme& hardest = r.passed.largest_force;
  if (!std::isnan(hardest.value))
    text += " The largest joint force for " +
            std::string(output(r).unit == "rad" ? "1 N m" : "1 N") + " on it is " +
            (std::isinf(hardest.value) ? "without bound" : compact(hardest.value, 4) + " N") +
            ", at " + place_of(r, hardest) + ".";
  return text;
}

/// The first few by name.
std::string dead_points_in_words(const MoveResult& r) {
  constexpr int most = 4;
  std::string text;
  int told = 0;
  for (const MovedPose& pose : r.poses) {
    if (pose.kind != MovedPose::Kind::dead_point) continue;
    if (told++ == most) return text + " …";
    text += (text.empty() ? " Dead points: " : "; ");
    for (std::size_t i = 0; i < r.coordinates.size() && i < 6; ++i)
      text += (i == 0 ? "" : ", ") + r.coordinates[i].name + " = " +
              compact(pose.q[static_cast<Eigen::Index>(i)], 5);
  }
  return text.empty() ? text : text + ".";
}

Json points(const MoveResult& r, MovedPose::Kind kind) {
  Json all = Json::array();
  for (const MovedPose& pose : r.poses)
    if (pose.kind == kind) {
      Json q = Json::object();
      for (std::size_t i = 0; i < r.coordinates.size(); ++i)
        q[r.coordinates[i].label()] = number_or_null(pose.q[static_cast<Eigen::Index>(i)]);
      all.push_back({{"value", number_or_null(r.start + pose.s)}, {"q", q}});
    }
  return all;
}

std::string counted(long n, const std::string& what) {
  return (n == 0 ? "no " : std::to_string(n) + " ") + what + (n == 1 ? "" : "s");
}

}  // namespace

std::string move_in_words(const MoveResult& r) {
  const Column& c = swept(r);
  const Reach& reach = r.reach[r.swept];
  const std::string unit = " " + c.unit;
  const double round = 2 * std::numbers::pi;
  const bool goes_round = r.end == MoveResult::End::closed && r.dead_points() == 0 &&
                          std::abs(std::abs(r.poses.back().s) - round) < 1e-6;
  std::string text = c.name;
  if (goes_round)
    text += " goes round";
  else if (r.dead_points() > 0 ||
           (r.end == MoveResult::End::closed && std::abs(r.poses.back().s) < 1e-6))
    text += " swings between " + compact(reach.least, 6) + " and " + compact(reach.most, 6) + unit;
  else
    text += " goes from " + compact(r.start, 6) + " to " + compact(r.start + r.poses.back().s, 6) +
            unit;
  text += ": " + counted(static_cast<long>(r.poses.size()), "pose") + ", " +
          counted(r.dead_points(), "dead point") + ", " +
          counted(r.change_points(), "change point");
  text += r.end == MoveResult::End::closed    ? "; back at the start."
          : r.end == MoveResult::End::reached ? "."
                                              : "; it stopped: " + r.why + ".";
  text += dead_points_in_words(r);
  if (!r.idle.empty())
    text += " Nothing depends on the turn of " + reading::all_in_quotes(r.idle) +
            " between two balls: it is held.";
  if (r.change_points() > 0)
    text += " At a change point another assembly is as near: it was passed straight on.";
  return text;
}

std::string move_table(const MoveResult& r) {
  std::string text = (r.scene.empty() ? "" : r.scene + ": ") + move_in_words(r) + "\n";
  std::vector<std::vector<std::string>> rows{
      {"coordinate", "least", "most", "range", "turns back", "least ratio", "largest ratio"}};
  for (std::size_t i = 0; i < r.coordinates.size(); ++i) {
    std::string least = "-", most = "-";
    for (std::size_t k = 0; k < r.rates.size(); ++k)
      if (r.rates[k].name == r.coordinates[i].name ||
          (r.rates.size() == r.coordinates.size() && k == i)) {
        const auto [low, high] = ratios(r, k);
        least = compact(low, 4);
        most = compact(high, 4);
      }
    const Reach& reach = r.reach[i];
    rows.push_back({r.coordinates[i].label(), compact(reach.least, 6), compact(reach.most, 6),
                    compact(reach.most - reach.least, 6), std::to_string(reach.turns_back), least,
                    most});
  }
  const std::string passed = transmission_in_words(r);
  return text + "\n" + in_columns(rows) + (passed.empty() ? "" : "\n" + passed + "\n");
}

std::string move_csv(const MoveResult& r) {
  std::vector<std::string> cells{"kind", "displacement [" + swept(r).unit + "]", "branch"};
  const bool asked = !r.poses.empty() && r.poses.front().reciprocal_condition >= 0;
  if (asked) cells.emplace_back("reciprocal_condition [1]");
  if (r.output >= 0) {
    cells.emplace_back("transmission_angle [rad]");
    cells.push_back("joint_force" + by_effort(r));
    cells.push_back(csv_cell(advantage_heading(r)));
  }
  for (const Column& c : r.coordinates) cells.push_back(csv_cell(c.label()));
  for (const int order : {1, 2})
    for (const Column& c : r.rates)
      cells.push_back(
          csv_cell(c.name + (order == 1 ? ".ratio" : ".ratio_rate") + by_swept(r, c.unit, order)));
  for (std::size_t i = 0; i < r.markers.size(); ++i)
    cells.push_back(csv_cell(i % 6 < 3 ? r.markers[i].label()
                                       : r.markers[i].name + by_swept(r, r.markers[i].unit, 1)));
  std::string text = csv_line(cells);
  for (const MovedPose& pose : r.poses) {
    cells = {name_of(pose.kind), round_trip(pose.s),
             pose.branch == 0 ? "" : std::to_string(pose.branch)};
    if (asked) cells.push_back(round_trip(pose.reciprocal_condition));
    if (r.output >= 0)
      for (const double x : {pose.transmission_angle, pose.joint_force, advantage(r, pose)})
        cells.push_back(round_trip(x));
    for (const double q : pose.q) cells.push_back(round_trip(q));
    for (const Eigen::VectorXd* x : {&pose.u, &pose.udot})
      for (std::size_t i = 0; i < r.rates.size(); ++i)
        cells.push_back(x->size() > 0 ? round_trip((*x)[static_cast<Eigen::Index>(i)]) : "");
    for (const double x : pose.markers) cells.push_back(round_trip(x));
    text += csv_line(cells);
  }
  return text;
}

Json move_json(const MoveResult& r) {
  Json reach = Json::object();
  for (std::size_t i = 0; i < r.coordinates.size(); ++i)
    reach[r.coordinates[i].label()] = {{"least", number_or_null(r.reach[i].least)},
                                       {"most", number_or_null(r.reach[i].most)},
                                       {"turns_back", r.reach[i].turns_back}};
  Json ratio = Json::object();
  for (std::size_t k = 0; k < r.rates.size(); ++k) {
    const auto [least, most] = ratios(r, k);
    ratio[r.rates[k].name + by_swept(r, r.rates[k].unit, 1)] = {{"least", number_or_null(least)},
                                                                {"most", number_or_null(most)}};
  }
  Json passed;
  if (r.output >= 0) {
    passed["coordinate"] = output(r).label();
    const auto add = [&](const std::string& name, const MoveResult::Extreme& least,
                         const MoveResult::Extreme& most) {
      Json& entry = passed[name];
      if (std::isnan(least.value)) return;
      entry = {{"least", number_or_null(least.value)},
               {"least_at", number_or_null(r.start + least.s)},
               {"most", number_or_null(most.value)},
               {"most_at", number_or_null(r.start + most.s)}};
    };
    add("transmission_angle", r.passed.least_angle, r.passed.largest_angle);
    add("joint_force", r.passed.least_force, r.passed.largest_force);
  }
  return {{"scene", r.scene},
          {"output", passed},
          {"swept", swept(r).label()},
          {"start", number_or_null(r.start)},
          {"end", name_of(r.end)},
          {"why", r.why.empty() ? Json() : Json(r.why)},
          {"idle", r.idle},
          {"displacement", number_or_null(r.poses.empty() ? none : r.poses.back().s)},
          {"poses", r.poses.size()},
          {"reach", reach},
          {"ratios", ratio},
          {"dead_points", points(r, MovedPose::Kind::dead_point)},
          {"change_points", points(r, MovedPose::Kind::change_point)}};
}

Film move_film(const MoveResult& r, int intervals) {
  return film_of(
      travel_of(r), [&](std::size_t i) -> const Eigen::VectorXd& { return r.poses[i].q; },
      intervals);
}

Json move_charts(const MoveResult& r) {
  const std::vector<double> travel = travel_of(r);
  Json charts = Json::array();
  const auto add = [&](const std::string& key, const std::string& title, const std::string& unit,
                       std::vector<std::pair<std::string, std::vector<double>>> curves) {
    add_chart(charts, travel,
              {key, title, "travel of " + swept(r).label(), unit, "move.csv", std::move(curves)});
  };
  for (const std::string unit : {"rad", "m"}) {
    std::vector<std::pair<std::string, std::vector<double>>> curves;
    for (std::size_t i = 0; i < r.coordinates.size(); ++i)
      if (r.coordinates[i].unit == unit) {
        curves.emplace_back(r.coordinates[i].name, std::vector<double>());
        for (const MovedPose& pose : r.poses)
          curves.back().second.push_back(pose.q[static_cast<Eigen::Index>(i)]);
      }
    add("q_" + unit, "coordinates [" + unit + "]", unit, curves);
  }
  std::vector<std::pair<std::string, std::vector<double>>> curves;
  for (std::size_t k = 0; k < r.rates.size(); ++k) {
    curves.emplace_back(r.rates[k].name, std::vector<double>());
    for (const MovedPose& pose : r.poses)
      curves.back().second.push_back(pose.u.size() > 0 ? pose.u[static_cast<Eigen::Index>(k)]
                                                       : none);
  }
  if (r.output >= 0) {
    std::vector<double> angles, forces;
    for (const MovedPose& pose : r.poses) {
      angles.push_back(pose.transmission_angle);
      forces.push_back(pose.joint_force);
    }
    add("transmission", "transmission angle of " + output(r).name + " [rad]", "rad",
        {{output(r).name, angles}});
    add("joint_force", "largest joint force for a unit effort on " + output(r).name, "",
        {{output(r).name, forces}});
  }
  add("ratios", "rates while " + swept(r).name + " has a rate of 1", "", curves);
  return charts;
}

}  // namespace momenta
