#pragma once
// A mechanism as a linear system about any state of any motion,
//
//   E ẋ = A x + B w,   y = C x + D w,
//
// x, w, y differences from the motion's own. With the derivatives of linearise_state(), joints that
// drives prescribe among the rates (operating_point.h), δ = f, δu = ḟ, δu̇ = f̈ there, and τ the
// efforts at all other rates,
//
//   δ̇ = δu + B δ                                          kinematics
//   M δu̇ + C δu + K δ + Aᵀ δλ = τ                          (1a)
//   Φ_q δ = 0,   A δu + V δ = 0,   A δu̇ + C_a δu + K_a δ = 0    Φ, Φ̇ and Φ̈ along the motion
//
// The last three hold at once: about a motion Φ_q changes, so the second is not the first
// differentiated with constant coefficients. Loops give the dependent rates (D), I are the others;
// one basis of the rows is kept.
//
//   descriptor   x = (δ, δu, δu̇, δλ). Every equation stands as above; kinematics and d/dt δu = δu̇
//                are asked of I alone (dummy derivatives), so the index is 1, the finite
//                eigenvalues are those of the motion, and infinite ones are simple.
//   minimal      x = (δ_I, δu_I), E = 1. With P and N spanning Φ_q δ = 0 and A δu = 0, identities
//                at I,
//                  δ = P δ_I + …,  δu = N δu_I + S δ + …,  δu̇ = N d/dt δu_I + a(δu, δ, f̈),
//                  NᵀMN d/dt δu_I = Nᵀ(τ − M a − C δu − K δ)
//                where S and a have the second derivatives of Φ. With nonholonomic rows there are
//                more δ_I than δu_I.
//
// Both have one transfer function, input by input. Inputs: τ by rate; f, ḟ, f̈ of each driven joint
// and loop (loop_drives.h), three inputs of one signal: to a motion f(s) the model answers by G (1,
// s, s²)ᵀ f. Outputs: δ, δu, δu̇, positions and velocities of markers, the efforts of drives, and δλ
// where it is unique. Sources: Mattsson, Söderlind, SIAM J. Sci. Comput. 14 (1993) 677;
// docs/theory/linear-models.md.

#include <momenta/dae/analysis/linear/equilibrium.h>
#include <momenta/dae/form/form.h>

#include <Eigen/Core>
#include <complex>
#include <string>
#include <vector>

namespace momenta {

/// Request: kind, inputs and outputs of a linear model.
struct LinearRequest {
  /// Independent coordinates and rates alone, or all of them beside λ.
  enum class Kind { minimal, descriptor };
  Kind kind = Kind::minimal;  ///< which of the two
  /// Columns by name ("O.q"), by its part before the last point ("O"), or by group: efforts,
  /// drives. Empty: all.
  std::vector<std::string> inputs;
  /// Likewise; groups: coordinates, rates, accelerations, markers, efforts, multipliers.
  std::vector<std::string> outputs;
  /// Coordinates for δ_I, "O.q"; empty: chosen. Independent rates are the same, or part of them.
  std::vector<std::string> independent;
};

/// A linear model and the state it is of.
struct LinearModel {
  LinearRequest::Kind kind = LinearRequest::Kind::minimal;  ///< as asked for
  std::string scene;                                        ///< its name
  double t = 0;                                             ///< [s]
  std::vector<Column> coordinates;                          ///< names of q
  std::vector<Column> rates;                                ///< names of u
  Eigen::VectorXd q;                                        ///< nq
  Eigen::VectorXd u;                                        ///< nv
  Eigen::VectorXd udot;                                     ///< nv
  std::vector<Column> states;                               ///< names of x
  std::vector<Column> inputs;                               ///< names of w
  std::vector<Column> outputs;                              ///< names of y
  Eigen::MatrixXd E;                                        ///< states × states
  Eigen::MatrixXd A;                                        ///< states × states
  Eigen::MatrixXd B;                                        ///< states × inputs
  Eigen::MatrixXd C;                                        ///< outputs × states
  Eigen::MatrixXd D;                                        ///< outputs × inputs
  Eigen::VectorXcd poles;             ///< finite, by real part, the largest first [1/s]
  std::vector<std::string> left_out;  ///< dependent loop equations
  double kept = 0;                    ///< relative, least singular value of Φ_q; 0 without loops
};

inline constexpr int most_of_linear_model = 600;  ///< nv + m

/// Takes a consistent state; its `udot` and `lambda` do not matter. O((nv + m)³)
/// @throws SceneError where the pose is singular, loops cannot follow a drive (names the loop
/// equation), something moves without inertia, a name is unknown, independent coordinates do not
/// determine the pose, or numbers are not finite
LinearModel linear_model(const Mechanism& mechanism, const Start& at,
                         const LinearRequest& request = {});

/// The model at an equilibrium, with its own rows of Φ_q that count.
LinearModel linear_model(const Mechanism& mechanism, const Equilibrium& at,
                         const LinearRequest& request = {});

}  // namespace momenta
