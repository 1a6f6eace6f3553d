#pragma once
// NumberSweep at one level; derivation: number_slopes.h. A number that places a joint, an end of a
// loop or of a spring moves what hangs there by a small screw ξ, fixed in the axes of the body that
// carries it. With Ω the motion of that body, velocities there change by Ω × ξ, so that
//
//   ∂L*/∂ξ = T* − Ω × P*
//
// of the forces T* and momenta P* that are handed through there, loop impulses included: at a joint
// those of (26), (27), summed over all that it carries.
//
// Motions are collected until each lane of a register has one, and swept together: none depends on
// another.

#include <momenta/dae/gradient/levels/force_numbers.h>
#include <momenta/dae/gradient/levels/loop_numbers.h>
#include <momenta/dae/gradient/levels/tangent_sweeps.h>

#include <optional>
#include <vector>

namespace momenta {

template <class Space, int Level>
class NumberSweepAt final : public NumberSweep {
  static constexpr int axes = Space::dimension == 6 ? 3 : 2, width = native_width<Level>;
  using Lanes = Pack<width, Level>;
  using S = Directions<width, Level>;
  using Vector = typename Space::template Vector<S>;
  using Force = typename Space::template Force<S>;

 public:
  NumberSweepAt(const Model<Space>& model, const LoopModel<Space>& loops, bool of_places)
      : model_(model),
        places_(number_places(model, loops.loops.size())),
        place_(model),
        forces_(model, place_.w),
        sums_(static_cast<std::size_t>(places_.size), Lanes(0.0)) {
    if (of_places) {
      loops_.emplace(loops, place_.w);
      sigma_.resize(static_cast<std::size_t>(loops.rows));
    }
    // Laws of time take one value for all lanes, as do forces that choose by values.
    const bool apart = !model.drives.empty() || !model.laws.empty() || forces_.choose();
    together_ = apart ? 1 : width;
    for (Waiting& x : waiting_) x.numbers.resize(1 + 4 * place_.q.size() + 2 * sigma_.size());
  }

  void add(double factor, const Motion& at) override { wait(waiting_[of_all], of_all, factor, at); }
  void add_loop_rates(double factor, const Motion& at) override {
    if (loops_) wait(waiting_[of_loop_rates], of_loop_rates, factor, at);
  }
  void add_loops(double factor, double t, const double* q, const double* nu) override {
    if (loops_)
      wait(waiting_[of_loops], of_loops, factor, {t, q, nullptr, nu, nullptr, nullptr, nullptr});
  }
  void finish(double* slopes) override {
    for (const Kind kind : {of_all, of_loop_rates, of_loops}) sweep(waiting_[kind], kind);
    for (Lanes& sum : sums_) {
      for (int i = 0; i < width; ++i) *slopes += sum.lane(i);
      ++slopes;
      sum = Lanes(0.0);
    }
  }

 private:
  enum Kind { of_all, of_loop_rates, of_loops };
  /// Motions until each lane has one: t, q, δq, u, δu, σ, δσ, as plain numbers.
  struct Waiting {
    std::vector<Lanes> numbers;
    double factors[width];
    int lanes = 0;
    double* of_lane(int i) { return reinterpret_cast<double*>(numbers.data()) + i; }
  };
  /// Adds the derivative, or a given value, to the next sum.
  struct Put {
    Lanes factor;
    bool derivative = true;
    Lanes* to = nullptr;
    void operator()(const S& x) {
      *to += factor * (derivative ? x.b[0] : x.a);
      ++to;
    }
    /// A force without potential: its value times its coordinate's change along the direction.
    void along(const S& force, const S& coordinate) {
      S all(0.0);
      all.b[0] = force.a * coordinate.b[0];
      (*this)(all);
    }
    void skip(Eigen::Index numbers) { to += numbers; }
  };

