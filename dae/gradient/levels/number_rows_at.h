#pragma once
// NumberRows at one level; included by the files that are compiled for it, and nowhere else. Where
// r1, r3 are linear in numbers, their δ are plain numbers; with places of joints, loops and
// springs, dual numbers of one θ a lane, with directions in the tables. By a small screw ξ of a
// joint's place, fixed in the parent's axes, the joint's load moves as if the parent had moved,
//
//   T → (1 + ξ) T,   Ω_L → Ω_L + Ω_L × ξ on the way out,   F → F + ξ × F on the way back,
//
// and ends of loops and springs by their own shifts and turns.

#include <momenta/core/kernel/forces.h>
#include <momenta/core/kernel/sweeps.h>
#include <momenta/dae/gradient/levels/direction_sweeps_at.h>
#include <momenta/dae/gradient/levels/moved_loops.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

#include <optional>
#include <vector>

namespace momenta {

/// `Places`: with places.
template <class Space, int Level, bool Places>
class NumberRowsAt final : public NumberRows {
  static constexpr int lanes = native_width<Level>;
  static constexpr int axes = Space::dimension == 6 ? 3 : 2;
  using Lanes = Pack<lanes, Level>;
  using S = std::conditional_t<Places, Directions<lanes, Level>, Lanes>;
  using Motion = typename Space::template Motion<S>;
  using Force = typename Space::template Force<S>;
  using Vector = typename Space::template Vector<S>;
  using Numbers = NumberPlaces<Space>;

 public:
  /// `loops` null: without places.
  NumberRowsAt(const Model<Space>& model, std::size_t count, const LoopModel<Space>* loops)
      : model_(model),
        places_(number_places(model, count)),
        w_(model),
        q_(static_cast<std::size_t>(model.nq)),
        u_(static_cast<std::size_t>(model.nv)),
        r1_(u_.size()),
        r3_(u_.size()) {
    if constexpr (Places) {
      loops_.emplace(*loops, w_);
      sigma_.resize(static_cast<std::size_t>(loops->rows));
      r2_.resize(sigma_.size());
    }
  }

  int width() const override { return lanes; }
  void feed_back(double leak, double beta) override {
    leak_ = leak;
    beta_ = beta;
  }

  std::size_t take(const double* dn) override {
    Taken& t = taken_.emplace_back();
    t.dn.assign(dn, dn + lanes * places_.size);
    const auto any = [&](Eigen::Index first, Eigen::Index count) {
      for (Eigen::Index i = lanes * first; i < lanes * (first + count); ++i)
        if (dn[i] != 0) return true;
      return false;
    };
    const auto list = [&](std::vector<std::size_t>& to, std::size_t parts, Eigen::Index first,
                          Eigen::Index of_part, Eigen::Index from) {
      for (std::size_t k = 0; k < parts; ++k)
        if (any(first + of_part * static_cast<Eigen::Index>(k) + from, of_part - from))
          to.push_back(k);
    };
    list(t.bodies, w_.body.size(), 0, Numbers::of_body, 0);
    list(t.joints, w_.body.size(), places_.joints, Numbers::of_joint, of_place);
    list(t.springs, model_.springs.size(), places_.springs, Numbers::of_spring,
         Places ? 0 : 2 * axes);
    list(t.sums, model_.coordinate_springs.size(), places_.sums, Numbers::of_sum, 0);
    t.gravity = any(places_.joints - axes, axes);
    if constexpr (Places) {
      t.moved.resize(w_.body.size());
      for (std::size_t k = 0; k < w_.body.size(); ++k)
        t.moved[k] =
            any(places_.joints + Numbers::of_joint * static_cast<Eigen::Index>(k), of_place);
    }
    return taken_.size() - 1;
  }

  void place(double t, const double* q, const double* u, const double* sigma) override {
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] = S(q[i]);
    for (std::size_t i = 0; i < u_.size(); ++i) u_[i] = S(u[i]);
    if constexpr (Places) {
      t_ = t;
      plain_sigma_ = sigma;
      return;
    }
    poses_outward(w_, S(t), q_.data(), true);
    velocities_outward(w_, u_.data());
    if (model_.has_gravity) gravity_outward(w_);
  }

