#include <momenta/core/format/mjcf/mjcf_files.h>
#include <momenta/core/format/mjcf/mjcf_meshes.h>
#include <momenta/core/format/xml/file_inside.h>
#include <momenta/core/text/quoting.h>

#include <array>
#include <cmath>

namespace momenta::reading {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

enum class Inertia { convex, exact, legacy, shell };
constexpr std::array<std::string_view, 4> inertias{"convex", "exact", "legacy", "shell"};

Mesh from_numbers(const Node& node, std::string& fault) {
  Mesh mesh;
  const std::vector<double> points = node.numbers("vertex");
  if (points.size() % 3 != 0)
    node.fail("vertex", "has " + std::to_string(points.size()) + " numbers, expected 3 for each");
  for (std::size_t i = 0; i < points.size(); i += 3)
    mesh.points.emplace_back(points[i], points[i + 1], points[i + 2]);
  if (!node.has("face")) return hull_of(mesh, fault);
  const std::vector<double> corners = node.numbers("face");
  if (corners.size() % 3 != 0)
    node.fail("face", "has " + std::to_string(corners.size()) + " numbers, expected 3 for each");
  for (const double corner : corners)
    if (!(corner >= 0 && corner < static_cast<double>(mesh.points.size())) ||
        corner != std::floor(corner))
      node.fail("face", "has " + digits(corner) + ", expected a point from 0 to " +
                            std::to_string(mesh.points.size()) + ", without that");
  for (std::size_t i = 0; i < corners.size(); i += 3)
    mesh.triangles.push_back({static_cast<std::uint32_t>(corners[i]),
                              static_cast<std::uint32_t>(corners[i + 1]),
                              static_cast<std::uint32_t>(corners[i + 2])});
  return mesh;
}

/// p ← scale · R(refquat)ᵀ (p − refpos). A mirroring scale reverses the triangles.
void place(Mesh& mesh, const Node& node) {
  const Vector3d scale = node.vector("scale", Vector3d::Ones());
  const Vector3d from = node.vector("refpos", Vector3d::Zero());
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (node.has("refquat")) {
    const std::vector<double> q = node.numbers("refquat", 4);
    turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    if (!(turn.norm() > 0)) node.fail("refquat", "is zero, expected a quaternion w x y z");
    turn.normalize();
  }
  for (Vector3d& p : mesh.points) p = scale.cwiseProduct(turn.conjugate() * (p - from));
  if (scale.prod() < 0)
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

MeshMass mass_of(const Mesh& mesh, Inertia inertia, std::string& fault) {
  if (inertia == Inertia::shell) return mass_of_shell(mesh, fault);
  if (inertia == Inertia::legacy) return mass_by_pyramids(mesh, fault);
  if (inertia == Inertia::exact) return mass_of_inside(mesh, fault);
  const Mesh hull = hull_of(mesh, fault);
  return fault.empty() ? mass_by_pyramids(hull, fault) : MeshMass{};
}

/// Whether pyramids overestimate the volume of a closed mesh.
bool overcounts(const Mesh& mesh, const MeshMass& pyramids) {
  constexpr double same = 1e-6;  // relative to the volume: rounding of float32 points
  std::string open;
  const double inside = mass_of_inside(mesh, open).measure;
  return open.empty() && inside < (1 - same) * pyramids.measure;
}

}  // namespace

void MjcfMeshes::take(const Node& mesh, const fs::path& folder, const MjcfSettings& settings) {
  const std::string written = mesh.text("file", "");
  const std::string name = mesh.text("name", fs::path(written).stem().string());
  if (!assets_.emplace(name, Asset{mesh.element(), mesh.file(), folder, settings, {}, {}}).second)
    mesh.fail("is called " + in_quotes(name) + " as another, expected each name once among meshes");
}

const MjcfMeshes::Asset& MjcfMeshes::asset(const Node& geom) const {
  const std::string name = geom.text("mesh");
  const auto found = assets_.find(name);
  if (found == assets_.end()) {
    std::vector<std::string_view> known;
    for (const auto& entry : assets_) known.push_back(entry.first);
    geom.fail("mesh", "is " + in_quotes(name) + ", expected the name of a <mesh> of <asset>" +
                          did_you_mean(name, known));
  }
  return found->second;
}

// x = at (scale · Rᵀ (p − refpos)) is position + rotation · (size · p) where R = 1, or where the
// scale is the same along all axes and commutes with R.
std::optional<VisualSpec> MjcfMeshes::drawn(const Node& geom, const MjcfFrame& at,
                                            const fs::path& scene, std::string& why) const {
  const auto known = assets_.find(geom.text("mesh", ""));
  why = "meshes to draw that have no <mesh> with a file";
  if (known == assets_.end() || known->second.element.find("file") == nullptr) return std::nullopt;
  const Asset& mesh = known->second;
  const Node node(mesh.element, geom.owner(), mesh.file);
  fs::path written = node.text("file");
  if (mesh.settings.bare_names) written = written.filename();
  std::error_code error;
  const fs::path file = fs::weakly_canonical(mesh.folder / mesh.settings.meshes / written, error);
  why = "meshes to draw whose files are not there";
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  why = "meshes to draw that are no STL, OBJ or MSH";
  if (!is_mesh_file(file.string())) return std::nullopt;
  const Vector3d scale = node.vector("scale", Vector3d::Ones());
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (node.has("refquat")) {
    const std::vector<double> q = node.numbers("refquat", 4);
    turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    why = "meshes to draw that are turned and stretched";
    if (!(turn.norm() > 0) || scale[0] != scale[1] || scale[1] != scale[2]) return std::nullopt;
    turn = turn.normalized().conjugate();
  }
  VisualSpec visual;
  visual.kind = "mesh";
  visual.file = file.lexically_relative(scene).string();
  visual.size = scale;
  visual.rotation = (at.turn * turn).normalized();
  const Vector3d from = node.vector("refpos", Vector3d::Zero());
  visual.position = at * Vector3d(-(turn * scale.cwiseProduct(from)));
  return visual;
}

const MeshMass& MjcfMeshes::of(const Node& geom, bool shell, Remarks& remarks) {
  const std::string name = geom.text("mesh");
  const Asset& asset = this->asset(geom);
  const Node node(asset.element, "mesh " + in_quotes(name), asset.file);
  const auto inertia = shell ? Inertia::shell
                             : static_cast<Inertia>(node.word("inertia", inertias,
                                                              asset.settings.exact_meshes ? 1 : 2));
  std::optional<MeshMass>& mass = inertia == Inertia::shell ? asset.shell : asset.solid;
  if (mass) return *mass;
  std::string what, fault;
  const Mesh mesh = read(node, asset, what);
  mass = mass_of(mesh, inertia, fault);
  if (fault.empty() && !(mass->com.allFinite() && mass->inertia.allFinite()))
    fault = "is too large for numbers, expected a body's size [m]";
  if (!fault.empty()) node.fail(what + fault);
  if (inertia == Inertia::legacy && overcounts(mesh, *mass))
    remarks.count(
        "weighed by pyramids that overlap, as MuJoCo does where a mesh does not say "
        "inertia=\"exact\": meshes that are not convex");
  return *mass;
}

/// The mesh in the geom's axes; `what` begins the sentence on a fault.
Mesh MjcfMeshes::read(const Node& node, const Asset& asset, std::string& what) {
  for (const char* key : {"builtin", "content_type", "maxhullvert"})
    if (node.has(key)) node.fail(key, "is not read, expected a mesh without it");
  Mesh mesh;
  if (node.has("file")) {
    fs::path written = node.text("file");
    if (asset.settings.bare_names) written = written.filename();
    what = "file is " + in_quotes(written.string()) + ", which ";
    if (asset.settings.meshes.is_absolute())
      node.fail("file", "lies in the folder " + in_quotes(asset.settings.meshes.string()) +
                            ", expected a folder that is named from that of the model");
    const fs::path file =
        file_inside(node, "file", written.string(), asset.folder / asset.settings.meshes);
    try {
      mesh = read_mesh(file);
    } catch (const SceneError& error) {
      node.fail("file", "cannot be read: " + std::string(error.what()));
    }
  } else {
    std::string fault;
    if (!node.has("vertex")) node.fail("has no file and no vertex, expected one of them");
    mesh = from_numbers(node, fault);
    if (!fault.empty()) node.fail(fault);
  }
  place(mesh, node);
  return mesh;
}

}  // namespace momenta::reading
