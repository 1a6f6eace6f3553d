#pragma once
// What rounding decides is judged over an ensemble. Past a singular pose, at the worst of many step
// sizes, at the floor of a method's digits, two starts that differ in the last place end with
// errors that differ by factors; so do two processors, two compilers, two instruction levels. One
// member proves nothing, and a bound drawn around what one machine rounds fails on the next. So
// such a test takes some twenty starts, moved by a few units in the last place each, and asks of
// them
//
//   - a quantile of the errors, tight: what the method promises. It fails when the method is
//   broken;
//   - the worst error, loose by a stated factor: the tail that a quantile does not see.
//
// MOMENTA_JITTER=k in the environment, k = 1, 2, …, moves the starts of all runs in process by
// pattern k: whatever fails then has drawn its bound around rounding.

#include <momenta/dae/run/run_form.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <string>
#include <vector>

namespace momenta::equations {

/// k of MOMENTA_JITTER; 0 without.
int jitter();

/// Each number moved by −3 to 3 units in the last place, by pattern k; zeros stay. k = 0: unmoved.
void move_last_places(Eigen::VectorXd& numbers, int k);
Start moved(Start start, int k);

/// The start of a mechanism's runs: assembled, moved by MOMENTA_JITTER.
Start start_of(const Mechanism& mechanism);
/// A run from there at one tolerance, twenty samples, with its trajectory.
RunResult run_of(const Mechanism& mechanism, const std::string& form, const std::string& integrator,
                 const std::string& gauge, double tolerance, double end,
                 double max_cpu_seconds = 0);
/// `members` of them, the first as start_of() has it.
std::vector<Start> starts_of(const Mechanism& mechanism, int members = 20);

/// The value that a share of all does not exceed: quantile(v, 0.5) is the median.
double quantile(std::vector<double> values, double share);

}  // namespace momenta::equations
