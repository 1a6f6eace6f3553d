#include <momenta/core/scene/drive.h>
#include <momenta/dae/analysis/linear/linearisation.h>
#include <momenta/dae/mechanism/marker_motion.h>

#include <algorithm>
#include <vector>

namespace momenta {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int directions = 8;

/// Derivatives of (r, Φ̇, Φ̈) and of markers, eight directions at a time.
class Columns {
 public:
  Columns(const Mechanism& mechanism, double t, const VectorXd& q, const VectorXd& u,
          const VectorXd& udot, const VectorXd& lambda, const MatrixXd& X)
      : mechanism_(mechanism),
        t_(t),
        q_(q),
        u_(u),
        udot_(udot),
        X_(X),
        plain_(mechanism.evaluation<double>()),
        dual_(mechanism.evaluation<Dual8>()),
        place_(static_cast<std::size_t>(mechanism.nq())),
        rate_(static_cast<std::size_t>(mechanism.nv())),
        acceleration_(rate_.size()),
        r_(rate_.size()),
        lambda_(lambda.begin(), lambda.end()),
        of_loops_(static_cast<std::size_t>(mechanism.m())) {
    plain_->place(t, q.data());
  }

  enum class By { poses, rates, accelerations };

  /// Columns of ∂r; ∂Φ̇ and ∂Φ̈ unless null.
  void take(By by, MatrixXd& of_forces, MatrixXd* loops, MatrixXd* second = nullptr) {
    for (Eigen::Index first = 0; first < X_.cols(); first += directions) {
      const Eigen::Index count = std::min<Eigen::Index>(directions, X_.cols() - first);
      seed(by, first, count);
      dual_->place(t_, place_.data());
      dual_->move(rate_.data());
      if (loops) dual_->velocities(of_loops_.data());
      put(of_loops_, loops, first, count);
      dual_->joint_forces(place_.data(), rate_.data(), acceleration_.data(), lambda_.data(),
                          r_.data());
      put(r_, &of_forces, first, count);
      if (second) dual_->accelerations(of_loops_.data());
      put(of_loops_, second, first, count);
    }
  }

  void take_markers(MarkerMotion<Dual8>& markers, By by, MatrixXd& of_markers) {
    std::vector<Dual8> values(static_cast<std::size_t>(of_markers.rows()));
    for (Eigen::Index first = 0; first < X_.cols(); first += directions) {
      const Eigen::Index count = std::min<Eigen::Index>(directions, X_.cols() - first);
      seed(by, first, count);
      markers.at(t_, place_.data(), rate_.data(), values.data());
      put(values, &of_markers, first, count);
    }
  }

 private:
  static void put(const std::vector<Dual8>& values, MatrixXd* into, Eigen::Index first,
                  Eigen::Index count) {
    if (!into) return;
    for (Eigen::Index d = 0; d < count; ++d)
      for (std::size_t i = 0; i < values.size(); ++i)
        (*into)(static_cast<Eigen::Index>(i), first + d) = values[i].b[static_cast<std::size_t>(d)];
  }

  void seed(By by, Eigen::Index first, Eigen::Index count) {
    for (std::size_t i = 0; i < place_.size(); ++i) place_[i] = Dual8(q_[static_cast<long>(i)]);
    for (std::size_t i = 0; i < rate_.size(); ++i) rate_[i] = Dual8(u_[static_cast<long>(i)]);
    for (std::size_t i = 0; i < rate_.size(); ++i)
      acceleration_[i] = Dual8(udot_[static_cast<long>(i)]);
    VectorXd x, way(mechanism_.nq());
    for (Eigen::Index d = 0; d < count; ++d) {
      const auto k = static_cast<std::size_t>(d);
      x = X_.col(first + d);
      if (by == By::poses) {
        way.setZero();
        plain_->coordinate_rates(q_.data(), x.data(), way.data());
        for (std::size_t i = 0; i < place_.size(); ++i) place_[i].b[k] = way[static_cast<long>(i)];
      } else {
        auto& seeded = by == By::rates ? rate_ : acceleration_;
        for (std::size_t i = 0; i < seeded.size(); ++i) seeded[i].b[k] = x[static_cast<long>(i)];
      }
    }
  }

