#pragma once
// A single loop as six screws: hinges and slides, one after the other, E₁ E₂ … E₆ = 1, the
// displacement of each from the own pose a dual quaternion c + s L (dual_quaternion.h),
//
//   hinge   L = l + ε c × l,   s/c = tan θ/2      slide   L = ε l,   s/c = d/2
//
// Ties with more freedoms are several of them:
//
//   ball       three hinges through its centre at right angles: each rotation is two triples
//   rod        two balls one after the other, or a loop of kind distance: what is between them can
//              turn about their line, idle. The first ball is two hinges, the second across the
//              first and across the rod: each direction is two pairs
//
// so that every solution is found 2^balls times (`copies`). What is less than six is filled up with
// hinges in general position that have to stay where they are, θ = 0: a loop of fewer freedoms, its
// equations redundant or not, is all solutions of a loop of six that leave these alone. They stand
// between the others.

#include <momenta/dae/kinematics/dual_quaternion.h>
#include <momenta/dae/kinematics/pieces.h>

#include <array>

namespace momenta {

struct LoopScrew {
  Eigen::Vector3d centre, way;  ///< own pose, ground axes; centre [m]
  bool slides = false;
  int tie = -1;  ///< of the chain; −1: fills up
  bool fills() const { return tie < 0; }
  /// L, lengths in units of `length` [m].
  DualQuaternion line(double length) const;
  /// The displacement of s/c = `tangent`, lengths in those units.
  Eigen::Isometry3d displacement(double tangent, double length) const;
};

class LoopScrews {
 public:
  /// @param chain from the base to the base, of balls, hinges, slides and distances
  LoopScrews(TieChain chain, double length);
  /// Freedoms of the ties without idle ones; screws are six where these are at most six.
  int freedoms() const { return freedoms_; }
  int idle() const { return idle_; }
  long copies() const { return copies_; }
  const std::vector<LoopScrew>& screws() const { return screws_; }
  const TieChain& chain() const { return chain_; }
  /// The displacements of the chain's pieces with s/c of every screw; rods the shortest way.
  std::vector<Eigen::Isometry3d> displaced(const std::array<double, 6>& tangents) const;

 private:
  bool is_rod(std::size_t tie) const;
  void add(int tie, const Eigen::Vector3d& centre, const Eigen::Vector3d& way, bool slides = false);
  void add_ball(int tie, const Eigen::Vector3d& centre);
  void add_half_ball(int tie, const Eigen::Vector3d& centre, const Eigen::Vector3d& rod);
  void fill_up();

  TieChain chain_;
  double length_;
  int freedoms_ = 0, idle_ = 0;
  long copies_ = 1;
  std::vector<LoopScrew> screws_;
};

}  // namespace momenta
