#pragma once
// Linear models as text, JSON, and programs that define their matrices; keys and names are public
// interface: docs/reference/linearise.md.

#include <momenta/dae/linear/linear_model.h>

#include <string>

namespace momenta {

/// Sizes, the state, poles in a table, and what was left out.
std::string linear_table(const LinearModel& model);

/// scene kind t q u udot states inputs outputs E A B C D poles left_out kept.
std::string linear_json(const LinearModel& model);

/// A script for GNU Octave and MATLAB: E, A, B, C, D, names, and `sys` where there is a function
/// dss.
std::string linear_octave(const LinearModel& model);

/// A Python module: E, A, B, C, D as lists, names, response(s) by NumPy, and of a minimal model
/// system() by python-control.
std::string linear_python(const LinearModel& model);

}  // namespace momenta
