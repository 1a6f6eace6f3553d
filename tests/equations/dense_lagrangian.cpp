// The sums over bodies. Nested dual numbers are slow to compile: here, once for all programs.

#include "equations/dense_lagrangian.h"

namespace momenta::equations {

DenseLagrangian::DenseLagrangian(const Scene& scene, const Tree& tree)
    : scene_(scene),
      places_(scene.bodies.size()),
      rotors_(static_cast<std::size_t>(tree.nv)),
      nq_(tree.nq),
      nv_(tree.nv) {
  for (std::size_t k = 0; k < scene.bodies.size(); ++k)
    bodies_[scene.bodies[k].name] = static_cast<int>(k);
  for (const JointSpec& joint : scene.joints) {
    Place& p = places_[static_cast<std::size_t>(body(joint.child))];
    p.joint = &joint;
    p.parent = body(joint.parent);
    for (const DriveSpec& d : scene.drives)
      if (d.joint == joint.name) p.drives[d.coordinate] = &d;
    const int first = tree.first_part(tree.carried_by(joint.name));
    const auto& layout = tree.bodies[static_cast<std::size_t>(first)];
    p.q = layout.q;
    p.u = layout.u;
    p.nv = rates_of(joint.kind) - static_cast<int>(p.drives.size());
    p.quaternion =
        p.nv > 0 && (joint.kind == JointKind::spherical || joint.kind == JointKind::free);
    auto rate = static_cast<std::size_t>(p.u);  // driven coordinates have none
    if (joint.kind == JointKind::spherical)
      for (int i = 0; i < p.nv && !joint.rotor_inertia.empty(); ++i)
        rotors_[rate++] = joint.rotor_inertia[0];
    else
      for (std::size_t i = 0; i < joint.rotor_inertia.size(); ++i)
        if (!p.drives.contains(static_cast<int>(i))) rotors_[rate++] = joint.rotor_inertia[i];
  }
  std::vector<bool> placed(places_.size(), false);
  while (order_.size() < places_.size())
    for (std::size_t k = 0; k < places_.size(); ++k)
      if (!placed[k] &&
          (places_[k].parent < 0 || placed[static_cast<std::size_t>(places_[k].parent)])) {
        placed[k] = true;
        order_.push_back(k);
      }
}

template <class S>
auto DenseLagrangian::frames(const S& t, const List<S>& q) const -> List<Frame<S>> {
  const Rotation<S> upright = from_quaternion(lift<S>(1), Triple<S>{});
  List<Frame<S>> all(places_.size());
  for (const std::size_t k : order_) {
    const Place& p = places_[k];
    const JointSpec& j = *p.joint;
    const Frame<S> parent =
        p.parent < 0 ? Frame<S>{upright, {}} : all[static_cast<std::size_t>(p.parent)];
    // the joint frame in ground axes
    const Rotation<S> joint_axes =
        product(parent.axes, from_quaternion(lift<S>(j.rotation.w()), triple<S>(j.rotation.vec())));
    const Triple<S> joint_origin = parent.origin + parent.axes * triple<S>(j.origin_parent);
    // the child in the joint frame
    const S* own = q.data() + p.q;
    const auto coordinate = [&](int i) {  // q has no place for those that are driven
      const auto drive = p.drives.find(i);
      if (drive != p.drives.end()) return drive_position(*drive->second, t);
      const S* at = own;
      for (const auto& [driven, law] : p.drives) at -= driven < i;
      return at[i];
    };
    const auto unit = [](const Eigen::Vector3d& v) {
      using std::sqrt;
      const Triple<S> along = triple<S>(v);
      return (lift<S>(1) / sqrt(inner(along, along))) * along;
    };
    const auto about = [&](int x, const S& angle) {
      return about_axis(triple<S>(Eigen::Vector3d::Unit(x)), angle);
    };
    const Triple<S> axis = unit(j.axis);
    Rotation<S> turned = upright;
    Triple<S> moved{};
    switch (j.kind) {
      case JointKind::revolute:
        turned = about_axis(axis, coordinate(0));
        break;
      case JointKind::prismatic:
        moved = coordinate(0) * axis;
        break;
      case JointKind::helical:
        turned = about_axis(axis, coordinate(0));
        moved = lift<S>(j.pitch) * coordinate(0) * axis;
        break;
      case JointKind::cylindrical:
        moved = coordinate(0) * axis;
        turned = about_axis(axis, coordinate(1));
        break;
      case JointKind::universal: {
        const Triple<S> second = unit(j.axis2.isZero(0) ? perpendicular_to(j.axis) : j.axis2);
        turned = product(about_axis(axis, coordinate(0)), about_axis(second, coordinate(1)));
        break;
      }
      case JointKind::planar: {
        const Triple<S> given =
            triple<S>(j.direction.isZero(0) ? perpendicular_to(j.axis) : j.direction);
        using std::sqrt;
        const Triple<S> flat = given - inner(given, axis) * axis;
        const Triple<S> first = (lift<S>(1) / sqrt(inner(flat, flat))) * flat;
        moved = coordinate(0) * first + coordinate(1) * outer(axis, first);
        turned = about_axis(axis, coordinate(2));
        break;
      }
      case JointKind::spherical:
      case JointKind::free: {
        const int angles = j.kind == JointKind::free ? 3 : 0;
        if (angles > 0) moved = {coordinate(0), coordinate(1), coordinate(2)};
        if (p.quaternion) {
          own += angles;
          turned = from_quaternion(own[0], Triple<S>{own[1], own[2], own[3]});
        } else {
          turned = product(about(2, coordinate(angles + 2)),
                           product(about(1, coordinate(angles + 1)), about(0, coordinate(angles))));
        }
        break;
      }
      case JointKind::weld:
      case JointKind::user:  // tested against the built-in kinds
        break;
    }
    all[k].axes = product(joint_axes, turned);
    all[k].origin = joint_origin + joint_axes * moved - all[k].axes * triple<S>(j.origin_child);
  }
  return all;
}

template <class S>
auto DenseLagrangian::coordinate_rates(const List<S>& q, const List<S>& u) const -> List<S> {
  List<S> rates(q.size());
  for (const Place& p : places_) {
    auto at = static_cast<std::size_t>(p.q);
    auto from = static_cast<std::size_t>(p.u);
    if (!p.quaternion) {
      for (int i = 0; i < p.nv; ++i) rates[at++] = u[from++];
      continue;
    }
    const std::size_t quaternion = p.nv == 6 ? at + 3 : at;
    const S w = q[quaternion];
    const Triple<S> e{q[quaternion + 1], q[quaternion + 2], q[quaternion + 3]};
    if (p.nv == 6) {
      const Triple<S> v = from_quaternion(w, e) * Triple<S>{u[from], u[from + 1], u[from + 2]};
      for (std::size_t i = 0; i < 3; ++i) rates[at + i] = v[i];
      from += 3;
    }
    // ½ (w, e) ∘ (0, ω) = ½ (−e·ω, w ω + e × ω)
    const Triple<S> omega{u[from], u[from + 1], u[from + 2]};
    const S half = lift<S>(0.5L);
    const Triple<S> vector = half * (w * omega + outer(e, omega));
    rates[quaternion] = -(half * inner(e, omega));
    for (std::size_t i = 0; i < 3; ++i) rates[quaternion + 1 + i] = vector[i];
  }
  return rates;
}

template <class S>
auto DenseLagrangian::moving(const S& t, const List<S>& q, const List<S>& u, bool clock_runs) const
    -> List<Moving<S>> {
  using D = Dual<S, 1>;
  const List<S> qdot = coordinate_rates(q, u);
  List<D> along(q.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    along[i].a = q[i];
    along[i].b[0] = qdot[i];
  }
  D time;
  time.a = t;
  time.b[0] = lift<S>(clock_runs ? 1 : 0);
  const List<Frame<D>> frame = frames(time, along);
  List<Moving<S>> all(frame.size());
  for (std::size_t k = 0; k < frame.size(); ++k) {
    Rotation<S> rate;
    for (std::size_t i = 0; i < 3; ++i) {
      all[k].origin[i] = frame[k].origin[i].a;
      all[k].v[i] = frame[k].origin[i].b[0];
      for (std::size_t j = 0; j < 3; ++j) {
        all[k].axes[i][j] = frame[k].axes[i][j].a;
        rate[i][j] = frame[k].axes[i][j].b[0];
      }
    }
    const Rotation<S> spin = product(rate, transposed(all[k].axes));  // Ṙ Rᵀ = ω~
    all[k].w = {spin[2][1], spin[0][2], spin[1][0]};
  }
  return all;
}

template <class S>
auto DenseLagrangian::body_momenta(const List<Moving<S>>& bodies) const -> List<Wrench<S>> {
  List<Wrench<S>> all(bodies.size());
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const BodySpec& spec = scene_.bodies[k];
    const Moving<S>& b = bodies[k];
    const Triple<S> arm = b.axes * triple<S>(spec.com);
    Rotation<S> inertia;
    for (std::size_t i = 0; i < 3; ++i)
      inertia[i] = triple<S>(spec.inertia.row(static_cast<Eigen::Index>(i)));
    all[k].f = lift<S>(spec.mass) * (b.v + outer(b.w, arm));
    all[k].n = b.axes * (inertia * (transposed(b.axes) * b.w)) + outer(b.origin + arm, all[k].f);
  }
  return all;
}

