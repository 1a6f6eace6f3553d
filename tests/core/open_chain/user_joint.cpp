// User joints of the pose of built-in joints: the same motion, momenta, reactions, derivatives.
#include <gtest/gtest.h>
#include <momenta/core/open_chain/open_chain.h>

#include <algorithm>

#include "equations/parts.h"
#include "equations/tolerance.h"
#include "equations/user_chain.h"

namespace momenta::core_user_joint {
namespace {

using namespace equations;

/// `law` against the chain of built-in joints it stands for; `whole`: a kind that is such a chain.
void compare(const Chain& law, std::optional<JointSpec> whole = {}) {
  const int n = static_cast<int>(law.steps.size());
  const auto shared = std::make_shared<UserJoint>(n, law);
  const Scene mine =
      tree_of([&](Scene& s, const JointSpec& j) { s.joints.push_back(user(j, shared)); }, true);
  const Scene theirs = tree_of(
      [&](Scene& s, JointSpec j) {
        if (whole) {
          j.kind = whole->kind;
          j.axis = whole->axis;
          j.axis2 = whole->axis2;
          j.pitch = whole->pitch;
          s.joints.push_back(j);
          return;
        }
        for (int i = 0; i < n; ++i) {
          JointSpec part =
              equations::make_joint(law.steps[static_cast<std::size_t>(i)].kind,
                                    i + 1 == n ? j.name : j.name + std::to_string(i),
                                    i == 0 ? j.parent : j.name + std::to_string(i - 1),
                                    i + 1 == n ? j.child : j.name + std::to_string(i), {0, 0, 0},
                                    law.steps[static_cast<std::size_t>(i)].axis);
          if (i == 0) part.origin_parent = j.origin_parent, part.rotation = j.rotation;
          if (i + 1 == n) part.origin_child = j.origin_child;
          s.joints.push_back(part);
          if (i + 1 == n) continue;
          BodySpec massless;
          massless.name = part.child;
          s.bodies.push_back(massless);
        }
      },
      true);
  const double arm = length_of(theirs);
  OpenChain chain(mine, Algebra::spatial), reference(theirs, Algebra::spatial);
  ASSERT_EQ(chain.nv(), 2 * n + 2);
  ASSERT_EQ(reference.nv(), 2 * n + 2);
  for (unsigned seed = 0; seed < 5; ++seed) {
    const State s(2 * n + 2, 100 + seed);
    const Answer x(chain, s), y(reference, s);
    EXPECT_LE(relative_error(x.p, y.p), 1e-13);
    EXPECT_LE(relative_error(x.qdot, y.qdot), 1e-13);
    EXPECT_LE(relative_error(x.qdot, s.u), 1e-13);
    EXPECT_LE(relative_error(x.pdot, y.pdot), 1e-13);
    EXPECT_LE(relative_error(x.udot, y.udot), 1e-13);
    EXPECT_LE(relative_error(x.solved, y.solved), 1e-13);
    EXPECT_LE(relative_error(x.mass, y.mass), 1e-13);
    EXPECT_LE(relative_error(x.jacobian, y.jacobian), 1e-12);
    EXPECT_LE(relative_error(x.energies, y.energies), 1e-13);
    for (const auto& [name, r] : x.reactions) {
      ASSERT_TRUE(y.reactions.contains(name));
      EXPECT_LE(relative_error(r.force, y.reactions.at(name).force), 1e-13) << name;
      // A torque is one about a point: rounding of force times arm is in it.
      const auto& other = y.reactions.at(name);
      EXPECT_LE(relative_error(r.torque, other.torque, std::max(1.0, arm * other.force.norm())),
                1e-13)
          << name;
    }
  }
}

TEST(UserJoint, RevoluteAndPrismatic) {
  compare({{{a_turn, slanted}}});
  compare({{{a_slide, slanted}}});
}

TEST(UserJoint, Helical) {
  JointSpec whole;
  whole.kind = JointKind::helical;
  whole.axis = slanted;
  whole.pitch = 0.3;
  compare({{{JointKind::helical, slanted}}, 0.3}, whole);
}

TEST(UserJoint, Cylindrical) {
  JointSpec whole;
  whole.kind = JointKind::cylindrical;
  whole.axis = slanted;
  compare({{{a_slide, slanted}, {a_turn, slanted}}}, whole);
}

TEST(UserJoint, Universal) {
  JointSpec whole;
  whole.kind = JointKind::universal;
  whole.axis = slanted;
  whole.axis2 = Y;
  compare({{{a_turn, slanted}, {a_turn, Y}}}, whole);
}

TEST(UserJoint, EulerAnglesAndSixCoordinates) {
  compare({{{a_turn, Z}, {a_turn, Y}, {a_turn, X}}});
  compare({{{a_slide, slanted}, {a_turn, Z}, {a_slide, X}, {a_turn, Y}, {a_turn, X}}});
  compare({{{a_slide, X}, {a_slide, Y}, {a_slide, Z}, {a_turn, Z}, {a_turn, Y}, {a_turn, X}}});
}

TEST(UserJoint, EulerAnglesAreTheSphericalJoint) {
  // With ω = E u and p = Eᵀ p_ω, energies and the motion of the other joints are the same.
  const Chain euler{{{a_turn, Z}, {a_turn, Y}, {a_turn, X}}};
  const auto law = std::make_shared<UserJoint>(3, euler);
  OpenChain mine(
      tree_of([&](Scene& s, const JointSpec& j) { s.joints.push_back(user(j, law)); }, true));
  OpenChain spherical(tree_of(
      [&](Scene& s, JointSpec j) {
        j.kind = JointKind::spherical;
        s.joints.push_back(j);
      },
      true));
  const State s(8, 5);
  Eigen::VectorXd q(spherical.nq()), u(spherical.nv()), one(8), other(8);
  for (const char* name : {"U1", "J2", "U2", "J4"}) {
    const auto& m = mine.tree().bodies[static_cast<std::size_t>(mine.tree().carried_by(name))];
    const auto& b =
        spherical.tree().bodies[static_cast<std::size_t>(spherical.tree().carried_by(name))];
    if (b.kind != JointKind::spherical) {
      q[b.q] = s.q[m.q];
      u[b.u] = s.u[m.u];
      continue;
    }
    UserMotion<double> at;
    for (int i = 0; i < 3; ++i) at.q[i] = s.q[m.q + i];
    user_motion(*law, static_cast<const double*>(nullptr), at);
    Eigen::Matrix3d r;
    u.segment(b.u, 3).setZero();
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        r(i, k) = at.rotation(i, k);
        u[b.u + i] += at.E[k].w[i] * s.u[m.u + k];
      }
    const Eigen::Quaterniond turned(r);
    q.segment(b.q, 4) << turned.w(), turned.x(), turned.y(), turned.z();
  }
  const Energies e = mine.energies(0, s.q, s.u), f = spherical.energies(0, q, u);
  EXPECT_NEAR(e.kinetic, f.kinetic, 1e-13 * f.kinetic);
  EXPECT_NEAR(e.potential, f.potential, 1e-13 * (1 + std::abs(f.potential)));
  ASSERT_TRUE(mine.accelerations(0, s.q, s.u, one));
  ASSERT_TRUE(spherical.accelerations(0, q, u, other));
  const auto place = [](OpenChain& c, const char* name) {
    return c.tree().bodies[static_cast<std::size_t>(c.tree().carried_by(name))].u;
  };
  for (const char* name : {"J2", "J4"})
    EXPECT_NEAR(one[place(mine, name)], other[place(spherical, name)], 1e-12) << name;
  const auto x = mine.reactions(0, s.q, s.u), y = spherical.reactions(0, q, u);
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_LE(relative_error(x[i].force, y[i].force), 1e-13);
    EXPECT_LE(relative_error(x[i].torque, y[i].torque), 1e-13);
  }
}

