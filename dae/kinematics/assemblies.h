#pragma once
// The assemblies of a mechanism: poses that close its loops while coordinates h that leave it no
// freedom stay where they are,
//
//   Φ(q, t) = 0,      h(q) = h₀,      rank of D⁻¹ Φ_q C in the columns of the others = their
//   number.
//
// These are isolated solutions. They are searched by damped Gauss-Newton steps (closing.h) from
// starts drawn at random: angles in a full turn, lengths within 1.5 lengths of the scene about its
// own pose, quaternions evenly over all rotations. Poses that differ by full turns of angles, as
// far as the loops allow these, or by the sign of a quaternion are one, and so are poses closer
// than `same`. Poses that close a loop with its axes turned (turned_loops.h) are none.
//
// A search proves no completeness. If n starts closed and n₁ of the assemblies were met once, the
// chance that the next start that closes meets a new one is about n₁/n (I. J. Good, Biometrika 40
// (1953), 237-264), of starts drawn like these: an assembly with a small basin is met late.
//
// Where loops can be written as polynomials (loop_polynomials.h) a homotopy finds all of them, with
// the number of solutions over the complex numbers: complete where no path is lost or ends at a
// singular solution. `met` is then how many solutions led to it. Of a platform on legs its poses
// are counted, not those of the legs (platform_rod.h): what spins between two balls is no freedom
// then.

#include <momenta/dae/mechanism.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

/// What is held, and how long is searched.
struct AssembliesRequest {
  std::vector<std::string> hold;  ///< coordinates "O" or "J.q2"
  int starts = 1000;              ///< drawn at random
  std::uint64_t seed = 1;         ///< of these
  int threads = 1;                ///< without effect on what is found
  bool by_homotopy = false;       ///< all of them by paths in complex numbers, in place of starts
};

/// What paths of a homotopy led to (homotopy.h).
struct PathCount {
  long paths = 0;     ///< as many as the Bézout number
  long finite = 0;    ///< regular solutions over the complex numbers
  long infinite = 0;  ///< no solutions: at infinity, or no displacements
  long singular = 0;  ///< multiple solutions, or of curves
  long lost = 0;      ///< not followed to the end
  long real = 0;      ///< finite ones that are assemblies
  /// Whether the assemblies are all there are.
  bool is_complete() const { return singular == 0 && lost == 0; }
  /// Of solutions that were all found so many times; where one was not a path is lost.
  void count_copies_once(long copies);
};

/// One of them.
struct FoundAssembly {
  Eigen::VectorXd q;  ///< nq, angles within half a turn of the scene's own pose
  int met = 0;        ///< from how many starts
  double apart = 0;   ///< from the own pose, by the coordinate that differs most [rad or lengths]
  double least_value = 0;  ///< smallest singular value of the columns that are free, in units
  double most_value = 0;   ///< and the largest: their ratio is 0 where assemblies meet
};

/// What a search found.
struct Assemblies {
  static constexpr double same = 1e-5;  ///< closer ones are one [rad or lengths]

  std::vector<FoundAssembly> all;  ///< by `apart`: the scene's own first
  int starts = 0;                  ///< how many there were
  int closed = 0;                  ///< starts that led to an assembly
  int turned = 0;                  ///< that led to a loop with turned axes
  std::optional<PathCount> paths;  ///< by homotopy; then there are no starts
  /// How many assemblies were met once.
  int met_once() const;
};

/// Of the pose q (nq) that closes the loops at time t [s], the scene's own.
/// @throws SceneError where a coordinate is not known, or where freedoms are left: the sentence
/// names coordinates to hold
/// Cost: up to 60 least-norm factorisations of Φ_q a start.
Assemblies find_assemblies(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                           const AssembliesRequest& request);

}  // namespace momenta
