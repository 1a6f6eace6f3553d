#pragma once
// A single loop as six screws, hinges and slides in a row, E₁ E₂ … E₆ = 1, each displacement from
// the own pose a dual quaternion c + s L (dual_quaternion.h),
//
//   hinge   L = l + ε c × l,   s/c = tan θ/2      slide   L = ε l,   s/c = d/2
//
// Ties with more freedoms are several screws:
//
//   ball       three hinges through its centre at right angles: each rotation is two triples
//   rod        two balls in a row, or a loop of kind distance: the part between them turns idly
//              about their line. The first ball is two hinges, the second across the first and
//              across the rod: each direction is two pairs
//
// so that every solution is found 2^balls times (`copies`). Hinges in general position that have to
// stay, θ = 0, fill up to six and stand between the others: a loop of fewer freedoms, redundant
// equations or not, has the solutions of a loop of six that leave these alone.

#include <momenta/dae/analysis/kinematics/dual_quaternion.h>
#include <momenta/dae/analysis/kinematics/pieces.h>

#include <array>

namespace momenta {

struct LoopScrew {
  Eigen::Vector3d centre, way;  ///< in the own pose, ground axes; centre [m]
  bool slides = false;
  int tie = -1;  ///< −1: fills up
  bool fills() const { return tie < 0; }
  /// L, lengths in units of `length` [m].
  DualQuaternion line(double length) const;
  /// Displacement for s/c = `tangent`, in the same units of length.
  Eigen::Isometry3d displacement(double tangent, double length) const;
};

class LoopScrews {
 public:
  /// @param chain from base to base, of balls, hinges, slides and distances
  LoopScrews(TieChain chain, double length);
  /// Freedoms without idle ones; the screws are six if these are at most six.
  int freedoms() const { return freedoms_; }
  int idle() const { return idle_; }
  long copies() const { return copies_; }
  const std::vector<LoopScrew>& screws() const { return screws_; }
  const TieChain& chain() const { return chain_; }
  /// Displacements of the pieces, from s/c of every screw; rods the shortest way.
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
