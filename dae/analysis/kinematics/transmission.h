#pragma once
// Passing of force to an output at a pose, by statics without masses and applied forces. With a
// unit effort on the output coordinate o, held by the swept coordinates c and the held ones h,
//
//   Φ_qᵀ λ + E_cᵀ τ_c + E_hᵀ τ_h = e_o
//
// has a solution where the input can hold the output, so not at its dead points. λ gives the forces
// of all joints and loops. Where the output link takes the whole force f at one point B,
//
//   sin μ = |f·v_B| / (|f| |v_B|),      v_B of B while the output has rate 1 and its base rests:
//
// μ is the transmission angle, 90° less the pressure angle between f and the way of B. f lies along
// a coupler that is hinged at two points alone, so that in four-bars μ is the angle between coupler
// and output link, taken as at most 90°; with an output that slides, it is the angle between the
// coupler and the normal of the slide. The largest force among all joints and loops for the unit
// effort is the joint force index.
//
// Sources: H. Alt, Werkstattstechnik 26 (1932), 61-64 (transmission angle); J. E. Holte, T. R.
// Chase, Mech. Mach. Theory 29 (1994), 757-770 (joint force index).

#include <momenta/dae/algebra/dense/least_squares.h>
#include <momenta/dae/analysis/kinematics/held_coordinate.h>
#include <momenta/dae/run/measure/reactions.h>
#include <momenta/dae/topology/assembly/scaled_loops.h>

#include <string>
#include <utility>
#include <vector>

namespace momenta {

/// Transmission of a pose.
struct Transmitting {
  double angle;        ///< μ [rad], 0 to π/2; NaN where no single point takes the whole force
  double joint_force;  ///< largest force for a unit effort [1/m of an angle, 1 of a slide]; NaN:
                       ///< infinite
  std::string where;   ///< joint or loop with that force
};

class Transmission {
 public:
  /// `output`: a coordinate, as in coordinate_named(); `inputs`: places in u of the swept
  /// coordinates. Drives stand at t [s]. Makes a mechanism of its own.
  /// @throws SceneError where the output is unknown or an input
  Transmission(const Mechanism& mechanism, double t, const std::string& output,
               const std::vector<int>& inputs, std::vector<HeldCoordinate> held);

  /// Place of the output in q.
  int output() const { return output_q_; }
  /// Transmission at q (nq), loops closed. Cost: one dense least-squares solution of nv rows, two
  /// wrench sweeps.
  Transmitting at(const Eigen::VectorXd& q);

 private:
  /// A joint or loop of the output link, not the output's own, with its point on the link, a marker
  /// of the mechanism.
  struct Contact {
    std::string name;
    bool is_loop = false;
    std::size_t place = 0;  ///< among joints or loops of Reactions
    std::size_t marker = 0;
  };
  static Scene with_contacts(Scene scene, const std::string& link, const std::string& joint,
                             std::vector<Contact>& contacts);
  Eigen::VectorXd multipliers(const Eigen::VectorXd& q);

  std::vector<Contact> contacts_;
  double t_;
  int output_q_ = 0, output_u_ = 0;
  std::vector<int> inputs_;
  std::vector<HeldCoordinate> held_;
  std::string joint_;  ///< joint of the output
  std::unique_ptr<Mechanism> mechanism_;
  std::unique_ptr<ScaledLoops> loops_;
  std::unique_ptr<WrenchSweep> wrenches_;
  Eigen::MatrixXd balance_;
  DenseLeastSquares solver_;
};

}  // namespace momenta
