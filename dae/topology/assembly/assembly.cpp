#include <momenta/dae/kkt/least_norm.h>
#include <momenta/dae/kkt/loop_rank.h>
#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/topology/assembly/assembly.h>
#include <momenta/dae/topology/assembly/closing.h>
#include <momenta/dae/topology/assembly/second_order.h>
#include <momenta/dae/topology/assembly/start_accelerations.h>
#include <momenta/dae/topology/assembly/turned_loops.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace momenta {
namespace {

class Assembler {
 public:
  /// From q, u at time t [s].
  Assembler(const Mechanism& mechanism, double t, Eigen::VectorXd q, Eigen::VectorXd u)
      : mechanism_(mechanism),
        t_(t),
        q_(std::move(q)),
        u_(std::move(u)),
        loops_(mechanism),
        steps_(loops_.pattern(), mechanism.m(), mechanism.nv()) {
    loops_.hold_joints();
  }

  Assembly run(Assembled what) {
    Assembly a;
    a.start.t = t_;
    a.start.q = q_;
    a.start.u = u_;
    if (mechanism_.m() > 0) {
      if (mechanism_.nv() == 0) nothing_moves();
      close_positions(a);
      const int of_positions = mechanism_.has_nonholonomic() ? rank_of_positions() : 0;
      loops_.rows.assign(loops_.rows.size(), true);
      judge_rank(a);
      if (!a.dependent_rows.empty() && a.rank < mechanism_.nv()) expect_motions(a);
      close_velocities(a);
      a.free_positions = mechanism_.nv() - (mechanism_.has_nonholonomic() ? of_positions : a.rank);
    }
    if (mechanism_.m() == 0) a.free_positions = mechanism_.nv();
    a.mobility = mechanism_.nv() - a.rank;
    if (what == Assembled::motion) start_accelerations(mechanism_, e(), a.start);
    return a;
  }

 private:
  Evaluation<double>& e() { return loops_.evaluation(); }

  void close_positions(Assembly& a) {
    const Eigen::VectorXd guess = a.start.q;
    Closing::Pose found;
    double tolerance = 0;
    if (std::optional<Scene> scene = with_ordered_ends(mechanism_.scene())) {
      const Mechanism ordered(std::move(*scene), mechanism_.options());
      ScaledLoops loops(ordered);
      loops.columns = loops_.columns;
      LeastNorm steps(loops.pattern(), ordered.m(), ordered.nv());
      found = closed(loops, steps, a, tolerance);
    } else {
      found = closed(loops_, steps_, a, tolerance);
    }
    a.start.q = found.q;
    const Eigen::VectorXd phi = loops_.gap(t_, a.start.q).cwiseProduct(row_);
    a.position_residual = phi.cwiseAbs().maxCoeff();
    a.moved = (a.start.q - guess).cwiseAbs().maxCoeff();
    if (!found.is_closed) refuse(phi, tolerance, found.is_stretched);
    expect_no_lost_loop(mechanism_, e());
    if (!found.is_least) return;
    a.start.residue = phi;
    a.residue = residue_in_words(mechanism_, phi);
  }

  /// The pose from the guess, by the loops as they are written or with their ends in order.
  Closing::Pose closed(ScaledLoops& loops, LeastNorm& steps, Assembly& a, double& tolerance) {
    Closing closing(loops, steps, t_);
    Closing::Pose found = closing.close(a.start.q);
    a.iterations = closing.iterations();
    if (found.is_closed) turn_back(loops.mechanism(), closing, found, a);
    if (a.branch.empty()) a.branch = closing.branch();
    tolerance = closing.tolerance();
    return found;
  }

  /// Leads a pose that closes loops turned (turned_loops.h) to one that does not.
  void turn_back(const Mechanism& mechanism, Closing& closing, Closing::Pose& found, Assembly& a) {
    const std::vector<TurnedLoop> turned = turned_loops(mechanism, t_, found.q);
    if (turned.empty()) return;
    const std::string sentence = in_words(mechanism, turned);
    if (const auto back = led_back(mechanism, t_, found.q, turned, loops_.columns, a.iterations)) {
      found = closing.close(*back);
      a.iterations += closing.iterations();
      a.branch = "one of several assemblies perhaps: from the guess " + sentence +
                 ", and it was led back from there";
      return;
    }
    const auto in_one = [&](const Closing::Pose& pose) {
      return turned_loops(mechanism, t_, pose.q).empty();
    };
    const int before = closing.iterations();
    found = closing.from_seeds(a.start.q, in_one);
    a.iterations += closing.iterations() - before;
    if (!found.is_closed)
      throw SceneError(mechanism.scene().where(mechanism.scene().loops[turned[0].loop].at) +
                       "the mechanism cannot be assembled from these positions: " + sentence +
                       " alone; expected axes that meet as the scene says, or another rotation");
    a.branch = "one of several assemblies perhaps: from the guess " + sentence +
               ", this one was found from one of several starts around it";
  }

