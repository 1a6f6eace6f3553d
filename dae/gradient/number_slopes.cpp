#include <momenta/dae/gradient/number_slopes.h>
#include <momenta/dae/gradient/scene_difference.h>

#include <algorithm>
#include <array>

namespace momenta {
namespace {

using Eigen::Index;
using Eigen::Isometry3d;
using Eigen::VectorXd;

template <class Space>
Model<Space> built(const Tree& tree, const Scene& scene, const Plan& plan) {
  if constexpr (Space::dimension == 6)
    return build_spatial_model(tree, scene);
  else
    return build_planar_model(tree, scene, plan.basis);
}

template <class Space>
class NumberSlopesOf final : public NumberSlopes {
  static constexpr bool in_space = Space::dimension == 6;
  static constexpr int axes = in_space ? 3 : 2;
  using Places = NumberPlaces<Space>;

 public:
  NumberSlopesOf(const Mechanism& mechanism, bool with_places)
      : mechanism_(mechanism),
        model_(built<Space>(mechanism.tree(), mechanism.scene(), mechanism.plan())),
        loops_(build_loops(mechanism.scene(), mechanism.tree(), model_)),
        places_(number_places(model_, loops_.loops.size())),
        placed_(placed(mechanism.tree(), model_)),
        slides_(any_slides(mechanism.tree())),
        sweep_(make_number_sweep(model_, loops_, with_places)) {}

  Index size() const override { return guess() + 2 * mechanism_.nv() + 1; }
  Index beyond_inertias() const override { return places_.joints; }
  Index guess() const override { return places_.size; }

  Share of(const std::string& place) const override {
    const auto is_of = [&](const char* table, const std::string& name,
                           std::initializer_list<const char*> keys) {
      const std::string whole = std::string(table) + "." + name + ".";
      return place.starts_with(whole) &&
             std::any_of(keys.begin(), keys.end(), [&](const std::string& key) {
               const std::string rest = place.substr(whole.size());
               return rest == key || rest.starts_with(key + ".");
             });
    };
    const auto& bodies = mechanism_.tree().bodies;
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (is_of("body", bodies[k].name, {"mass", "com", "inertia", "shape"})) return {{of_body(k)}};
      if (is_of("joint", bodies[k].joint, {"stiffness", "rest", "damping", "friction"}))
        return {{of_joint(k)}};
      if (is_of("joint", bodies[k].joint, {"origin", "rotation", "axis", "axis2", "direction"}))
        return of_frames(bodies[k].joint);
      if (is_of("joint", bodies[k].joint, {"position", "velocity"}))
        return of_guess(bodies[k].joint);
    }
    const auto& loops = mechanism_.scene().loops;
    for (std::size_t i = 0; i < loops.size() && loops.size() == loops_.loops.size(); ++i)
      if (is_of("loop", loops[i].name,
                {"origin", "rotation", "axis", "axis2", "direction", "length", "offset"}))
        return {{of_loop(i)}, true};
    Index spring = 0, sum = 0, wrench = 0, bushing = 0;
    for (const ForceSpec& f : mechanism_.scene().forces) {
      if (!f.law.empty()) continue;
      const bool of_points = f.kind == "spring-damper", of_sum = f.kind == "coordinate-spring";
      if (of_points || of_sum) {
        const bool acts = f.stiffness != 0 || f.damping != 0 || has_stops(f) ||
                          (f.limits && of_points),
                   moved = is_of("force", f.name, {"origin"});
        if (moved || is_of("force", f.name, {"stiffness", "rest", "damping"})) {
          if (!acts) return {};
          return {{of_points ? of_spring(spring)
                             : Range{places_.sums + Places::of_sum * sum, Places::of_sum}},
                  moved};
        }
        if (acts) ++(of_points ? spring : sum);
      } else if (f.kind == "wrench") {
        if (is_of("force", f.name, {"point", "force", "torque"}))
          return {{{places_.wrenches + Places::of_wrench * wrench, Places::of_wrench}}};
        ++wrench;
      } else if (f.kind == "bushing") {
        if (is_of("force", f.name,
                  {"stiffness", "damping", "rotational_stiffness", "rotational_damping"}))
          return {{{places_.bushings + Places::of_bushing * bushing, Places::of_bushing}}};
        ++bushing;
      }
    }
    return {};
  }

  bool of_places() const override {
    return model_.bushings.empty() && model_.signals.empty() && model_.formula_forces.empty() &&
           loops_.motions.empty() && loops_.pairs.empty() && loops_.equations.empty() &&
           loops_.wheels.empty() && loops_.curves == 0;
  }

  bool of_plain_places() const override {
    return of_places() && model_.wrenches.empty() && !model_.has_corners &&
           std::all_of(model_.springs.begin(), model_.springs.end(),
                       [](const auto& spring) { return spring.damping == 0; });
  }

