#pragma once
// Triangle surfaces from STL, OBJ and MuJoCo's MSH. Own readers: a triangle list is a page of code,
// and libraries allocate what a file's head asks for. Here counts are compared with the file's size
// first.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace momenta::reading {

/// Triangles between points; from outside, their corners run counter-clockwise.
struct Mesh {
  std::vector<Eigen::Vector3d> points;  ///< finite [m, or the unit of the file]
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Reads .stl (binary or text), .obj or .msh, in any case, up to 64 MiB. Points of an STL with the
/// same coordinates become one; polygons of an OBJ become fans of triangles. @throws SceneError:
/// "file:line: sentence". Cost O(size of file)
Mesh read_mesh(const std::filesystem::path& file);

/// The same from the bytes of a file; `file` names it in messages.
Mesh parse_stl(std::string_view bytes, const std::string& file);
Mesh parse_obj(std::string_view text, const std::string& file);
Mesh parse_msh(std::string_view bytes, const std::string& file);

}  // namespace momenta::reading
