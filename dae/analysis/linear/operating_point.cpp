#include <momenta/core/scene/joint_kind.h>
#include <momenta/core/text/number_text.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/linear/operating_point.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace momenta {
namespace {

/// Whether the drive prescribes one coordinate of a joint that has no quaternion.
bool can_be_freed(const Scene& scene, const DriveSpec& drive) {
  const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                  [&](const JointSpec& j) { return j.name == drive.joint; });
  return joint != scene.joints.end() && scalar_coordinates_of(joint->kind) > 0;
}

using Place = std::pair<std::string, int>;  // joint, part or coordinate

/// A body by joint and coordinate: each part of a joint moves another one.
Place place_of(const Tree::Body& b) {
  return {b.joint, b.coordinate};
}

}  // namespace

void expect_between_stops(const Mechanism& mechanism, const Eigen::VectorXd& q) {
  const Tree& tree = mechanism.tree();
  for (const JointSpec& joint : mechanism.scene().joints) {
    if (!joint.restitution) continue;
    const Tree::Body& b = tree.bodies[static_cast<std::size_t>(tree.carried_by(joint.name))];
    if (b.nv == 0) continue;
    const auto [low, high] = *joint.limits;
    const double limit = q[b.q] - low < high - q[b.q] ? low : high,
                 rounding = 1e-9 * (1 + std::abs(limit));
    if (q[b.q] > low + rounding && q[b.q] < high - rounding) continue;
    throw SceneError(mechanism.scene().where(joint.at) + "joint " + reading::in_quotes(joint.name) +
                     " is at " + compact(q[b.q], 6) + ", at or beyond its rigid stop at " +
                     compact(limit, 6) +
                     ", which small motions would meet; expected a state between rigid stops, or "
                     "soft ones (stop_stiffness)");
  }
}

OperatingPoint operating_point(const Mechanism& mechanism, const Start& at) {
  expect_between_stops(mechanism, at.q);
  OperatingPoint point;
  Scene scene = mechanism.scene();
  std::vector<DriveSpec> kept;
  for (const DriveSpec& drive : scene.drives)
    if (!can_be_freed(scene, drive)) kept.push_back(drive);
  scene.drives = std::move(kept);
  point.freed = std::make_unique<const Mechanism>(std::move(scene), mechanism.options());
  point.t = at.t;
  if (mechanism.scene().lagrangian) {
    point.q = at.q;
    point.u = at.u;
    for (int i = 0; i < mechanism.nv(); ++i) point.free.push_back(i);
    return point;
  }
  const Tree &from = mechanism.tree(), &to = point.freed->tree();
  point.q = to.q0;
  point.u = to.u0;
  std::map<int, double> accelerations;  // by place in u
  std::map<Place, const Tree::Body*> by_place;
  for (const Tree::Body& b : from.bodies) by_place[place_of(b)] = &b;
  for (const Tree::Body& b : to.bodies) {
    const Tree::Body& given = *by_place.at(place_of(b));
    for (int i = 0; i < given.nq; ++i) point.q[b.q + i] = at.q[given.q + i];
    for (int i = 0; i < given.nv; ++i) point.u[b.u + i] = at.u[given.u + i];
    const bool prescribed = given.drive >= 0 && b.nv > 0;
    if (prescribed) {
      from.drives[static_cast<std::size_t>(given.drive)].evaluate(at.t, point.q[b.q], point.u[b.u],
                                                                  accelerations[b.u]);
    }
    for (int i = 0; i < b.nv && !prescribed; ++i) point.free.push_back(b.u + i);
  }
  std::sort(point.free.begin(), point.free.end());
  point.driven_accelerations.resize(static_cast<Eigen::Index>(accelerations.size()));
  for (const auto& [place, acceleration] : accelerations) {
    point.driven_accelerations[static_cast<Eigen::Index>(point.driven.size())] = acceleration;
    point.driven.push_back(place);
  }
  return point;
}

std::vector<Column> displacement_columns(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian) return mechanism.coordinate_columns();
  std::vector<Column> columns = mechanism.rate_columns();
  for (Column& c : columns) {
    char& letter = c.name[c.name.rfind('.') + 1];
    letter = letter == 'u' ? 'q' : letter == 'v' ? 'd' : 'r';
    c.unit.erase(c.unit.find('/'));
  }
  return columns;
}

std::vector<Column> force_columns_of(const Mechanism& mechanism) {
  std::vector<Column> columns = mechanism.rate_columns();
  if (mechanism.scene().lagrangian) {
    const auto coordinates = mechanism.coordinate_columns();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const std::string& unit = coordinates[i].unit;
      columns[i] = {coordinates[i].name + ".tau", unit == "m"     ? "N"
                                                  : unit == "rad" ? "N m"
                                                                  : "J/(" + unit + ")"};
    }
    return columns;
  }
  for (Column& c : columns) {
    const std::size_t dot = c.name.rfind('.');
    const std::string rest = c.name.substr(dot + 2);
    const char letter = c.name[dot + 1];
    c.name = c.name.substr(0, dot) +
             (letter == 'u'   ? ".tau"
              : letter == 'v' ? ".force_"
                              : ".torque_") +
             rest;
    c.unit = c.unit == "m/s" ? "N" : "N m";
  }
  return columns;
}

}  // namespace momenta
