#include <momenta/core/text/quoting.h>
#include <momenta/dae/algebra/dense/decompositions.h>
#include <momenta/dae/analysis/effort/closed_motion.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <algorithm>
#include <cmath>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double longest_step = 0.1;  // step of a given coordinate, in units
constexpr int most_corrections = 30;
constexpr double closed = 1e-12;  // least |Φ|∞, in units
constexpr double settled = 1e-7;  // a step after which the next is rounding

constexpr int most_rates = 2000;

}  // namespace

ClosedMotion::ClosedMotion(const Mechanism& mechanism, const GivenMotion& motion, VectorXd start,
                           double within)
    : mechanism_(mechanism),
      motion_(motion),
      loops_(mechanism),
      islands_(mechanism),
      rates_(mechanism.rate_columns()),
      positions_(loops_.rows),
      all_rows_(loops_.rows.size(), true),
      q_(std::move(start)),
      within_(within),
      tolerance_(std::max(closed, loops_.units().rounding)) {
  if (motion.rows.empty()) return;
  contradiction_ = contradiction(loops_, motion.rows.front().t, q_, independent_pivot);
  tolerance_ = std::max(tolerance_, contradiction_.left);
  for (const LoopIsland& island : islands_.all()) {
    if (static_cast<int>(island.rates.size()) > most_rates)
      throw SceneError(
          "loops tie " + std::to_string(island.rates.size()) +
          " rates to each other; motions are closed by dense matrices, expected up to " +
          std::to_string(most_rates));
    given_.emplace_back();
    for (std::size_t i = 0; i < island.rates.size(); ++i)
      if (motion.given[static_cast<std::size_t>(island.rates[i])])
        given_.back().push_back(static_cast<int>(i));
  }
}

std::string ClosedMotion::at(double t) const {
  return "at t = " + reading::digits(t) + " s ";
}

/// Way of given coordinates to their target, in units; others zero.
VectorXd ClosedMotion::way_to(const VectorXd& q, const VectorXd& target) {
  VectorXd apart = target - q;
  for (const auto& body : mechanism_.tree().bodies)
    if (body.nq > body.nv) {  // −q̂ is the same turn
      const auto here = q.segment(body.q + body.nq - 4, 4);
      const auto there = target.segment(body.q + body.nq - 4, 4);
      if (here.dot(there) < 0) apart.segment(body.q + body.nq - 4, 4) = -there - here;
    }
  VectorXd rates = VectorXd::Zero(mechanism_.nv());
  loops_.evaluation().joint_rates(q.data(), apart.data(), rates.data());
  for (int i = 0; i < mechanism_.nv(); ++i)
    rates[i] = motion_.given[static_cast<std::size_t>(i)] ? rates[i] / loops_.units().rates[i] : 0;
  return rates;
}

/// δ with J δ = right and given entries nearest to `wanted`.
VectorXd ClosedMotion::nearest(const VectorXd& right, const VectorXd& wanted, double t) {
  VectorXd all(mechanism_.nv());
  for (std::size_t k = 0; k < given_.size(); ++k) {
    const LoopIsland& island = islands_.all()[k];
    if (island.rows.empty()) {
      if (given_[k].empty()) refuse_open(t, island);
      all[island.rates.front()] = wanted[island.rates.front()];
      continue;
    }
    VectorXd delta = island.particular(LoopIsland::part(island.rows, right));
    const auto count = static_cast<Eigen::Index>(given_[k].size());
    MatrixXd EN(count, island.freedoms());
    VectorXd left(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const int place = given_[k][static_cast<std::size_t>(i)];
      EN.row(i) = island.N.row(place);
      left[i] = wanted[island.rates[static_cast<std::size_t>(place)]] - delta[place];
    }
    if (island.freedoms() > 0) {
      if (count < island.freedoms()) refuse_open(t, island);
      Eigen::ColPivHouseholderQR<MatrixXd> qr(EN);
      qr.setThreshold(independent_pivot);
      if (qr.rank() < island.freedoms()) refuse_open(t, island);
      delta += island.N * qr.solve(left);
    }
    LoopIsland::put(island.rates, delta, all);
  }
  return all;
}

