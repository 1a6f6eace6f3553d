#include <momenta/core/format/mesh/mesh.h>
#include <momenta/dae/output/meshes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>

namespace momenta {

namespace {

using reading::Mesh;

constexpr std::size_t bytes_each = 8, most_points = 65536;

/// The points of each cell are merged.
Mesh clustered(const Mesh& mesh, double cell) {
  struct Cluster {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    double count = 0;
  };
  std::map<std::array<long, 3>, std::uint32_t> number;
  std::vector<Cluster> clusters;
  std::vector<std::uint32_t> of(mesh.points.size());
  for (std::size_t i = 0; i < mesh.points.size(); ++i) {
    std::array<long, 3> key{};
    for (Eigen::Index k = 0; k < 3; ++k)
      key[static_cast<std::size_t>(k)] = std::lround(mesh.points[i][k] / cell);
    const auto [at, fresh] = number.emplace(key, static_cast<std::uint32_t>(clusters.size()));
    if (fresh) clusters.emplace_back();
    of[i] = at->second;
    clusters[at->second].sum += mesh.points[i];
    clusters[at->second].count += 1;
  }
  Mesh small;
  for (const Cluster& c : clusters) small.points.emplace_back(c.sum / c.count);
  std::set<std::array<std::uint32_t, 3>> known;
  for (const auto& t : mesh.triangles) {
    std::array<std::uint32_t, 3> corners{of[t[0]], of[t[1]], of[t[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    // The least corner first, so that equal triangles compare equal.
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (known.insert(corners).second) small.triangles.push_back(corners);
  }
  return small;
}

std::size_t bytes_of(const std::vector<Mesh>& meshes) {
  std::size_t bytes = 0;
  for (const Mesh& m : meshes) bytes += bytes_each * (m.points.size() + m.triangles.size());
  return bytes;
}
bool fit(const std::vector<Mesh>& meshes, std::size_t bytes) {
  return bytes_of(meshes) <= bytes && std::all_of(meshes.begin(), meshes.end(), [](const Mesh& m) {
           return m.points.size() <= most_points;
         });
}

/// Coarsens to the smallest cells that fit; to the last tried if none do.
void coarsen(std::vector<Mesh>& meshes, double length, std::size_t bytes) {
  if (fit(meshes, bytes)) return;
  const std::vector<Mesh> whole = meshes;
  constexpr int most_tries = 48;
  constexpr double root = 1.4142135623730951;
  double cell = length / 4096;
  for (int i = 0; i < most_tries && !fit(meshes, bytes); ++i, cell *= root)
    for (std::size_t k = 0; k < meshes.size(); ++k) meshes[k] = clustered(whole[k], cell);
}

}  // namespace

void coarsen_meshes(Picture& picture, std::size_t bytes) {
  std::vector<Mesh> meshes;
  for (const Picture::Triangles& mesh : picture.meshes)
    meshes.push_back({mesh.points, mesh.corners});
  coarsen(meshes, picture.length, bytes);
  for (std::size_t k = 0; k < meshes.size(); ++k)
    picture.meshes[k] = {std::move(meshes[k].points), std::move(meshes[k].triangles)};
}

std::vector<std::string> take_meshes(Picture& picture, const std::string& scene_file,
                                     std::size_t bytes) {
  namespace fs = std::filesystem;
  std::vector<std::string> told;
  using Key = std::pair<std::string, std::array<double, 3>>;
  std::map<Key, int> places;
  std::map<std::string, bool> unread;
  std::vector<Mesh> meshes;
  std::size_t wanted = 0;
  for (Picture::Solid& solid : picture.solids) {
    const VisualSpec& v = solid.visual;
    if (v.kind != "mesh") continue;
    ++wanted;
    if (unread.contains(v.file) || bytes == 0) continue;
    const Key key{v.file, {v.size[0], v.size[1], v.size[2]}};
    const auto [at, fresh] = places.emplace(key, static_cast<int>(meshes.size()));
    solid.mesh = at->second;
    if (!fresh) continue;
    try {
      Mesh mesh = reading::read_mesh(fs::path(scene_file).parent_path() / v.file);
      for (Eigen::Vector3d& p : mesh.points) p = v.size.cwiseProduct(p);
      if (v.size.prod() < 0)
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
      meshes.push_back(std::move(mesh));
    } catch (const SceneError& error) {
      unread[v.file] = true;
      places.erase(at);
      solid.mesh = -1;
      told.push_back("left out of the page: a mesh: " + std::string(error.what()));
    }
  }
  if (wanted > 0 && bytes == 0)
    return {"left out of the page: meshes (" + std::to_string(wanted) + "), by --mesh-bytes 0"};
  coarsen(meshes, picture.length, bytes);
  const bool none_left =
      std::all_of(meshes.begin(), meshes.end(), [](const Mesh& m) { return m.triangles.empty(); });
  if (!fit(meshes, bytes) || (none_left && !meshes.empty())) {
    for (Picture::Solid& solid : picture.solids) solid.mesh = -1;
    told.push_back("left out of the page: meshes (" + std::to_string(wanted) +
                   "), which --mesh-bytes " + std::to_string(bytes) + " does not hold");
    return told;
  }
  for (const Mesh& m : meshes) picture.meshes.push_back({m.points, m.triangles});
  return told;
}

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
