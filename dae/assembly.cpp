#include <momenta/dae/assembly.h>
#include <momenta/dae/assembly_units.h>
#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_solver.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace momenta {
namespace {

constexpr int most_iterations = 200;
constexpr double largest_step = 0.4;  // [rad or lengths]: stay on the branch of the guess
constexpr double closed = 1e-12;      // |Φ|∞, points in lengths; at least
constexpr double far = 0.1;           // [rad or lengths]: Newton's steps may leave the branch
constexpr double rank_tolerance = LeastNorm::rank_tolerance;

class Assembler {
 public:
  /// From q, u at time t [s].
  Assembler(const Mechanism& mechanism, double t, Eigen::VectorXd q, Eigen::VectorXd u)
      : mechanism_(mechanism),
        t_(t),
        q_(std::move(q)),
        u_(std::move(u)),
        e_(mechanism.evaluation<double>()),
        pattern_(mechanism.constraint_pattern()),
        steps_(pattern_, mechanism.m(), mechanism.nv()),
        free_(static_cast<std::size_t>(mechanism.nv()), true),
        units_(mechanism) {
    for (const auto& name : mechanism.scene().held) {
      const Tree& tree = mechanism.tree();
      const int last = tree.carried_by(name);
      for (int k = last < 0 ? 0 : tree.first_part(last); k <= last; ++k) {
        const auto& b = tree.bodies[static_cast<std::size_t>(k)];
        for (int i = 0; i < b.nv; ++i) free_[static_cast<std::size_t>(b.u + i)] = false;
      }
    }
  }

  Assembly run() {
    Assembly a;
    a.start.t = t_;
    a.start.q = q_;
    a.start.u = u_;
    if (mechanism_.m() > 0) {
      if (mechanism_.nv() == 0) nothing_moves();
      close_positions(a);
      close_velocities(a);
      judge_rank(a);
    }
    a.mobility = mechanism_.nv() - a.rank;
    accelerations(a);
    return a;
  }

 private:
  /// Entries of D⁻¹ Φ_q C in those units; those of held joints zero where only free ones step.
  std::vector<double> jacobian(bool all = false) {
    std::vector<double> values(pattern_.size());
    e_->constraint_entries(values.data());
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto [row, column] = pattern_[i];
      const bool steps = all || free_[static_cast<std::size_t>(column)];
      values[i] = steps ? values[i] * column_[column] / row_[row] : 0;
    }
    return values;
  }
  static double largest_of(const std::vector<double>& j) {
    double largest = 0;
    for (const double x : j) largest = std::max(largest, std::abs(x));
    return largest;
  }
  Eigen::VectorXd gap(const Eigen::VectorXd& q) {
    Eigen::VectorXd phi(mechanism_.m());
    e_->place(t_, q.data());
    e_->positions(phi.data());
    return phi.cwiseQuotient(row_);
  }
  /// q after a step in units.
  Eigen::VectorXd moved(const Eigen::VectorXd& q, const Eigen::VectorXd& step) {
    const Eigen::VectorXd rates = step.cwiseProduct(column_);
    Eigen::VectorXd qdot = Eigen::VectorXd::Zero(mechanism_.nq());
    e_->place(t_, q.data());
    e_->coordinate_rates(q.data(), rates.data(), qdot.data());
    Eigen::VectorXd next = q + qdot;
    mechanism_.tree().normalise(next);
    return next;
  }
  /// Where a step leads, shortened until the loops close further; near rounding level they no
  /// longer do, and the norm stays at infinity.
  struct Trial {
    Eigen::VectorXd q;
    double norm = std::numeric_limits<double>::infinity();
  };
  Trial along(const Eigen::VectorXd& q, double norm, Eigen::VectorXd step) {
    Trial best;
    if (!step.allFinite()) return best;
    const double length = step.size() > 0 ? step.cwiseAbs().maxCoeff() : 0;
    if (length > largest_step) step *= largest_step / length;
    for (int halving = 0; halving < 12; ++halving, step *= 0.5) {
      Eigen::VectorXd next = moved(q, step);
      if (const double reached = gap(next).norm(); reached < norm) {
        best.q = std::move(next);
        best.norm = reached;
        break;
      }
    }
    return best;
  }
  /// Minimises |J δ + Φ|² + λ² |δ|², λ = |Φ|, but not so small that rows which are dust beside the
  /// others count.
  Eigen::VectorXd damped_step(const std::vector<double>& j, const Eigen::VectorXd& phi) {
    steps_.factor(j, std::max(phi.norm(), rank_tolerance * largest_of(j)));
    return -steps_.solve(phi);
  }