template <class S>
auto DenseLagrangian::projected(const S& t, const List<S>& q, const List<Wrench<S>>& wrenches) const
    -> List<S> {
  List<S> sums(static_cast<std::size_t>(nv_));
  for (std::size_t j = 0; j < sums.size(); ++j) {
    List<S> unit(sums.size());
    unit[j] = lift<S>(1);
    const List<Moving<S>> virtual_motion = moving(t, q, unit, false);
    for (std::size_t k = 0; k < wrenches.size(); ++k) {
      const Moving<S>& b = virtual_motion[k];
      // δ of the point of the body that is at the ground's origin
      sums[j] += inner(wrenches[k].f, b.v - outer(b.w, b.origin)) + inner(wrenches[k].n, b.w);
    }
  }
  return sums;
}

template <class S>
S DenseLagrangian::kinetic_energy(const S& t, const List<S>& q, const List<S>& u) const {
  const auto bodies = moving(t, q, u, true);
  const auto h = body_momenta(bodies);
  S twice{};
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const Moving<S>& b = bodies[k];
    twice += inner(h[k].f, b.v - outer(b.w, b.origin)) + inner(h[k].n, b.w);
  }
  for (std::size_t i = 0; i < u.size(); ++i) twice += lift<S>(rotors_[i]) * u[i] * u[i];
  return lift<S>(0.5L) * twice;
}

