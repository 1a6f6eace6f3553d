#include <momenta/dae/topology/assembly/bending.h>

#include <cmath>
#include <random>

namespace momenta {
namespace {

using Eigen::VectorXd;

class Bend {
 public:
  Bend(ScaledLoops& loops, LeastNorm& steps, double t, double tolerance)
      : loops_(loops), steps_(steps), t_(t), tolerance_(tolerance) {}

  Bending at(const VectorXd& q) {
    Bending found;
    const VectorXd phi = loops_.gap(t_, q);
    if (phi.size() == 0) return found;
    std::vector<int> dropped = steps_.judge(loops_.jacobian(), Judged::dependence).dependent;
    if (dropped.empty()) {
      Eigen::Index worst = 0;
      phi.cwiseAbs().maxCoeff(&worst);
      dropped.push_back(static_cast<int>(worst));
    }
    is_dropped_.assign(static_cast<std::size_t>(phi.size()), false);
    for (const int row : dropped) is_dropped_[static_cast<std::size_t>(row)] = true;
    look(q, found);
    loops_.gap(t_, q);
    return found;
  }

 private:
  static constexpr int motions = 3, newton_steps = 12;
  static constexpr double length = 0.1;  // [rad or lengths]
  // Φ_D of redundant rows is at most left_by_files and changes by a part of itself; by 0.1² / 2 for
  // curvatures of one.
  static constexpr double bent = 10 * left_by_files;

  void look(const VectorXd& q, Bending& found) {
    VectorXd open, after;
    VectorXd from = q;
    if (!hold(from, open)) return;
    std::mt19937 random(1);  // the same motions every time
    for (int i = 0; i < motions; ++i) {
      loops_.gap(t_, from);
      const std::vector<double> j = held_jacobian();
      VectorXd motion(loops_.mechanism().nv());
      for (Eigen::Index k = 0; k < motion.size(); ++k)
        motion[k] =
            loops_.columns[static_cast<std::size_t>(k)]
                ? 2 * static_cast<double>(random()) / static_cast<double>(std::mt19937::max()) - 1
                : 0;
      steps_.factor(j);
      motion -= steps_.solve(steps_.product(j, motion));
      const double largest = motion.size() > 0 ? motion.cwiseAbs().maxCoeff() : 0;
      if (!(largest > 1e-6)) continue;  // nothing moves
      motion *= length / largest;
      VectorXd there = loops_.moved(from, motion);
      if (!hold(there, after)) continue;
      const VectorXd change = after - open;
      if (!(change.cwiseAbs().maxCoeff() > bent)) continue;
      found.bends = true;
      if (!(change.dot(open) < 0)) continue;
      found.closes = true;
      VectorXd start = loops_.moved(from, std::sqrt(open.norm() / change.norm()) * motion);
      if (hold(start, after)) found.nearer.push_back(std::move(start));
    }
  }

  /// Closes the held rows from q by Newton's method; `dropped`: Φ of the others then.
  bool hold(VectorXd& q, VectorXd& dropped) {
    for (int i = 0; i < newton_steps; ++i) {
      dropped = loops_.gap(t_, q);
      VectorXd held = dropped;
      for (Eigen::Index k = 0; k < held.size(); ++k)
        (is_dropped_[static_cast<std::size_t>(k)] ? held : dropped)[k] = 0;
      if (held.cwiseAbs().maxCoeff() <= tolerance_) return true;
      steps_.factor(held_jacobian());
      const VectorXd step = -steps_.solve(held);
      if (!step.allFinite()) return false;
      q = loops_.moved(q, step);
    }
    return false;
  }

  std::vector<double> held_jacobian() {
    std::vector<double> j = loops_.jacobian();
    for (std::size_t i = 0; i < j.size(); ++i)
      if (is_dropped_[static_cast<std::size_t>(loops_.pattern()[i].row)]) j[i] = 0;
    return j;
  }

  ScaledLoops& loops_;
  LeastNorm& steps_;
  double t_, tolerance_;
  std::vector<bool> is_dropped_;
};

}  // namespace

Bending bending(ScaledLoops& loops, LeastNorm& steps, double t, const VectorXd& q,
                double tolerance) {
  return Bend(loops, steps, t, tolerance).at(q);
}

}  // namespace momenta
