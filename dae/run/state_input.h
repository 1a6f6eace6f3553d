#pragma once
// The STATE of --at: {"t": 0, "q": {"O": [..], …}, "v": {…} or "p": {…}, "tau": {…}}, by joint
// name, from a file, from standard input ("-") or as the text itself. Evaluations at a state take
// all of it; starts from a state take q and v.

#include <momenta/dae/run/state_values.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <string>

namespace momenta {

/// Missing values are the scene's start: with loops the start that assembly finds, which is sought
/// only if needed.
/// @throws SceneError: one sentence with the source, the key or joint, what was found and expected
GivenState read_state(const std::string& state, const Mechanism& mechanism);

/// A consistent point: the start that assembly finds, or the state, if it closes the loops.
/// @throws SceneError as read_state(), and where a loop is open or opens
Start start_of(const std::string& state, const Mechanism& mechanism);

/// Other start values or first guesses for a scene, {"q": {"O": [..], …}, "v": {…}} by joint name,
/// from a file or written out; other joints keep theirs.
/// @throws SceneError as read_state(), and where the scene does not take them
void start_at(const std::string& state, Scene& scene);

}  // namespace momenta
