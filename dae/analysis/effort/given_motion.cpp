#include <momenta/core/scene/drive.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/given_motion.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>

#include <algorithm>
#include <optional>

namespace momenta {
namespace {

using Eigen::VectorXd;
constexpr int neighbours = 7;

/// Consecutive places in q and u given together: one coordinate, or all of a joint with a
/// quaternion.
struct Together {
  std::string joint;
  int q, nq, u, nv;
};

std::vector<Together> together(const Mechanism& mechanism) {
  std::vector<Together> all;
  if (mechanism.scene().lagrangian)
    for (int i = 0; i < mechanism.nq(); ++i) all.push_back({"", i, 1, i, 1});
  for (const auto& b : mechanism.tree().bodies)
    if (b.nq == b.nv)
      for (int i = 0; i < b.nq; ++i) all.push_back({b.joint, b.q + i, 1, b.u + i, 1});
    else
      all.push_back({b.joint, b.q, b.nq, b.u, b.nv});
  return all;
}

class Table {
 public:
  explicit Table(const Reference& r) : r_(r) {}

  /// @throws SceneError where the column's unit differs
  std::optional<std::size_t> find(const Column& column) const {
    for (std::size_t i = 0; i < r_.columns().size(); ++i) {
      const std::string& found = r_.columns()[i];
      if (found == column.label()) return i;
      if (found.substr(0, found.find(" [")) == column.name)
        throw SceneError(r_.file() + ":1: found column '" + found + "'; expected '" +
                         column.label() + "'");
    }
    return std::nullopt;
  }
  /// Places of all columns; empty: none is there. @throws SceneError where some are
  std::vector<std::size_t> find_all(const std::vector<Column>& columns, int first,
                                    int count) const {
    std::vector<std::size_t> places;
    std::string missing;
    for (int i = first; i < first + count; ++i) {
      const Column& column = columns[static_cast<std::size_t>(i)];
      if (const auto place = find(column))
        places.push_back(*place);
      else
        missing = column.label();
    }
    if (!places.empty() && !missing.empty())
      throw SceneError(r_.file() + ":1: column '" + missing +
                       "' is missing; expected all of its joint or none");
    return places;
  }
  double operator()(std::size_t row, std::size_t column) const { return r_.values()[row][column]; }
  const Reference& file() const { return r_; }

 private:
  const Reference& r_;
};

/// Rows of the difference at each row, and their weights.
class Differences {
 public:
  explicit Differences(const std::vector<double>& t) {
    const int n = static_cast<int>(t.size()), width = std::min(neighbours, n);
    for (int i = 0; i < n; ++i) {
      const int first = std::clamp(i - width / 2, 0, n - width);
      first_.push_back(first);
      weights_.push_back(
          derivative_weights(std::vector<double>(t.begin() + first, t.begin() + first + width),
                             t[static_cast<std::size_t>(i)]));
    }
  }
  /// Derivative of order 1 or 2 of value(row) at a row.
  template <class Value>
  double operator()(std::size_t row, int order, Value value) const {
    double sum = 0;
    const Eigen::MatrixXd& w = weights_[row];
    for (Eigen::Index j = 0; j < w.rows(); ++j)
      sum += w(j, order - 1) * value(static_cast<std::size_t>(first_[row] + j));
    return sum;
  }

 private:
  std::vector<int> first_;
  std::vector<Eigen::MatrixXd> weights_;
};

class Giver {
 public:
  Giver(const Mechanism& mechanism, const VectorXd& start, const MotionSource& source)
      : mechanism_(mechanism), start_(start), source_(source) {
    motion_.given.assign(static_cast<std::size_t>(mechanism.nv()), false);
    const std::vector<double>& times = source.table ? source.table->times() : source.times;
    for (const double t : times)
      motion_.rows.push_back(
          {t, start, VectorXd::Zero(mechanism.nv()), VectorXd::Zero(mechanism.nv())});
  }

  GivenMotion give() {
    if (source_.table) take_table();
    for (const DriveSpec& drive : source_.drives) take_drive(drive);
    if (source_.poses_alone && source_.drives.empty() && !source_.table && source_.hold.empty())
      motion_.given.assign(motion_.given.size(), true);
    for (const std::string& name : source_.hold) {
      const auto [q, u] = coordinate_named(mechanism_, name);
      if (given(u))
        throw SceneError("coordinate '" + name +
                         "' is held, and has a motion; expected one of both");
      motion_.given[static_cast<std::size_t>(u)] = true;
    }
    if (source_.poses_alone)
      for (GivenMotion::Row& row : motion_.rows) {
        row.u.setZero();
        row.udot.setZero();
      }
    return std::move(motion_);
  }

