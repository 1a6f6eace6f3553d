#pragma once
// What `momenta check` finds of a mechanism, and its parts as text and as JSON.

#include <momenta/core/scene/lagrangian.h>
#include <momenta/dae/assembly/assembly.h>
#include <momenta/dae/assembly/drive_reach.h>
#include <momenta/dae/measure/rank.h>
#include <momenta/dae/mechanism.h>

#include <nlohmann/json.hpp>

namespace momenta::program {

/// Above this the singular value decompositions of the rank report take minutes.
constexpr int most_equations = 600;

/// A mechanism, its start, and what is found there.
struct Checked {
  explicit Checked(const Mechanism& checked);

  const Mechanism& mechanism;
  const Tree& tree;
  const Assembly assembly;
  bool bodies;       ///< or a Lagrangian
  bool ranked;       ///< `rank` is there
  RankReport rank;   ///< of the loop equations
  double end;        ///< of the scene's run [s]
  DriveReach reach;  ///< of drives beside loops
};

int count_nonholonomic(const Mechanism& mechanism);

/// The tree or the coordinates, and the loops.
void print_structure(const Checked& c);
void print_rank(const Mechanism& mechanism, const RankReport& r);
nlohmann::ordered_json rank_json(const Mechanism& mechanism, const RankReport& r);
/// All of it.
nlohmann::ordered_json check_json(const Checked& c);

}  // namespace momenta::program
