#pragma once
// A body of a planar tree as the fused sweeps want it. All vectors run in ground axes, moments
// about each body's own joint; a body's frame is turned so that its first child's joint lies on its
// x axis, which saves half of the products that place it.

#include <momenta/core/kernel/model.h>

#include <cstdint>
#include <vector>

namespace momenta {

struct PlanarLink {
  double x = 0, y = 0;    ///< joint in the parent's frame [m]; y = 0 for a first child
  double m = 0, J = 0;    ///< [kg], about O [kg m²]
  double cx = 0, cy = 0;  ///< own first moment, body frame [kg m]
  double wx = 0, wy = 0;  ///< moment of the weight of all that stays in place: wx cos + wy sin
  double prismatic_x = 0, prismatic_y = 0;  ///< of a slider, in the parent's frame
  double rotor = 0;                         ///< inertia on the joint's rate: rotor.h [kg m² or kg]
  double sign = 1;  ///< of a revolute joint: +1 when its axis is the plane's normal
  int q = 0, u = 0;
  int parent = -1;
  int slot = -1;
  int record = -1;
  bool revolute = true;  ///< undriven revolute joint
  bool first = false, leaf = false, has_force = false, has_rotor = false;
  bool forced = false;  ///< springs or wrenches at points of its own
  bool opens = false;   ///< the last child of its parent, which the inward sweep meets first
};

struct PlanarTree {
  const Model<Planar>* model = nullptr;
  std::vector<PlanarLink> links;
  std::vector<double> theta0;      ///< angle of the body's frame in its parent's at q = 0 [rad]
  std::vector<double> frame_turn;  ///< of the frame used here in the model's frame [rad]
  int slots = 0, records = 0;
};

PlanarTree build_links(const Model<Planar>& model);

}  // namespace momenta