/// Refuses a motion that leaves N y open, E N y = 0.
void ClosedMotion::refuse_open(double t, const LoopIsland& island) {
  const auto k = static_cast<std::size_t>(&island - islands_.all().data());
  const int freedoms = island.freedoms();
  MatrixXd EN(static_cast<Eigen::Index>(given_[k].size()), freedoms);
  for (std::size_t i = 0; i < given_[k].size(); ++i)
    EN.row(static_cast<Eigen::Index>(i)) = island.N.row(given_[k][i]);
  MatrixXd open = MatrixXd::Identity(freedoms, freedoms);
  int count = freedoms;
  if (EN.rows() > 0) {
    Eigen::FullPivLU<MatrixXd> lu(EN);
    lu.setThreshold(independent_pivot);
    open = lu.kernel();
    count = freedoms - static_cast<int>(lu.rank());
  }
  // Largest rates in the open motions, one for each freedom.
  Eigen::ColPivHouseholderQR<MatrixXd> moves((island.N * open).transpose());
  std::vector<std::string> names, joints;
  for (int i = 0; i < count; ++i) {
    const int rate = island.rates[static_cast<std::size_t>(moves.colsPermutation().indices()[i])];
    if (std::string name = coordinate_of_rate(mechanism_, rate); !name.empty()) {
      names.push_back(std::move(name));
      continue;
    }
    for (const auto& body : mechanism_.tree().bodies)
      if (rate >= body.u && rate < body.u + body.nv &&
          std::find(joints.begin(), joints.end(), body.joint) == joints.end())
        joints.push_back(body.joint);
  }
  throw SceneError(
      at(t) + "the motion leaves " + std::to_string(count) + (count == 1 ? " degree" : " degrees") +
      " of freedom open; expected as many more coordinates with a motion, or held" +
      (names.empty() ? "" : ", such as " + reading::all_in_quotes(names)) +
      (joints.empty() ? ""
                      : "; those of " + reading::all_in_quotes(joints) + " take a motion alone"));
}

double ClosedMotion::missed(const VectorXd& wanted, const VectorXd& got, int* worst) const {
  double largest = 0;
  for (const auto& island : islands_.all())
    for (const int i : island.rates)
      if (motion_.given[static_cast<std::size_t>(i)]) {
        const double apart = std::abs(wanted[i] - got[i]);
        if (!(apart <= largest)) {
          largest = apart;
          *worst = i;
        }
      }
  return largest;
}

/// The coordinate that a rate moves; where the two differ in kind, the joint.
Column ClosedMotion::coordinate_of(int rate) const {
  const std::vector<Column> coordinates = mechanism_.coordinate_columns();
  for (const Tree::Body& b : mechanism_.tree().bodies) {
    if (rate < b.u || rate >= b.u + b.nv) continue;
    if (!b.has_quaternion()) return coordinates[static_cast<std::size_t>(b.q + rate - b.u)];
    return {b.joint, b.is_length(rate - b.u) ? "m" : "rad"};
  }
  return coordinates[static_cast<std::size_t>(rate)];  // of formulas
}

void ClosedMotion::refuse(double t, const VectorXd& missing, int worst, const Column& column) {
  const LoopIsland& island = islands_.of(worst);
  VectorXd pull = VectorXd::Zero(static_cast<Eigen::Index>(island.rates.size()));
  for (std::size_t i = 0; i < island.rates.size(); ++i)
    if (motion_.given[static_cast<std::size_t>(island.rates[i])])
      pull[static_cast<Eigen::Index>(i)] = missing[island.rates[i]];
  Eigen::Index row = 0;
  island.multipliers(pull).cwiseAbs().maxCoeff(&row);
  const std::string& loop =
      mechanism_.rows()[static_cast<std::size_t>(island.rows[static_cast<std::size_t>(row)])].loop;
  char apart[32];
  std::snprintf(apart, sizeof apart, "%.3g",
                std::abs(missing[worst]) * loops_.units().rates[worst]);
  throw SceneError(at(t) + "the " + loop_word(mechanism_) + "s cannot follow the motion: " +
                   loop_word(mechanism_) + " '" + loop + "' keeps '" + column.name + "' " + apart +
                   " " + column.unit + " from what is given; expected a motion that the " +
                   loop_word(mechanism_) + "s allow");
}

/// Φ less contradictions, in units.
VectorXd ClosedMotion::gap(double t, const VectorXd& q) {
  return loops_.gap(t, q) - contradiction_.open;
}