  std::vector<Index> without_potential() const override {
    // The last numbers of a joint are stiffness, rest, damping, torque, friction and rotor; of a
    // spring stiffness, rest, damping and, between points, the offset.
    std::vector<Index> all;
    const auto put = [&all](Index first, Index stride, std::size_t count, Index from_end) {
      for (Index k = 1; k <= static_cast<Index>(count); ++k)
        all.push_back(first + stride * k - from_end);
    };
    for (const Index from_end : {4, 2})
      put(places_.joints, Places::of_joint, model_.bodies.size(), from_end);
    put(places_.springs, Places::of_spring, model_.springs.size(), 2);
    put(places_.sums, Places::of_sum, model_.coordinate_springs.size(), 1);
    return all;
  }

  bool of_drives() const override {
    const auto is_driven = [&](const auto& term) {
      return model_.bodies[static_cast<std::size_t>(term.body)].drive >= 0;
    };
    return of_places() &&
           std::none_of(model_.coordinate_springs.begin(), model_.coordinate_springs.end(),
                        [&](const auto& spring) {
                          return std::any_of(spring.terms.begin(), spring.terms.end(), is_driven);
                        });
  }
  Index drives() const override { return places_.drives; }

  void add(double factor, const NumberSweep::Motion& at) override { sweep_->add(factor, at); }
  void add_loop_rates(double factor, const NumberSweep::Motion& at) override {
    sweep_->add_loop_rates(factor, at);
  }
  void add_loops(double factor, double t, const double* q, const double* nu) override {
    sweep_->add_loops(factor, t, q, nu);
  }
  void finish(VectorXd& slopes) override { sweep_->finish(slopes.data()); }

  VectorXd numbers(const Scene& other) const override {
    const Tree tree = build_valid_tree(other);
    const Model<Space> model = built<Space>(tree, other, mechanism_.plan());
    const LoopModel<Space> loops = build_loops(other, tree, model);
    if (model.bodies.size() != model_.bodies.size() ||
        model.springs.size() != model_.springs.size() ||
        model.coordinate_springs.size() != model_.coordinate_springs.size() ||
        model.wrenches.size() != model_.wrenches.size() ||
        model.bushings.size() != model_.bushings.size() ||
        model.drives.size() != model_.drives.size() || loops.loops.size() != loops_.loops.size())
      return {};
    VectorXd all(size());
    Index at = 0;
    const auto put = [&](double number) { all[at++] = number; };
    const auto put_vector = [&](const auto& v) {
      for (int i = 0; i < axes; ++i) put(v[i]);
    };
    for (const auto& body : model.bodies) {
      const auto& b = body.inertia;
      put(b.m);
      put_vector(b.mc);
      if constexpr (in_space) {
        for (int i = 0; i < 3; ++i)
          for (int j = i; j < 3; ++j) put(b.J(i, j));
      } else {
        put(b.J);
      }
    }
    put_vector(model.gravity);
    const std::vector<Isometry3d> there = placed(tree, model);
    for (std::size_t k = 0; k < model.bodies.size(); ++k) {
      const auto& b = model.bodies[k];
      const Eigen::Matrix3d turn = there[k].linear() * placed_[k].linear().transpose();
      const Eigen::Vector3d angle =
          0.5 * Eigen::Vector3d(turn(2, 1) - turn(1, 2), turn(0, 2) - turn(2, 0),
                                turn(1, 0) - turn(0, 1));
      const Eigen::Vector3d from = placed_[k].translation(),
                            shift = there[k].translation() - from - angle.cross(from);
      put_vector(shift);
      if constexpr (in_space) {
        put_vector(angle);
      } else {
        put(b.edge.prismatic_x);
        put(b.edge.prismatic_y);
      }
      for (const double number : {b.stiffness, b.rest, b.damping, b.torque, b.friction, b.rotor})
        put(number);
    }
    for (const auto& l : loops.loops) {
      put_vector(l.at_a);
      put_vector(l.at_b);
      for (std::size_t j = 0; j < axes; ++j) {
        put_vector(l.axis_a[j]);
        put_vector(l.axis_b[j]);
      }
      for (const double number : {l.per_length, l.given, l.across2, l.gamma}) put(number);
    }
    for (const auto& spring : model.springs) {
      put_vector(spring.at_parent);
      put_vector(spring.at_child);
      for (const double number : {spring.stiffness, spring.rest, spring.damping, spring.offset2})
        put(number);
    }
    for (const auto& spring : model.coordinate_springs)
      for (const double number : {spring.stiffness, spring.rest, spring.damping}) put(number);
    for (const auto& wrench : model.wrenches) {
      put_vector(wrench.at);
      put_vector(wrench.force);
      if constexpr (in_space)
        put_vector(wrench.torque);
      else
        put(wrench.normal_torque);
    }
    for (const auto& bushing : model.bushings)
      for (const double number : {bushing.stiffness, bushing.damping, bushing.rotational_stiffness,
                                  bushing.rotational_damping})
        put(number);
    for (std::size_t i = 0; i < 2 * model.drives.size(); ++i) put(0);
    if (tree.q0.size() != mechanism_.nv() || tree.u0.size() != mechanism_.nv()) return {};
    all.segment(at, tree.q0.size()) = tree.q0;
    all.segment(at + tree.q0.size(), tree.u0.size()) = tree.u0;
    all[all.size() - 1] = slides_ ? length_of(other) : 0;
    return all;
  }