 private:
  bool given(int u) const { return motion_.given[static_cast<std::size_t>(u)]; }

  void take_drive(const DriveSpec& drive) {
    expect_effort_of(mechanism_.scene(), drive);
    const Tree& tree = mechanism_.tree();
    const auto& body =
        tree.bodies[static_cast<std::size_t>(tree.part_of(drive.joint, drive.coordinate))];
    if (given(body.u)) return;
    const MotionLaw law(drive);
    for (GivenMotion::Row& row : motion_.rows)
      law.evaluate(row.t, row.q[body.q], row.u[body.u], row.udot[body.u]);
    motion_.given[static_cast<std::size_t>(body.u)] = true;
  }

  void take_table() {
    const Table table(*source_.table);
    const auto coordinates = mechanism_.coordinate_columns(), rates = mechanism_.rate_columns();
    std::vector<Column> accelerations;
    for (const Column& rate : rates) accelerations.push_back(acceleration_column(rate));
    bool any = false;
    for (const Together& part : together(mechanism_)) {
      const auto q = table.find_all(coordinates, part.q, part.nq);
      const auto u = table.find_all(rates, part.u, part.nv);
      const auto udot = table.find_all(accelerations, part.u, part.nv);
      if (q.empty()) continue;
      any = true;
      std::fill_n(motion_.given.begin() + part.u, part.nv, true);
      for (std::size_t i = 0; i < motion_.rows.size(); ++i)
        for (int k = 0; k < part.nq; ++k)
          motion_.rows[i].q[part.q + k] = table(i, q[static_cast<std::size_t>(k)]);
      if (part.nq != part.nv)
        for (std::size_t i = 0; i < motion_.rows.size(); ++i) expect_quaternion(part, i);
      if (!source_.poses_alone) take_rates(part, table, q, u, udot);
      normalise(part);
    }
    if (!any)
      throw SceneError(source_.table->file() + ":1: there is no column of a coordinate; expected " +
                       "for instance '" + coordinates.front().label() + "'");
  }

  void expect_quaternion(const Together& part, std::size_t row) const {
    const double length = motion_.rows[row].q.segment(part.q + part.nq - 4, 4).norm();
    if (!(std::abs(length - 1) < 1e-3))
      throw SceneError(source_.table->file() + ": the quaternion of joint '" + part.joint +
                       "' has length " + reading::digits(length) +
                       " at t = " + reading::digits(motion_.rows[row].t) + " s; expected 1");
  }

  void normalise(const Together& part) {
    if (part.nq != part.nv)
      for (GivenMotion::Row& row : motion_.rows) row.q.segment(part.q + part.nq - 4, 4).normalize();
  }

  void take_rates(const Together& part, const Table& table, const std::vector<std::size_t>& q,
                  const std::vector<std::size_t>& u, const std::vector<std::size_t>& udot) {
    if (!differences_ && (u.empty() || udot.empty())) {
      if (motion_.rows.size() < 3)
        throw SceneError(source_.table->file() + ": there are " +
                         std::to_string(motion_.rows.size()) +
                         " rows; expected 3 at least, or columns of rates and accelerations");
      differences_.emplace(source_.table->times());
    }
    for (std::size_t i = 0; i < motion_.rows.size(); ++i) {
      GivenMotion::Row& row = motion_.rows[i];
      if (u.empty() && part.nq != part.nv) {
        by_quaternion(part, table, q, i);
      } else {
        for (int k = 0; k < part.nv; ++k) {
          const auto at = static_cast<std::size_t>(k);
          const auto of = [&](const std::vector<std::size_t>& columns) {
            return [&table, column = columns[at]](std::size_t j) { return table(j, column); };
          };
          row.u[part.u + k] = u.empty() ? (*differences_)(i, 1, of(q)) : table(i, u[at]);
          row.udot[part.u + k] = u.empty()      ? (*differences_)(i, 2, of(q))
                                 : udot.empty() ? (*differences_)(i, 1, of(u))
                                                : 0;
        }
      }
      if (!udot.empty())
        for (int k = 0; k < part.nv; ++k)
          row.udot[part.u + k] = table(i, udot[static_cast<std::size_t>(k)]);
    }
  }

