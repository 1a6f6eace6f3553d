#pragma once
// A body of a planar tree for the fused sweeps. All vectors are in ground axes, moments about each
// body's own joint; a frame is turned so that the first child's joint lies on its x axis, which
// saves half of the products that place it.

#include <momenta/core/kernel/model.h>

#include <cstdint>
#include <vector>

namespace momenta {

struct PlanarLink {
  double x = 0, y = 0;    ///< joint in the parent's frame [m]; y = 0 for a first child
  double m = 0, J = 0;    ///< [kg], about O [kg m²]
  double cx = 0, cy = 0;  ///< own first moment, body frame [kg m]
  double wx = 0,
         wy = 0;  ///< moment of the weight of all mass at rest in the frame: wx cos + wy sin
  double prismatic_x = 0, prismatic_y = 0;  ///< direction of a slider in the parent's frame
  double rotor = 0;                         ///< inertia on the joint's rate: rotor.h [kg m² or kg]
  double sign = 1;  ///< revolute joints: +1 when the axis is the plane's normal
  int q = 0, u = 0;
  int parent = -1;
  int slot = -1;
  int record = -1;
  bool revolute = true;  ///< undriven revolute joint
  bool first = false, leaf = false, has_force = false, has_rotor = false;
  bool forced = false;  ///< springs or wrenches act at its points
  bool opens = false;   ///< last child of its parent, first in the inward sweep
};

struct PlanarTree {
  const Model<Planar>* model = nullptr;
  std::vector<PlanarLink> links;
  std::vector<double> theta0;      ///< angle of the body's frame in its parent's at q = 0 [rad]
  std::vector<double> frame_turn;  ///< turn of this frame in the model's frame [rad]
  int slots = 0, records = 0;
};

PlanarTree build_links(const Model<Planar>& model);

}  // namespace momenta
