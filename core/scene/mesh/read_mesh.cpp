// Choice of a reader by the file's ending; and MSH, MuJoCo's own format: four counts, then numbers.

#include <momenta/core/scene/file_text.h>
#include <momenta/core/scene/mesh/mesh.h>
#include <momenta/core/scene/mesh/numbers.h>
#include <momenta/core/text/near_name.h>

namespace momenta::reading {

Mesh read_mesh(const std::filesystem::path& file) {
  std::string ending = file.extension().string();
  for (char& c : ending)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  const std::string name = file.string();
  const auto parse = ending == ".stl"   ? parse_stl
                     : ending == ".obj" ? parse_obj
                     : ending == ".msh" ? parse_msh
                                        : nullptr;
  if (ending == ".dae")
    fail(name, {},
         "is COLLADA, whose scenes of cameras, lights and units are not read; expected .stl, .obj "
         "or .msh, which `assimp export` or Blender make of it");
  if (parse == nullptr)
    fail(name, {}, "its name ends in " + in_quotes(ending) + ", expected .stl, .obj or .msh");
  return parse(text_of(file, "mesh"), name);
}

/// int32 numbers of points, normals, texture coordinates and triangles; float32 points (3 each),
/// normals (3), texture coordinates (2); int32 corners of triangles (3).
Mesh parse_msh(std::string_view bytes, const std::string& file) {
  constexpr std::size_t head = 16, point = 12, texture = 8;
  if (bytes.size() < head)
    fail(file, {}, "has " + std::to_string(bytes.size()) + " bytes, expected at least 16");
  std::array<std::uint64_t, 4> counts{};
  for (std::size_t i = 0; i < counts.size(); ++i)
    counts[i] = number_at<std::uint32_t>(bytes, 4 * i);
  const auto [points, normals, textures, triangles] = counts;
  const std::uint64_t size = head + point * (points + normals + triangles) + texture * textures;
  if (size != bytes.size())
    fail(file, {},
         "has " + std::to_string(bytes.size()) + " bytes, expected " + std::to_string(size) +
             " for the counts in its head");
  Mesh mesh;
  mesh.points.resize(points);
  for (std::size_t i = 0; i < points; ++i)
    mesh.points[i] = point_at(bytes, head + point * i, file, i + 1);
  const std::size_t corners = head + point * (points + normals) + texture * textures;
  mesh.triangles.resize(triangles);
  for (std::size_t i = 0; i < triangles; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto corner = number_at<std::uint32_t>(bytes, corners + point * i + 4 * k);
      if (corner >= points)
        fail(file, {},
             "triangle " + std::to_string(i + 1) + " has the corner " + std::to_string(corner) +
                 ", expected less than " + std::to_string(points));
      mesh.triangles[i][k] = corner;
    }
  return mesh;
}

}  // namespace momenta::reading
