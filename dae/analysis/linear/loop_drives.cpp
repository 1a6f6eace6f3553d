#include <momenta/core/scene/drive.h>
#include <momenta/core/text/quoting.h>
#include <momenta/dae/analysis/effort/given_motion.h>
#include <momenta/dae/analysis/linear/loop_drives.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

const LoopSpec& loop_of(const Scene& scene, const DriveSpec& drive) {
  return *std::find_if(scene.loops.begin(), scene.loops.end(),
                       [&](const LoopSpec& l) { return l.name == drive.loop; });
}

bool is_number(const Scene& scene, const DriveSpec& drive) {
  const LoopKind kind = loop_of(scene, drive).kind;
  return drive.origin.empty() && (kind == LoopKind::distance || kind == LoopKind::coupler);
}

/// Whether a coordinate of the loop is an angle.
bool is_angle(const Scene& scene, const DriveSpec& drive) {
  if (!drive.origin.empty()) return false;
  switch (loop_of(scene, drive).kind) {
    case LoopKind::revolute:
    case LoopKind::universal:
    case LoopKind::spherical:
      return true;
    case LoopKind::cylindrical:
      return drive.coordinate == 1;
    case LoopKind::planar:
      return drive.coordinate == 2;
    default:
      return false;
  }
}

/// Whether a coupler's offset is in rad: all its coordinates are angles.
bool couples_angles(const Scene& scene, const LoopSpec& loop) {
  return std::all_of(loop.joints.begin(), loop.joints.end(), [&](const std::string& name) {
    const auto joint = std::find_if(scene.joints.begin(), scene.joints.end(),
                                    [&](const JointSpec& j) { return j.name == name; });
    return joint != scene.joints.end() && joint->kind != JointKind::prismatic;
  });
}

/// f + x + ḟ (t − t₀) + f̈ (t − t₀)²/2: the drive's motion at t₀, shifted.
DriveSpec shifted(const DriveSpec& drive, double t, double x) {
  double f = 0, rate = 0, second = 0;
  MotionLaw(drive).evaluate(t, f, rate, second);
  DriveSpec other;
  other.loop = drive.loop;
  other.coordinate = drive.coordinate;
  other.origin = drive.origin;
  other.at = drive.at;
  other.kind = "formula";
  const auto number = [](double a) { return "(" + reading::digits(a) + ")"; };
  const std::string since = "(t - " + number(t) + ")";
  other.law = number(f + x) + " + " + number(rate) + "*" + since + " + " + number(second / 2) +
              "*" + since + "^2";
  return other;
}

/// (Φ, Φ̇, Φ̈, Φ_qᵀλ but for terms without f), one below the other.
class Values {
 public:
  Values(const Mechanism& mechanism, double t, const VectorXd& q, const VectorXd& u,
         const VectorXd& udot, const VectorXd& lambda)
      : mechanism_(mechanism), t_(t), q_(q), u_(u), udot_(udot), lambda_(lambda) {}

  VectorXd at(int drive, double x) const {
    Scene scene = mechanism_.scene();
    DriveSpec& spec = scene.drives[static_cast<std::size_t>(drive)];
    spec = shifted(spec, t_, x);
    const Mechanism other(std::move(scene), mechanism_.options());
    const auto e = other.evaluation<double>();
    const Eigen::Index m = mechanism_.m(), nv = mechanism_.nv();
    VectorXd all(3 * m + nv);
    e->place(t_, q_.data());
    e->positions(all.data());
    e->move(u_.data());
    e->velocities(all.data() + m);
    e->joint_forces(q_.data(), u_.data(), udot_.data(), lambda_.data(), all.data() + 3 * m);
    e->accelerations(all.data() + 2 * m);
    return all;
  }

  VectorXd slope_of_slide(int drive) const {
    const double h = length_of(mechanism_.scene());
    return (at(drive, h) - at(drive, -h)) / (2 * h);
  }

