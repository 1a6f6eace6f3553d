#pragma once
// Linear models as text, JSON, and programs with their matrices; keys and names are public
// interface: docs/reference/linearise.md.

#include <momenta/dae/analysis/linear/linear_model.h>

#include <string>

namespace momenta {

/// Sizes, state, a table of poles, and equations left out.
std::string linear_table(const LinearModel& model);

/// scene kind t q u udot states inputs outputs E A B C D poles left_out kept.
std::string linear_json(const LinearModel& model);

/// Script for GNU Octave and MATLAB: E, A, B, C, D, names, and `sys` where dss exists.
std::string linear_octave(const LinearModel& model);

/// Python: E, A, B, C, D as lists, names, response(s) by NumPy, and for a minimal model system() by
/// python-control.
std::string linear_python(const LinearModel& model);

}  // namespace momenta