  const Mechanism& mechanism_;
  double t_;
  const VectorXd &q_, &u_, &udot_;
  const MatrixXd& X_;
  std::unique_ptr<Evaluation<double>> plain_;
  std::unique_ptr<Evaluation<Dual8>> dual_;
  std::vector<Dual8> place_, rate_, acceleration_, r_, lambda_, of_loops_;
};

/// B x, from both derivatives along one direction each.
VectorXd turning(const Mechanism& mechanism, const Evaluation<double>& plain,
                 const Evaluation<Dual8>& dual, const VectorXd& q, const VectorXd& u,
                 const VectorXd& x) {
  const auto nq = static_cast<std::size_t>(mechanism.nq());
  const auto derivative = [&](const VectorXd& along, const VectorXd& rates) {
    VectorXd way = VectorXd::Zero(mechanism.nq());
    plain.coordinate_rates(q.data(), along.data(), way.data());
    std::vector<Dual8> place(nq), rate(rates.begin(), rates.end()), qdot(nq, Dual8(0.0));
    for (std::size_t i = 0; i < nq; ++i) {
      place[i] = Dual8(q[static_cast<long>(i)]);
      place[i].b[0] = way[static_cast<long>(i)];
    }
    dual.coordinate_rates(place.data(), rate.data(), qdot.data());
    VectorXd d(mechanism.nq());
    for (std::size_t i = 0; i < nq; ++i) d[static_cast<long>(i)] = qdot[i].b[0];
    return d;
  };
  const VectorXd qdot = derivative(x, u) - derivative(u, x);
  VectorXd rates = VectorXd::Zero(mechanism.nv());
  plain.joint_rates(q.data(), qdot.data(), rates.data());
  return rates;
}

MatrixXd turnings(const Mechanism& mechanism, double t, const VectorXd& q, const VectorXd& u,
                  const MatrixXd& X) {
  MatrixXd B = MatrixXd::Zero(mechanism.nv(), X.cols());
  if (!mechanism.plan().quasi_velocities) return B;
  const auto plain = mechanism.evaluation<double>();
  const auto dual = mechanism.evaluation<Dual8>();
  plain->place(t, q.data());
  for (Eigen::Index j = 0; j < X.cols(); ++j)
    B.col(j) = turning(mechanism, *plain, *dual, q, u, X.col(j));
  return B;
}

void take_all(const Mechanism& mechanism, double t, const VectorXd& q, const VectorXd& u,
              const VectorXd& lambda, const MatrixXd& X, Linearisation& l, MatrixXd* loop_rates) {
  for (MatrixXd* a : {&l.M, &l.C, &l.K}) a->setZero(mechanism.nv(), X.cols());
  l.loops.setZero(mechanism.m(), X.cols());
  const VectorXd unaccelerated = VectorXd::Zero(mechanism.nv());
  Columns columns(mechanism, t, q, u, unaccelerated, lambda, X);
  columns.take(Columns::By::poses, l.K, loop_rates);
  columns.take(Columns::By::rates, l.C, mechanism.m() > 0 ? &l.loops : nullptr);
  columns.take(Columns::By::accelerations, l.M, nullptr);
}

}  // namespace

Linearisation linearise(const Mechanism& mechanism, double t, const VectorXd& q,
                        const VectorXd& lambda, const MatrixXd& X) {
  Linearisation l;
  const VectorXd rest = VectorXd::Zero(mechanism.nv());
  take_all(mechanism, t, q, rest, lambda, X, l, nullptr);
  return l;
}

MovingLinearisation linearise_moving(const Mechanism& mechanism, double t, const VectorXd& q,
                                     const VectorXd& u, const VectorXd& lambda, const MatrixXd& X) {
  MovingLinearisation l;
  l.loop_rates.setZero(mechanism.m(), X.cols());
  take_all(mechanism, t, q, u, lambda, X, l, mechanism.m() > 0 ? &l.loop_rates : nullptr);
  l.turning = turnings(mechanism, t, q, u, X);
  return l;
}

StateLinearisation linearise_state(const Mechanism& mechanism, double t, const VectorXd& q,
                                   const VectorXd& u, const VectorXd& udot, const VectorXd& lambda,
                                   const MatrixXd& X) {
  StateLinearisation l;
  const Eigen::Index nv = mechanism.nv(), m = mechanism.m();
  for (MatrixXd* a : {&l.M, &l.C, &l.K}) a->setZero(nv, X.cols());
  for (MatrixXd* a : {&l.loops, &l.loop_rates, &l.second_by_rates, &l.second_by_poses})
    a->setZero(m, X.cols());
  for (MatrixXd* a : {&l.markers_by_rates, &l.markers_by_poses})
    a->setZero(6 * static_cast<Eigen::Index>(mechanism.scene().markers.size()), X.cols());
  Columns columns(mechanism, t, q, u, udot, lambda, X);
  columns.take(Columns::By::poses, l.K, &l.loop_rates, &l.second_by_poses);
  columns.take(Columns::By::rates, l.C, &l.loops, &l.second_by_rates);
  columns.take(Columns::By::accelerations, l.M, nullptr);
  if (l.markers_by_poses.size() > 0) {
    const auto markers = make_marker_motion<Dual8>(mechanism);
    columns.take_markers(*markers, Columns::By::poses, l.markers_by_poses);
    columns.take_markers(*markers, Columns::By::rates, l.markers_by_rates);
  }
  l.turning = turnings(mechanism, t, q, u, X);
  return l;
}

Scene held_at_start(Scene scene) {
  for (DriveSpec& drive : scene.drives) {
    double f = 0, rate = 0, acceleration = 0;
    MotionLaw(drive).evaluate(0.0, f, rate, acceleration);
    DriveSpec held;
    held.joint = drive.joint;
    held.loop = drive.loop;
    held.coordinate = drive.coordinate;
    held.origin = drive.origin;
    held.at = drive.at;
    held.kind = "polynomial";
    held.coefficients = {f};
    drive = std::move(held);
  }
  for (JointSpec& joint : scene.joints) joint.velocity.clear();
  return scene;
}

}  // namespace momenta
