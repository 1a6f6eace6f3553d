// OBJ: "v x y z" are points and "f a b c ..." polygons by numbers of points, from 1, or from −1
// backwards; behind a slash are textures and normals. Curves and free surfaces are refused: without
// them the surface would be another one.

#include <momenta/core/scene/mesh/mesh.h>
#include <momenta/core/scene/mesh/numbers.h>

#include <algorithm>
#include <limits>

namespace momenta::reading {
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

}  // namespace momenta::reading
