#pragma once
// The gradient of a run as text, CSV and JSON; keys and columns are public interface:
// docs/reference/gradient.md.

#include <momenta/dae/gradient/gradient.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Summary: "P.y at t = 1 s is -0.83; by momentum, rk4 …".
std::string gradient_in_words(const GradientResult& result);

/// Summary, and a row a variable: value, dJ/dθ, and θ dJ/dθ over J.
std::string gradient_table(const GradientResult& result);

/// A line a time: t, then derivatives of coordinates and rates by each variable.
std::string gradient_csv(const GradientResult& result);

nlohmann::ordered_json gradient_json(const GradientResult& result);

}  // namespace momenta