  void rows(std::size_t place, double* r1, [[maybe_unused]] double* r2, double* r3) override {
    const Taken& t = taken_[place];
    if constexpr (Places) {
      place_moved(t);
      body_momenta(w_);
      apply_forces(w_, model_.has_body_forces());
      add_loops(t, r2);
    } else {
      for (auto& body : w_.body) {
        body.P = {};
        body.T = {};
      }
    }
    for (const std::size_t k : t.bodies) add_inertia(k, t);
    if (t.gravity) add_gravity(t);
    for (const std::size_t i : t.springs) add_spring(i, t);
    for (const std::size_t i : t.sums) add_sum(i, t);
    inward(t);
    for (const std::size_t k : t.joints) add_joint(k, t);
    for (std::size_t i = 0; i < r1_.size(); ++i) {
      slope(r1_[i]).store(r1 + lanes * i);
      slope(r3_[i]).store(r3 + lanes * i);
    }
  }

 private:
  /// Numbers of a joint's place: shift and turn, or direction of a slide.
  static constexpr Eigen::Index of_place = Numbers::of_joint - 6;
  struct Taken {
    std::vector<double> dn;
    std::vector<std::size_t> bodies, joints, springs, sums;  ///< indices that change
    bool gravity = false;
    std::vector<char> moved;  ///< by body: the place of its joint changes
  };
  static S number(const Taken& t, Eigen::Index i) {
    const Lanes dn = Lanes::load(t.dn.data() + lanes * i);
    if constexpr (Places) {
      S x;
      x.a = Lanes(0.0);
      x.b[0] = dn;
      return x;
    } else {
      return dn;
    }
  }
  static const Lanes& slope(const S& x) {
    if constexpr (Places)
      return x.b[0];
    else
      return x;
  }
  Vector vector(const Taken& t, Eigen::Index first) const {
    Vector v;
    for (int i = 0; i < axes; ++i) v[i] = number(t, first + i);
    return v;
  }

