#pragma once
// A drive of a scene, and the functions by points that its formulas call.

#include <momenta/core/scene/location.h>

#include <string>
#include <vector>

namespace momenta {

/// A function of one number by points, which formulas call by its name.
struct FunctionSpec {
  std::string name;  ///< letters, digits and _, a letter first; none of those formulas have
  std::string kind = "cubic";  ///< cubic monotone linear: between the points; straight outside
  std::vector<double> x;       ///< increasing, at least two
  std::vector<double> y;       ///< one for each x
  Location at;                 ///< where the file has it
};

/// A drive: one number of a joint or of a loop as a function of time.
///
/// A drive of a joint prescribes a coordinate, counted from 0 as in the joint's q. In cylindrical,
/// universal and planar joints any coordinate can be driven, each by its own drive. A driven
/// spherical joint has drives for all of roll, pitch and yaw, which are coordinates 0, 1, 2: child
/// axes = Rz(yaw) Ry(pitch) Rx(roll) in the joint frame. A driven free joint has drives for all of
/// x, y, z, roll, pitch, yaw; on a body without mass it is a moving base.
///
/// A drive of a loop prescribes a coordinate, counted as in a joint of the same kind
/// (driven_coordinates_of), which is then no longer free; or a component of `origin_parent`, which
/// then moves. The value that the loop itself gives for a driven number has no effect.
///
///   - polynomial: f = Σ cᵢ tⁱ, coefficients = [c0, c1, ...]
///   - harmonic: f = offset + amplitude sin(ω t + φ), with ω = frequency [rad/s], φ = phase [rad]
///   - step: `from` → `to` between start and start + duration, by the quintic 10x³ − 15x⁴ + 6x⁵
///   - table: natural cubic spline through (times, values); constant slope outside
///   - formula: `law`, of t
/// MotionLaw (core/scene/drive.h) evaluates these laws.
struct DriveSpec {
  std::string joint;   ///< or `loop`: one of them is empty
  std::string loop;    ///< or `joint`
  int coordinate = 0;  ///< which of that joint or loop, from 0
  std::string origin;  ///< loops: "x", "y" or "z" of origin_parent instead of a coordinate
  std::string kind;    ///< polynomial harmonic step table formula
  std::vector<double> coefficients;     ///< polynomial: [rad or m, by s to the power]
  double offset = 0;                    ///< harmonic [rad or m]
  double amplitude = 0;                 ///< harmonic [rad or m]
  double frequency = 0;                 ///< harmonic: ω [rad/s]
  double phase = 0;                     ///< harmonic: φ [rad]
  double from = 0;                      ///< step [rad or m]
  double to = 0;                        ///< step [rad or m]
  double start = 0;                     ///< step [s]
  double duration = 0;                  ///< step [s]
  std::vector<double> times;            ///< table: ascending [s]
  std::vector<double> values;           ///< table: one for each time [rad or m]
  std::string law;                      ///< formula, of t [rad or m]
  std::vector<FunctionSpec> functions;  ///< formula: those of the scene that it calls
  Location at;                          ///< where the file has it
};

}  // namespace momenta
