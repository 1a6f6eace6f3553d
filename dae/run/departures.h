#pragma once
// How far a run left what holds along every motion of its mechanism while its loops stayed closed:
//
//   energy   |E(t) − E(0)|  over  max (T + |V − V(0)|) + ∫ Σ|P| dt,   the energy turned over, P of
//            dampers, friction and formulas, of drives, and of impacts; V also in the middle of
//            steps, with loops; trees with few samples are not judged
//   rates    |Φ̇|∞ over the fastest rate of a joint, both in the units of LoopUnits
//
// Beyond the shares `told` the run is done, with a warning; beyond `apart` it came apart: its
// motion is none of this mechanism. Energies below what the tolerance leaves of those in the state
// count as none, as do rates that move a joint by less than a thousandth over the run, and without
// faster ones energies below a thousandth of those in the state: what a stiff damper takes of rates
// that the tolerance leaves open is no exchange.

#include <momenta/dae/integrator/memory.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_result.h>

#include <cmath>
#include <string>
#include <vector>

namespace momenta {

class Departures {
 public:
  struct Share {
    double told, apart;
  };
  static constexpr Share energy{0.05, 0.25}, rates{0.05, 0.25};

  Departures(const Mechanism& mechanism, const RunSettings& settings, double span);

  /// |V − V(0)| in the middle of a step [J].
  void look_between(double exchanged) { exchanged_ = std::fmax(exchanged_, exchanged); }
  /// A sample at t: T + |V|, T + |V − V(0)|, ∫ Σ|P| so far, and by how much the balance is off [J].
  void look_at_energy(double t, double in_state, double exchanged, double flow, double off);
  /// |Φ̇|∞ at a sample and its row, the fastest rate of a joint [1/s].
  void look_at_rates(double t, double opening, Eigen::Index row, double fastest);
  void carry(Memory& memory) {
    memory(largest_energy_), memory(exchanged_), memory(turned_over_);
    memory(beyond_told_.from), memory(beyond_apart_.from);
    memory(opening_), memory(row_), memory(at_), memory(fastest_);
  }

  /// Energy turned over up to the last sample [J].
  double turned_over() const { return turned_over_; }

  /// The verdict on a run that reached its end: `departure`, or status and reason. @pre
  /// run.energy_error_max is set
  void judge(RunResult& run) const;

 private:
  /// Time at which a share of the energy turned over was first passed [s]; NaN: never.
  struct Beyond {
    double from = not_measured;
    void look(double t, bool beyond) {
      if (beyond && std::isnan(from)) from = t;
    }
  };
  double floor() const { return at_rest_ + of_state_ * largest_energy_; }
  void judge_energy(RunResult& run) const;
  void judge_rates(RunResult& run) const;

  const Mechanism& mechanism_;
  double still_;    ///< rates below count as none [1/s]
  double at_rest_;  ///< part of floor() beside energies in the state [J]
  double of_state_;
  Beyond beyond_told_, beyond_apart_;
  double largest_energy_ = 0;                  ///< T + |V| at the samples [J]
  double exchanged_ = 0, turned_over_ = 0;     ///< largest T + |V − V(0)|; with ∫ Σ|P| [J]
  double opening_ = 0, at_ = 0, fastest_ = 0;  ///< largest |Φ̇|∞, its time, fastest rate
  Eigen::Index row_ = 0;
};

// Whether runs of one motion ended on different branches of it. Where reliable runs end in
// different poses behind a singular pose, chance chose which of the motions that meet there each
// followed, whatever a single run saw of it: none is the motion.

struct Ambiguity {
  bool differ = false;
  double from = not_measured;  ///< the first singular pose [s]
  double apart = 0;            ///< largest difference of end poses [rad or lengths of the scene]
};

/// Compares the runs of the tightest tolerance that reached the end.
Ambiguity ambiguity_of(const std::vector<RunResult>& runs);

/// One clause. @pre they differ
std::string in_words(const Ambiguity& ambiguity);

}  // namespace momenta
