#pragma once
// A mechanism moved through its poses: one coordinate, or several in proportion, swept by loops
// that stay closed, and where that leads. No time and no forces.
//
// The curve of poses (pose_curve.h) is followed from the start, straight across change points and
// round dead points, until the coordinate is where it was asked to go or the curve is closed. Found
// on it, each to rounding, are
//
//   dead points    τ_s = 0: the swept coordinate turns back; whatever drives it there has no say,
//   change points  det B = 0: another curve of poses crosses, of another assembly,
//   limits         τ_i = 0: a coordinate's largest and smallest values.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// What is swept, and how far.
struct MoveRequest {
  /// Coordinates "O" or "J.q2", and how far they go in proportion [rad or m].
  std::vector<std::pair<std::string, double>> sweep;
  std::vector<std::string> hold;  ///< what stays as it is at the start (held_coordinate.h)
  std::string
      output;  ///< a coordinate: how well force is passed to it (transmission.h); empty: none
  std::optional<double> to;  ///< where the first ends [rad or m]; none: once along the curve
  double by = 0;  ///< of the first from row to row [rad or m]; 0: a degree, or a 100th of a length
  bool singular_values = false;  ///< of J at each row
  long most_rows = 100000;       ///< poses, at the most
};

/// A row of what was found.
struct MovedPose {
  /// Why a pose is a row.
  enum class Kind {
    sample,       ///< where s was asked for
    dead_point,   ///< s turns back
    change_point  ///< another curve crosses
  };
  Kind kind = Kind::sample;  ///< why it is a row
  double s = 0;              ///< how far the first swept coordinate has come [rad or m]
  int branch = 0;            ///< sign of det B(e_s); 0: at a dead point
  Eigen::VectorXd q;         ///< nq
  /// u (nv) for the first swept coordinate at unit rate: transmission ratios [rad/s or m/s]. Empty
  /// at dead and change points.
  Eigen::VectorXd u;
  /// u̇ (nv) with it: how the ratios change, by the swept coordinate. Empty where u is.
  Eigen::VectorXd udot;
  std::vector<double> markers;       ///< x y z [m] and its derivatives by s, of each; as q, u
  double transmission_angle = 0;     ///< of the output [rad]; NaN where there is none
  double joint_force = 0;            ///< largest for a unit effort on the output; NaN: none told
  double reciprocal_condition = -1;  ///< smallest over largest singular value of J; −1: not asked
};
/// "sample", "dead point", "change point".
const char* name_of(MovedPose::Kind kind);

/// How far a coordinate goes on the curve.
struct Reach {
  double least = 0;    ///< [rad or m]
  double most = 0;     ///< [rad or m]
  int turns_back = 0;  ///< how often it comes to rest relative to s
};

/// The poses found, and what the coordinates do along them.
struct MoveResult {
  /// How following the curve ended.
  enum class End {
    closed,   ///< back at the start, moving the same way
    reached,  ///< where it was asked to go
    stopped   ///< before that
  };
  End end = End::stopped;           ///< how it ended
  std::string why;                  ///< where it stopped; else empty
  std::string scene;                ///< its name
  std::vector<std::string> idle;    ///< balls whose turn moves nothing else, and is held
  std::vector<Column> coordinates;  ///< of q
  std::vector<Column> rates;        ///< of u
  std::vector<Column> markers;      ///< of MovedPose::markers
  std::size_t swept = 0;            ///< place of the first among `coordinates`
  /// A value along the curve, and where.
  struct Extreme {
    double value = std::numeric_limits<double>::quiet_NaN();  ///< NaN: nowhere
    double s = 0;                                             ///< as in MovedPose
  };
  /// What is passed to the output, located between poses.
  struct Passed {
    Extreme least_angle;    ///< transmission angle [rad]
    Extreme largest_angle;  ///< [rad]
    Extreme least_force;    ///< joint force for a unit effort
    Extreme largest_force;  ///< infinite at most dead points
  };
  Passed passed;                 ///< of the output
  int output = -1;               ///< place of the output among `coordinates`; −1: none
  int output_rate = -1;          ///< and among `rates`
  double start = 0;              ///< its value at s = 0
  std::vector<MovedPose> poses;  ///< along the curve
  std::vector<Reach> reach;      ///< of each coordinate
  /// How many there are among the poses.
  int dead_points() const { return count(MovedPose::Kind::dead_point); }
  /// How many there are among the poses.
  int change_points() const { return count(MovedPose::Kind::change_point); }

 private:
  int count(MovedPose::Kind kind) const;
};
/// "closed", "reached", "stopped".
const char* name_of(MoveResult::End end);

/// From a consistent pose q (nq); drives stand at t [s].
/// @throws SceneError where a coordinate is not known or is part of a quaternion, where it cannot
/// move, or where freedoms are left: the sentence names coordinates to hold
/// Cost: two or three dense factorisations of nv + 1 a row.
MoveResult move(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                const MoveRequest& request);

}  // namespace momenta
