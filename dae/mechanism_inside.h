#pragma once
// Models, links and loops of a mechanism in the algebra of its plan.

#include <momenta/core/kernel/link.h>
#include <momenta/core/kernel/model.h>
#include <momenta/core/kernel/planar_joint.h>
#include <momenta/core/lagrangian/lagrangian_model.h>
#include <momenta/dae/loop/loop_model.h>
#include <momenta/dae/mechanism.h>
#include <momenta/dae/sweeps/levels/loop_sweeps.h>

#include <optional>
#include <utility>
#include <variant>

namespace momenta {

template <class Space>
struct Mechanism::Cast {
  Model<Space> model;
  LoopModel<Space> loops;
  SweptLoops<Space> swept, as_given;  ///< as_given: only where `swept` pairs ties anew
  decltype(build_links(std::declval<const Model<Space>&>())) links;
};

struct Mechanism::Casts {
  std::variant<Cast<Planar>, Cast<Spatial>> cast;  ///< without bodies where there is a Lagrangian
  std::optional<LagrangianModel> lagrangian;
};

/// Calls f with the Cast of the plan's algebra.
template <class F>
decltype(auto) Mechanism::visit(F&& f) const {
  const auto& cast = casts_->cast;
  return plan_.planar ? f(std::get<0>(cast)) : f(std::get<1>(cast));
}

}  // namespace momenta
