#include <momenta/core/scene/drive.h>
#include <momenta/core/scene/formula.h>
#include <momenta/core/scene/lagrangian/lagrangian_model.h>
#include <momenta/core/text/number_text.h>
#include <momenta/dae/analysis/linear/equilibrium.h>
#include <momenta/dae/analysis/linear/local_pencil.h>
#include <momenta/dae/analysis/linear/negative_curvature.h>
#include <momenta/dae/analysis/linear/pose_motion.h>
#include <momenta/dae/kkt/loop_units.h>
#include <momenta/dae/kkt/unheld_joints.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace momenta {
namespace {

using Eigen::VectorXd;

constexpr int most_steps = 1000, steps_a_rate = 4, most_halvings = 30, most_polishings = 4;
constexpr double balanced = 1e-8;       // relative force left at an equilibrium
constexpr double at_rest = 1e-10;       // relative force left, to be polished
constexpr double longest_step = 0.4;    // [rad or lengths of the scene]
constexpr double gone = 1e3;            // lengths of the scene: falling
constexpr double neutral_floor = 1e-9;  // least relative μ: keeps neutral directions

double whole_mass(const Mechanism& mechanism) {
  double mass = 0;
  for (const BodySpec& body : mechanism.scene().bodies) mass += body.mass;
  return mass;
}

/// Largest M_ii (nv) of a joint without mass, relative to a body of mean size. It has no frequency
/// of its own: loops move it, and its force is their rounding.
VectorXd massless_up_to(const Mechanism& mechanism) {
  constexpr double part = 1e-9;
  const auto bodies =
      static_cast<double>(std::max<std::size_t>(1, mechanism.scene().bodies.size()));
  const double mass = whole_mass(mechanism) / bodies,
               length = length_of(mechanism.scene()) / bodies;
  VectorXd least = VectorXd::Constant(mechanism.nv(), part * mass * length * length);
  for (const Tree::Body& b : mechanism.tree().bodies)
    for (int i = 0; i < b.nv; ++i)
      if (b.is_length(i)) least[b.u + i] = part * mass;
  return least;
}

/// Lagrangian: forces on coordinates at rest, and the weight of a rate of 1/s.
VectorXd formula_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  VectorXd scale(mechanism.nv()), force(mechanism.nv());
  e.mass_diagonal(scale.data());
  e.momentum_rates(nullptr, nullptr, nullptr, 0, force.data());
  return (scale + force.cwiseAbs()).cwiseMax(1e-30);
}

/// Whether the formula of a loop of positions has t in it.
bool has_time(const Scene& scene, const LoopSpec& loop) {
  if (loop.kind != LoopKind::equation) return false;
  const std::vector<Signal> signals = FormulaReader(scene).read(loop.equation).signals;
  return std::any_of(signals.begin(), signals.end(),
                     [](const Signal& s) { return s.kind == Signal::Kind::time; });
}

/// Refuses a loop or constraint with Φ_t ≠ 0, which a formula with t, a formula of velocities or
/// drives move.
[[noreturn]] void refuse_moving(const Scene& scene, const std::string& name) {
  const auto is_it = [&](const auto& named) { return named.name == name; };
  const auto moves = [&](Location at, const std::string& what, const char* expected) {
    throw SceneError(scene.where(at) + what + ": no pose is at rest; expected " + expected);
  };
  if (scene.lagrangian) {
    const auto& all = scene.lagrangian->constraints;
    const auto found = std::find_if(all.begin(), all.end(), is_it);
    moves(found == all.end() ? Location{} : found->at, "constraint '" + name + "' moves with t",
          "constraints without t");
  }
  const auto loop = std::find_if(scene.loops.begin(), scene.loops.end(), is_it);
  const bool by_formula = loop != scene.loops.end() && has_equation(*loop) &&
                          (has_time(scene, *loop) || !has_running_drive(scene));
  if (by_formula && loop->kind == LoopKind::equation)
    moves(loop->at, "equation '" + name + "' moves with t", "an equation without t");
  if (by_formula)
    moves(loop->at, "velocity equation '" + name + "' is not zero at rest",
          "terms that have rates in them");
  throw SceneError(scene.where({}) + "the drives move loop '" + name +
                   "': no pose is at rest while they run; expected drives that turn the mechanism "
                   "as a whole, or to be held");
}

class Searcher {
 public:
  explicit Searcher(const Mechanism& mechanism)
      : mechanism_(mechanism),
        poses_(mechanism),
        e_(poses_.evaluation()),
        pencil_(mechanism),
        ways_(mechanism, poses_),
        length_(length_of(mechanism.scene())),
        potential_(has_potential(mechanism)),
        rest_(VectorXd::Zero(mechanism.nv())),
        unit_(natural_units(mechanism)) {}