  /// Adds δM Ω and the weight of δm, δ(m c).
  void add_inertia(std::size_t k, const Taken& t) {
    auto& s = w_.body[k];
    const Eigen::Index first = Numbers::of_body * static_cast<Eigen::Index>(k);
    typename Space::template RigidInertia<S> change;
    change.m = number(t, first);
    change.mc = vector(t, first + 1);
    if constexpr (axes == 2) {
      const Vector own = change.mc;
      change.mc = {{s.edge.c * own[0] - s.edge.s * own[1], s.edge.s * own[0] + s.edge.c * own[1]}};
      change.J = number(t, first + 3);
    } else {
      for (int i = 0; i < 6; ++i) change.J.x[i] = number(t, first + 4 + i);
    }
    s.P += Space::momentum(change, s.V);
    if (model_.has_gravity) s.T += Space::weight(change.m, change.mc, s.g);
  }
  void add_gravity(const Taken& t) {
    const Vector change = vector(t, places_.joints - axes);
    for (std::size_t k = 0; k < w_.body.size(); ++k) {
      const auto& inertia = w_.inertia(k);
      Vector mc, g = change;
      for (int i = 0; i < axes; ++i) mc[i] = S(inertia.mc[i]);
      if constexpr (axes == 3) g = from_ground(w_, static_cast<int>(k), change);
      w_.body[k].T += Space::weight(S(inertia.m), mc, g);
    }
  }
  /// −δk s + k δrest − δc ṡ along the stretch s; numbers from `first` on.
  S force(const Taken& t, Eigen::Index first, double stiffness, const S& stretch,
          const S& rate) const {
    return stiffness * number(t, first + 1) - number(t, first) * stretch -
           number(t, first + 2) * rate;
  }
  void add_spring(std::size_t i, const Taken& t) {
    const auto& spring = model_.springs[i];
    SpringLine<Space, S> line(w_, spring);
    if (!line.has_direction()) return;
    const Eigen::Index first =
        places_.springs + Numbers::of_spring * static_cast<Eigen::Index>(i) + 2 * axes;
    if constexpr (Places) {  // pull of moved ends, not the spring's own
      using std::sqrt;
      const auto tension = [&](const SpringLine<Space, S>& at) {
        return S((spring.stiffness * (at.length - S(spring.rest)) +
                  spring.damping * at.rate(w_, spring)) /
                 at.length);
      };
      line.pull(w_, spring, S(-tension(line)));
      line.parent += to_ground(w_, spring.parent, vector(t, first - 2 * axes));
      line.child += to_ground(w_, spring.child, vector(t, first - axes));
      line.D = line.child - line.parent;
      line.length = sqrt(dot(line.D, line.D) + (S(spring.offset2) + number(t, first + 3)));
      line.pull(w_, spring, tension(line));
    }
    line.pull(
        w_, spring,
        S(-force(t, first, spring.stiffness, S(line.length - spring.rest), line.rate(w_, spring)) /
          line.length));
  }
  void add_sum(std::size_t i, const Taken& t) {
    const auto& spring = model_.coordinate_springs[i];
    const S along =
        force(t, places_.sums + Numbers::of_sum * static_cast<Eigen::Index>(i), spring.stiffness,
              coordinate_stretch(w_, spring), coordinate_stretch_rate(w_, spring));
    for (const auto& term : spring.terms) add_along_joint(w_, term.body, S(term.ratio * along));
  }
  void add_joint(std::size_t k, const Taken& t) {
    using std::sqrt;
    const auto& b = model_.bodies[k];
    if (b.nv != 1) return;
    const Eigen::Index first =
        places_.joints + Numbers::of_joint * static_cast<Eigen::Index>(k) + of_place;
    const auto at = static_cast<std::size_t>(b.u);
    const S &u = u_[at], stretch = q_[static_cast<std::size_t>(b.q)] - S(b.rest);
    const S size = sqrt(u * u + S(b.friction_rate * b.friction_rate));
    r3_[at] += force(t, first, b.stiffness, stretch, u) + number(t, first + 3) -
               number(t, first + 4) * (u / size);
    r1_[at] += number(t, first + 5) * u;
  }

