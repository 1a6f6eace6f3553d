#pragma once
// A leg with the effect of a rod: two points, one on the base and one on the platform, keep their
// distance. It is a chain of ties (pieces.h) that turn about two centres, first those of one, then
// those of the other:
//
//   at one of them    two hinges whose lines cross there
//   at the other      a ball, or three hinges whose lines cross there, neighbours not parallel
//
// or the latter at both: then the leg turns idly about the line of its centres. Hinges beside a
// ball, through its centre, and those on the line of both centres count to either. So a universal
// joint is two hinges and a body between them, a spherical one three hinges, and a swivel in a leg
// between two universal joints makes one of them a ball. Slides in a leg are held; they change its
// length, wherever their axes lie. Over the complex numbers a leg reaches every place at its
// length.
//
// Its pieces follow from the platform. With the displacement D of the platform from the own pose,
// where the centres are b and p, all displacements are D = B P, B a turn about b and P one about p:
// B takes p − b to D p − b, P⁻¹ takes b − p to D⁻¹ b − p. The centre with two hinges follows from
// this, and the other is the rest (turns.h); a leg with more hinges turns the shortest way. Of two
// solutions the one that turns less is taken: assemblies are counted by poses of the platform.

#include <momenta/dae/analysis/kinematics/pieces.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <vector>

namespace momenta {

class PlatformRod {
 public:
  /// The rod of a chain from the base to the platform, or of a loop of kind distance; none where
  /// the chain is no such leg. @param length of the scene [m]
  static std::optional<PlatformRod> of(const TieChain& chain, double length);

  const Eigen::Vector3d& on_base() const { return b_; }  ///< own pose, ground axes [m]
  const Eigen::Vector3d& on_platform() const { return p_; }
  const TieChain& chain() const { return chain_; }
  /// Freedoms of the leg while both its ends stand.
  int idle() const { return idle_; }

  /// Displacements of its pieces for one of the platform, where it can follow.
  std::optional<std::vector<Eigen::Isometry3d>> displaced(const Eigen::Isometry3d& platform) const;

 private:
  using Turns = std::optional<std::vector<Eigen::Quaterniond>>;

  bool split_at(std::size_t place, double length);
  std::vector<const Tie*> part(bool first) const;
  static Turns turned(const std::vector<const Tie*>& ties, const Eigen::Quaterniond& whole);

  TieChain chain_;
  std::size_t split_ = 0;  ///< number of ties that turn about b
  Eigen::Vector3d b_, p_;
  int idle_ = 0;
};

}  // namespace momenta
