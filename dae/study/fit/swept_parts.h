#pragma once
// Parts of a motion that is swept: the mechanism goes through places s₁ … s_n of a coordinate c,
// equally far apart, at a constant rate of c. At each pose there are
//
//   coordinates C.q, rates C.u, markers P.x … P.vz, and by name of a coordinate
//   O.effort        that of the swept one, which keeps up the motion: by the power of all forces,
//                   τ ċ = u·(M u̇ + bias − Q); joint forces of loops do no work
//   C.transmission  the transmission angle of an output (dae/analysis/kinematics/transmission.h)
//   [rad] A.force, ground.torque_z, …   what joints, loops and the ground transmit
//   (motion_reactions.h)
//
// An integral is ∫ g dc by the trapezoidal rule. Derivatives by θ are central differences of sixth
// order of whole solutions: the poses of mechanisms with other θ, each closed to rounding.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/study/fit/motion_parts.h>

#include <array>
#include <optional>

namespace momenta {

/// Range and rate of a swept coordinate.
struct SweptWay {
  std::string sweep;                             ///< "O" or "J.q2"
  std::optional<std::array<double, 2>> between;  ///< [rad or m]; none: a turn from the start
  int poses = 73;                                ///< both ends included
  double rate = 1;                               ///< [rad/s or m/s]
};

/// Numbers of a swept motion, by θ.
class SweptParts final : public MotionParts {
 public:
  /// @throws std::invalid_argument for a bad way; SceneError where the given scene cannot be swept
  SweptParts(const ParametricMechanism& family, Eigen::VectorXd sizes, SweptWay way);
  /// @throws std::invalid_argument also for a length without `between`
  std::size_t add(const MotionPart& part) override;
  /// Sweeps only if there are parts. Cost: one sweep, six more per parameter with derivatives
  bool at(const Eigen::VectorXd& theta, bool derivatives, MotionValues& values) override;

  const std::vector<double>& places() const { return places_; }  ///< s [rad or m]
  const Column& swept() const { return swept_; }                 ///< the swept coordinate
  /// g of a part of any kind, by pose of the last motion.
  const Eigen::VectorXd& curve(std::size_t part) const { return curves_[part]; }

 private:
  struct Name {
    enum class Of { coordinate, rate, marker, effort, transmission, reaction };
    std::string name;
    Of of = Of::coordinate;
    int place = 0;  ///< in q, u, markers, MotionReactions::names(); transmission: in q
  };
  struct Part {
    MotionPart::Kind kind;
    SmoothFormula g;  ///< takes parameters, then names_
  };
  /// Table of the used columns, poses × names; false: why_.
  bool take(const Eigen::VectorXd& theta, Eigen::MatrixXd& table);

  SweptWay way_;
  Column swept_;
  std::vector<double> places_;
  std::vector<Name> names_;
  int reactions_ = 0;  ///< count of reactions
  std::vector<bool> used_;
  std::vector<Part> parts_;
  std::vector<Eigen::VectorXd> curves_;
};

}  // namespace momenta
