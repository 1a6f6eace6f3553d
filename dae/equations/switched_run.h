#pragma once
// A run in pieces between the switches of a file's formulas: comparisons, sign and floor
// (core/expression/switches.h). In a piece each is held in its mode, so that BDF's polynomials
// reach across no jump. Where a switch turns, by the dense output, the piece ends; the next one
// begins from a consistent start in the new mode.
//
// Where the new mode turns back at once, the two sides drive against each other; where a mode ends
// short of its switch, formulas may have no values behind it: log(x) in if(x > 0, log(x), 0). The
// run then goes on with the formulas as they are written.

#include <momenta/core/expression/switches.h>
#include <momenta/dae/equations/equation_run.h>
#include <momenta/dae/event/crossings.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// One call of the integrator, from file.start to the end of what is asked for or to where `watch`,
/// which may be empty, returns false after a step; added to `run`. `spent_s`: CPU time before.
void integrate_piece(const EquationFile& file, const EquationStart& start,
                     const EquationRunRequest& request,
                     const std::function<bool(double, double, const Interpolant&)>& watch,
                     double spent_s, EquationRun& run);

class SwitchedRun {
 public:
  /// The file and the request must outlive it.
  SwitchedRun(const EquationFile& file, const EquationRunRequest& request);

  /// False, and nothing is done: there are no switches, or such as turn with rates.
  bool run(const EquationStart& start, EquationRun& run);

 private:
  /// What a piece ends with: switches that turn at one time.
  struct Turns {
    double t = 0;
    std::vector<std::size_t> which;
    std::vector<double> modes;  ///< they take
  };
  double& mode(std::size_t k) { return held_.parameters[file_.parameters.size() + k]; }
  double argument(std::size_t k, double t, const double* y);
  double margin(std::size_t k, double t, const double* y) {
    return switches_.margin(k, mode(k), argument(k, t, y));
  }
  /// Of the step that was just taken.
  void find_turns(double t0, double t1, const Interpolant& between);
  /// To a turn: true; or to where the run ends. `spent_s`: CPU time before.
  bool piece(const EquationStart& start, double spent_s, EquationRun& run);
  /// A start of held_ where the last piece ended. One sentence where there is none, or where values
  /// would jump.
  std::string begin_anew(EquationStart& start);
  /// A variable with a rate that would jump from held_'s value to that of the start; −1: none does.
  int jumping(const EquationStart& start) const;
  /// On from there with the formulas as they are written. False: they have no start there.
  bool as_written(double spent_s, EquationRun& run);
  /// What the run ends with at t; true.
  bool stop(double t, const std::string& why, EquationRun& run);
  /// "'if' of equation 2, 'z = if(t < 1, x, 2*x)'".
  std::string in_words(std::size_t k) const;

  const EquationFile& file_;
  const EquationRunRequest& request_;
  Switches switches_;
  EquationFile held_;             ///< modes behind the parameters; of the piece its start
  std::vector<int> equation_of_;  ///< the first that has the switch
  bool of_rates_ = false;
  double tolerance_;  ///< of times
  std::vector<Crossings> crossings_;
  Turns turns_;
  std::vector<double> x_, line_, y_;
};

}  // namespace momenta
