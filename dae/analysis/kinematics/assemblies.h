#pragma once
// The assemblies of a mechanism: poses that close its loops at fixed values of coordinates h that
// leave it no freedom,
//
//   Φ(q, t) = 0,      h(q) = h₀,      rank of D⁻¹ Φ_q C in the other columns = their number.
//
// These are isolated solutions. Damped Gauss-Newton steps (closing.h) search them from random
// starts: angles in a full turn, lengths within 1.5 lengths of the scene about its own pose,
// quaternions evenly over all rotations. Poses are one if they differ by full turns of angles,
// where loops allow these, by the sign of a quaternion or by less than `same`. Poses that close a
// loop with its axes turned (turned_loops.h) do not count.
//
// A search proves no completeness. If n starts closed and n₁ assemblies were met once, the chance
// that the next start that closes meets a new one is about n₁/n (I. J. Good, Biometrika 40 (1953),
// 237-264): an assembly with a small basin is met late.
//
// Where loops can be written as polynomials (loop_polynomials.h) a homotopy finds all of them, and
// the number of solutions over the complex numbers: complete where no path is lost or ends at a
// singular solution. `met` then counts solutions. Of a platform on legs its own poses count, not
// those of the legs (platform_rod.h): a leg that spins between two balls is no freedom.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// Assemblies found by a search.
struct AssembliesRequest {
  std::vector<std::string> hold;  ///< coordinates "O" or "J.q2"
  int starts = 1000;              ///< drawn at random
  std::uint64_t seed = 1;         ///< seed of the starts
  int threads = 1;                ///< no effect on the result
  bool by_homotopy = false;       ///< all, by paths in complex numbers, without starts
};

/// Ends of the paths of a homotopy (homotopy.h).
struct PathCount {
  long paths = 0;     ///< the Bézout number
  long finite = 0;    ///< regular solutions over the complex numbers
  long infinite = 0;  ///< no solutions: at infinity, or no displacements
  long singular = 0;  ///< multiple solutions, or points of curves
  long lost = 0;      ///< not followed to the end
  long real = 0;      ///< finite solutions that are assemblies
  /// Whether the search found all assemblies.
  bool is_complete() const { return singular == 0 && lost == 0; }
  /// Divides by `copies`, how often each solution was found; a remainder is lost paths.
  void count_copies_once(long copies);
};

/// An assembly.
struct FoundAssembly {
  Eigen::VectorXd q;       ///< nq, angles within half a turn of the scene's own pose
  int met = 0;             ///< number of starts that led here
  double apart = 0;        ///< largest difference from the own pose [rad or lengths]
  double least_value = 0;  ///< smallest singular value of the free columns, in units
  double most_value = 0;   ///< largest; least_value / most_value is 0 where assemblies meet
};

/// What a search found.
struct Assemblies {
  static constexpr double same = 1e-5;  ///< distance of equal assemblies [rad or lengths]

  std::vector<FoundAssembly> all;  ///< by `apart`: the scene's own first
  int starts = 0;                  ///< how many there were
  int closed = 0;                  ///< starts that led to an assembly
  int turned = 0;                  ///< starts that led to a loop with turned axes
  std::optional<PathCount> paths;  ///< by homotopy; then there are no starts
  /// Assemblies met once.
  int met_once() const;
};

/// Takes the scene's own pose q (nq), which closes the loops at time t [s].
/// @throws SceneError for an unknown coordinate, or with names of coordinates to hold where
/// freedoms are left
/// Cost: up to 60 least-norm factorisations of Φ_q a start.
Assemblies find_assemblies(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                           const AssembliesRequest& request);

}  // namespace momenta