/// Newton's method; false where it fails. On its way equations that depend on others at every
/// closed pose do so but for the gap, and would hold what is given away from its target. So the
/// rank is that of the pose it starts from, which is closed; unless it is singular there, when the
/// equations left out stay open.
bool ClosedMotion::close(double t, const VectorXd& target, VectorXd& q) {
  const VectorXd start = q;
  if (close(t, target, true, q)) return true;
  q = start;
  return close(t, target, false, q);
}

bool ClosedMotion::close(double t, const VectorXd& target, bool rank_kept, VectorXd& q) {
  for (int k = 0; k < most_corrections; ++k) {
    const VectorXd gap = this->gap(t, q);
    const double open = gap.size() > 0 ? gap.cwiseAbs().maxCoeff() : 0;
    if (!std::isfinite(open)) return false;
    islands_.factor(loops_, contradiction_.pivot, rank_kept && k > 0);
    VectorXd step = nearest(-gap, way_to(q, target), t);
    const double length = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
    if (!std::isfinite(length)) return false;
    if (length > 1) step /= length;
    q = loops_.moved(q, step);
    if (length > settled || open > std::max(settled, tolerance_)) continue;
    const VectorXd after = this->gap(t, q);
    return after.size() == 0 || after.cwiseAbs().maxCoeff() <= tolerance_;
  }
  return false;
}

void ClosedMotion::go_to(std::size_t number, VectorXd& q, VectorXd& u, VectorXd& udot) {
  const GivenMotion::Row& row = motion_.rows[number];
  const double t = row.t;
  loops_.rows = positions_;
  loops_.gap(t, q_);
  const VectorXd way = way_to(q_, row.q);
  const double far = way.size() > 0 ? way.cwiseAbs().maxCoeff() : 0;
  const int steps = std::max(1, static_cast<int>(std::ceil(far / longest_step)));
  const VectorXd from = q_;
  const auto moved = [&](const VectorXd& q_from, const VectorXd& step) {
    loops_.evaluation().place(t, q_from.data());
    return loops_.moved(q_from, step);
  };
  for (int k = 1; k <= steps; ++k) {
    const double part = static_cast<double>(k) / steps;
    const VectorXd target = k == steps ? row.q : moved(from, part * way);
    if (close(t, target, q_)) continue;
    const VectorXd gap = this->gap(t, q_);
    Eigen::Index worst = 0;
    const double open = gap.size() > 0 ? gap.cwiseAbs().maxCoeff(&worst) : 0;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", open);
    throw SceneError(at(t) + "the " + loop_word(mechanism_) +
                     "s cannot follow the motion: " + loop_word(mechanism_) + " '" +
                     (mechanism_.m() > 0 ? mechanism_.rows()[static_cast<std::size_t>(worst)].loop
                                         : std::string()) +
                     "' stays open by " + text +
                     " lengths of the scene; expected a motion that it can reach");
  }
  int worst = 0;
  const VectorXd none = VectorXd::Zero(mechanism_.nv());
  const VectorXd left = way_to(q_, row.q);
  const double gap = missed(left, none, &worst);
  if (gap > within_) refuse(t, left, worst, coordinate_of(worst));
  gap_ = std::max(gap_, gap);

  // Rates, with nonholonomic rows; then accelerations.
  loops_.rows = all_rows_;
  loops_.gap(t, q_);
  islands_.factor(loops_, contradiction_.pivot);
  const VectorXd& unit = loops_.units().rates;
  Evaluation<double>& e = loops_.evaluation();
  VectorXd rate(mechanism_.m()), force(mechanism_.nv());
  e.move(nullptr);
  e.velocities(rate.data());
  const VectorXd v = row.u.cwiseQuotient(unit);
  const VectorXd scaled_rates = nearest(-loops_.in_units(rate), v, t);
  const double rate_gap = missed(v, scaled_rates, &worst);
  const double largest = scaled_rates.size() > 0 ? scaled_rates.cwiseAbs().maxCoeff() : 0;
  if (rate_gap > 1e-3 * (largest + std::abs(v[worst])) && rate_gap > within_)
    refuse(t, v - scaled_rates, worst, rates_[static_cast<std::size_t>(worst)]);
  u = scaled_rates.cwiseProduct(unit);
  e.move(u.data());
  e.joint_forces(q_.data(), u.data(), none.data(), nullptr, force.data());
  e.accelerations(rate.data());
  udot = nearest(-loops_.in_units(rate), row.udot.cwiseQuotient(unit), t).cwiseProduct(unit);
  q = q_;
}

}  // namespace momenta
