#include <momenta/dae/algebra/dense/singular_values.h>
#include <momenta/dae/analysis/kinematics/idle_turns.h>

#include <algorithm>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double null = 1e-9;  // singular value of a freedom, relative

struct Ball {
  const Tree::Body* body = nullptr;
  Eigen::Vector3d axis;  ///< axis of the idle turn, in child axes
};

/// Balls that turn while nothing else moves.
std::vector<Ball> idle_balls(ScaledLoops& loops, double t, const VectorXd& q) {
  const Mechanism& mechanism = loops.mechanism();
  std::vector<Ball> balls;
  std::vector<int> column(static_cast<std::size_t>(mechanism.nv()), -1);
  int columns = 0;
  for (const auto& body : mechanism.tree().bodies)
    if (body.has_quaternion() && body.nv == 3) {
      balls.push_back({&body, Eigen::Vector3d::Zero()});
      for (int i = 0; i < 3; ++i) column[static_cast<std::size_t>(body.u + i)] = columns++;
    }
  if (balls.empty() || mechanism.m() == 0) return {};
  const VectorXd gap = loops.gap(t, q);
  MatrixXd J = MatrixXd::Zero(mechanism.m(), columns);
  const std::vector<double> entries = loops.jacobian();
  for (std::size_t k = 0; k < entries.size(); ++k)
    if (const int at = column[static_cast<std::size_t>(loops.pattern()[k].column)]; at >= 0)
      J(loops.pattern()[k].row, at) = entries[k];
  const SingularValues svd(J);
  const Eigen::Index rank = svd.rank(null);
  const MatrixXd ways = svd.v.rightCols(columns - rank);
  if (ways.cols() == 0) return {};
  std::vector<Ball> idle;
  VectorXd step = VectorXd::Zero(mechanism.nv());
  for (std::size_t k = 0; k < balls.size(); ++k) {
    const SingularValues turns(ways.middleRows(3 * static_cast<long>(k), 3));
    const VectorXd& sizes = turns.values;
    const auto freedoms = (sizes.array() > 1e-6).count();
    if (freedoms > 1) return {};
    if (freedoms == 0) continue;
    balls[k].axis = turns.u.col(0);
    idle.push_back(balls[k]);
  }
  // A finite turn, along all directions at once.
  for (Eigen::Index i = 0; i < ways.cols(); ++i)
    for (std::size_t k = 0; k < balls.size(); ++k)
      step.segment<3>(balls[k].body->u) +=
          (0.7 - 0.2 * static_cast<double>(i)) * ways.col(i).segment<3>(3 * static_cast<long>(k));
  const bool follows = (loops.gap(t, loops.moved(q, step)) - gap).cwiseAbs().maxCoeff() < null;
  return follows ? idle : std::vector<Ball>();
}

}  // namespace

bool start_without_idle_turns(PoseCurve& curve, double t, const VectorXd& q, CurvePoint& point,
                              std::vector<std::string>& held) {
  if (curve.start(q, point)) return true;
  if (curve.freedoms() < 2) return false;
  for (const Ball& ball : idle_balls(curve.loops(), t, q)) {
    const int before = curve.freedoms();
    curve.hold(held_turn(ball.body->q, ball.body->u, ball.axis, q));
    const bool started = curve.start(q, point);
    if (curve.freedoms() < before)
      held.push_back(ball.body->joint);
    else
      curve.release();
    if (started) return true;
  }
  return curve.start(q, point);
}

}  // namespace momenta