 private:
  Range of_body(std::size_t k) const {
    return {Places::of_body * static_cast<Index>(k), Places::of_body};
  }
  Range of_joint(std::size_t k) const {
    return {places_.joints + Places::of_joint * static_cast<Index>(k), Places::of_joint};
  }
  Range of_loop(std::size_t i) const {
    return {places_.loops + Places::of_loop * static_cast<Index>(i), Places::of_loop};
  }
  Range of_spring(Index i) const {
    return {places_.springs + Places::of_spring * i, Places::of_spring};
  }
  Share of_guess(const std::string& joint) const {
    Share all{{}, true};
    for (const auto& body : mechanism_.tree().bodies)
      if (body.joint == joint && body.nv > 0)
        for (const Index first : {guess() + body.q, guess() + mechanism_.nv() + body.u})
          all.ranges.push_back({first, body.nv});
    return all;
  }
  /// All numbers in frames of the bodies that a joint joins: these may move with it.
  Share of_frames(const std::string& joint) const {
    const auto& bodies = mechanism_.tree().bodies;
    std::vector<bool> moves(bodies.size() + 1, false);  // the ground, last, stays
    const auto at = [&](int body) {
      return body < 0 ? bodies.size() : static_cast<std::size_t>(body);
    };
    for (std::size_t k = 0; k < bodies.size(); ++k)
      if (bodies[k].joint == joint) moves[k] = moves[at(bodies[k].parent)] = true;
    moves[bodies.size()] = false;
    Share all{{}, true};
    for (std::size_t k = 0; k < bodies.size(); ++k) {
      if (moves[k]) all.ranges.push_back(of_body(k));
      if (moves[k] || moves[at(bodies[k].parent)]) all.ranges.push_back(of_joint(k));
    }
    for (std::size_t i = 0; i < loops_.loops.size(); ++i)
      if (moves[at(loops_.loops[i].a)] || moves[at(loops_.loops[i].b)])
        all.ranges.push_back(of_loop(i));
    for (std::size_t i = 0; i < model_.springs.size(); ++i)
      if (moves[at(model_.springs[i].parent)] || moves[at(model_.springs[i].child)])
        all.ranges.push_back(of_spring(static_cast<Index>(i)));
    for (std::size_t i = 0; i < model_.wrenches.size(); ++i)
      if (moves[at(model_.wrenches[i].body)])
        all.ranges.push_back(
            {places_.wrenches + Places::of_wrench * static_cast<Index>(i), Places::of_wrench});
    return all;
  }
  static bool any_slides(const Tree& tree) {
    return std::any_of(tree.bodies.begin(), tree.bodies.end(), [](const Tree::Body& body) {
      for (int i = 0; i < body.nv; ++i)
        if (body.is_length(i)) return true;
      return false;
    });
  }
  /// Poses of the model's frames in their parents' at zero coordinates.
  static std::vector<Isometry3d> placed(const Tree& tree, const Model<Space>& model) {
    Isometry3d ground = Isometry3d::Identity();
    ground.linear() = model.basis.transpose();
    std::vector<Isometry3d> all;
    for (std::size_t k = 0; k < tree.bodies.size(); ++k) {
      const int parent = tree.bodies[k].parent;
      all.push_back((parent < 0 ? ground : model.frames[static_cast<std::size_t>(parent)]) *
                    tree.bodies[k].placement * model.frames[k].inverse());
    }
    return all;
  }

  const Mechanism& mechanism_;
  Model<Space> model_;
  LoopModel<Space> loops_;
  Places places_;
  std::vector<Isometry3d> placed_;
  bool slides_;
  std::unique_ptr<NumberSweep> sweep_;
};

}  // namespace

std::unique_ptr<NumberSlopes> make_number_slopes(const Mechanism& mechanism, bool with_places) {
  if (mechanism.plan().planar)
    return std::make_unique<NumberSlopesOf<Planar>>(mechanism, with_places);
  return std::make_unique<NumberSlopesOf<Spatial>>(mechanism, with_places);
}

}  // namespace momenta