template <class S>
S DenseLagrangian::potential_energy(const S& t, const List<S>& q) const {
  using std::sqrt;
  const auto at = frames(t, q);
  const auto point = [&](const std::string& name, const Eigen::Vector3d& x) {
    const int k = body(name);
    if (k < 0) return triple<S>(x);
    const auto& b = at[static_cast<std::size_t>(k)];
    return b.origin + b.axes * triple<S>(x);
  };
  S v{};
  for (const BodySpec& b : scene_.bodies)
    v -= lift<S>(b.mass) * inner(triple<S>(scene_.gravity), point(b.name, b.com));
  for (const Place& p : places_)
    if (p.has_joint_forces()) {
      const S stretch = q[static_cast<std::size_t>(p.q)] - lift<S>(p.joint->rest);
      v += lift<S>(0.5L * p.joint->stiffness) * stretch * stretch;
    }
  for (const ForceSpec& f : scene_.forces) {
    if (f.kind == "spring-damper") {
      const Triple<S> line = point(f.child, f.origin_child) - point(f.parent, f.origin_parent);
      const S stretch = sqrt(inner(line, line)) - lift<S>(f.rest);
      v += lift<S>(0.5L * f.stiffness) * stretch * stretch;
    } else if (f.kind == "torque") {
      for (const Place& p : places_)
        if (p.joint->name == f.joint && p.has_joint_forces())
          v -= lift<S>(f.value) * q[static_cast<std::size_t>(p.q)];
    } else if (!f.in_body_axes) {
      v -= inner(triple<S>(f.force), point(f.body, f.point));
    }
  }
  return v;
}