  /// u and u̇ of a joint with a quaternion, from its coordinates.
  void by_quaternion(const Together& part, const Table& table, const std::vector<std::size_t>& q,
                     std::size_t i) {
    GivenMotion::Row& row = motion_.rows[i];
    VectorXd first(part.nq), second(part.nq);
    const auto four = [&](std::size_t j) {
      Eigen::Vector4d all;
      for (int k = 0; k < 4; ++k) all[k] = table(j, q[static_cast<std::size_t>(part.nq - 4 + k)]);
      return all;
    };
    const Eigen::Vector4d here = four(i);
    for (int k = 0; k < part.nq; ++k) {
      const auto value = [&](std::size_t j) {
        const double x = table(j, q[static_cast<std::size_t>(k)]);
        return k >= part.nq - 4 && four(j).dot(here) < 0 ? -x : x;  // −q is the same turn
      };
      first[k] = (*differences_)(i, 1, value);
      second[k] = (*differences_)(i, 2, value);
    }
    // x = y/|y|: ẋ = (ẏ − x n)/|y| with n = d|y|/dt, ẍ = (ÿ − 2 ẋ n − x ṅ)/|y|; the part along x
    // turns nothing.
    const Eigen::Index at = part.nq - 4;
    const Eigen::Vector4d y = row.q.segment(part.q + at, 4), x = y.normalized();
    const Eigen::Vector4d ydot = first.segment(at, 4), yddot = second.segment(at, 4);
    const double n = x.dot(ydot);
    const Eigen::Vector4d xdot = (ydot - x * n) / y.norm();
    first.segment(at, 4) = xdot;
    second.segment(at, 4) = (yddot - 2 * n * xdot) / y.norm();
    if (!dual_) dual_ = mechanism_.evaluation<Dual8>();
    std::vector<Dual8> place(start_.begin(), start_.end()), rate(place.size(), Dual8(0.0)),
        u(static_cast<std::size_t>(mechanism_.nv()), Dual8(0.0));
    for (int k = 0; k < part.nq; ++k) {
      const auto to = static_cast<std::size_t>(part.q + k);
      place[to] = Dual8(k < at ? row.q[part.q + k] : x[k - at]);
      place[to].b[0] = first[k];
      rate[to] = Dual8(first[k]);
      rate[to].b[0] = second[k];
    }
    dual_->joint_rates(place.data(), rate.data(), u.data());
    for (int k = 0; k < part.nv; ++k) {
      row.u[part.u + k] = value_of(u[static_cast<std::size_t>(part.u + k)]);
      row.udot[part.u + k] = u[static_cast<std::size_t>(part.u + k)].b[0];
    }
  }

  const Mechanism& mechanism_;
  const VectorXd& start_;
  const MotionSource& source_;
  GivenMotion motion_;
  std::optional<Differences> differences_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
};

}  // namespace

void expect_effort_of(const Scene& scene, const DriveSpec& drive) {
  if (drive.joint.empty())
    throw SceneError(scene.where(drive.at) + "drive of loop '" + drive.loop +
                     "': efforts are found of drives of joints; expected a joint that is driven");
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const JointSpec& j) { return j.name == drive.joint; });
  if (scalar_coordinates_of(joint->kind) == 0)
    throw SceneError(scene.where(drive.at) + "drive of joint '" + drive.joint +
                     "': efforts of spherical and free joints are about axes of the child, not of "
                     "the angles that are driven; expected its motion as columns of a table");
}

Eigen::MatrixXd derivative_weights(const std::vector<double>& x, double z) {
  const auto n = static_cast<Eigen::Index>(x.size());
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, 3);  // by node, by order
  const auto at = [&](Eigen::Index i) { return x[static_cast<std::size_t>(i)]; };
  double before = 1, reach = at(0) - z;
  c(0, 0) = 1;
  for (Eigen::Index i = 1; i < n; ++i) {
    const Eigen::Index orders = std::min<Eigen::Index>(i, 2);
    double product = 1;
    const double reached = reach;
    reach = at(i) - z;
    for (Eigen::Index j = 0; j < i; ++j) {
      const double apart = at(i) - at(j);
      product *= apart;
      if (j == i - 1) {
        for (Eigen::Index k = orders; k > 0; --k)
          c(i, k) =
              before * (static_cast<double>(k) * c(i - 1, k - 1) - reached * c(i - 1, k)) / product;
        c(i, 0) = -before * reached * c(i - 1, 0) / product;
      }
      for (Eigen::Index k = orders; k > 0; --k)
        c(j, k) = (reach * c(j, k) - static_cast<double>(k) * c(j, k - 1)) / apart;
      c(j, 0) = reach * c(j, 0) / apart;
    }
    before = product;
  }
  return c.rightCols(2);
}

Column acceleration_column(const Column& rate) {
  return {rate.name + "dot", rate.unit.ends_with("/s") ? rate.unit + "^2" : rate.unit + "/s"};
}

GivenMotion given_motion(const Mechanism& mechanism, const VectorXd& start,
                         const MotionSource& source) {
  return Giver(mechanism, start, source).give();
}

}  // namespace momenta
