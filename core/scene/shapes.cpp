#include <momenta/core/scene/shapes.h>
#include <momenta/core/text/quoting.h>

#include <Eigen/Eigenvalues>

namespace momenta::reading {

Eigen::Vector3d centre_of(const Shape& shape) {
  if (shape.kind == "rod") return 0.5 * shape.size.x() * shape.axis;
  return Eigen::Vector3d::Zero();
}

Eigen::Matrix3d inertia_of(const Shape& shape, double mass) {
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d along = shape.axis * shape.axis.transpose();
  if (shape.kind == "rod") {
    const double length = shape.size.x();
    return mass * length * length / 12 * (one - along);
  }
  if (shape.kind == "box") {
    const Eigen::Vector3d squares = shape.size.cwiseAbs2();
    return mass / 12 *
           (squares.sum() * Eigen::Vector3d::Ones() - squares).asDiagonal().toDenseMatrix();
  }
  if (shape.kind == "cylinder") {
    const double length = shape.size.x(), radius = shape.size.y();
    return mass * radius * radius / 2 * along +
           mass * (3 * radius * radius + length * length) / 12 * (one - along);
  }
  if (shape.kind == "sphere") return 0.4 * mass * shape.size.x() * shape.size.x() * one;
  return Eigen::Matrix3d::Zero();
}

std::string matrix_fault(const Eigen::Matrix3d& inertia) {
  if (!inertia.allFinite()) return "is not finite, expected smaller numbers";
  const double largest = inertia.cwiseAbs().maxCoeff();
  if (largest == 0) return "";
  const Eigen::Matrix3d scaled = inertia / largest;
  return (scaled - scaled.transpose()).cwiseAbs().maxCoeff() > 1e-9 ? "is not symmetric" : "";
}

std::string inertia_fault(const Eigen::Matrix3d& inertia) {
  if (std::string fault = matrix_fault(inertia); !fault.empty()) return fault;
  const double largest = inertia.cwiseAbs().maxCoeff();
  if (largest == 0) return "";
  const Eigen::Matrix3d scaled = inertia / largest;

  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  const Eigen::Vector3d moments = solver.eigenvalues();  // ascending
  const double slack = 1e-9 * moments.cwiseAbs().maxCoeff();
  const std::string found = "has the principal moments " + digits(largest * moments[0]) + ", " +
                            digits(largest * moments[1]) + ", " + digits(largest * moments[2]);
  if (moments[0] < -slack) return found + ", expected none negative";
  if (moments[2] > moments[0] + moments[1] + slack)
    return found +
           ", expected none larger than the sum of the other two (for a planar body write one "
           "number, its "
           "moment about z)";
  return "";
}

}  // namespace momenta::reading