auto DenseLagrangian::applied(const List<Moving<Real>>& bodies) const -> List<Wrench<Real>> {
  using V = Triple<Real>;
  List<Wrench<Real>> sum(bodies.size());
  const auto push = [&](int k, const V& x, const V& f) {
    if (k < 0) return;
    auto& s = sum[static_cast<std::size_t>(k)];
    s.f = s.f + f;
    s.n = s.n + outer(x, f);
  };
  // position and velocity of a point of a body
  const auto point = [&](int k, const Eigen::Vector3d& x) -> std::pair<V, V> {
    if (k < 0) return {triple<Real>(x), V{}};
    const auto& b = bodies[static_cast<std::size_t>(k)];
    const V arm = b.axes * triple<Real>(x);
    return {b.origin + arm, b.v + outer(b.w, arm)};
  };
  for (std::size_t k = 0; k < bodies.size(); ++k) {
    const BodySpec& b = scene_.bodies[k];
    push(static_cast<int>(k), point(static_cast<int>(k), b.com).first,
         Real(b.mass) * triple<Real>(scene_.gravity));
  }
  for (const ForceSpec& f : scene_.forces) {
    if (f.kind == "spring-damper") {
      const auto [from, from_rate] = point(body(f.parent), f.origin_parent);
      const auto [to, to_rate] = point(body(f.child), f.origin_child);
      const V line = to - from;
      const Real length = std::sqrt(inner(line, line));
      const Real length_rate = inner(line, to_rate - from_rate) / length;
      const Real tension = f.stiffness * (length - f.rest) + f.damping * length_rate;
      push(body(f.child), to, (-tension / length) * line);
      push(body(f.parent), from, (tension / length) * line);
    } else if (f.kind == "wrench") {
      const int k = body(f.body);
      const auto& b = bodies[static_cast<std::size_t>(k)];
      const auto turned = [&](const Eigen::Vector3d& v) {
        return f.in_body_axes ? b.axes * triple<Real>(v) : triple<Real>(v);
      };
      push(k, point(k, f.point).first, turned(f.force));
      auto& s = sum[static_cast<std::size_t>(k)];
      s.n = s.n + turned(f.torque);
    }
  }
  return sum;
}

auto DenseLagrangian::momentum_changes(Real t, const List<Real>& q, const List<Real>& u,
                                       const List<Real>& udot) const -> List<Wrench<Real>> {
  using D = Dual<Real, 1>;
  const List<Real> qdot = coordinate_rates(q, u);
  List<D> q_along(q.size()), u_along(u.size());
  for (std::size_t i = 0; i < q.size(); ++i) {
    q_along[i].a = q[i];
    q_along[i].b[0] = qdot[i];
  }
  for (std::size_t i = 0; i < u.size(); ++i) {
    u_along[i].a = u[i];
    u_along[i].b[0] = udot[i];
  }
  const auto h = body_momenta(moving(D::variable(t, 0), q_along, u_along, true));
  List<Wrench<Real>> rates(h.size());
  for (std::size_t k = 0; k < h.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) {
      rates[k].f[i] = h[k].f[i].b[0];
      rates[k].n[i] = h[k].n[i].b[0];
    }
  return rates;
}

