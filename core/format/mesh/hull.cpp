#include <momenta/core/format/mesh/mesh_mass.h>

#include <Eigen/Geometry>
#include <cstdio>
#include <memory>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace momenta::reading {
namespace {

/// Data of Qhull, freed in any case.
struct Qhull {
  qhT data;
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  explicit Qhull(std::FILE* messages) { qh_zero(&data, messages); }
  ~Qhull() {
    data.NOerrexit = True;
    qh_freeqhull(&data, !qh_ALL);
    int left = 0, bytes = 0;
    qh_memfreeshort(&data, &left, &bytes);
  }
};

}  // namespace

Mesh hull_of(const Mesh& mesh, std::string& fault) {
  if (mesh.points.size() < 4) {
    fault = "has fewer than 4 points, expected a solid";
    return {};
  }
  std::vector<coordT> points;
  points.reserve(3 * mesh.points.size());
  for (const Eigen::Vector3d& p : mesh.points) points.insert(points.end(), {p[0], p[1], p[2]});
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> nowhere(std::fopen("/dev/null", "w"),
                                                                std::fclose);
  Qhull qhull(nowhere.get());
  qhT* const qh = &qhull.data;  // the macros of Qhull need this name
  std::string command = "qhull Qt";
  if (qh_new_qhull(qh, 3, static_cast<int>(mesh.points.size()), points.data(), False,
                   command.data(), nullptr, nowhere.get()) != 0) {
    fault = "has no convex hull with a volume, expected points that are not in a plane";
    return {};
  }
  Mesh hull;
  hull.points = mesh.points;
  facetT* facet = nullptr;
  vertexT *vertex = nullptr, **vertexp = nullptr;
  FORALLfacets {
    std::array<std::uint32_t, 3> corners{};
    std::size_t count = 0;
    FOREACHvertex_(facet->vertices) {
      const int number = qh_pointid(qh, vertex->point);
      if (number < 0 || count == 3) {
        fault = "has a convex hull that Qhull does not cut into triangles";
        return {};
      }
      corners[count++] = static_cast<std::uint32_t>(number);
    }
    const Eigen::Vector3d &a = hull.points[corners[0]], &b = hull.points[corners[1]],
                          &c = hull.points[corners[2]];
    const Eigen::Map<const Eigen::Vector3d> outwards(facet->normal);
    if ((b - a).cross(c - a).dot(outwards) < 0) std::swap(corners[1], corners[2]);
    hull.triangles.push_back(corners);
  }
  return hull;
}

}  // namespace momenta::reading
