#pragma once
// A drive of a scene, and the functions by points in its formulas.

#include <momenta/core/scene/location.h>

#include <string>
#include <vector>

namespace momenta {

/// A function of one number by points, called by name in formulas.
struct FunctionSpec {
  std::string name;            ///< letters, digits and _, a letter first; no function of formulas
  std::string kind = "cubic";  ///< interpolation: cubic monotone linear; straight outside
  std::vector<double> x;       ///< increasing, at least two
  std::vector<double> y;       ///< one for each x
  Location at;                 ///< where the file has it
};

/// A drive: one number of a joint or of a loop as a function of time.
///
/// A drive of a joint prescribes a coordinate, counted from 0 as in q. Cylindrical, universal and
/// planar joints may have any driven, each by its own drive. A driven spherical joint has drives
/// for roll, pitch and yaw, its coordinates 0, 1, 2: child axes = Rz(yaw) Ry(pitch) Rx(roll) in the
/// joint frame. A driven free joint has drives for x, y, z, roll, pitch, yaw; on a massless body it
/// is a moving base.
///
/// A drive of a loop prescribes a coordinate (driven_coordinates_of), counted as in a joint of the
/// same kind and then no longer free; or a component of `origin_parent`, which then moves. The
/// loop's own value of a driven number has no effect.
///
///   - polynomial: f = Σ cᵢ tⁱ, coefficients = [c0, c1, ...]
///   - harmonic: f = offset + amplitude sin(ω t + φ), with ω = frequency [rad/s], φ = phase [rad]
///   - step: `from` → `to` between start and start + duration, by the quintic 10x³ − 15x⁴ + 6x⁵
///   - table: natural cubic spline through (times, values); constant slope outside
///   - formula: `law`, of t
/// MotionLaw (core/scene/drive.h) evaluates these laws.
struct DriveSpec {
  std::string joint;   ///< joint, else empty and `loop` given
  std::string loop;    ///< loop, else empty
  int coordinate = 0;  ///< coordinate of that joint or loop, from 0
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
  std::vector<FunctionSpec> functions;  ///< formula: functions of the scene that it calls
  Location at;                          ///< where the file has it
};

}  // namespace momenta
