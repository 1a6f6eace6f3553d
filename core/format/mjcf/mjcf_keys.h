#pragma once
// <keyframe>: states of the model by name. One may be chosen as the start (--key); else a remark
// names them.

#include <momenta/core/format/mjcf/mjcf_model.h>

namespace momenta::reading {

/// Checks that every <key> has as many numbers as the model has coordinates, rates and `actuators`;
/// controls of keys of attached models are not counted. After the bodies. @throws SceneError
void expect_keys_fit(const std::vector<Node>& keyframes, std::size_t actuators,
                     const MjcfModel& model);

/// `ctrl` of the chosen <key>; empty: none. @throws SceneError for an unknown name
std::vector<double> controls_of_key(const std::vector<Node>& keyframes, const std::string& chosen,
                                    const MjcfModel& model);

/// Starts the model at the <key> `chosen` by its name, or by its number from 0; empty: none, and a
/// remark names them all. `acts`: its controls are taken. `time` is left out: runs begin at 0.
/// `qpos` and `qvel` follow the joints in the order of the file: hinges and slides count from 0,
/// not from `ref`; a ball has a quaternion w x y z and the angular velocity in body axes; a free
/// joint position, quaternion, velocity in world axes and angular velocity in body axes. Other
/// attributes stay as in the model. @throws SceneError for an unknown name, and for other sizes
void read_keys(const std::vector<Node>& keyframes, const std::string& chosen, bool acts,
               MjcfModel& model);

}  // namespace momenta::reading
