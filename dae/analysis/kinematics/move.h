#pragma once
// Motion of a mechanism through its poses, without time and forces: one coordinate, or several in
// proportion, swept with loops closed.
//
// The curve of poses (pose_curve.h) is followed from the start, straight across change points and
// round dead points, until the coordinate reaches its goal or the curve is closed. Found on it,
// each to rounding, are
//
//   dead points    τ_s = 0: the swept coordinate turns back; whatever drives it there has no say,
//   change points  det B = 0: another curve of poses crosses, of another assembly,
//   limits         τ_i = 0: a coordinate's largest and smallest values.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Request: swept coordinates and their range.
struct MoveRequest {
  /// Coordinates "O" or "J.q2", and how far they go in proportion [rad or m].
  std::vector<std::pair<std::string, double>> sweep;
  std::vector<std::string> hold;  ///< functions of the pose held at their start (held_coordinate.h)
  std::string output;             ///< coordinate that takes the force (transmission.h); empty: none
  std::optional<double> to;  ///< end of the first coordinate [rad or m]; none: once along the curve
  double by = 0;  ///< step of the first from row to row [rad or m]; 0: a degree, or a 100th of a
                  ///< length
  bool singular_values = false;  ///< singular values of J at each row
  long most_rows = 100000;       ///< poses, at the most
};

/// A row of the result.
struct MovedPose {
  /// Why a pose is a row.
  enum class Kind {
    sample,       ///< s was asked for
    dead_point,   ///< s turns back
    change_point  ///< another curve crosses
  };
  Kind kind = Kind::sample;  ///< why it is a row
  double s = 0;              ///< way of the first swept coordinate [rad or m]
  int branch = 0;            ///< sign of det B(e_s); 0: at a dead point
  Eigen::VectorXd q;         ///< nq
  /// u (nv) with the first swept coordinate at unit rate: transmission ratios [rad/s or m/s]. Empty
  /// at dead and change points.
  Eigen::VectorXd u;
  /// u̇ (nv) at that rate: derivative of the ratios by the swept coordinate. Empty where u is.
  Eigen::VectorXd udot;
  std::vector<double> markers;       ///< x y z [m] and derivatives by s of each; as q, u
  double transmission_angle = 0;     ///< angle at the output [rad]; NaN: none
  double joint_force = 0;            ///< largest for a unit effort on the output; NaN: none
  double reciprocal_condition = -1;  ///< smallest over largest singular value of J; −1: not asked
};
/// "sample", "dead point", "change point".
const char* name_of(MovedPose::Kind kind);

/// Range of a coordinate on the curve.
struct Reach {
  double least = 0;    ///< [rad or m]
  double most = 0;     ///< [rad or m]
  int turns_back = 0;  ///< rests relative to s
};

/// The poses found, and what the coordinates do along them.
struct MoveResult {
  /// How following the curve ended.
  enum class End {
    closed,   ///< back at the start, moving the same way
    reached,  ///< at the goal
    stopped   ///< before the goal
  };
  End end = End::stopped;           ///< how it ended
  std::string why;                  ///< empty unless stopped
  std::string scene;                ///< its name
  std::vector<std::string> idle;    ///< balls whose idle turn is held
  std::vector<Column> coordinates;  ///< names of q
  std::vector<Column> rates;        ///< names of u
  std::vector<Column> markers;      ///< names of MovedPose::markers
  std::size_t swept = 0;            ///< place of the first
  /// Extreme value along the curve, and its place.
  struct Extreme {
    double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: nowhere
    double s = 0;  ///< how far the first swept coordinate has come [rad or m]
  };
  /// Extremes at the output, located between poses.
  struct Passed {
    Extreme least_angle;    ///< transmission angle [rad]
    Extreme largest_angle;  ///< [rad]
    Extreme least_force;    ///< joint force for a unit effort
    Extreme largest_force;  ///< infinite at most dead points
  };
  Passed passed;                 ///< of the output
  int output = -1;               ///< place of the output among `coordinates`; −1: none
  int output_rate = -1;          ///< place of the output among `rates`; −1: none
  double start = 0;              ///< first swept coordinate at s = 0
  std::vector<MovedPose> poses;  ///< along the curve
  std::vector<Reach> reach;      ///< reach by coordinate
  /// Number of dead points among the poses.
  int dead_points() const { return count(MovedPose::Kind::dead_point); }
  /// Number of change points among the poses.
  int change_points() const { return count(MovedPose::Kind::change_point); }

 private:
  int count(MovedPose::Kind kind) const;
};
/// "closed", "reached", "stopped".
const char* name_of(MoveResult::End end);

/// Starts at a consistent pose q (nq); drives stand at t [s].
/// @throws SceneError where a coordinate is unknown, is part of a quaternion or cannot move, or
/// with coordinates to hold where freedoms are left
/// Cost: two or three dense factorisations of nv + 1 a row.
MoveResult move(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                const MoveRequest& request);

}  // namespace momenta
