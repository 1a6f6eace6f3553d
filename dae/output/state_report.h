#pragma once
// All quantities at a state, as a JSON document; keys and units: docs/reference/evaluate.md.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/state_values.h>

#include <string>

namespace momenta {

std::string state_json(const Mechanism& mechanism, const GivenState& given,
                       const StateValues& values);

}  // namespace momenta