  void wait(Waiting& x, Kind kind, double factor, const Motion& at) {
    x.factors[x.lanes] = factor;
    double* to = x.of_lane(x.lanes);
    const auto take = [&](const double* from, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i, to += width) *to = from ? from[i] : 0.0;
    };
    const std::size_t n = place_.q.size(), m = sigma_.size();
    take(&at.t, 1);
    for (const double* from : {at.q, at.dq, at.u, at.du}) take(from, n);
    for (const double* from : {at.sigma, at.dsigma}) take(from, m);
    if (++x.lanes == together_) sweep(x, kind);
  }
  void sweep(Waiting& x, Kind kind) {
    const int lanes = x.lanes;
    x.lanes = 0;
    if (lanes == 0) return;
    for (int i = lanes; i < width; ++i) {  // other lanes repeat the first, and count nothing
      const double* from = x.of_lane(0);
      double* to = x.of_lane(i);
      for (std::size_t k = 0; k < x.numbers.size(); ++k) to[k * width] = from[k * width];
      x.factors[i] = 0;
    }
    put_.derivative = kind != of_loops;
    place(x, [](const Lanes& all) { return all; });
    if (kind != of_all || lanes == 1 || !springs_vanish()) return put(kind, Lanes::load(x.factors));
    // A spring without its length is left out, of all lanes: each motion then goes alone.
    for (int i = 0; i < lanes; ++i) {
      place(x, [i](const Lanes& all) { return Lanes(all.lane(i)); });
      Lanes factor(0.0);
      factor.set_lane(i, x.factors[i]);
      put(kind, factor);
    }
  }
  bool springs_vanish() const {
    for (const auto& spring : model_.springs)
      if (!SpringLine<Space, S>(place_.w, spring).has_direction()) return true;
    return false;
  }
  /// Poses, velocities and σ, of numbers made by `of`.
  template <class Of>
  void place(const Waiting& x, Of&& of) {
    const Lanes* from = x.numbers.data();
    const Lanes t = of(*from++);
    const auto take = [&](std::vector<S>& to) {
      const std::size_t count = to.size();
      for (std::size_t i = 0; i < count; ++i)
        to[i] = place_.along(of(from[i]), of(from[count + i]));
      from += 2 * count;
    };
    for (auto* to : {&place_.q, &place_.u, &sigma_}) take(*to);
    place_.place(t, true);
  }
  void put(Kind kind, const Lanes& factor) {
    put_.factor = factor;
    put_.to = sums_.data();
    if (kind != of_all) return put_loops_alone();
    put_inertias();
    if (loops_) {
      body_momenta(place_.w);
      weights_and_forces();
      hand_to_bodies();
      project_inward(place_.w, static_cast<S*>(nullptr));
    }
    put_joints(true, true);
    if (loops_) loops_->each(sigma_.data(), true, put_);
    put_.to = sums_.data() + places_.springs;
    forces_.each(put_);
  }
  void hand_to_bodies() {
    loops_->place(sigma_.data());
    loops_->hand_to_bodies();
  }
  void put_loops_alone() {
    for (auto& body : place_.w.body) {
      body.P = {};
      body.T = {};
    }
    hand_to_bodies();
    project_inward(place_.w, static_cast<S*>(nullptr));
    put_.to += places_.joints;
    put_joints(put_.derivative, false);
    loops_->each(sigma_.data(), put_.derivative, put_);
  }

  /// Bodies' numbers, then gravity's: D ∂(T − V), which is linear in them.
  void put_inertias() {
    const auto& w = place_.w;
    Vector moment;
    for (std::size_t k = 0; k < w.body.size(); ++k) {
      const auto body = static_cast<int>(k);
      const auto& b = model_.bodies[k].inertia;
      const auto& v = w.body[k].V;
      const auto at = origin(w, body), center = to_ground(w, body, b.mc);
      S height(0.0);
      for (int i = 0; i < axes; ++i) {
        height += model_.gravity[i] * at[i];
        moment[i] += b.m * at[i] + center[i];
      }
      put_(0.5 * dot(v.v, v.v) + height);
      if constexpr (axes == 3) {
        Vector g;
        for (int i = 0; i < 3; ++i) g[i] = S(model_.gravity[i]);
        const auto first = cross(v.v, v.w) + from_ground(w, body, g);
        for (int i = 0; i < 3; ++i) put_(first[i]);
        for (int i = 0; i < 3; ++i)
          for (int j = i; j < 3; ++j) put_((i == j ? 0.5 : 1.0) * (v.w[i] * v.w[j]));
      } else {
        const S x = v.w * v.v[1] + model_.gravity[0], y = model_.gravity[1] - v.w * v.v[0];
        const auto& pose = w.body[k].pose;
        put_(pose.c * x + pose.s * y);
        put_(pose.c * y - pose.s * x);
        put_(0.5 * (v.w * v.w));
      }
    }
    for (int i = 0; i < axes; ++i) put_(moment[i]);
  }

