#pragma once
// A slow twin of planar mechanisms with pins that rub: bodies in maximal coordinates (x, y, θ), the
// force of each pin two multipliers, its friction a couple of that force; solved again and again
// until the forces do not change. Nothing is shared with the library but the law μ(v), written
// anew.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <vector>

namespace momenta::equations {

class PlanarPins {
 public:
  struct Body {
    double mass, inertia;  ///< about the centre of mass, where (x, y) is
  };
  struct Pin {
    int a, b;                    ///< bodies; −1: the ground
    Eigen::Vector2d on_a, on_b;  ///< from their centres of mass, in their axes
    double radius, still, moving, transition;
  };

  PlanarPins(std::vector<Body> bodies, std::vector<Pin> pins, Eigen::Vector2d gravity)
      : bodies_(std::move(bodies)), pins_(std::move(pins)), gravity_(gravity) {}

  int size() const { return 3 * static_cast<int>(bodies_.size()); }

  /// The accelerations at places x and rates v.
  Eigen::VectorXd accelerations(const Eigen::VectorXd& x, const Eigen::VectorXd& v) const {
    const int n = size(), m = 2 * static_cast<int>(pins_.size());
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + m, n + m);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n + m);
    for (int i = 0; i < n / 3; ++i) {
      const Body& body = bodies_[static_cast<std::size_t>(i)];
      A.diagonal().segment<3>(3 * i) << body.mass, body.mass, body.inertia;
      right.segment<2>(3 * i) = body.mass * gravity_;
    }
    for (std::size_t k = 0; k < pins_.size(); ++k) {
      const int row = n + 2 * static_cast<int>(k);
      const auto end = [&](int body, const Eigen::Vector2d& at, double sign) {
        if (body < 0) return;
        const Eigen::Vector2d arm = Eigen::Rotation2Dd(x[3 * body + 2]) * at;
        Eigen::Matrix<double, 2, 3> J;
        J << 1, 0, -arm.y(), 0, 1, arm.x();
        A.block<2, 3>(row, 3 * body) = sign * J;
        A.block<3, 2>(3 * body, row) = sign * J.transpose();
        right.segment<2>(row) += sign * v[3 * body + 2] * v[3 * body + 2] * arm;
      };
      end(pins_[k].a, pins_[k].on_a, -1);
      end(pins_[k].b, pins_[k].on_b, 1);
    }
    const Eigen::PartialPivLU<Eigen::MatrixXd> lu(A);
    Eigen::VectorXd found = lu.solve(right);
    for (int again = 0; again < 200; ++again) {
      Eigen::VectorXd rubbed = right;
      for (std::size_t k = 0; k < pins_.size(); ++k) {
        const Pin& pin = pins_[k];
        const double turning =
            (pin.b < 0 ? 0 : v[3 * pin.b + 2]) - (pin.a < 0 ? 0 : v[3 * pin.a + 2]);
        const double s = pin.radius * turning / pin.transition;
        const double mu = pin.moving * std::tanh(4 * s) +
                          (pin.still - pin.moving) * s / std::pow(s * s / 4 + 0.75, 2);
        const double couple =
            pin.radius * mu * found.segment<2>(n + 2 * static_cast<int>(k)).norm();
        if (pin.b >= 0) rubbed[3 * pin.b + 2] -= couple;
        if (pin.a >= 0) rubbed[3 * pin.a + 2] += couple;
      }
      const Eigen::VectorXd next = lu.solve(rubbed);
      const double change = (next - found).norm();
      found = next;
      if (change <= 1e-15 * found.norm()) break;
    }
    return found.head(n);
  }

  /// RK4 over `steps` steps to `end`.
  void integrate(Eigen::VectorXd& x, Eigen::VectorXd& v, double end, int steps) const {
    const double h = end / steps;
    for (int i = 0; i < steps; ++i) {
      const Eigen::VectorXd a1 = accelerations(x, v);
      const Eigen::VectorXd v2 = v + h / 2 * a1, a2 = accelerations(x + h / 2 * v, v2);
      const Eigen::VectorXd v3 = v + h / 2 * a2, a3 = accelerations(x + h / 2 * v2, v3);
      const Eigen::VectorXd v4 = v + h * a3, a4 = accelerations(x + h * v3, v4);
      x += h / 6 * (v + 2 * v2 + 2 * v3 + v4);
      v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }

 private:
  std::vector<Body> bodies_;
  std::vector<Pin> pins_;
  Eigen::Vector2d gravity_;
};

}  // namespace momenta::equations
