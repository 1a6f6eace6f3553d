#pragma once
// The models of a mechanism's tree and loops in the algebra of its plan.

#include <momenta/core/kernel/model.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/dae/mechanism/loop/loop_model.h>
#include <momenta/dae/mechanism/mechanism.h>

#include <optional>
#include <variant>

namespace momenta {

template <class Space>
struct ModelData {
  Model<Space> model;
  LoopModel<Space> loops;
};

struct Mechanism::Models {
  std::variant<ModelData<Planar>, ModelData<Spatial>> data;
  std::optional<LagrangianModel> lagrangian;
};

template <class F>
decltype(auto) Mechanism::visit(F&& f) const {
  const auto& data = models_->data;
  return plan_.planar ? f(std::get<0>(data)) : f(std::get<1>(data));
}

}  // namespace momenta
