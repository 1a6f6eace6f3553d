#pragma once
// STATE of `momenta evaluate`: {"t": 0, "q": {"O": [..], …}, "v": {…} or "p": {…}, "tau": {…}} by
// joint name, from a file, from standard input ("-") or written out.

#include <momenta/dae/study/state_values.h>

#include <string>

namespace momenta::program {

/// What is left out is the scene's start: where loops close, the start that assembly finds, which
/// is looked for only if something of it is needed.
/// @throws SceneError: one sentence with the source, the key or joint, what was found and expected
GivenState read_state(const std::string& state, const Mechanism& mechanism);

}  // namespace momenta::program
