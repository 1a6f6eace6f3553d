#include <momenta/dae/report/solid_faces.h>

#include <array>
#include <cmath>
#include <numbers>

namespace momenta {
namespace {

using Eigen::Vector3d;

/// Radius and height along z.
using Profile = std::vector<std::array<double, 2>>;

void add_arc(Profile& profile, int pieces, double from, double to, double radius, double height) {
  for (int i = 0; i <= pieces; ++i) {
    const double w = from + (to - from) * i / pieces;
    profile.push_back({radius * std::cos(w), height + radius * std::sin(w)});
  }
}

/// The profile turned about z, stretched along the axes; discs close open ends.
std::vector<Face> turned(const Profile& profile, const Vector3d& stretch) {
  constexpr int sides = 14;
  const auto corner = [&](std::size_t ring, int side) -> Vector3d {
    const double w = 2 * std::numbers::pi * side / sides;
    return stretch.cwiseProduct(
        Vector3d(profile[ring][0] * std::cos(w), profile[ring][0] * std::sin(w), profile[ring][1]));
  };
  std::vector<Face> faces;
  for (std::size_t i = 1; i < profile.size(); ++i)
    for (int k = 0; k < sides; ++k)
      faces.push_back({corner(i - 1, k), corner(i - 1, k + 1), corner(i, k + 1), corner(i, k)});
  constexpr double point = 1e-9;
  Face bottom, top;
  for (int k = 0; k < sides; ++k) {
    bottom.push_back(corner(0, -k));
    top.push_back(corner(profile.size() - 1, k));
  }
  if (profile.front()[0] > point) faces.push_back(bottom);
  if (profile.back()[0] > point) faces.push_back(top);
  return faces;
}

std::vector<Face> box(const Vector3d& size) {
  static constexpr std::array<std::array<int, 4>, 6> sides{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  std::vector<Face> faces;
  for (const auto& side : sides) {
    Face face;
    for (const int i : side)
      face.push_back(0.5 * Vector3d((i & 1) != 0 ? size.x() : -size.x(),
                                    (i & 2) != 0 ? size.y() : -size.y(),
                                    (i & 4) != 0 ? size.z() : -size.z()));
    faces.push_back(face);
  }
  return faces;
}

}  // namespace

std::vector<Face> faces_of(const Picture& picture, const Picture::Solid& solid) {
  constexpr double half = std::numbers::pi / 2;
  const VisualSpec& v = solid.visual;
  const double length = v.size[0], radius = v.size[1];
  std::vector<Face> faces;
  Profile profile;
  if (v.kind == "mesh") {
    if (solid.mesh < 0) return {};
    const Picture::Triangles& mesh = picture.meshes[static_cast<std::size_t>(solid.mesh)];
    for (const auto& t : mesh.corners)
      faces.push_back({mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]});
  } else if (v.kind == "box") {
    faces = box(v.size);
  } else if (v.kind == "cylinder") {
    profile = {{radius, -length / 2}, {radius, length / 2}};
    faces = turned(profile, Vector3d::Ones());
  } else if (v.kind == "capsule") {
    add_arc(profile, 3, -half, 0, radius, -length / 2);
    add_arc(profile, 3, 0, half, radius, length / 2);
    faces = turned(profile, Vector3d::Ones());
  } else {
    add_arc(profile, 8, -half, half, 1, 0);
    faces = turned(profile, v.kind == "sphere" ? Vector3d::Constant(v.size[0]) : v.size);
  }
  for (Face& face : faces)
    for (Vector3d& corner : face) corner = v.position + v.rotation * corner;
  return faces;
}

}  // namespace momenta