  VectorXd slope_of_angle(int drive) const {
    VectorXd sum = VectorXd::Zero(3 * mechanism_.m() + mechanism_.nv());
    for (int k = 1; k <= 6; ++k) {
      const double x = (2 * k - 1) * std::numbers::pi / 6, s = std::sin(x / 2);
      sum += at(drive, x) * ((k % 2 == 1 ? 1 : -1) / (12 * s * s));
    }
    return sum;
  }

 private:
  const Mechanism& mechanism_;
  double t_;
  const VectorXd &q_, &u_, &udot_, &lambda_;
};

/// Columns for f of a length or of an offset: the only row of its loop.
void take_number(const Mechanism& mechanism, const DriveSpec& drive, double t, Eigen::Index column,
                 LoopDriveColumns& c) {
  const auto& rows = mechanism.rows();
  const auto row =
      std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.loop == drive.loop; }) -
      rows.begin();
  const MotionLaw law(drive);
  double f = 0, rate = 0, second = 0;
  if (loop_of(mechanism.scene(), drive).kind == LoopKind::coupler) {
    c.loops(row, column) = -1;
    return;
  }
  law.evaluate(0.0, f, rate, second);
  const double at_start = f;
  law.evaluate(t, f, rate, second);
  c.loops(row, column) = -f / at_start;
  c.loop_rates(row, column) = -rate / at_start;
  c.second_by_poses(row, column) = -second / at_start;
}

}  // namespace

std::vector<int> drives_of_loops_that_vary(const Scene& scene) {
  std::vector<int> places;
  for (std::size_t i = 0; i < scene.drives.size(); ++i) {
    const DriveSpec& drive = scene.drives[i];
    if (drive.loop.empty() || has_curves(loop_of(scene, drive))) continue;
    places.push_back(static_cast<int>(i));
  }
  return places;
}

std::vector<Column> columns_of_loop_drive(const Scene& scene, int place) {
  const DriveSpec& drive = scene.drives[static_cast<std::size_t>(place)];
  const LoopSpec& loop = loop_of(scene, drive);
  const bool angle =
      is_angle(scene, drive) || (loop.kind == LoopKind::coupler && couples_angles(scene, loop));
  const std::string unit = angle ? "rad" : "m", name = drive.loop + ".";
  if (!drive.origin.empty())
    return {{name + drive.origin, unit},
            {name + "v" + drive.origin, unit + "/s"},
            {name + "a" + drive.origin, unit + "/s^2"}};
  const bool several = driven_coordinates_of(loop.kind) > 1;
  const std::string which = several ? std::to_string(drive.coordinate + 1) : "";
  const Column rate{name + "u" + which, unit + "/s"};
  return {{name + "q" + which, unit}, rate, acceleration_column(rate)};
}

LoopDriveColumns loop_drive_columns(const Mechanism& mechanism, const std::vector<int>& drives,
                                    double t, const VectorXd& q, const VectorXd& u,
                                    const VectorXd& udot, const VectorXd& lambda) {
  const Eigen::Index m = mechanism.m(), nv = mechanism.nv();
  const auto count = static_cast<Eigen::Index>(drives.size());
  LoopDriveColumns c;
  for (MatrixXd* a : {&c.loops, &c.loop_rates, &c.second_by_poses}) a->setZero(m, count);
  c.forces.setZero(nv, count);
  const Values values(mechanism, t, q, u, udot, lambda);
  const Scene& scene = mechanism.scene();
  for (Eigen::Index k = 0; k < count; ++k) {
    const int place = drives[static_cast<std::size_t>(k)];
    const DriveSpec& drive = scene.drives[static_cast<std::size_t>(place)];
    if (is_number(scene, drive)) {
      take_number(mechanism, drive, t, k, c);
      continue;
    }
    const VectorXd slope =
        is_angle(scene, drive) ? values.slope_of_angle(place) : values.slope_of_slide(place);
    c.loops.col(k) = slope.head(m);
    c.loop_rates.col(k) = slope.segment(m, m);
    c.second_by_poses.col(k) = slope.segment(2 * m, m);
    c.forces.col(k) = slope.tail(nv);
  }
  return c;
}

}  // namespace momenta