RealVector DenseLagrangian::generalised_forces(Real t, const Eigen::VectorXd& q,
                                               const Eigen::VectorXd& u) const {
  const List<Real> coordinates = real(q);
  const List<Real> sums = projected(t, coordinates, applied(moving(t, coordinates, real(u), true)));
  RealVector forces = Eigen::Map<const RealVector>(sums.data(), nv_);
  for (const Place& p : places_)
    if (p.has_joint_forces()) {
      const JointSpec& j = *p.joint;
      forces[p.u] -= Real(j.stiffness) * (Real(q[p.q]) - j.rest) + Real(j.damping) * u[p.u];
      for (const ForceSpec& f : scene_.forces)
        if (f.kind == "torque" && f.joint == j.name) forces[p.u] += f.value;
    }
  return forces;
}

RealMatrix DenseLagrangian::mass_matrix(Real t, const Eigen::VectorXd& q) const {
  const List<Real> at = real(q);
  RealMatrix m(nv_, nv_);
  for (int j = 0; j < nv_; ++j) {
    List<Real> unit(static_cast<std::size_t>(nv_));
    unit[static_cast<std::size_t>(j)] = 1;
    const List<Real> column = projected(t, at, body_momenta(moving(t, at, unit, false)));
    m.col(j) = Eigen::Map<const RealVector>(column.data(), nv_);
    m(j, j) += rotors_[static_cast<std::size_t>(j)];
  }
  return m;
}

RealVector DenseLagrangian::momenta_at(Real t, const Eigen::VectorXd& q,
                                       const Eigen::VectorXd& u) const {
  const List<Real> p = momenta(t, real(q), real(u));
  return Eigen::Map<const RealVector>(p.data(), nv_);
}

RealVector DenseLagrangian::accelerations(Real t, const Eigen::VectorXd& q,
                                          const Eigen::VectorXd& u) const {
  const List<Real> at = real(q), still(static_cast<std::size_t>(nv_));
  const List<Real> bias = projected(t, at, momentum_changes(t, at, real(u), still));
  return mass_matrix(t, q).ldlt().solve(generalised_forces(t, q, u) -
                                        Eigen::Map<const RealVector>(bias.data(), nv_));
}

auto DenseLagrangian::along(const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                            const RealVector& udot) const -> std::pair<List<D1>, List<D1>> {
  const RealVector qdot = coordinate_rates_at(q, u);
  List<D1> q_along(static_cast<std::size_t>(nq_)), u_along(static_cast<std::size_t>(nv_));
  for (int i = 0; i < nq_; ++i) {
    q_along[static_cast<std::size_t>(i)].a = q[i];
    q_along[static_cast<std::size_t>(i)].b[0] = qdot[i];
  }
  for (int i = 0; i < nv_; ++i) {
    u_along[static_cast<std::size_t>(i)].a = u[i];
    u_along[static_cast<std::size_t>(i)].b[0] = udot[i];
  }
  return {q_along, u_along};
}