/// The derivatives of x by 2n numbers, what was cut put back.
Eigen::VectorXd derivatives(const LocalDual& x, const Cuts& cuts, int count) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count + cuts.size());
  for (int k = 0; k < x.terms; ++k)
    sum[x.at[static_cast<std::size_t>(k)]] += x.b[static_cast<std::size_t>(k)];
  for (int z = cuts.size(); z-- > 0;)
    for (std::size_t k = cuts.first(z); k < cuts.last(z); ++k)
      sum[cuts.columns()[k]] += sum[count + z] * cuts.values()[k];
  return sum.head(count);
}

TEST(UserJoint, SparseDualNumbersHaveTheSameDerivatives) {
  const Chain six{
      {{a_slide, X}, {a_slide, Y}, {a_slide, Z}, {a_turn, slanted}, {a_turn, Y}, {a_turn, X}}};
  for (const UserJoint& law : {UserJoint(2, Moving{}), UserJoint(6, six)})
    for (const bool moves : {true, false}) {
      const int n = law.coordinates();
      const State s(n, 31);
      UserMotion<LocalDual> sparse;
      LocalDual rates[6];
      sparse.t = LocalDual(s.t);
      for (int i = 0; i < n; ++i) {
        sparse.q[i] = LocalDual::variable(s.q[i], i);
        rates[i] = LocalDual::variable(s.u[i], n + i);
      }
      Cuts cuts;
      cuts.begin(2 * n, true);
      user_motion(law, moves ? static_cast<const LocalDual*>(rates) : nullptr, sparse);
      cuts.stop();
      using D = Dual<double, 1>;
      std::vector<LocalDual> all;
      each_number(sparse, [&](const LocalDual& x) { all.push_back(x); });
      for (int direction = 0; direction < 2 * n; ++direction) {
        UserMotion<D> one;
        D along[6];
        one.t = D(s.t);
        for (int i = 0; i < n; ++i) {
          one.q[i] = D(s.q[i]), along[i] = D(s.u[i]);
          if (direction == i) one.q[i].b[0] = 1;
          if (direction == n + i) along[i].b[0] = 1;
        }
        user_motion(law, moves ? static_cast<const D*>(along) : nullptr, one);
        std::size_t k = 0;
        each_number(one, [&](const D& x) {
          EXPECT_NEAR(all[k].a, x.a, 1e-14) << k;
          EXPECT_NEAR(derivatives(all[k], cuts, 2 * n)[direction], x.b[0], 1e-12)
              << k << " " << direction;
          ++k;
        });
      }
    }
}

}  // namespace
}  // namespace momenta::core_user_joint
