#pragma once
// Loops with their ends in one order. Equations of a loop are components in axes of its parent,
//
//   D_j = b_j · (x_A − x_B),     O_ij = a_i · b_j,
//
// and the same loop seen from its child has them in axes of the other body: the same where it is
// closed, not on the way there. Newton's steps from an open guess then lead to another pose, next
// to it, or in another assembly. So an assembly is made of loops whose parent is the ground or
// stands before the child among the scene's bodies, and does not depend on which end of a loop is
// written as its parent.

#include <momenta/core/scene/scene.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// The scene with the ends of its loops in that order; nothing where it is written so.
/// Driven loops stay, and kinds whose ends cannot change places. O(bodies + loops)
std::optional<Scene> with_ordered_ends(const Scene& scene);

// Loops that a pose closes turned. Rows of axes a_i of the child and b_j of the parent say
// a_i · b_j = 0, and that holds not only where the axes coincide, C = 1 with C_ij = a_i · b_j:
//
//   O31 O32       C_31 = C_32 = 0          a_3 = b_3, and a_3 = −b_3: turned by half a turn
//   O12 O23 O31   C_12 = C_23 = C_31 = 0   C = 1; three half turns, C diagonal with two −1; four
//                                          third turns, C_13, C_21, C_32 = ±1 with product 1
//   O12 (plane)   sin of an angle          0, and half a turn
//   F of a rack   r sin(θ + ξ/r − offset)  0, and half a turn: led back by its offset
//
// (Of rows (c11 0 c13), (c21 c22 0), (0 c32 c33) orthogonality asks c11 c21 = c22 c32 = c13 c33 =
// 0: if c21 = 0 all off the diagonal is zero, else all on it.) Φ_q has full rank at all of these as
// it has at C = 1, so Newton's method goes to whichever is nearest, and the mechanism there is
// another one. A turned loop is led back: with G the turn of the axes b_j that takes them to the
// a_i, the pose closes the loop with b_j turned by G^s at s = 1, and is followed to s = 0,
//
//   Φ(q(s); G^s b, x_B + s D) = 0,
//
// D being what the pose at s = 1 has along a slide or in a plane, whose axes G turns as well; one
// way round, and if that ends the other, G^s with the angle θ − 2π in place of θ. At half a turn
// the two ways are as long, and which is called the one is a matter of writing (of rounding, of
// which body is the parent, in a plane or in space): all are gone then, and the pose is taken that
// moves the mass least (displacement_of_mass.h). Where they move it alike the axes of the ground
// decide.

/// A turned loop and its turn G.
struct TurnedLoop {
  std::size_t loop = 0;         ///< index in the scene
  Eigen::Vector3d axis, other;  ///< axis of G in the loop frame; of a hinge another one too
  double angle = 0;             ///< angle of G [rad], above 0, at most π
  Eigen::Vector3d driven = Eigen::Vector3d::Zero();  ///< displacement by drives, loop frame [m]
  Eigen::Vector3d apart = Eigen::Vector3d::Zero();   ///< D in parent axes [m]
};

/// Loops that the pose q (nq) at time t [s] closes turned, drives counted. @pre Φ(q, t) = 0.
/// O(bodies); nothing where no loop has rows of axes.
std::vector<TurnedLoop> turned_loops(const Mechanism& mechanism, double t,
                                     const Eigen::VectorXd& q);

/// A pose that closes the loops with all axes in one, led there from q: the first reached, shorter
/// ways round first; of half turns the nearest. `columns` (nv): rates of joints that may move. Adds
/// Newton's `iterations`. None where every way ends: there may be no such pose. Cost: some 10 to
/// 100 mechanisms made and as many solutions of Newton's method.
std::optional<Eigen::VectorXd> led_back(const Mechanism& mechanism, double t,
                                        const Eigen::VectorXd& q,
                                        const std::vector<TurnedLoop>& turned,
                                        const std::vector<bool>& columns, int& iterations);

/// "loop 'A' closes with its axes turned by 180°", "loops 'A', 'B' close …", at most six names and
/// the largest angle.
std::string in_words(const Mechanism& mechanism, const std::vector<TurnedLoop>& turned);

}  // namespace momenta
