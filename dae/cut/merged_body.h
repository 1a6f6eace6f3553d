#pragma once
// Two bodies as one. With R, r the turn and origin of the second one's frame in the first's,
//
//   m = m₁ + m₂,  c = (m₁ c₁ + m₂ c₂') / m,  c₂' = r + R c₂
//   I = I₁ + R I₂ Rᵀ + m₁ m₂ / m (d² 1 − d dᵀ),  d = c₂' − c₁

#include <momenta/core/scene/scene.h>

namespace momenta {

/// `first` with the mass of `second`; its shape, which would be drawn about another centre, goes.
BodySpec merged_body(BodySpec first, const BodySpec& second, const Eigen::Quaterniond& turn,
                     const Eigen::Vector3d& origin);

}  // namespace momenta