Real DenseLagrangian::energy(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const {
  const List<Real> at = real(q);
  return kinetic_energy(t, at, real(u)) + potential_energy(t, at);
}

Real DenseLagrangian::energy_rate(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u,
                                  const RealVector& udot) const {
  const auto [q_along, u_along] = along(q, u, udot);
  const D1 clock = D1::variable(t, 0);
  return kinetic_energy(clock, q_along, u_along).b[0] + potential_energy(clock, q_along).b[0];
}

RealVector DenseLagrangian::momentum_rates(Real t, const Eigen::VectorXd& q,
                                           const Eigen::VectorXd& u) const {
  using D = D1;
  const auto [q_along, u_along] = along(q, u, accelerations(t, q, u));
  const List<D> p = momenta(D::variable(t, 0), q_along, u_along);
  RealVector rates(nv_);
  for (int i = 0; i < nv_; ++i) rates[i] = p[static_cast<std::size_t>(i)].b[0];
  return rates;
}

RealVector DenseLagrangian::lagrange_rates(Real t, const Eigen::VectorXd& q,
                                           const Eigen::VectorXd& u) const {
  using D = Dual<Real, 1>;
  RealVector rates = generalised_forces(t, q, u);
  for (int i = 0; i < nv_; ++i) {
    List<D> at(static_cast<std::size_t>(nq_)), rate(static_cast<std::size_t>(nv_));
    for (int k = 0; k < nq_; ++k) {
      at[static_cast<std::size_t>(k)] = lift<D>(q[k]);
      rate[static_cast<std::size_t>(k)] = lift<D>(u[k]);
    }
    at[static_cast<std::size_t>(i)].b[0] = 1;
    rates[i] += kinetic_energy(lift<D>(t), at, rate).b[0];
  }
  return rates;
}

RealVector DenseLagrangian::coordinate_rates_at(const Eigen::VectorXd& q,
                                                const Eigen::VectorXd& u) const {
  const List<Real> rates = coordinate_rates(real(q), real(u));
  return Eigen::Map<const RealVector>(rates.data(), nq_);
}

auto DenseLagrangian::reactions(Real t, const Eigen::VectorXd& q, const Eigen::VectorXd& u) const
    -> List<Eigen::Matrix<double, 6, 1>> {
  const RealVector udot = accelerations(t, q, u);
  const auto bodies = moving(t, real(q), real(u), true);
  const auto forces = applied(bodies);
  auto net = momentum_changes(t, real(q), real(u), {udot.data(), udot.data() + nv_});
  for (std::size_t i = order_.size(); i-- > 0;) {
    const std::size_t k = order_[i];
    net[k].f = net[k].f - forces[k].f;
    net[k].n = net[k].n - forces[k].n;
    if (places_[k].parent < 0) continue;
    auto& parent = net[static_cast<std::size_t>(places_[k].parent)];
    parent.f = parent.f + net[k].f;
    parent.n = parent.n + net[k].n;
  }
  List<Eigen::Matrix<double, 6, 1>> all;
  for (const JointSpec& joint : scene_.joints) {
    const auto k = static_cast<std::size_t>(body(joint.child));
    const auto& b = bodies[k];
    const Triple<Real> at = b.origin + b.axes * triple<Real>(joint.origin_child);
    const Triple<Real> f = transposed(b.axes) * net[k].f;
    const Triple<Real> n = transposed(b.axes) * (net[k].n - outer(at, net[k].f));
    Eigen::Matrix<double, 6, 1> wrench;
    for (std::size_t i = 0; i < 3; ++i) {
      wrench[static_cast<Eigen::Index>(i)] = static_cast<double>(f[i]);
      wrench[static_cast<Eigen::Index>(i + 3)] = static_cast<double>(n[i]);
    }
    all.push_back(wrench);
  }
  return all;
}

auto DenseLagrangian::poses(Real t, const Eigen::VectorXd& q) const -> List<Eigen::Isometry3d> {
  List<Eigen::Isometry3d> all;
  for (const Frame<Real>& f : frames(t, real(q))) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<std::size_t>(i);
      pose.translation()[i] = static_cast<double>(f.origin[row]);
      for (int j = 0; j < 3; ++j)
        pose.linear()(i, j) = static_cast<double>(f.axes[row][static_cast<std::size_t>(j)]);
    }
    all.push_back(pose);
  }
  return all;
}

template auto DenseLagrangian::moving(const Real&, const List<Real>&, const List<Real>&, bool) const
    -> List<Moving<Real>>;
template Real DenseLagrangian::kinetic_energy(const Real&, const List<Real>&,
                                              const List<Real>&) const;
template Real DenseLagrangian::potential_energy(const Real&, const List<Real>&) const;

}  // namespace momenta::equations
