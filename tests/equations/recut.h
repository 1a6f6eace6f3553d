#pragma once
// One mechanism of hinges, cut elsewhere.

#include <momenta/core/kernel/tree/tree.h>
#include <momenta/core/scene/scene.h>

#include <string>

namespace momenta::equations {

/// The hinge seen from its child: same angle, axis reversed.
JointSpec other_way_round(const JointSpec& j);

/// The scene of hinges with loop `closed` made a joint and joint `cut` made a loop, driven as it
/// was, at the poses of `q`.
Scene recut(const Scene& scene, const Tree& tree, const Eigen::VectorXd& q, const std::string& cut,
            const std::string& closed);

}  // namespace momenta::equations