  [[noreturn]] void refuse(const Eigen::VectorXd& phi, double tolerance, bool stretched) {
    const Scene& scene = mechanism_.scene();
    expect_no_lost_loop(mechanism_, e());
    std::string open, within;
    Location at;
    int row = 0;
    const std::string word = std::string(loop_word(mechanism_)) + " '";
    const auto judge = [&](const std::string& name, Location place) {
      double largest = 0;
      for (; row < mechanism_.m() && mechanism_.rows()[static_cast<std::size_t>(row)].loop == name;
           ++row)
        largest = std::max(largest, std::abs(phi[row]));
      if (largest <= tolerance * row_[row - 1]) return;
      char text[32];
      std::snprintf(text, sizeof text, "%.3g", largest);
      if (open.empty()) at = place;
      // A gap so small names the bound that it exceeds.
      if (largest < 1e-6 * row_[row - 1] && within.empty()) {
        char bound[32];
        std::snprintf(bound, sizeof bound, " to %.2g", tolerance * row_[row - 1]);
        within = bound;
      }
      open += (open.empty() ? "" : ", ") + word + name + "' stays open by " + text;
    };
    for (const auto& loop : scene.loops) judge(loop.name, loop.at);
    if (scene.lagrangian)
      for (const auto& c : scene.lagrangian->constraints) judge(c.name, c.at);
    throw SceneError(
        scene.where(at) + (scene.lagrangian ? "the coordinates" : "the mechanism") +
        " cannot be assembled from these positions: " + open +
        (scene.held.empty() ? ""
         : scene.lagrangian ? " while coordinates are held"
                            : " while joints are held") +
        (stretched ? ", stretched: no motion closes it further" : "") + " (" +
        std::to_string(mechanism_.m()) + " equations, " +
        std::to_string(std::count(loops_.columns.begin(), loops_.columns.end(), true)) +
        " free rates); expected " +
        (scene.lagrangian ? "constraints that can be met" : "loops that close") + within);
  }

  /// The fastest rate of a driven joint, in radians or lengths of the scene [1/s]. A loop that it
  /// carries as a whole opens by the rounding of that rate. O(drives)
  double fastest_drive() const {
    const Tree& tree = mechanism_.tree();
    const double length = tree.drives.empty() ? 1 : length_of(mechanism_.scene());
    double fastest = 0;
    for (const Tree::Body& b : tree.bodies) {
      if (b.drive < 0) continue;
      double f = 0, rate = 0, bend = 0;
      tree.drives[static_cast<std::size_t>(b.drive)].evaluate(t_, f, rate, bend);
      // A driven joint has no rates: is_length() does not know it.
      fastest = std::max(fastest, std::abs(rate) / (b.kind == JointKind::prismatic ? length : 1));
    }
    return fastest;
  }

  void close_velocities(Assembly& a) {
    Eigen::VectorXd& u = a.start.u;
    Eigen::VectorXd rate(mechanism_.m());
    const std::vector<double> j = loops_.jacobian();
    steps_.factor(j);
    const auto fastest = [&] {
      return u.size() > 0 ? u.cwiseQuotient(column_).cwiseAbs().maxCoeff() : 0;
    };
    const double given = fastest();  // its rounding stays in the result
    for (int pass = 0; pass < 2; ++pass) {
      e().move(u.data());
      e().velocities(rate.data());
      u -= steps_.solve(rate.cwiseQuotient(row_)).cwiseProduct(column_);
    }
    e().move(nullptr);
    e().velocities(rate.data());
    const double prescribed =
        std::max(rate.cwiseQuotient(row_).cwiseAbs().maxCoeff(), fastest_drive());
    e().move(u.data());
    e().velocities(rate.data());
    a.velocity_residual = rate.cwiseAbs().maxCoeff();
    double largest = 0;
    for (const double x : j) largest = std::max(largest, std::abs(x));
    const double scale = prescribed + std::max(given, fastest()) * (1 + largest);
    // Rates keep the part of redundant equations in singular values that do not count.
    const bool known = a.rank == mechanism_.m() || a.kept > 0;
    const double left = std::max(1e-10, known ? 2 * a.dropped : rank_tolerance);
    if (rate.cwiseQuotient(row_).cwiseAbs().maxCoeff() <= left * scale) return;
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
    throw SceneError(scene.where({}) + "the velocities of the held " +
                     (scene.lagrangian ? "coordinates" : "joints") + " tear " +
                     loop_word(mechanism_) + " '" + name + "' apart at a rate of " + text +
                     "; expected rates that the " + loop_word(mechanism_) + "s allow");
  }

