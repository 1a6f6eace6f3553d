#pragma once
// The sentence about drives that cannot go on: which, when, and at which loop.

#include <momenta/dae/mechanism/mechanism.h>

#include <Eigen/Core>
#include <string>

namespace momenta {

/// "drive of 'O' cannot go on at t = 0.1152 s: loop 'B' does not close behind it (dead point of 'b'
/// and 'c')". `open`: Φ that stays open behind t [s], by row (m) in comparable units. Named are
/// drives on the way around the loop that stays open most, or its own, and bodies on it that no
/// driven joint holds.
std::string stalled_drive(const Mechanism& mechanism, double t, const Eigen::VectorXd& open);

}  // namespace momenta
