#include <momenta/core/format/mjcf/mjcf_inertia.h>
#include <momenta/core/format/mjcf/mjcf_model.h>
#include <momenta/core/format/xml/made_scene.h>
#include <momenta/core/text/quoting.h>

#include <Eigen/Eigenvalues>
#include <array>

namespace momenta::reading {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d rotated(const Matrix3d& m, const Eigen::Quaterniond& turn) {
  const Matrix3d r = turn.toRotationMatrix();
  if (r == Matrix3d::Identity()) return m;
  const Matrix3d t = r * m * r.transpose();
  return 0.5 * (t + t.transpose());
}

/// Steiner's term m (|r|² 1 − r rᵀ).
Matrix3d steiner(double mass, const Vector3d& r) {
  return mass * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

struct Solid {
  double volume = 0;                    ///< [m³], or the area of a shell [m²]
  Vector3d moments = Vector3d::Zero();  ///< per mass, principal, z last
};

Solid solid_of(GeomShape shape, const Vector3d& s) {
  const double pi = std::numbers::pi;
  const Vector3d squares = s.cwiseAbs2();
  const Vector3d others(squares[1] + squares[2], squares[0] + squares[2], squares[0] + squares[1]);
  if (shape == GeomShape::box) return {8 * s.prod(), others / 3};
  if (shape == GeomShape::ellipsoid) return {4 * pi / 3 * s.prod(), others / 5};
  const double r = s[0], h = s[1];
  if (shape == GeomShape::sphere) return {4 * pi / 3 * r * r * r, Vector3d::Constant(0.4 * r * r)};
  const double cylinder = 2 * pi * r * r * h, ball = 4 * pi / 3 * r * r * r;
  const double across = (3 * r * r + 4 * h * h) / 12, along = r * r / 2;
  if (shape == GeomShape::cylinder) return {cylinder, {across, across, along}};
  const double part = ball / (cylinder + ball);
  const double ends = 0.4 * r * r + h * h + 0.75 * h * r;
  const double x = part * ends + (1 - part) * across;
  return {cylinder + ball, {x, x, part * 0.4 * r * r + (1 - part) * along}};
}

/// The surface alone: area, and moments per mass.
Solid shell_of(GeomShape shape, const Vector3d& s) {
  const double pi = std::numbers::pi;
  if (shape == GeomShape::box) {
    const double ab = s[0] * s[1], bc = s[1] * s[2], ca = s[2] * s[0];
    const Vector3d squares(bc + (ab + ca) / 3, ca + (ab + bc) / 3, ab + (bc + ca) / 3);
    const Vector3d means = squares.cwiseProduct(s.cwiseAbs2()) / (ab + bc + ca);
    return {8 * (ab + bc + ca), {means[1] + means[2], means[0] + means[2], means[0] + means[1]}};
  }
  const double r = s[0], h = shape == GeomShape::sphere ? 0 : s[1];
  const double side = 4 * pi * r * h, disc = pi * r * r;
  double area = side, polar = side * r * r, axial = side * h * h / 3;
  if (shape == GeomShape::cylinder) {
    area += 2 * disc;
    polar += disc * r * r;
    axial += 2 * disc * h * h;
  } else {
    area += 4 * disc;
    polar += 8 * disc * r * r / 3;
    axial += 4 * disc * (h * h + h * r + r * r / 3);
  }
  const double across = (polar / 2 + axial) / area;
  return {area, {across, across, polar / area}};
}

/// Inertia of a mass on a mesh, in the frame of the mesh's points, which is the geom's.
MjcfInertia weighed(const MeshMass& mesh, double mass) {
  return {mass, mesh.com, mass / mesh.measure * mesh.inertia};
}

}  // namespace

MjcfInertia operator*(const MjcfFrame& frame, const MjcfInertia& inner) {
  return {inner.mass, frame * inner.com, rotated(inner.inertia, frame.turn)};
}

Vector3d geom_size(const Node& geom, GeomShape shape) {
  const std::vector<double> given = geom.numbers("size");
  const bool by_ends = geom.has("fromto");
  const bool of_three = shape == GeomShape::ellipsoid || shape == GeomShape::box;
  const std::size_t needed = shape == GeomShape::sphere || by_ends ? 1 : (of_three ? 3 : 2);
  if (given.size() < needed)
    geom.fail("size", "has " + std::to_string(given.size()) + " numbers, expected " +
                          std::to_string(needed) + " for a " +
                          std::string(geom_shapes[static_cast<std::size_t>(shape)]));
  Vector3d size = Vector3d::Zero();
  for (std::size_t i = 0; i < needed; ++i) size[static_cast<Eigen::Index>(i)] = given[i];
  if (by_ends) {
    const std::vector<double> n = geom.numbers("fromto", 6);
    const double half = 0.5 * Vector3d(n[3] - n[0], n[4] - n[1], n[5] - n[2]).norm();
    size = of_three ? Vector3d(given[0], given[0], half) : Vector3d(given[0], half, 0);
  }
  for (std::size_t i = 0; i < (by_ends ? (of_three ? 3 : 2) : needed); ++i)
    if (!(size[static_cast<Eigen::Index>(i)] > 0))
      geom.fail("size", "is not positive, expected numbers > 0 [m]");
  return size;
}

void MjcfInertia::add(const MjcfInertia& other) {
  if (other.mass == 0) return;
  const double sum = mass + other.mass;
  const Vector3d middle = (mass * com + other.mass * other.com) / sum;
  inertia += steiner(mass, com - middle) + other.inertia + steiner(other.mass, other.com - middle);
  mass = sum;
  com = middle;
}

MjcfInertia read_inertial(const Node& node, const MjcfAngles& angles) {
  MjcfInertia body;
  body.mass = node.number("mass");
  body.com = node.vector("pos");
  if (node.has("fullinertia")) {
    if (node.has("diaginertia")) node.fail("has diaginertia and fullinertia, expected one of them");
    for (const std::string_view key : orientation_keys)
      if (node.has(key))
        node.fail("has fullinertia and " + std::string(key) +
                  ", expected diaginertia with an orientation, or fullinertia alone");
    const std::vector<double> m = node.numbers("fullinertia", 6);
    body.inertia = symmetric(m[0], m[1], m[2], m[3], m[4], m[5]);
  } else {
    const Vector3d moments = node.vector("diaginertia");
    body.inertia = rotated(moments.asDiagonal().toDenseMatrix(), read_turn(node, angles));
  }
  return body;
}

MjcfInertia read_geom(const Node& geom, const MjcfAngles& angles, bool at_rest, MjcfMeshes& meshes,
                      Remarks& remarks) {
  const auto shape = static_cast<GeomShape>(geom.word("type", geom_shapes, 0));
  if (geom.has("fromto") && shape != GeomShape::capsule && shape != GeomShape::cylinder &&
      shape != GeomShape::ellipsoid && shape != GeomShape::box)
    geom.fail("fromto", "stands on a " + std::string(geom_shapes[static_cast<std::size_t>(shape)]) +
                            ", expected a capsule, cylinder, ellipsoid or box");
  if (shape == GeomShape::plane || shape == GeomShape::hfield) return {};
  const bool by_mass = geom.has("mass");
  const double given = by_mass ? geom.number("mass") : geom.number("density", 1000);
  if (given < 0) geom.fail(by_mass ? "mass" : "density", "is negative, expected a number >= 0");
  if (given == 0) return {};
  const bool shell = geom.flag("shellinertia", false);
  if (shape == GeomShape::mesh) {
    if (at_rest) return {};
    const MeshMass& mesh = meshes.of(geom, shell, remarks);
    return read_frame(geom, angles) * weighed(mesh, by_mass ? given : given * mesh.measure);
  }
  if (shape == GeomShape::sdf || geom.has("mesh")) {
    if (at_rest) return {};
    geom.fail("type", "is " + std::string(geom_shapes[static_cast<std::size_t>(shape)]) +
                          " with a mesh to fit, which is not read; expected the type mesh, or an "
                          "<inertial> of the body");
  }
  if (shell && shape == GeomShape::ellipsoid)
    geom.fail("shellinertia", "is true for an ellipsoid, which is not read; expected a solid");
  const MjcfFrame frame = read_frame(geom, angles);
  const Vector3d size = geom_size(geom, shape);
  const Solid solid = shell ? shell_of(shape, size) : solid_of(shape, size);
  const double mass = by_mass ? given : given * solid.volume;
  return frame *
         MjcfInertia{mass, Vector3d::Zero(), (mass * solid.moments).asDiagonal().toDenseMatrix()};
}

// Changes of masses by <compiler>, as in MuJoCo. For a body with mass m and principal moments I1,
// I2, I3:
//
//   m ≥ boundmass and each Ii ≥ boundinertia, those below are raised to them; what has no mass and
//   no
//     <inertial> gets it at the point of its frame that its `pos` names in its parent's;
//   balanceinertia: where no rigid body has such moments, Ii + Ij < Ik, each is (I1 + I2 + I3)/3;
//   settotalmass M: then all m and Ii times M / Σ m, over all bodies but the world.

MjcfInertia bounded(const MjcfInertia& body, const MjcfSettings& settings) {
  MjcfInertia kept = body;
  if (body.mass >= 0) kept.mass = std::max(body.mass, settings.least_mass);
  if (settings.least_moment <= 0 && !settings.balances) return kept;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(body.inertia);
  const Eigen::Vector3d own = principal.eigenvalues();  // ascending
  Eigen::Vector3d moments = own.cwiseMax(settings.least_moment);
  if (settings.balances && moments[0] + moments[1] < moments[2])
    moments.setConstant(moments.mean());
  if (moments == own) return kept;
  const Eigen::Matrix3d& axes = principal.eigenvectors();
  const Eigen::Matrix3d inertia = axes * moments.asDiagonal() * axes.transpose();
  kept.inertia = 0.5 * (inertia + inertia.transpose());
  return kept;
}

void scale_to_total_mass(MjcfModel& model) {
  if (model.total_mass == 0) return;
  double sum = 0;
  for (const BodySpec& body : model.scene.bodies) sum += body.mass;
  if (sum == 0) return;
  const double factor = model.total_mass / sum;
  for (BodySpec& body : model.scene.bodies) {
    body.mass *= factor;
    body.inertia *= factor;
  }
  for (ForceSpec& force : model.scene.forces)
    if (force.kind == "wrench") force.force *= factor;  // force of gravcomp
}

}  // namespace momenta::reading