  /// ξ of joint k in the parent's axes.
  Motion screw(const Taken& t, std::size_t k) const {
    const Eigen::Index first = places_.joints + Numbers::of_joint * static_cast<Eigen::Index>(k);
    Motion xi{};
    xi.v = vector(t, first);
    if constexpr (axes == 3) xi.w = vector(t, first + 3);
    return xi;
  }
  /// Poses, gravity and velocities with the places of joints moved.
  void place_moved(const Taken& t) {
    w_.time = S(t_);
    Vector fall;
    for (int i = 0; i < axes; ++i) fall[i] = S(model_.gravity[i]);
    for (std::size_t k = 0; k < w_.body.size(); ++k) {
      place_body(w_, k, S(t_), q_.data(), false);
      const auto& b = model_.bodies[k];
      auto& s = w_.body[k];
      const auto* parent = b.parent < 0 ? nullptr : &w_.body[static_cast<std::size_t>(b.parent)];
      typename Space::template Pose<S> from;
      if constexpr (axes == 3) from.axes = identity3<S>();
      if (parent) from = parent->pose;
      if constexpr (axes == 2) {
        if (t.moved[k]) {
          const Eigen::Index first =
              places_.joints + Numbers::of_joint * static_cast<Eigen::Index>(k);
          s.edge.r += to_ground(w_, b.parent, vector(t, first));
          if (b.kind == JointKind::prismatic) {
            const Vector along = to_ground(w_, b.parent, vector(t, first + 2));
            s.edge.prismatic += along;
            s.edge.r += (b.drive >= 0 ? s.drive : q_[static_cast<std::size_t>(b.q)]) * along;
          }
        }
        s.pose = Space::pose_outward(b.edge, b.kind, s.edge, from);
        s.g = fall;
      } else {
        Vector shift{};
        if (t.moved[k]) {
          const Motion xi = screw(t, k);
          shift = from.axes * xi.v;
          Mat3<S> axes_now = from.axes;
          for (int i = 0; i < 3; ++i) {  // R (1 + ξ_ω ×), row by row
            const Vector row{{from.axes(i, 0), from.axes(i, 1), from.axes(i, 2)}};
            const Vector turned = cross(row, xi.w);
            for (int j = 0; j < 3; ++j) axes_now(i, j) += turned[j];
          }
          from.axes = axes_now;
        }
        const auto at = Space::pose_outward(b.edge, b.kind, s.edge,
                                            typename Space::template Pose<S>{from.axes, {}});
        s.step = shift + at.origin;
        s.pose = {at.axes, from.origin + s.step};
        s.g = from_ground(w_, static_cast<int>(k), fall);
      }
      move_body(w_, k, u_.data());
      if constexpr (axes == 3)
        if (t.moved[k] && parent)
          s.V +=
              Space::to_child(b.edge, b.kind, s.edge, Space::cross_motion(parent->V, screw(t, k)));
    }
  }
  /// Fills r2, adds impulses and their rates to the bodies.
  void add_loops(const Taken& t, double* r2) {
    for (std::size_t i = 0; i < sigma_.size(); ++i)
      sigma_[i] = S(plain_sigma_ ? plain_sigma_[i] : 0.0);
    loops_->add(
        sigma_.data(), leak_, beta_, [&](Eigen::Index i) { return number(t, places_.loops + i); },
        r2_.data());
    for (std::size_t i = 0; i < r2_.size(); ++i) slope(r2_[i]).store(r2 + lanes * i);
  }

  /// Eᵀ P* and Eᵀ (T* − Ω × P*), (34) and (35).
  void inward([[maybe_unused]] const Taken& t) {
    for (std::size_t k = w_.body.size(); k-- > 0;) {
      const auto& b = model_.bodies[k];
      auto& s = w_.body[k];
      if (b.nv > 0) {
        const auto at = static_cast<std::size_t>(b.u);
        Joint<Space>::project(b, s.edge, s.P, &r1_[at]);
        auto net = s.T;
        net -= Space::cross_force(s.V, s.P);
        Joint<Space>::project(b, s.edge, net, &r3_[at]);
        if constexpr (axes == 3)
          if (b.law) {
            Joint<Space>::move(b, s.edge, &u_[at]);
            Joint<Space>::add_axis_rate(b, s.edge, s.P, &r3_[at]);
          }
      }
      if (b.parent < 0) continue;
      auto& parent = w_.body[static_cast<std::size_t>(b.parent)];
      Force P = Space::to_parent(b.edge, b.kind, s.edge, s.P),
            T = Space::to_parent(b.edge, b.kind, s.edge, s.T);
      if constexpr (Places && axes == 3)
        if (t.moved[k]) {
          const Motion xi = screw(t, k);
          P += Space::cross_force(xi, P);
          T += Space::cross_force(xi, T);
        }
      parent.P += P;
      parent.T += T;
    }
  }

  const Model<Space>& model_;
  Numbers places_;
  Workspace<Space, S> w_;
  std::vector<S> q_, u_, r1_, r3_;
  std::vector<Taken> taken_;
  // With places alone:
  std::conditional_t<Places, std::optional<MovedLoops<Space, S>>, int> loops_{};
  std::vector<S> sigma_, r2_;
  double t_ = 0, leak_ = 0, beta_ = 0;
  const double* plain_sigma_ = nullptr;
};

template <int Level, class Space>
std::unique_ptr<NumberRows> number_rows_at(const Model<Space>& model, std::size_t count,
                                           const LoopModel<Space>* loops) {
  if (loops) return std::make_unique<NumberRowsAt<Space, Level, true>>(model, count, loops);
  return std::make_unique<NumberRowsAt<Space, Level, false>>(model, count, nullptr);
}

}  // namespace momenta
