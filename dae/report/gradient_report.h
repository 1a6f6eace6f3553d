#pragma once
// The gradient of a run as text, CSV and JSON; keys and columns are public interface:
// docs/reference/gradient.md.

#include <momenta/dae/gradient/gradient.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// "P.y at t = 1 s is -0.83; by momentum, rk4 …": what there is to know first.
std::string gradient_in_words(const GradientResult& result);

/// A row a variable: its value, dJ/dθ, and θ dJ/dθ over J, with those words above it.
std::string gradient_table(const GradientResult& result);

/// A line a time: t, then of each variable the derivatives of coordinates and rates.
std::string gradient_csv(const GradientResult& result);

nlohmann::ordered_json gradient_json(const GradientResult& result);

}  // namespace momenta
