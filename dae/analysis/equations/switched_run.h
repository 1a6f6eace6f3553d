#pragma once
// A run in pieces between the switches of a file's formulas: comparisons, sign and floor
// (core/expression/switches.h). In a piece each switch is held in its mode, so that the
// integrator's polynomials reach across no jump. Where a switch turns, by the dense output, the
// piece ends; the next one begins from a consistent start in the new mode.
//
// Where the new mode turns back at once, the two sides drive against each other; where a mode ends
// short of its switch, formulas may have no values behind it: log(x) in if(x > 0, log(x), 0). The
// run then goes on with the formulas as they are written.

#include <momenta/core/expression/switches.h>
#include <momenta/dae/analysis/equations/equation_run.h>
#include <momenta/dae/run/event/crossings.h>

#include <functional>
#include <string>
#include <vector>

namespace momenta {

/// One call of the integrator, from file.start to the requested end or to the step after which
/// `watch` (may be empty) returns false; added to `run`. `spent_s`: CPU time before.
void integrate_piece(const EquationFile& file, const EquationStart& start,
                     const EquationRunRequest& request,
                     const std::function<bool(double, double, const Interpolant&)>& watch,
                     double spent_s, EquationRun& run);

class SwitchedRun {
 public:
  /// File and request must outlive the run.
  SwitchedRun(const EquationFile& file, const EquationRunRequest& request);

  /// False, with nothing done: no switches, or some that depend on rates.
  bool run(const EquationStart& start, EquationRun& run);

 private:
  /// Switches that turn together at the end of a piece.
  struct Turns {
    double t = 0;
    std::vector<std::size_t> which;
    std::vector<double> modes;  ///< new modes
  };
  int most_index() const { return largest_index(request_.integrator); }
  double& mode(std::size_t k) { return held_.parameters[file_.parameters.size() + k]; }
  double argument(std::size_t k, double t, const double* y);
  double margin(std::size_t k, double t, const double* y) {
    return switches_.margin(k, mode(k), argument(k, t, y));
  }
  /// Sets turns_ to the turns of the step just taken.
  void find_turns(double t0, double t1, const Interpolant& between);
  /// Runs to a turn: true; or to the end of the run. `spent_s`: CPU time before.
  bool piece(const EquationStart& start, double spent_s, EquationRun& run);
  /// Start of held_ where the last piece ended; a sentence if there is none, or values would
  /// jump, whatever the formulas as written say of the moment itself.
  std::string begin_anew(EquationStart& start, bool& jumps);
  /// Variable with a rate whose value would jump from held_ to the start; −1: none.
  int jumping(const EquationStart& start) const;
  /// Continues from there with the formulas as written. False: they have no start there.
  bool as_written(double spent_s, EquationRun& run);
  /// Ends the run at t for the reason `why`; true.
  bool stop(double t, const std::string& why, EquationRun& run);
  /// "'if' of equation 2, 'z = if(t < 1, x, 2*x)'".
  std::string in_words(std::size_t k) const;

  const EquationFile& file_;
  const EquationRunRequest& request_;
  Switches switches_;
  EquationFile held_;             ///< modes follow the parameters; start is the piece's
  std::vector<int> equation_of_;  ///< first equation with the switch
  bool of_rates_ = false;
  double tolerance_;  ///< for times of turns
  std::vector<Crossings> crossings_;
  Turns turns_;
  std::vector<double> x_, line_, y_;
};

}  // namespace momenta