  void weights_and_forces() {
    auto& w = place_.w;
    if (model_.has_gravity) gravity_outward(w);
    for (std::size_t k = 0; k < w.body.size(); ++k) {
      w.body[k].T = {};
      if (!model_.has_gravity) continue;
      const auto& inertia = w.inertia(k);
      Vector mc;
      for (int i = 0; i < axes; ++i) mc[i] = S(inertia.mc[i]);
      w.body[k].T = Space::weight(S(inertia.m), mc, w.body[k].g);
    }
    forces_.hand_to_bodies();
  }
  /// Numbers of joints; T* is summed on the way.
  void put_joints(bool of_rates, bool of_forces) {
    auto& w = place_.w;
    Lanes* const first = put_.to;
    constexpr auto stride = NumberPlaces<Space>::of_joint;
    for (std::size_t k = w.body.size(); k-- > 0;) {
      put_.to = first + stride * static_cast<Eigen::Index>(k);
      const auto& b = model_.bodies[k];
      const auto& s = w.body[k];
      const bool moves = b.nv == 1;
      const S q = moves ? place_.q[static_cast<std::size_t>(b.q)] : s.drive,
              u = moves ? place_.u[static_cast<std::size_t>(b.u)] : s.drive_rate;
      if (loops_)
        put_place(k, q, u, of_rates);
      else
        put_.skip(axes == 3 ? 6 : 4);
      if (!of_forces) continue;
      if (moves) {
        using std::sqrt;
        const S stretch = q - b.rest;
        put_(-0.5 * (stretch * stretch));
        put_(b.stiffness * stretch);
        put_.along(-u, q);
        put_(q);
        put_.along(-(u / sqrt(u * u + S(b.friction_rate * b.friction_rate))), q);
      } else {
        put_.skip(5);
      }
      S twice(0.0);
      for (int i = 0; i < b.nv; ++i) {
        const S& rate = place_.u[static_cast<std::size_t>(b.u + i)];
        twice += rate * rate;
      }
      put_(0.5 * twice);
    }
    put_.to = first + stride * static_cast<Eigen::Index>(w.body.size());
  }
  /// Place of joint k in its parent: T* − Ω × P*, in the parent's frame.
  void put_place(std::size_t k, const S& q, const S& u, bool of_rates) {
    auto& w = place_.w;
    const auto& b = model_.bodies[k];
    const auto& s = w.body[k];
    Force net = s.P;
    if (of_rates) {
      net = s.T;
      if (b.parent >= 0) {
        auto& parent = w.body[static_cast<std::size_t>(b.parent)];
        net -= Space::cross_force(Space::to_child(b.edge, b.kind, s.edge, parent.V), s.P);
        parent.T += Space::to_parent(b.edge, b.kind, s.edge, s.T);
      }
    }
    if (b.drive >= 0) {
      Put put = put_;
      put.to = sums_.data() + places_.drives + NumberPlaces<Space>::of_drive * b.drive;
      put(Joint<Space>::along(b, s.edge, net));
      if (of_rates) put(Joint<Space>::along(b, s.edge, s.P));
    }
    const Force there = Space::to_parent(b.edge, b.kind, s.edge, net);
    if constexpr (axes == 2) {
      const Vector f = in_body_axes(w, b.parent, there.f);
      for (int i = 0; i < 2; ++i) put_(f[i]);
      // A slide's direction e: its body is moved by q e and moves on by u e.
      if (b.kind != JointKind::prismatic) {
        put_.skip(2);
        return;
      }
      const Vector p = in_body_axes(w, b.parent, s.P.f);
      for (int i = 0; i < 2; ++i) put_(of_rates ? S(q * f[i] + u * p[i]) : S(q * f[i]));
    } else {
      for (int i = 0; i < 6; ++i) put_(there[i]);
    }
  }

  const Model<Space>& model_;
  NumberPlaces<Space> places_;
  PlacedAlong<Space, Level, width> place_;
  ForceNumbers<Space, S> forces_;
  std::optional<LoopNumbers<Space, S>> loops_;  ///< none: no places
  std::vector<S> sigma_;
  int together_;             ///< motions that are swept at once
  Waiting waiting_[3];       ///< by kind
  std::vector<Lanes> sums_;  ///< sums of all numbers, lane by lane
  Put put_;
};

template <int Level, class Space>
std::unique_ptr<NumberSweep> number_sweep_at(const Model<Space>& model,
                                             const LoopModel<Space>& loops, bool of_places) {
  return std::make_unique<NumberSweepAt<Space, Level>>(model, loops, of_places);
}

}  // namespace momenta
