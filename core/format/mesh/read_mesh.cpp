// Choice of a reader by the file's ending; and MSH, MuJoCo's own format: four counts, then numbers.

#include <momenta/core/format/mesh/mesh.h>
#include <momenta/core/format/mesh/numbers.h>
#include <momenta/core/scene/file_text.h>
#include <momenta/core/text/quoting.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <unordered_map>

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

// OBJ: "v x y z" are points and "f a b c ..." polygons by numbers of points, from 1, or from −1
// backwards; behind a slash are textures and normals. Curves and free surfaces are refused: without
// them the surface would be another one.

namespace {

/// Kinds of lines without effect on the surface.
constexpr std::array<std::string_view, 20> idle{
    "vn",  "vt",  "vp",       "g",        "o",     "s", "mg", "usemtl", "mtllib",     "usemap",
    "lod", "map", "c_interp", "d_interp", "bevel", "l", "p",  "maplib", "shadow_obj", "trace_obj"};

class ObjReader {
 public:
  explicit ObjReader(const std::string& file) : file_(file) {}

  void line(std::string_view line, int at) {
    line = line.substr(0, line.find('#'));
    const std::string_view word = next_word(line);
    if (word.empty()) return;
    if (word == "v") {
      Eigen::Vector3d p;
      for (Eigen::Index k = 0; k < 3; ++k) p[k] = next_number(line, file_, at);
      mesh_.points.push_back(p);
    } else if (word == "f") {
      polygon(line, at);
    } else if (std::find(idle.begin(), idle.end(), word) == idle.end()) {
      fail(file_, {at, 0}, "has a line of kind " + in_quotes(word) + ", expected v and f");
    }
  }
  Mesh take() { return std::move(mesh_); }

 private:
  void polygon(std::string_view line, int at) {
    corners_.clear();
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line))
      corners_.push_back(corner(word, at));
    if (corners_.size() < 3)
      fail(file_, {at, 0},
           "a face has " + std::to_string(corners_.size()) + " corners, expected at least 3");
    for (std::size_t i = 2; i < corners_.size(); ++i)
      mesh_.triangles.push_back({corners_[0], corners_[i - 1], corners_[i]});
  }

  std::uint32_t corner(std::string_view word, int at) const {
    const std::string_view number = word.substr(0, word.find('/'));
    const auto points = static_cast<std::int64_t>(mesh_.points.size());
    std::int64_t value = 0;
    const auto [stop, error] = std::from_chars(number.data(), number.data() + number.size(), value);
    if (stop != number.data() + number.size() || error != std::errc() || value == 0 ||
        value > points || value < -points)
      fail(file_, {at, 0},
           "a face has the corner " + in_quotes(word) + ", expected a point from 1 to " +
               std::to_string(points));
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : points + value);
  }

  const std::string& file_;
  Mesh mesh_;
  std::vector<std::uint32_t> corners_;
};

}  // namespace

Mesh parse_obj(std::string_view text, const std::string& file) {
  ObjReader reader(file);
  Lines lines(text);
  std::string joined;
  for (std::string_view line; lines.next(line);) {
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool goes_on = line.ends_with('\\');
    if (goes_on) line.remove_suffix(1);
    if (joined.empty() && !goes_on) {
      reader.line(line, lines.number());
      continue;
    }
    (joined += line) += ' ';
    if (goes_on) continue;
    reader.line(joined, lines.number());
    joined.clear();
  }
  if (!joined.empty()) reader.line(joined, lines.number());
  return reader.take();
}

// STL, binary: 80 bytes of anything, the number of triangles, and 50 bytes each: a normal, three
// corners, two bytes of anything. Text: "solid", then facets of three "vertex x y z". Both may
// begin with "solid": a file is binary where its size fits its count. Normals are not used; the
// order of the corners tells the outside.

namespace {

using Eigen::Vector3d;

constexpr std::size_t head = 84, facet = 50;

/// Points by coordinates, each once: STL repeats a point for each triangle around it.
class Points {
 public:
  explicit Points(Mesh& mesh) : mesh_(mesh) {}
  std::uint32_t of(const Vector3d& point) {
    const Vector3d p = point.array() + 0.0;  // −0 is 0
    const auto fresh = static_cast<std::uint32_t>(mesh_.points.size());
    const auto [known, added] = known_.try_emplace({p[0], p[1], p[2]}, fresh);
    if (added) mesh_.points.push_back(p);
    return known->second;
  }

 private:
  struct Hash {
    std::size_t operator()(const std::array<double, 3>& p) const {
      std::uint64_t h = 0;
      for (const double x : p) {
        h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15U;
        h ^= h >> 29;
      }
      return h;
    }
  };
  Mesh& mesh_;
  std::unordered_map<std::array<double, 3>, std::uint32_t, Hash> known_;
};

Mesh binary(std::string_view bytes, const std::string& file) {
  Mesh mesh;
  Points points(mesh);
  const std::size_t count = (bytes.size() - head) / facet;
  mesh.triangles.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      mesh.triangles[i][k] =
          points.of(point_at(bytes, head + facet * i + 12 * (k + 1), file, 3 * i + k + 1));
  return mesh;
}

Mesh from_text(std::string_view text, const std::string& file) {
  Mesh mesh;
  Points points(mesh);
  std::array<std::uint32_t, 3> corners{};
  std::size_t count = 0;
  Lines lines(text);
  for (std::string_view line; lines.next(line);) {
    const std::string_view word = next_word(line);
    const int at = lines.number();
    if (word == "vertex") {
      Vector3d p;
      for (Eigen::Index k = 0; k < 3; ++k) p[k] = next_number(line, file, at);
      if (count < 3) corners[count] = points.of(p);
      ++count;
    } else if (word == "endfacet") {
      if (count != 3)
        fail(file, {at, 0}, "a facet has " + std::to_string(count) + " corners, expected 3");
      mesh.triangles.push_back(corners);
      count = 0;
    } else if (!word.empty() && word != "facet" && word != "outer" && word != "endloop" &&
               word != "solid" && word != "endsolid") {
      fail(file, {at, 0}, "has " + in_quotes(word) + ", expected facets of an STL");
    }
  }
  if (count != 0) fail(file, {}, "ends within a facet, expected endfacet");
  return mesh;
}

}  // namespace

Mesh parse_stl(std::string_view bytes, const std::string& file) {
  if (bytes.size() >= head) {
    const std::uint64_t count = number_at<std::uint32_t>(bytes, head - 4);
    if (head + facet * count == bytes.size()) return binary(bytes, file);
    if (!bytes.starts_with("solid"))
      fail(file, {},
           "has " + std::to_string(bytes.size()) + " bytes, expected " +
               std::to_string(head + facet * count) + " for the " + std::to_string(count) +
               " triangles in its head");
  }
  std::string_view start = bytes.substr(0, 200);
  start.remove_prefix(std::min(start.size(), start.find_first_not_of(" \t\r\n")));
  if (!start.starts_with("solid"))
    fail(file, {}, "is no STL, expected 84 bytes and 50 for each triangle, or a text of facets");
  return from_text(bytes, file);
}

}  // namespace momenta::reading
