#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>

#include <algorithm>
#include <cmath>

namespace momenta {

std::pair<int, int> coordinate_named(const Mechanism& mechanism, const std::string& name) {
  const std::vector<Column> columns = mechanism.coordinate_columns();
  std::vector<std::string> known;
  const auto is_it = [&](int q, bool alone) {
    const std::string& column = columns[static_cast<std::size_t>(q)].name;
    known.push_back(column);
    return column == name || (alone && column == name + ".q");
  };
  if (mechanism.scene().lagrangian)
    for (int i = 0; i < mechanism.nq(); ++i)
      if (is_it(i, false)) return {i, i};
  for (const auto& body : mechanism.tree().bodies) {
    if (body.nq != body.nv) continue;  // quaternions
    for (int i = 0; i < body.nq; ++i)
      if (is_it(body.q + i, body.nq == 1)) return {body.q + i, body.u + i};
  }
  throw SceneError("coordinate '" + name + "' is not known" +
                   (known.empty() ? ": all joints are welds, are driven or have quaternions; "
                                    "expected another joint"
                                  : "; expected " + reading::all_in_quotes(known)));
}

std::string coordinate_of_rate(const Mechanism& mechanism, int rate) {
  const std::vector<Column> columns = mechanism.coordinate_columns();
  if (mechanism.scene().lagrangian) return columns[static_cast<std::size_t>(rate)].name;
  for (const auto& body : mechanism.tree().bodies)
    if (body.nq == body.nv && rate >= body.u && rate < body.u + body.nv)
      return columns[static_cast<std::size_t>(body.q + rate - body.u)].name;
  return "";
}

using Eigen::VectorXd;

double HeldCoordinate::value(const VectorXd& q) const {
  double sum = 0;
  for (const auto& [place, c] : terms) sum += c * q[place];
  return sum;
}

Eigen::RowVectorXd HeldCoordinate::row(Evaluation<double>& e, const VectorXd& q,
                                       Eigen::Index nv) const {
  VectorXd rate = VectorXd::Zero(nv), qdot = VectorXd::Zero(q.size());
  Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(rate.size());
  for (const int u : rates) {
    rate[u] = 1;
    e.coordinate_rates(q.data(), rate.data(), qdot.data());
    row[u] = value(qdot);
    rate[u] = 0;
  }
  return row;
}

HeldCoordinate held_turn(int place, int rate, const Eigen::Vector3d& axis, const VectorXd& q) {
  const double half = std::atan2(q.segment<3>(place + 1).dot(axis), q[place]);
  HeldCoordinate held;
  held.terms.emplace_back(place, -std::sin(half));
  for (int i = 0; i < 3; ++i) held.terms.emplace_back(place + 1 + i, std::cos(half) * axis[i]);
  held.rates = {rate, rate + 1, rate + 2};
  return held;
}

HeldCoordinate held_coordinate(const Mechanism& mechanism, const std::string& name,
                               const VectorXd& q) {
  const std::vector<Column> coordinates = mechanism.coordinate_columns(),
                            rates = mechanism.rate_columns();
  for (const auto& body : mechanism.tree().bodies) {
    if (!body.has_quaternion()) continue;
    const int turns = body.u + body.nv - 3, quaternion = body.q + body.nq - 4;
    for (int i = 0; i < 3; ++i)
      if (rates[static_cast<std::size_t>(turns + i)].name == name)
        return held_turn(quaternion, turns, Eigen::Vector3d::Unit(i), q);
    for (int i = 0; i < body.nq; ++i)
      if (coordinates[static_cast<std::size_t>(body.q + i)].name == name) {
        HeldCoordinate held{{{body.q + i, 1.0}}, {}};
        for (int k = 0; k < body.nv; ++k) held.rates.push_back(body.u + k);
        return held;
      }
  }
  const auto [place, rate] = coordinate_named(mechanism, name);
  return {{{place, 1.0}}, {rate}};
}

std::string name_to_hold(const Mechanism& mechanism, int rate) {
  for (const auto& body : mechanism.tree().bodies) {
    if (rate < body.u || rate >= body.u + body.nv) continue;
    if (body.has_quaternion() && rate >= body.u + body.nv - 3) break;
    return mechanism.coordinate_columns()[static_cast<std::size_t>(body.q + rate - body.u)].name;
  }
  return mechanism.scene().lagrangian
             ? mechanism.coordinate_columns()[static_cast<std::size_t>(rate)].name
             : mechanism.rate_columns()[static_cast<std::size_t>(rate)].name;
}

}  // namespace momenta