  Equilibrium from(double t, const VectorXd& q, Search search) {
    Equilibrium found;
    found.t = t;
    Pose here = look(t, q);
    refuse_moving_loops(t, here);
    scale_ = force_scales(mechanism_, e_);
    const double fastest = here.udot.cwiseQuotient(unit_).cwiseAbs().maxCoeff();
    natural_ = std::max({natural(t, q), fastest, 1e-12});
    mu_ = std::max(fastest, floor());
    here.left = measure(here);
    soften(t, q);
    if (search == Search::start) {
      if (!(here.left <= balanced)) refuse(here, "the assembled pose is no equilibrium");
    } else {
      while (!(here.left <= at_rest) && found.steps < most_steps + steps_a_rate * mechanism_.nv()) {
        ++found.steps;
        const bool moved = search == Search::settle ? settle(t, here) : halve(t, here);
        // Steps may end above `at_rest`, where rounding hides what a step gains.
        const bool ends = here.left <= at_rest || !moved;
        if (search == Search::settle && ends && leave_saddle(t, here)) continue;
        if (!moved || !((here.q - q).cwiseAbs().maxCoeff() < gone * std::max(length_, 1.0))) break;
      }
      if (!(here.left <= balanced)) refuse(here, "no equilibrium was found from this pose");
    }
    for (int pass = 0; search != Search::start && pass < most_polishings; ++pass)
      if (!polish(t, here)) break;
    found.q = here.q;
    found.lambda = here.lambda;
    found.left = here.left;
    found.potential = here.potential;
    found.pivot = poses_.pivot();
    found.last_step = step_;
    found.moved = q.size() > 0 ? (here.q - q).cwiseAbs().maxCoeff() : 0;
    return found;
  }

  VectorXd moved(double t, const VectorXd& q, const VectorXd& way) {
    VectorXd next;
    return poses_.move(t, q, way, next) ? next : q;
  }

 private:
  struct Pose {
    VectorXd q, udot, lambda, force;  ///< force: M u̇ = −r − Φ_qᵀλ
    double potential = 0, merit = 0;  ///< V and V − T₀
    double left = 0;
  };

  Pose look(double t, const VectorXd& q) {
    Pose p;
    p.q = q;
    if (!poses_.let_go(t, q, p.udot, p.lambda))
      throw SceneError(mechanism_.scene().where({}) + "the mechanism cannot be let go: " +
                       no_inertia(mechanism_, poses_.singular_joint(), t, q.data()));
    p.force.resize(mechanism_.nv());
    e_.place(t, q.data());
    e_.move(rest_.data());
    e_.joint_forces(q.data(), rest_.data(), nullptr, p.lambda.data(), p.force.data());
    p.force = -p.force;
    p.potential = e_.potential(q.data());
    p.merit = p.potential - e_.kinetic();
    p.left = scale_.size() > 0 ? measure(p) : 0;
    return p;
  }
  double measure(const Pose& p) const {
    return p.force.size() > 0 ? p.force.cwiseQuotient(scale_).cwiseAbs().maxCoeff() : 0;
  }
  /// Largest force over inertia of a joint [1/s²].
  double natural(double t, const VectorXd& q) {
    VectorXd inertia(mechanism_.nv());
    e_.place(t, q.data());
    e_.mass_diagonal(inertia.data());
    const VectorXd massless = massless_up_to(mechanism_);
    double most = 0;
    for (Eigen::Index i = 0; i < inertia.size(); ++i)
      if (inertia[i] > massless[i]) most = std::max(most, scale_[i] / (inertia[i] * unit_[i]));
    return most;
  }
  double floor() const { return neutral_floor * natural_; }

  void refuse_moving_loops(double t, const Pose& p) {
    if (mechanism_.m() == 0 || !mechanism_.plan().drives) return;
    VectorXd rate(mechanism_.m());
    e_.place(t, p.q.data());
    e_.move(rest_.data());
    e_.velocities(rate.data());
    Eigen::Index worst;
    if (rate.cwiseAbs().maxCoeff(&worst) <= 1e-9 * length_) return;
    refuse_moving(mechanism_.scene(), mechanism_.rows()[static_cast<std::size_t>(worst)].loop);
  }

  /// Softens loops by 1e-8 of their stiffness: redundant ones then do no harm.
  void soften(double t, const VectorXd& q) {
    if (mechanism_.m() == 0) return;
    e_.place(t, q.data());
    scales_ = row_scales(mechanism_, e_);
  }

