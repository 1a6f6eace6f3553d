#include <momenta/core/scalar/sixth_order.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/motion_reactions.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/analysis/kinematics/transmission.h>
#include <momenta/dae/study/fit/swept_parts.h>
#include <momenta/dae/study/fit/swept_poses.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace momenta {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// "O" for "O.q"; else the name itself.
std::string by_joint(const std::string& column) {
  return column.ends_with(".q") ? column.substr(0, column.size() - 2) : column;
}

}  // namespace

SweptParts::SweptParts(const ParametricMechanism& family, VectorXd sizes, SweptWay way)
    : MotionParts(family, std::move(sizes)), way_(std::move(way)) {
  if (way_.poses < 2)
    throw std::invalid_argument("found " + std::to_string(way_.poses) +
                                " poses of a way, expected two or more");
  if (way_.between && !((*way_.between)[0] < (*way_.between)[1] &&
                        std::isfinite((*way_.between)[1] - (*way_.between)[0])))
    throw std::invalid_argument("found a way from " + reading::digits((*way_.between)[0]) + " to " +
                                reading::digits((*way_.between)[1]) +
                                ", expected finite ends, the smaller first");
  if (!std::isfinite(way_.rate))
    throw std::invalid_argument("the rate of the swept coordinate is " +
                                reading::digits(way_.rate) + ", expected a finite number");
  const auto mechanism = family.at(family.own());
  const std::vector<Column> q = mechanism->coordinate_columns(), u = mechanism->rate_columns(),
                            markers = mechanism->marker_columns();
  const int swept = coordinate_named(*mechanism, way_.sweep).first;
  swept_ = q[static_cast<std::size_t>(swept)];
  if (!way_.between && swept_.unit == "rad") {
    const double start = SweptPoses(*mechanism, way_.sweep).start();
    way_.between = {start, start + 2 * std::numbers::pi};
  }
  const auto [from, to] = way_.between.value_or(std::array<double, 2>{});
  for (int i = 0; i < way_.poses; ++i)
    places_.push_back(i + 1 == way_.poses ? to : from + (to - from) * i / (way_.poses - 1));
  using Of = Name::Of;
  const auto add_columns = [&](const std::vector<Column>& columns, Of of) {
    for (std::size_t i = 0; i < columns.size(); ++i)
      names_.push_back({columns[i].name, of, static_cast<int>(i)});
  };
  add_columns(q, Of::coordinate);
  add_columns(u, Of::rate);
  add_columns(markers, Of::marker);
  names_.push_back({by_joint(swept_.name) + ".effort", Of::effort, swept});
  for (std::size_t i = 0; i < q.size(); ++i)
    if (static_cast<int>(i) != swept)
      names_.push_back(
          {by_joint(q[i].name) + ".transmission", Of::transmission, static_cast<int>(i)});
  for (const std::string& name : MotionReactions::names(*mechanism))
    names_.push_back({name, Of::reaction, reactions_++});
  used_.assign(names_.size(), false);
}

std::size_t SweptParts::add(const MotionPart& part) {
  if (!way_.between)
    throw std::invalid_argument("coordinate " + reading::in_quotes(way_.sweep) +
                                " is no angle, so it has no turn to go; expected --over FROM:TO");
  std::vector<std::string> names = parameter_names();
  for (const Name& name : names_) names.push_back(name.name);
  parts_.push_back({part.kind, SmoothFormula(part.formula, names)});
  for (const int v : parts_.back().g.used())
    if (const int k = v - static_cast<int>(parameter_names().size()); k >= 0)
      used_[static_cast<std::size_t>(k)] = true;
  return parts_.size() - 1;
}

