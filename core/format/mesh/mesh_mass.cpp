#include <momenta/core/format/mesh/mesh_mass.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace momenta::reading {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Rounding of a sum of volumes, relative to the sum of their sizes.
constexpr double rounding = 1e-12;

struct Triangle {
  Vector3d a, b, c;
  Vector3d sum() const { return a + b + c; }
  Vector3d area() const { return 0.5 * (b - a).cross(c - a); }
  double volume() const { return a.dot(b.cross(c)) / 6; }
  Matrix3d squares() const {
    const Vector3d s = sum();
    return a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose();
  }
};

/// Calls visit(triangle) for each triangle, corners relative to `origin`.
template <class Visit>
void each(const Mesh& mesh, const Vector3d& origin, const Visit& visit) {
  for (const auto& [i, j, k] : mesh.triangles)
    visit(Triangle{mesh.points[i] - origin, mesh.points[j] - origin, mesh.points[k] - origin});
}

/// Mean of the triangles' centres, weighted by area.
Vector3d middle_of(const Mesh& mesh, double& area) {
  const Vector3d start = mesh.points.empty() ? Vector3d(Vector3d::Zero()) : mesh.points.front();
  Vector3d sum = Vector3d::Zero();
  area = 0;
  each(mesh, start, [&](const Triangle& t) {
    const double a = t.area().norm();
    area += a;
    sum += a / 3 * t.sum();
  });
  return area > 0 ? Vector3d(start + sum / area) : start;
}

/// An edge passed more often one way than the other, its ends counted from 1; empty: none.
std::string open_edge(const Mesh& mesh) {
  struct Passage {
    std::pair<std::uint32_t, std::uint32_t> ends;
    int sense;
    bool operator<(const Passage& other) const { return ends < other.ends; }
  };
  std::vector<Passage> passages;
  passages.reserve(3 * mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k], to = t[(k + 1) % 3];
      if (from < to) passages.push_back({{from, to}, 1});
      if (to < from) passages.push_back({{to, from}, -1});
    }
  std::sort(passages.begin(), passages.end());
  for (auto p = passages.begin(); p != passages.end();) {
    int sum = 0;
    const auto ends = p->ends;
    for (; p != passages.end() && p->ends == ends; ++p) sum += p->sense;
    if (sum != 0) return std::to_string(ends.first + 1) + " and " + std::to_string(ends.second + 1);
  }
  return "";
}

/// Σ weight(t) of the integrals of 1, x and x xᵀ over simplices with `corners` corners: a weight
/// w has ∫ x = w s/corners and ∫ x xᵀ = w/(corners (corners + 1)) (…).
template <class Weight>
MeshMass summed(const Mesh& mesh, const Vector3d& start, double corners, const Weight& weight,
                bool around_start, double& sizes) {
  MeshMass mass;
  Vector3d first = Vector3d::Zero();
  sizes = 0;
  each(mesh, start, [&](const Triangle& t) {
    const double w = weight(t);
    mass.measure += w;
    sizes += std::abs(w);
    first += w / corners * t.sum();
  });
  if (!(mass.measure > rounding * sizes)) return mass;
  mass.com = start + first / mass.measure;
  Matrix3d second = Matrix3d::Zero();
  const Vector3d about = around_start ? start : mass.com;
  each(mesh, about,
       [&](const Triangle& t) { second += weight(t) / (corners * (corners + 1)) * t.squares(); });
  if (around_start) {
    const Vector3d r = mass.com - start;
    second -= mass.measure * r * r.transpose();
  }
  mass.inertia = second.trace() * Matrix3d::Identity() - second;
  return mass;
}

bool too_far(const Mesh& mesh, std::string& fault) {
  for (const Vector3d& p : mesh.points)
    if (!(p.lpNorm<Eigen::Infinity>() < 1e60)) {
      fault = "has coordinates beyond 1e60, expected a body's size [m]";
      return true;
    }
  if (mesh.triangles.empty()) fault = "has no triangles, expected a surface";
  return mesh.triangles.empty();
}

}  // namespace

MeshMass mass_of_inside(const Mesh& mesh, std::string& fault) {
  if (too_far(mesh, fault)) return {};
  if (const std::string edge = open_edge(mesh); !edge.empty()) {
    fault = "is not closed at the edge between points " + edge +
            ", expected each edge in two triangles that pass it in opposite ways";
    return {};
  }
  double area = 0, sizes = 0;
  const Vector3d middle = middle_of(mesh, area);
  const MeshMass mass = summed(
      mesh, middle, 4, [](const Triangle& t) { return t.volume(); }, false, sizes);
  if (mass.measure < -rounding * sizes)
    fault = "has a negative volume, expected corners that run counter-clockwise seen from outside";
  else if (!(mass.measure > rounding * sizes))
    fault = "has no volume, expected a solid";
  return mass;
}

MeshMass mass_by_pyramids(const Mesh& mesh, std::string& fault) {
  if (too_far(mesh, fault)) return {};
  double area = 0, sizes = 0;
  const Vector3d middle = middle_of(mesh, area);
  MeshMass mass = summed(
      mesh, middle, 4, [](const Triangle& t) { return std::abs(t.volume()); }, false, sizes);
  // MuJoCo takes volume and inertia from pyramids about the centre of mass.
  double volume = 0;
  each(mesh, mass.com, [&](const Triangle& t) { volume += std::abs(t.volume()); });
  mass.measure = volume;
  if (!(volume > rounding * std::pow(area, 1.5))) fault = "has no volume, expected a solid";
  return mass;
}

MeshMass mass_of_shell(const Mesh& mesh, std::string& fault) {
  if (too_far(mesh, fault)) return {};
  double area = 0, sizes = 0;
  const Vector3d middle = middle_of(mesh, area);
  if (!(area > 0)) {
    fault = "has no area, expected a surface";
    return {};
  }
  return summed(
      mesh, middle, 3, [](const Triangle& t) { return t.area().norm(); }, false, sizes);
}

}  // namespace momenta::reading