  /// Rank of the holonomic rows, held joints included.
  int rank_of_positions() {
    std::vector<double> values = scaled_entries(mechanism_, e(), loops_.units());
    for (std::size_t i = 0; i < values.size(); ++i)
      if (mechanism_.nonholonomic()[static_cast<std::size_t>(loops_.pattern()[i].row)])
        values[i] = 0;
    return steps_.judge(values, Judged::dependence).rank;
  }

  void judge_rank(Assembly& a) {
    LoopRank judged = loop_rank(mechanism_, e(), Judged::dependence);
    a.rank = judged.rank;
    a.kept = judged.kept;
    a.dropped = judged.dropped;
    a.dependent_rows = std::move(judged.dependent);
  }

  /// Refuses, or reports, free rates that no motion has.
  void expect_motions(Assembly& a) {
    const Rigidity found = second_order(loops_, t_, a.start.q, a.rank);
    e().place(t_, a.start.q.data());
    if (found.stuck.size() == 0) return;
    const std::string words = in_words(mechanism_, found);
    if (found.certain)
      throw SceneError(mechanism_.scene().where({}) +
                       (found.all && found.flat == 0 ? "the mechanism" : "part of the mechanism") +
                       " cannot move at its start: " + words);
    const std::string undecided = "whether it can move is undecided: " + words;
    if (found.all) throw SceneError(mechanism_.scene().where({}) + undecided);
    if (a.branch.empty()) a.branch = undecided;
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
  ScaledLoops loops_;
  LeastNorm steps_;
  const Eigen::VectorXd &column_ = loops_.units().rates, &row_ = loops_.units().equations;
};

}  // namespace

std::string residue_in_words(const Mechanism& mechanism, const Eigen::VectorXd& phi) {
  if (phi.size() == 0) return "";
  const Eigen::VectorXd open = phi.cwiseQuotient(LoopUnits(mechanism).equations).cwiseAbs();
  Eigen::Index worst = 0;
  const double largest = open.maxCoeff(&worst);
  const auto loop_of = [&](Eigen::Index row) -> const std::string& {
    return mechanism.rows()[static_cast<std::size_t>(row)].loop;
  };
  // Loops whose equations are open by a thousandth as much at least.
  std::vector<std::string> others;
  for (Eigen::Index i = 0; i < open.size(); ++i)
    if (open[i] > 1e-3 * largest && loop_of(i) != loop_of(worst) &&
        (others.empty() || others.back() != loop_of(i)))
      others.push_back(loop_of(i));
  constexpr std::size_t most_named = 6;
  std::string with;
  for (std::size_t i = 0; i < others.size() && i < most_named; ++i)
    with += (i == 0 ? " and those of '" : ", '") + others[i] + "'";
  if (others.size() > most_named) with += ", …";
  char size[32];
  std::snprintf(size, sizeof size, "%.2g", std::abs(phi[worst]));
  return loop_word(mechanism) + (" '" + loop_of(worst)) + "' stays open by " + size +
         (mechanism.angle_rows()[static_cast<std::size_t>(worst)] ? " rad" : " m") +
         ": its equations" + with +
         " are redundant and differ by that in the scene's numbers; closed in the least-squares "
         "sense";
}

Assembly assemble(const Mechanism& mechanism, Assembled what) {
  return assemble(mechanism, 0, mechanism.tree().q0, mechanism.tree().u0, what);
}

Assembly assemble(const Mechanism& mechanism, double t, const Eigen::VectorXd& q,
                  const Eigen::VectorXd& u, Assembled what) {
  return Assembler(mechanism, t, q, u).run(what);
}

}  // namespace momenta
