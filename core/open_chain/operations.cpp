#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain/operations.h>

#include <cmath>

namespace momenta {
namespace {

template <class Space>
OperationCount count(const Tree& tree, const Model<Space>& model, Recursion recursion) {
  // Any state will do: only zeros and ones of the model are folded.
  const auto variables = [](Eigen::Index n, const auto& value) {
    std::vector<Counted> x;
    for (Eigen::Index i = 0; i < n; ++i) x.push_back(Counted::variable(value(i)));
    return x;
  };
  const auto q = variables(tree.nq, [&](auto i) { return tree.q0[i] + 0.1; });
  const auto p = variables(tree.nv, [](auto i) { return std::cos(1.0 + static_cast<double>(i)); });
  std::vector<Counted> u(p.size()), rates(p.size()), qdot(q.size());
  const auto links = build_links(model);
  const Counted t = tree.drives.empty() ? Counted(0.0) : Counted::variable(0.0);
  Counted::count = {};
  if (recursion == Recursion::momentum) {
    MomentumSweeps<Space, Counted> sweeps(links);
    Counted::count = {};
    sweeps(t, q.data(), p.data(), u.data(), rates.data());
    coordinate_rates(model, q.data(), u.data(), qdot.data());
  } else {
    AccelerationSweeps<Space, Counted> sweeps(links);
    std::vector<Counted> tau(p.size());
    Counted::count = {};
    if (model.has_joint_forces)
      for (const auto& b : model.bodies)
        if (b.nv == 1)
          tau[static_cast<std::size_t>(b.u)] =
              joint_force(b, q[static_cast<std::size_t>(b.q)], p[static_cast<std::size_t>(b.u)]);
    sweeps(t, q.data(), p.data(), static_cast<const Counted*>(tau.data()), rates.data());
  }
  return Counted::count;
}

}  // namespace

OperationCount count_operations(const Tree& tree, const Scene& scene, const Plan& plan,
                                Recursion recursion) {
  return plan.planar ? count(tree, build_planar_model(tree, scene, plan.basis), recursion)
                     : count(tree, build_spatial_model(tree, scene), recursion);
}

}  // namespace momenta
