#pragma once
// <keyframe>: states of the model by name. One may be chosen as the start (--key); else they are
// told.

#include <momenta/core/scene/mjcf/mjcf_model.h>

namespace momenta::reading {

/// Every <key>, chosen or not, has as many numbers as the model has coordinates, rates and
/// `actuators`; of one that came with an attached model the controls are not counted. After the
/// bodies. @throws SceneError
void expect_keys_fit(const std::vector<Node>& keyframes, std::size_t actuators,
                     const MjcfModel& model);

/// `ctrl` of the <key> that is chosen as below; empty: it says none. @throws SceneError for an
/// unknown name
std::vector<double> controls_of_key(const std::vector<Node>& keyframes, const std::string& chosen,
                                    const MjcfModel& model);

/// Makes the state of a <key> the start: `chosen` by its name, or by its number from 0; empty:
/// none, and a remark names what there is. `acts`: its controls are taken. `time` is left out: a
/// run begins at 0, and nothing here depends on time. `qpos` and `qvel` count over the joints in
/// the order of the file: hinges and slides count from 0, not from `ref`; a ball has a quaternion w
/// x y z and the angular velocity in body axes; a free joint position, quaternion, velocity in axes
/// of the world and angular velocity in body axes. What a key does not give is as the model stands.
/// @throws SceneError for an unknown name, and for other sizes
void read_keys(const std::vector<Node>& keyframes, const std::string& chosen, bool acts,
               MjcfModel& model);

}  // namespace momenta::reading
