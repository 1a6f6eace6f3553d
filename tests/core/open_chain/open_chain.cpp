// Laws any open chain obeys, whatever its equations look like: power, symmetry of the Hamiltonian
// Jacobian, M M⁻¹ = 1, indifference to where the scene stands in space.

#include "equations/decompositions.h"
#include "equations/dense_lagrangian.h"
#include "equations/random_tree.h"
#include "equations/recursions.h"
#include "equations/tolerance.h"

#include <gtest/gtest.h>
#include <momenta/core/kernel/accelerations.h>
#include <momenta/core/kernel/mass_matrix.h>
#include <momenta/core/kernel/momentum_recursion.h>
#include <momenta/core/open_chain/open_chain.h>

namespace momenta::core_open_chain {
namespace {

using namespace equations;

/// d/dt (T + V) along the motion is the power of dampers, drives and forces that follow bodies.
TEST(Laws, EnergyRateIsPower) {
  using D = Dual<double, 1>;
  double worst = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    Scene scene = random.scene({});
    for (ForceSpec& force : scene.forces)
      if (!force.in_body_axes) force.torque.setZero();  // a ground-axes couple has no potential
    OpenChain chain(scene, Algebra::spatial);
    const Tree& tree = chain.tree();
    const TreeState s = random.state(tree);
    Eigen::VectorXd udot(tree.nv), qdot(tree.nq);
    ASSERT_TRUE(chain.accelerations(s.t, s.q, s.u, udot));
    chain.coordinate_rates(s.q, s.u, qdot);

    // the energy as a dual number along (q̇, u̇, 1)
    const Model<Spatial> model = build_spatial_model(tree, scene);
    Workspace<Spatial, D> w(model);
    std::vector<D> q(static_cast<std::size_t>(tree.nq)), u(static_cast<std::size_t>(tree.nv));
    for (int i = 0; i < tree.nq; ++i) {
      q[static_cast<std::size_t>(i)] = D(s.q[i]);
      q[static_cast<std::size_t>(i)].b[0] = qdot[i];
    }
    for (int i = 0; i < tree.nv; ++i) {
      u[static_cast<std::size_t>(i)] = D(s.u[i]);
      u[static_cast<std::size_t>(i)].b[0] = udot[i];
    }
    poses_outward(w, D::variable(s.t, 0), q.data(), true);
    velocities_outward(w, u.data());
    const D kinetic = kinetic_energy(w), potential = potential_energy(w, q.data());

    // powers: every term also enters the size by its magnitude
    double power = 0, size = std::abs(kinetic.b[0]) + std::abs(potential.b[0]);
    const auto add = [&](double term) {
      power += term;
      size += std::abs(term);
    };
    Workspace<Spatial, double> plain(model);
    Eigen::VectorXd again(tree.nv), tau(tree.nv);
    ASSERT_TRUE(
        equations::acceleration_recursion(plain, s.t, s.q.data(), s.u.data(), again.data()));
    accelerations_outward(plain, s.u.data(), again.data());
    apply_forces(plain, model.has_body_forces());
    newton_euler_inward(plain, s.q.data(), s.u.data(), tau.data());  // body[k].P is F_K now
    for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
      const Tree::Body& b = tree.bodies[k];
      if (b.nv == 1) add(-b.damping * s.u[b.u] * s.u[b.u]);
      if (b.drive < 0) continue;
      const auto& moved = plain.body[k];
      add(Joint<Spatial>::along(model.bodies[k], moved.edge, moved.P) * moved.drive_rate);
    }
    const DenseLagrangian twin(scene, tree);
    const auto bodies = twin.moving(Real(s.t), std::vector<Real>(s.q.begin(), s.q.end()),
                                    std::vector<Real>(s.u.begin(), s.u.end()), true);
    const auto body = [&](const std::string& name) {
      for (std::size_t k = 0; k < scene.bodies.size(); ++k)
        if (scene.bodies[k].name == name) return &bodies[k];
      return static_cast<decltype(&bodies[0])>(nullptr);
    };
    const auto point = [&](const std::string& name, const Eigen::Vector3d& x) {
      std::pair<Triple<Real>, Triple<Real>> r{triple<Real>(x), {}};
      if (const auto* b = body(name)) {
        const Triple<Real> arm = b->axes * triple<Real>(x);
        r = {b->origin + arm, b->v + outer(b->w, arm)};
      }
      return r;
    };
    for (const ForceSpec& f : scene.forces) {
      if (f.kind == "spring-damper") {
        const auto from = point(f.parent, f.origin_parent), to = point(f.child, f.origin_child);
        const Triple<Real> line = to.first - from.first;
        const Real rate = inner(line, to.second - from.second) / std::sqrt(inner(line, line));
        add(static_cast<double>(-f.damping * rate * rate));
      } else if (f.kind == "wrench" && f.in_body_axes) {
        const auto* b = body(f.body);
        add(static_cast<double>(
            inner(b->axes * triple<Real>(f.force), point(f.body, f.point).second)));
        add(static_cast<double>(inner(b->axes * triple<Real>(f.torque), b->w)));
      }
    }
    // u̇ is known to its own size times ε, times the momenta it works against
    Eigen::VectorXd p(tree.nv);
    chain.momenta(s.t, s.q, s.u, p);
    const double work = p.cwiseAbs().dot(udot.cwiseAbs());
    const double error = std::abs(kinetic.b[0] + potential.b[0] - power);
    worst = equations::larger(worst, over_growth(error / std::max({1.0, size, work}),
                                                 condition(chain.mass_matrix(s.t, s.q))));
  }
  EXPECT_LT(worst, algebra_tol(12));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

TEST(Laws, InverseMassTimesIsTheInverse) {
  double worst = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    OpenChain chain(scene, Algebra::spatial);
    const Tree& tree = chain.tree();
    const TreeState s = random.state(tree);
    const Model<Spatial> model = build_spatial_model(tree, scene);
    const auto links = build_links(model);
    MomentumSweeps<Spatial, double> sweeps(links);
    Eigen::VectorXd u(tree.nv), pdot(tree.nv);
    ASSERT_TRUE(sweeps(s.t, s.q.data(), s.u.data(), u.data(), pdot.data()));
    const Eigen::MatrixXd m = chain.mass_matrix(s.t, s.q);
    Eigen::MatrixXd inverse(tree.nv, tree.nv);
    for (int j = 0; j < tree.nv; ++j) {
      const Eigen::VectorXd unit = Eigen::VectorXd::Unit(tree.nv, j);
      Eigen::VectorXd column(tree.nv);
      sweeps.inverse_mass_times(unit.data(), column.data());
      inverse.col(j) = column;
    }
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(tree.nv, tree.nv);
    worst =
        equations::larger(worst, over_growth(relative_error(m * inverse, identity), condition(m)));
    EXPECT_LT(over_growth(relative_error(inverse, inverse.transpose().eval()), condition(m)),
              algebra_tol(12));
  }
  EXPECT_LT(worst, algebra_tol(12));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

/// In canonical trees without dampers q̇ = ∂H/∂p, ṗ = −∂H/∂q. Hence ∂q̇/∂p and ∂ṗ/∂q are symmetric
/// and ∂ṗ/∂p = −(∂q̇/∂q)ᵀ. By dual numbers through the kernel, with drives.
template <class Space>
void hamiltonian_symmetry(bool flat) {
  double worst = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    RandomTree random(seed);
    const TreeRecipe recipe{.bodies = 6, .kinds = canonical_kinds};
    Scene scene = flat ? random.planar_scene(recipe) : random.scene(recipe);
    for (JointSpec& joint : scene.joints) joint.damping = 0;
    for (ForceSpec& force : scene.forces) {
      force.damping = 0;
      force.in_body_axes = false;
      if (!flat) force.torque.setZero();
    }
    const Tree tree = build_tree(scene);
    const TreeState s = random.state(tree);
    Model<Space> model;
    if constexpr (Space::dimension == 6)
      model = build_spatial_model(tree, scene);
    else
      model = build_planar_model(tree, scene, *find_plane(tree, scene).basis);
    Workspace<Space, double> plain(model);
    const int n = tree.nv;
    if (n == 0) continue;
    Eigen::VectorXd p(n);
    momenta_from_rates(plain, s.t, s.q.data(), s.u.data(), p.data());

    // rows q̇, ṗ; columns along q, then along p
    Eigen::MatrixXd jacobian(2 * n, 2 * n);
    Workspace<Space, Dual8> w(model);
    for (int first = 0; first < 2 * n; first += 8) {
      const auto size = static_cast<std::size_t>(n);
      std::vector<Dual8> q(s.q.begin(), s.q.end()), momenta(p.begin(), p.end()), u(size),
          pdot(size);
      const int last = std::min(first + 8, 2 * n);
      for (int j = first; j < last; ++j)
        (j < n ? q[static_cast<std::size_t>(j)] : momenta[static_cast<std::size_t>(j - n)])
            .b[static_cast<std::size_t>(j - first)] = 1;
      ASSERT_TRUE(equations::momentum_recursion(w, Dual8(s.t), q.data(), momenta.data(), u.data(),
                                                pdot.data()));
      for (std::size_t i = 0; i < size; ++i)
        for (int j = first; j < last; ++j) {
          const auto along = static_cast<std::size_t>(j - first);
          jacobian(static_cast<int>(i), j) = u[i].b[along];
          jacobian(n + static_cast<int>(i), j) = pdot[i].b[along];
        }
    }
    const Eigen::MatrixXd uq = jacobian.topLeftCorner(n, n), up = jacobian.topRightCorner(n, n),
                          pq = jacobian.bottomLeftCorner(n, n),
                          pp = jacobian.bottomRightCorner(n, n);
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    poses_outward(plain, s.t, s.q.data(), false);
    mass_matrix_inward(plain, [&](int i, int j, double value) { m(i, j) = m(j, i) = value; });
    const double growth = condition(m);
    const auto note = [&](double error) {
      worst = equations::larger(worst, over_growth(error, growth));
    };
    note(relative_error(up, up.transpose().eval()));
    note(relative_error(up * m, Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n))));
    note(relative_error(pq, pq.transpose().eval()));
    note(relative_error(pp, (-uq.transpose()).eval()));
  }
  EXPECT_LT(worst, algebra_tol(16));
  testing::Test::RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}
