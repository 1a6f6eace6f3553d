// STL, binary: 80 bytes of anything, the number of triangles, and 50 bytes each: a normal, three
// corners, two bytes of anything. Text: "solid", then facets of three "vertex x y z". Both may
// begin with "solid": a file is binary where its size fits its count. Normals are not used; the
// order of the corners tells the outside.

#include <momenta/core/scene/mesh/mesh.h>
#include <momenta/core/scene/mesh/numbers.h>

#include <bit>
#include <unordered_map>

namespace momenta::reading {
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