  /// Where Newton's steps from q lead.
  struct Closed {
    Eigen::VectorXd q;
    double gap = 0;  ///< |Φ|∞, points in lengths
    bool is_closed = false;
  };
  Closed close_from(Eigen::VectorXd q, int& iterations) {
    Eigen::VectorXd phi = gap(q);
    double norm = phi.norm();
    int stalled = 0;
    std::vector<double> j;
    // Factorised where the loops are closed: J changes by rounding from there.
    bool settled = false;
    for (; iterations < most_iterations && norm > 1e-16 && stalled < 2; ++iterations) {
      if (!settled) steps_.factor(j = jacobian());
      settled = phi.cwiseAbs().maxCoeff() <= closed_;
      Trial next = along(q, norm, -steps_.solve(phi));
      // Redundant rows are redundant only where the loops are closed: off it they ask, through
      // pivots as small as the gap, for steps that lead nowhere. Damping by the gap is harmless
      // near the end, where it vanishes faster than what is left to do.
      if (!settled && !(next.norm < 0.5 * norm))
        if (Trial damped = along(q, norm, damped_step(j, phi)); damped.norm < next.norm)
          next = std::move(damped);
      const double next_norm = next.norm;
      if (!(next_norm < norm)) break;
      stalled = next_norm > 0.5 * norm && norm < closed_ ? stalled + 1 : 0;
      q = next.q;
      phi = gap(q);
      norm = next_norm;
    }
    const double last = phi.size() > 0 ? phi.cwiseAbs().maxCoeff() : 0;
    return {q, last, last <= closed_};
  }

  /// The gap closed continuously, down to a hundredth; false where it gets stuck before.
  bool follow(Eigen::VectorXd& q) {
    constexpr double longest = 0.05, bend = 0.3, least_part = 1e-4;
    constexpr int most_steps = 600;
    Eigen::VectorXd phi = gap(q);
    const double end = 0.01 * std::min(phi.norm(), 1.0);
    double part = longest;
    for (int count = 0; count < most_steps && phi.norm() > end; ++count) {
      const std::vector<double> j = jacobian();
      Eigen::VectorXd step = damped_step(j, phi);
      if (!step.allFinite()) return false;
      const double length = step.cwiseAbs().maxCoeff();
      step *= std::min(part, longest / std::max(length, longest * 1e-3));
      const Eigen::VectorXd expected = steps_.product(j, step);
      if (!(expected.norm() > 1e-6 * phi.norm())) return false;  // nowhere to go
      const Eigen::VectorXd next = moved(q, step);
      const Eigen::VectorXd reached = gap(next);
      if ((reached - phi - expected).norm() > bend * expected.norm()) {
        if ((part *= 0.5) < least_part) return false;
        e_->place(t_, q.data());
        continue;
      }
      part = std::min(0.25, 1.5 * part);
      q = next;
      phi = reached;
    }
    return phi.norm() <= end;
  }

  /// Largest change of a coordinate, in units.
  double apart(const Eigen::VectorXd& a, const Eigen::VectorXd& b) const {
    double largest = 0;
    for (const auto& body : mechanism_.tree().bodies)
      for (int i = 0; i < body.nq; ++i) {
        const double unit = i < body.nv ? column_[body.u + i] : 1;
        largest = std::max(largest, std::abs(a[body.q + i] - b[body.q + i]) / unit);
      }
    return largest;
  }

  void close_positions(Assembly& a) {
    const Eigen::VectorXd guess = a.start.q;
    Closed found = close_from(guess, a.iterations);
    const double way = apart(found.q, guess);
    if (!found.is_closed || way > far) {
      Closed followed{guess, 0, false};
      const bool arrived = follow(followed.q);
      followed = close_from(followed.q, a.iterations);
      const double other = apart(followed.q, guess);
      if (followed.is_closed && (!found.is_closed || other < 0.7 * way - far)) {
        char text[160];
        std::snprintf(text, sizeof text,
                      "the assembly reached continuously from the guess, joints moved by at most "
                      "%.3g; Newton's steps lead to another, %.3g away",
                      other, way);
        if (found.is_closed) a.branch = text;
        found = std::move(followed);
      } else if (found.is_closed && !arrived) {
        a.branch =
            "one of several assemblies, the guess does not tell which: on the way from there the "
            "loop equations lose rank before they close";
      }
    }
    a.start.q = found.q;
    const Eigen::VectorXd phi = gap(a.start.q);
    a.position_residual = phi.cwiseProduct(row_).cwiseAbs().maxCoeff();
    a.moved = (a.start.q - guess).cwiseAbs().maxCoeff();
    if (!found.is_closed) refuse(phi.cwiseProduct(row_));
  }

  [[noreturn]] void refuse(const Eigen::VectorXd& phi) const {
    const Scene& scene = mechanism_.scene();
    std::string open;
    Location at;
    int row = 0;
    for (const auto& loop : scene.loops) {
      double largest = 0;
      for (; row < mechanism_.m() &&
             mechanism_.rows()[static_cast<std::size_t>(row)].loop == loop.name;
           ++row)
        largest = std::max(largest, std::abs(phi[row]));
      if (largest <= closed_ * row_[row - 1]) continue;
      char text[32];
      std::snprintf(text, sizeof text, "%.3g", largest);
      if (open.empty()) at = loop.at;
      open += (open.empty() ? "loop '" : ", loop '") + loop.name + "' stays open by " + text;
    }
    throw SceneError(scene.where(at) + "the mechanism cannot be assembled from these positions: " +
                     open + (scene.held.empty() ? "" : " while joints are held") + " (" +
                     std::to_string(mechanism_.m()) + " equations, " +
                     std::to_string(std::count(free_.begin(), free_.end(), true)) +
                     " free rates); expected loops that close");
  }

