#pragma once
// Markers of a mechanism at states of any scalar: dual numbers give derivatives along directions.

#include <momenta/core/kernel/sweeps.h>
#include <momenta/core/scalar/power_series.h>
#include <momenta/dae/mechanism/marker_points.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <memory>
#include <utility>

namespace momenta {

template <class S>
class MarkerMotion {
 public:
  virtual ~MarkerMotion() = default;
  /// Positions and velocities in the order of Mechanism::marker_columns(), at q (nq), u (nv).
  /// O(bodies)
  virtual void at(double t, const S* q, const S* u, S* values) = 0;
};

template <class Space, class S>
class MarkerSweeps final : public MarkerMotion<S> {
 public:
  MarkerSweeps(const Mechanism& mechanism, Model<Space> model)
      : model_(std::move(model)),
        w_(model_),
        points_(mechanism.scene(), mechanism.tree(), model_) {}
  void at(double t, const S* q, const S* u, S* values) override {
    poses_outward(w_, Moment<S>::at(t), q, true);
    velocities_outward(w_, u);
    points_.write(w_, values);
  }

 private:
  Model<Space> model_;
  Workspace<Space, S> w_;
  MarkerPoints<Space> points_;
};

/// @pre the scene has bodies. The mechanism must outlive it.
template <class S>
std::unique_ptr<MarkerMotion<S>> make_marker_motion(const Mechanism& mechanism) {
  const Tree& tree = mechanism.tree();
  if (mechanism.plan().planar)
    return std::make_unique<MarkerSweeps<Planar, S>>(
        mechanism, build_planar_model(tree, mechanism.scene(), mechanism.plan().basis));
  return std::make_unique<MarkerSweeps<Spatial, S>>(mechanism,
                                                    build_spatial_model(tree, mechanism.scene()));
}

}  // namespace momenta