bool SweptParts::take(const VectorXd& theta, MatrixXd& table) {
  using Of = Name::Of;
  const auto mechanism = family_.at(theta);
  SweptPoses poses(*mechanism, way_.sweep);
  std::vector<CurvePoint> points;
  if (!poses.reach(places_, points)) {
    why_ = poses.why();
    return false;
  }
  bool moves = false;
  std::map<std::size_t, Transmission> transmissions;
  std::optional<MotionReactions> reactions;
  for (std::size_t k = 0; k < names_.size(); ++k) {
    if (!used_[k]) continue;
    moves |= names_[k].of != Of::coordinate && names_[k].of != Of::transmission;
    if (names_[k].of == Of::reaction && !reactions) reactions.emplace(*mechanism, poses.rate());
    if (names_[k].of != Of::transmission) continue;
    const std::string& name = names_[k].name;
    transmissions.try_emplace(k, *mechanism, 0.0, name.substr(0, name.rfind('.')),
                              std::vector<int>{poses.rate()}, std::vector<HeldCoordinate>{});
  }
  const auto e = mechanism->evaluation<double>();
  VectorXd u = VectorXd::Zero(mechanism->nv()), udot = u, way = u, none, r(mechanism->nv());
  VectorXd markers(static_cast<Index>(6 * mechanism->scene().markers.size()));
  table.setZero(static_cast<Index>(points.size()), static_cast<Index>(names_.size()));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VectorXd& q = points[i].q;
    double effort = 0;
    VectorXd transmitted;
    if (moves) {
      if (!poses.rates(points[i], 1, way, none) || !poses.rates(points[i], way_.rate, u, udot)) {
        why_ = poses.why();
        return false;
      }
      e->place(0, q.data());
      e->move(u.data());
      e->markers(markers.data());
      e->joint_forces(q.data(), u.data(), udot.data(), nullptr, r.data());
      effort = r.dot(way);
      if (reactions) transmitted = reactions->at(q, u, udot);
    }
    for (std::size_t k = 0; k < names_.size(); ++k) {
      if (!used_[k]) continue;
      const Name& name = names_[k];
      double& to = table(static_cast<Index>(i), static_cast<Index>(k));
      switch (name.of) {
        case Of::coordinate:
          to = q[name.place];
          break;
        case Of::rate:
          to = u[name.place];
          break;
        case Of::marker:
          to = markers[name.place];
          break;
        case Of::effort:
          to = effort;
          break;
        case Of::transmission:
          to = transmissions.at(k).at(q).angle;
          break;
        case Of::reaction:
          to = transmitted[name.place];
          break;
      }
      if (!std::isfinite(to)) {
        why_ = "at " + swept_.name + " = " + reading::digits(places_[i]) + " " + name.name +
               (name.of == Of::reaction ? " is not unique: loop equations are redundant"
                                        : " has no value");
        return false;
      }
    }
  }
  return true;
}

bool SweptParts::at(const VectorXd& theta, bool derivatives, MotionValues& values) {
  try {
    take_parameters(theta, derivatives, values);
    MatrixXd table, near;
    std::vector<MatrixXd> by;  // by θ_j
    if (parts_.empty()) {
      values.parts.clear();
      values.parts_by.clear();
      return true;
    }
    if (!take(theta, table)) return false;
    for (Index j = 0; derivatives && j < theta.size(); ++j) {
      const auto at_point = [&](std::size_t i, double h) {
        VectorXd other = theta;
        other[j] += sixth_order::k_of(i) * h;
        if (!take(other, near)) throw SceneError(why_);
        return VectorXd(near.reshaped());
      };
      // At one width: a θ whose neighbours do not close is no candidate.
      by.push_back(sixth_order::slope_at(sixth_order::part * sizes_[j], sixth_order::iterated, 0,
                                         table.reshaped(), at_point)
                       .by.reshaped(table.rows(), table.cols()));
    }
    values.parts.clear();
    values.parts_by.clear();
    curves_.clear();
    const Index parameters = values.parameters.size(), n = table.rows();
    const double apart = (places_.back() - places_.front()) / static_cast<double>(n - 1);
    for (const Part& part : parts_) {
      VectorXd g(n), x(parameters + table.cols()), slope;
      MatrixXd g_by = MatrixXd::Zero(derivatives ? n : 0, theta.size());
      x.head(parameters) = values.parameters;
      for (Index i = 0; i < n; ++i) {
        x.tail(table.cols()) = table.row(i).transpose();
        g[i] = part.g(x, derivatives ? &slope : nullptr);
        if (!derivatives) continue;
        g_by.row(i) = slope.head(parameters).transpose() * values.parameters_by;
        for (Index j = 0; j < theta.size(); ++j)
          g_by(i, j) += by[static_cast<std::size_t>(j)].row(i).dot(slope.tail(table.cols()));
      }
      curves_.push_back(g);
      if (!g.allFinite() || !g_by.allFinite()) {
        why_ = "a formula of the motion, or its derivative, has no finite value";
        return false;
      }
      if (part.kind == MotionPart::Kind::most || part.kind == MotionPart::Kind::least) {
        values.parts.push_back(g);
        values.parts_by.push_back(g_by);
        continue;
      }
      VectorXd weights = VectorXd::Zero(n);
      switch (part.kind) {
        case MotionPart::Kind::first:
          weights[0] = 1;
          break;
        case MotionPart::Kind::last:
          weights[n - 1] = 1;
          break;
        default:
          weights.setConstant(apart);
          weights[0] = weights[n - 1] = 0.5 * apart;
          if (part.kind == MotionPart::Kind::mean) weights /= apart * static_cast<double>(n - 1);
      }
      values.parts.push_back(VectorXd::Constant(1, weights.dot(g)));
      values.parts_by.push_back(derivatives ? MatrixXd(weights.transpose() * g_by) : MatrixXd());
    }
    return true;
  } catch (const SceneError& error) {
    why_ = error.what();
    return false;
  }
}

}  // namespace momenta