TEST(Laws, HamiltonianSymmetryInSpace) {
  hamiltonian_symmetry<Spatial>(false);
}
TEST(Laws, HamiltonianSymmetryInPlane) {
  hamiltonian_symmetry<Planar>(true);
}

/// In canonical trees ṗ is ∂L/∂q + Q, with derivatives of the twin's own T.
TEST(Laws, LagrangesEquations) {
  double worst = 0;
  for (unsigned seed = 200; seed < 260; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({.kinds = canonical_kinds});
    OpenChain chain(scene, Algebra::spatial);
    const DenseLagrangian twin(scene, chain.tree());
    const TreeState s = random.state(chain.tree());
    const RealVector expected = twin.lagrange_rates(s.t, s.q, s.u);
    Eigen::VectorXd p(chain.nv()), qdot(chain.nv()), pdot(chain.nv());
    chain.momenta(s.t, s.q, s.u, p);
    ASSERT_TRUE(chain.rates(s.t, s.q, p, qdot, pdot));
    worst = equations::larger(worst, over_growth(relative_error(pdot, expected.cast<double>()),
                                                 condition(chain.mass_matrix(s.t, s.q))));
  }
  EXPECT_LT(worst, algebra_tol(6));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

/// The whole scene turned and shifted: joints on the ground, gravity, and what is given in ground
/// axes move along; the motion in joint coordinates does not change.
TEST(Laws, SpaceHasNoPreferredPlace) {
  double worst = 0;
  for (unsigned seed = 300; seed < 400; ++seed) {
    RandomTree random(seed);
    const Scene scene = random.scene({});
    const Eigen::Quaterniond turn = random.turn();
    const Eigen::Vector3d shift = random.vector(3);
    Scene moved = scene;
    moved.gravity = turn * scene.gravity;
    for (JointSpec& joint : moved.joints)
      if (joint.parent == "ground") {
        joint.origin_parent = turn * joint.origin_parent + shift;
        joint.rotation = turn * joint.rotation;
      }
    for (ForceSpec& force : moved.forces) {
      if (force.kind == "spring-damper" && force.parent == "ground")
        force.origin_parent = turn * force.origin_parent + shift;
      if (force.kind == "wrench" && !force.in_body_axes) {
        force.force = turn * force.force;
        force.torque = turn * force.torque;
      }
    }
    OpenChain here(scene, Algebra::spatial), there(moved, Algebra::spatial);
    const TreeState s = random.state(here.tree());
    const int nq = here.nq(), nv = here.nv();
    Eigen::VectorXd p(nv), qdot(nq), pdot(nv), qdot_there(nq), pdot_there(nv);
    here.momenta(s.t, s.q, s.u, p);
    ASSERT_TRUE(here.rates(s.t, s.q, p, qdot, pdot));
    ASSERT_TRUE(there.rates(s.t, s.q, p, qdot_there, pdot_there));
    const double growth = condition(here.mass_matrix(s.t, s.q));
    worst = equations::larger(worst, over_growth(relative_error(qdot_there, qdot), growth));
    worst = equations::larger(worst, over_growth(relative_error(pdot_there, pdot), growth));
    EXPECT_LT(relative_error(there.mass_matrix(s.t, s.q), here.mass_matrix(s.t, s.q)),
              algebra_tol(12));
  }
  EXPECT_LT(worst, algebra_tol(6));
  RecordProperty("worst", std::to_string(worst * 1e16) + "e-16");
}

}  // namespace
}  // namespace momenta::core_open_chain