  void close_velocities(Assembly& a) {
    Eigen::VectorXd& u = a.start.u;
    Eigen::VectorXd rate(mechanism_.m());
    const std::vector<double> j = jacobian();
    steps_.factor(j);
    for (int pass = 0; pass < 2; ++pass) {
      e_->move(u.data());
      e_->velocities(rate.data());
      u -= steps_.solve(rate.cwiseQuotient(row_)).cwiseProduct(column_);
    }
    e_->move(u.data());
    e_->velocities(rate.data());
    a.velocity_residual = rate.cwiseAbs().maxCoeff();
    const double scale = 1 + (u.size() > 0 ? u.cwiseQuotient(column_).cwiseAbs().maxCoeff() : 0) *
                                 (1 + largest_of(j));
    if (rate.cwiseQuotient(row_).cwiseAbs().maxCoeff() <= 1e-10 * scale) return;
    Eigen::Index worst;
    rate.cwiseAbs().maxCoeff(&worst);
    const auto& name = mechanism_.rows()[static_cast<std::size_t>(worst)].loop;
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", a.velocity_residual);
    const Scene& scene = mechanism_.scene();
    if (scene.held.empty() && !scene.drives.empty())
      throw SceneError(scene.where(scene.drives.front().at) + "drives cannot start: loop '" + name +
                       "' would open at a rate of " + text +
                       ", whatever the other joints do; expected drives that the loops allow");
    throw SceneError(scene.where({}) + "the velocities of the held joints tear loop '" + name +
                     "' apart at a rate of " + text + "; expected rates that the loops allow");
  }

  void judge_rank(Assembly& a) {
    LeastNorm::Rows rows = steps_.judge(jacobian(true));
    a.rank = rows.rank;
    a.smallest_pivot = rows.smallest_pivot;
    a.largest_neglected = rows.largest_neglected;
    a.dependent_rows = std::move(rows.dependent);
  }

  void accelerations(Assembly& a) {
    Start& s = a.start;
    s.udot = Eigen::VectorXd::Zero(mechanism_.nv());
    s.lambda = Eigen::VectorXd::Zero(mechanism_.m());
    if (mechanism_.nv() == 0) return;
    e_->place(s.t, s.q.data());
    if (mechanism_.m() == 0) {
      if (!e_->open_accelerations(s.t, s.q.data(), s.u.data(), s.udot.data()))
        no_inertia(e_->singular_joint());
      return;
    }
    if (mechanism_.kkt() == KktChoice::sweeps && !mechanism_.dense_kkt()) {
      const auto solver = make_loop_solver(mechanism_, *e_);
      if (!solver->acceleration(s.t, s.q.data(), s.u.data(), nullptr, 0, 0, s.udot.data(),
                                s.lambda.data()))
        no_inertia(solver->singular_joint());
      return;
    }
    const auto kkt = make_kkt(mechanism_);
    if (!kkt->factor(*e_, s.t, s.q.data(), fade_evaluation)) no_inertia(kkt->singular_joint());
    e_->move(s.u.data());
    Eigen::VectorXd r(mechanism_.nv()), g(mechanism_.m());
    e_->joint_forces(s.q.data(), s.u.data(), nullptr, nullptr, r.data());
    e_->accelerations(g.data());
    r = -r;
    g = -g;
    if (!kkt->solve(r.data(), g.data(), nullptr, s.udot.data(), s.lambda.data())) no_inertia(-1);
  }

  [[noreturn]] void no_inertia(int rate) const {
    throw SceneError(mechanism_.scene().where({}) +
                     "the mechanism cannot move at its start: " + mechanism_.no_inertia(rate));
  }

  [[noreturn]] void nothing_moves() const {
    const LoopSpec& loop = mechanism_.scene().loops.front();
    throw SceneError(mechanism_.scene().where(loop.at) + "loop '" + loop.name +
                     "' ties bodies of which none can move: expected a joint that is neither a "
                     "weld nor driven");
  }

  const Mechanism& mechanism_;
  double t_;
  Eigen::VectorXd q_, u_;  ///< the guess
  std::unique_ptr<Evaluation<double>> e_;
  const std::vector<KktPattern::Entry>& pattern_;  ///< of Φ_q
  LeastNorm steps_;
  std::vector<bool> free_;
  AssemblyUnits units_;
  const Eigen::VectorXd &column_ = units_.rates, &row_ = units_.equations;
  const double closed_ = std::max(closed, units_.rounding);
};

}  // namespace

Assembly assemble(const Mechanism& mechanism) {
  return assemble(mechanism, 0, mechanism.tree().q0, mechanism.tree().u0);
}

Assembly assemble(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& u) {
  return Assembler(mechanism, t, q, u).run();
}

}  // namespace momenta
