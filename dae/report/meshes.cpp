#include <momenta/core/scene/mesh/mesh.h>
#include <momenta/dae/report/meshes.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
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

}  // namespace momenta