  /// δ at μ; empty where the matrix is singular.
  VectorXd step(double t, const Pose& p, double mu) {
    if (!scales_.empty()) {
      std::vector<double> compliance = scales_;
      for (double& c : compliance) c *= 1e-8 / (mu + natural_);
      pencil_.soften(std::move(compliance));
    }
    if (!pencil_.factor(t, p.q, p.lambda, mu, 0)) return {};
    VectorXd delta = p.force, gap = VectorXd::Zero(mechanism_.m());
    pencil_.solve(delta, gap);
    if (!delta.allFinite()) return {};
    step_ = delta.cwiseAbs().maxCoeff();
    const double longest = delta.cwiseQuotient(unit_).cwiseAbs().maxCoeff();
    part_ = std::min(1.0, longest_step / longest);
    return part_ * delta;
  }

  /// Fall of V − T₀; with forces without a potential the work of all forces, by the trapezoidal
  /// rule. The way back to Φ = 0 lies across the forces left, and does no work.
  double fall(const Pose& here, const Pose& there, const VectorXd& delta) const {
    return potential_ ? here.merit - there.merit : 0.5 * delta.dot(here.force + there.force);
  }

  /// A step downhill. μ follows how well K predicts the fall of V − T₀.
  bool settle(double t, Pose& here) {
    constexpr int most_tries = 60;
    constexpr double least_share = 0.05, poor = 0.25, good = 0.75;
    const double rounding = 4e-15 * scale_.cwiseProduct(unit_).maxCoeff();
    const double before = mu_;
    for (int tries = 0; tries < most_tries; ++tries, mu_ *= 4) {
      const VectorXd delta = step(t, here, mu_);
      VectorXd q;
      if (delta.size() == 0 || !poses_.move(t, here.q, delta, q)) continue;
      const double work = delta.dot(here.force);
      if (!(work > 0)) continue;
      // δᵀKδ by the step's own equation, shortened by `part_`.
      e_.place(t, here.q.data());
      const double bent = part_ * work - mu_ * delta.dot(poses_.momentum(delta));
      Pose next = look(t, q);
      const double fallen = fall(here, next, delta), share = fallen / (work - 0.5 * bent);
      const bool down = work > rounding && share > least_share;
      const bool level = fallen >= -rounding;
      if (!down && !(level && next.left < here.left)) continue;
      const bool trusted = !down || (share > good && share < 2 - good);
      here = std::move(next);
      mu_ = std::max(trusted ? 0.2 * mu_ : share < poor ? 2 * mu_ : mu_, floor());
      return true;
    }
    mu_ = before;
    return false;
  }

  /// Moves a little from a saddle, along the directions of downward curvature. False: there are
  /// none.
  bool leave_saddle(double t, Pose& here) {
    constexpr double aside = 0.05;  // [rad or lengths of the scene]
    if (step(t, here, floor()).size() == 0) return false;
    const VectorXd down = ways_.find(t, here.q, here.lambda, pencil_, potential_);
    if (down.size() == 0) return false;
    VectorXd q, way = aside / down.cwiseQuotient(unit_).cwiseAbs().maxCoeff() * down;
    for (int k = 0; k < 6; ++k, way *= -0.5) {
      if (!poses_.move(t, here.q, way, q)) continue;
      if (Pose next = look(t, q); fall(here, next, way) > 0) {
        here = std::move(next);
        return true;
      }
    }
    return false;
  }

  bool halve(double t, Pose& here) {
    VectorXd delta = step(t, here, floor());
    if (delta.size() == 0) return false;
    for (int k = 0; k < most_halvings; ++k, delta *= 0.5) {
      VectorXd q;
      if (!poses_.move(t, here.q, delta, q)) continue;
      Pose next = look(t, q);
      if (!(next.left < here.left)) continue;
      here = std::move(next);
      return true;
    }
    return false;
  }

  bool polish(double t, Pose& here) {
    const VectorXd delta = step(t, here, floor());
    VectorXd q;
    if (delta.size() == 0 || !poses_.move(t, here.q, delta, q)) return false;
    Pose next = look(t, q);
    if (!(next.left < here.left)) return false;
    here = std::move(next);
    return true;
  }

