#pragma once
// Findings of `momenta check`, and their parts as text and as JSON.

#include <momenta/core/scene/lagrangian.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/measure/rank.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/drive_reach.h>
#include <momenta/dae/topology/cut/recut.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta::program {

/// Above this the rank report's decompositions take minutes.
constexpr int most_equations = 600;

struct Checked {
  explicit Checked(const Mechanism& checked);

  const Mechanism& mechanism;
  const Tree& tree;
  const Assembly assembly;
  bool bodies;  ///< false: a Lagrangian
  bool ranked;  ///< `rank` is known
  RankReport rank;
  double end;        ///< end of the scene's run [s]
  DriveReach reach;  ///< drives' reach beside loops
};

int count_nonholonomic(const Mechanism& mechanism);

void print_structure(const Checked& c);
void print_rank(const Mechanism& mechanism, const RankReport& r);
nlohmann::ordered_json rank_json(const Mechanism& mechanism, const RankReport& r);
nlohmann::ordered_json check_json(const Checked& c);

/// Whether there are drives beside loops.
bool has_reach(const Mechanism& mechanism);
/// Reach of drives in one line.
std::string in_words(const DriveReach& reach, double end);
nlohmann::ordered_json reach_json(const DriveReach& reach);
/// Savings of other cut joints, in one sentence.
std::string cuts_in_words(const Recut& recut);

}  // namespace momenta::program