  [[noreturn]] void refuse(const Pose& p, const std::string& what) const {
    Eigen::Index worst;
    p.force.cwiseQuotient(scale_).cwiseAbs().maxCoeff(&worst);
    if (mechanism_.scene().lagrangian)
      throw SceneError(mechanism_.scene().where({}) + what + ": coordinate '" +
                       mechanism_.coordinate_columns()[static_cast<std::size_t>(worst)].name +
                       "' is left with a force of " + compact(std::abs(p.force[worst]), 3) +
                       "; expected a pose where all forces balance");
    std::string joint;
    bool shift = false;
    for (std::size_t k = 0; k < mechanism_.tree().bodies.size(); ++k) {
      const Tree::Body& b = mechanism_.tree().bodies[k];
      if (worst < b.u || worst >= b.u + b.nv) continue;
      joint = mechanism_.tree().joint_in_words(static_cast<int>(k));
      shift = b.is_length(static_cast<int>(worst) - b.u);
    }
    const char* force = shift ? " N" : " N m";
    const char* rate = shift ? " m/s²" : " rad/s²";
    throw SceneError(mechanism_.scene().where({}) + what + ": " + joint + " is left with " +
                     compact(std::abs(p.force[worst]), 3) + force + ", let go it starts with " +
                     compact(std::abs(p.udot[worst]), 3) + rate +
                     "; expected a pose where all forces balance");
  }

  const Mechanism& mechanism_;
  PoseMotion poses_;
  Evaluation<double>& e_;
  LocalPencil pencil_;
  NegativeCurvature ways_;
  double length_;
  bool potential_;
  VectorXd rest_, unit_, scale_;
  std::vector<double> scales_;  ///< scales of the loops' rows
  double natural_ = 1;          ///< [1/s²]
  double mu_ = 1, step_ = 0;
  double part_ = 1;  ///< part_ of the last step
};

}  // namespace

bool has_potential(const Mechanism& mechanism) {
  if (mechanism.scene().lagrangian) return mechanism.lagrangian().balanced;
  return std::none_of(
      mechanism.scene().forces.begin(), mechanism.scene().forces.end(), [&](const ForceSpec& f) {
        return (has_formula(f) && f.kind != "potential") ||
               (f.kind == "wrench" &&
                (f.in_body_axes || (!mechanism.plan().planar && !f.torque.isZero(0))));
      });
}

VectorXd force_scales(const Mechanism& mechanism, Evaluation<double>& e) {
  if (mechanism.scene().lagrangian) return formula_scales(mechanism, e);
  const Scene& scene = mechanism.scene();
  const double mass = whole_mass(mechanism), length = length_of(scene);
  double force = scene.gravity.norm() * mass, torque = 0;
  for (const ForceSpec& f : scene.forces) {
    if (f.kind == "spring-damper") force += f.stiffness * (f.rest + length);
    if (f.kind == "bushing") {
      force += std::abs(f.stiffness) * length;
      torque += std::abs(f.rotational_stiffness);
    }
    if (f.kind == "coordinate-spring")
      for (const double ratio : f.ratios)
        torque += std::abs(ratio * f.stiffness) * (std::abs(ratio) + std::abs(f.rest));
    force += f.force.norm();
    torque += f.kind == "torque" ? std::abs(f.value) : f.torque.norm();
  }
  torque += e.formula_size();
  force += 2 * e.kinetic() / length;  // energy of running drives
  for (const JointSpec& j : scene.joints) torque += std::abs(j.stiffness) * (1 + std::abs(j.rest));
  VectorXd scale(mechanism.nv());
  const VectorXd massless = massless_up_to(mechanism);
  e.mass_diagonal(scale.data());
  for (const Tree::Body& b : mechanism.tree().bodies)
    for (int i = 0; i < b.nv; ++i) {
      double& s = scale[b.u + i];  // M_ii
      const double lever = b.is_length(i)             ? 1
                           : !(s > massless[b.u + i]) ? length
                           : mass > 0                 ? std::sqrt(s / mass)
                                                      : 1;
      s = std::max({force * lever + torque, 1e-12 * s, 1e-30});
    }
  return scale;
}

VectorXd natural_units(const Mechanism& mechanism) {
  const double length = length_of(mechanism.scene());
  VectorXd unit = VectorXd::Ones(mechanism.nv());
  for (const Tree::Body& b : mechanism.tree().bodies)
    for (int i = 0; i < b.nv; ++i)
      if (b.is_length(i)) unit[b.u + i] = length;
  return unit;
}

Equilibrium find_equilibrium(const Mechanism& mechanism, const Start& start, Search search) {
  if (mechanism.nv() == 0) {
    Equilibrium fixed;
    fixed.t = start.t;
    fixed.q = start.q;
    fixed.lambda = start.lambda;
    return fixed;
  }
  return Searcher(mechanism).from(start.t, start.q, search);
}

Equilibrium settle_from(const Mechanism& mechanism, const Equilibrium& saddle,
                        const VectorXd& way) {
  Searcher searcher(mechanism);
  return searcher.from(saddle.t, searcher.moved(saddle.t, saddle.q, way), Search::settle);
}

}  // namespace momenta
