#include <momenta/dae/output/json.h>
#include <momenta/dae/output/picture_data.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <numbers>

namespace momenta {
namespace {

constexpr double whole_short = 32767;

/// Seven digits: a hundredth of a pixel, and half the bytes of seventeen.
double seven_digits(double x) {
  if (x == 0 || !std::isfinite(x)) return 0;
  const double unit = std::pow(10.0, 6 - std::floor(std::log10(std::abs(x))));
  return std::isfinite(unit) ? std::round(x * unit) / unit : x;
}
Json numbers_of(const Eigen::Vector3d& v) {
  return {seven_digits(v.x()), seven_digits(v.y()), seven_digits(v.z())};
}
const char* text_of(Picture::Turn turn) {
  return turn == Picture::Turn::none ? "none" : turn == Picture::Turn::about_axis ? "axis" : "free";
}
Json pairs_of(const std::vector<Picture::Pair>& pairs) {
  Json all = Json::array();
  for (const Picture::Pair& p : pairs)
    all.push_back({{"name", p.name},
                   {"kind", p.kind},
                   {"parent", p.parent},
                   {"child", p.child},
                   {"at_parent", numbers_of(p.at_parent)},
                   {"at_child", numbers_of(p.at_child)}});
  return all;
}

/// Five digits are enough for the eye: about 100 bytes a solid.
double five_digits(double x) {
  return std::round(x * 1e5) / 1e5;
}
Json solids_of(const Picture& picture) {
  Json all = Json::array();
  for (const auto& [body, v, mesh] : picture.solids) {
    if (v.kind == "mesh" && mesh < 0) continue;
    Json solid{{"body", body}, {"kind", v.kind}};
    if (v.kind == "mesh")
      solid["mesh"] = mesh;
    else
      solid["size"] = numbers_of(v.size);
    if (!v.position.isZero()) solid["at"] = numbers_of(v.position);
    const Eigen::Quaterniond& r = v.rotation;
    if (!r.vec().isZero())
      solid["turn"] = {five_digits(r.w()), five_digits(r.x()), five_digits(r.y()),
                       five_digits(r.z())};
    if (v.colour) {
      char hex[8];
      const auto part = [&colour = *v.colour](int i) {
        return static_cast<unsigned>(std::lround(255 * colour[i]));
      };
      std::snprintf(hex, sizeof hex, "#%02x%02x%02x", part(0) & 255U, part(1) & 255U,
                    part(2) & 255U);
      solid["colour"] = hex;
    }
    all.push_back(std::move(solid));
  }
  return all;
}
Json strokes_of(const Picture& picture) {
  Json all = Json::array();
  for (const Picture::Stroke& s : picture.strokes) {
    Json points = Json::array();
    for (const auto& point : s.points) points.push_back(numbers_of(point));
    all.push_back({{"body", s.body}, {"points", points}, {"closed", s.closed}});
  }
  return all;
}
std::string base64(const std::vector<std::int16_t>& numbers) {
  static constexpr char digits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  std::uint32_t bits = 0;
  int held = 0;
  const auto push = [&](std::uint32_t byte) {
    bits = (bits << 8) | byte;
    for (held += 8; held >= 6; held -= 6) text += digits[(bits >> (held - 6)) & 63];
  };
  for (const std::int16_t number : numbers) {
    const auto word = static_cast<std::uint16_t>(number);
    push(word & 255U);
    push(word >> 8U);
  }
  if (held > 0) text += digits[(bits << (6 - held)) & 63];
  while (text.size() % 4 != 0) text += '=';
  return text;
}

std::int16_t part_of(double x, double whole) {
  const double part = whole > 0 ? std::round(whole_short * x / whole) : 0;
  return static_cast<std::int16_t>(std::clamp(part, -whole_short, whole_short));
}
/// Points as shorts, in parts of `scale` from the middle; corners as unsigned shorts.
Json meshes_of(const Picture& picture) {
  Json all = Json::array();
  for (const Picture::Triangles& mesh : picture.meshes) {
    Eigen::Vector3d low = Eigen::Vector3d::Constant(INFINITY), high = -low;
    for (const Eigen::Vector3d& p : mesh.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const Eigen::Vector3d middle = mesh.points.empty() ? low.setZero() : 0.5 * (low + high);
    double scale = 0;
    for (const Eigen::Vector3d& p : mesh.points)
      scale = std::max(scale, (p - middle).lpNorm<Eigen::Infinity>());
    std::vector<std::int16_t> points, corners;
    for (const Eigen::Vector3d& p : mesh.points)
      for (Eigen::Index i = 0; i < 3; ++i) points.push_back(part_of(p[i] - middle[i], scale));
    for (const auto& corner : mesh.corners)
      for (const std::uint32_t c : corner)
        corners.push_back(static_cast<std::int16_t>(static_cast<std::uint16_t>(c)));
    all.push_back({{"middle", numbers_of(middle)},
                   {"scale", seven_digits(scale)},
                   {"points", base64(points)},
                   {"corners", base64(corners)}});
  }
  return all;
}
Json couplers_of(const Picture& picture) {
  Json all = Json::array();
  for (const Picture::Coupler& c : picture.couplers)
    all.push_back({{"name", c.name}, {"bodies", c.bodies}, {"ratios", c.ratios}});
  return all;
}
Json loads_of(const Picture& picture) {
  Json all = Json::array();
  for (const Picture::Load& l : picture.loads)
    all.push_back({{"body", l.body},
                   {"at", numbers_of(l.at)},
                   {"force", numbers_of(l.force)},
                   {"torque", numbers_of(l.torque)},
                   {"in_body", l.in_body_axes}});
  return all;
}

/// Angle in units of 2π/65536, without whole turns.
std::int16_t angle_of(double angle) {
  const double units = std::round(angle * 32768 / std::numbers::pi);
  return static_cast<std::int16_t>(units - 65536 * std::floor((units + 32768) / 65536));
}

std::size_t bytes_a_frame(const Picture& picture) {
  std::size_t numbers = picture.loops.size() * (picture.planar ? 2 : 3);
  for (const Picture::Body& body : picture.bodies)
    numbers += (body.turn == Picture::Turn::none         ? 0u
                : body.turn == Picture::Turn::about_axis ? 1u
                                                         : 4u) +
               (body.translations ? 3u : 0u);
  return 2 * numbers * 4 / 3;
}

}  // namespace

Json picture_json(const Picture& picture) {
  Json bodies = Json::array(), markers = Json::array();
  for (const Picture::Body& b : picture.bodies) {
    Json ends = Json::array();
    for (const auto& end : b.ends) ends.push_back(numbers_of(end));
    bodies.push_back({{"name", b.name},
                      {"joint", b.joint},
                      {"kind", b.joint_kind},
                      {"parent", b.parent},
                      {"at_parent", numbers_of(b.at_parent)},
                      {"at_child", numbers_of(b.at_child)},
                      {"turn", text_of(b.turn)},
                      {"slides", b.translations},
                      {"rest", {b.rest.w(), b.rest.x(), b.rest.y(), b.rest.z()}},
                      {"axis", {b.axis.x(), b.axis.y(), b.axis.z()}},
                      {"shape", b.shape.kind},
                      {"size", numbers_of(b.shape.size)},
                      {"along", numbers_of(b.shape.axis)},
                      {"com", numbers_of(b.com)},
                      {"ends", ends}});
  }
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body& b = picture.bodies[k];
    if (b.limits) bodies[k]["limits"] = {(*b.limits)[0], (*b.limits)[1]};
    if (b.sprung) bodies[k]["spring"] = true;
    if (b.damped) bodies[k]["damper"] = true;
    if (b.driven) bodies[k]["drive"] = true;
    if (b.pushed) bodies[k]["torque"] = true;
  }
  for (const Picture::Marker& m : picture.markers)
    markers.push_back({{"name", m.name}, {"body", m.body}, {"at", numbers_of(m.at)}});
  Json view = Json::array();
  for (int i = 0; i < 3; ++i)
    view.push_back({picture.view(0, i), picture.view(1, i), picture.view(2, i)});
  Json json{{"planar", picture.planar},
            {"length", picture.length},
            {"view", view},
            {"bodies", bodies},
            {"loops", pairs_of(picture.loops)},
            {"springs", pairs_of(picture.springs)},
            {"solids", solids_of(picture)},
            {"couplers", couplers_of(picture)},
            {"loads", loads_of(picture)},
            {"markers", markers}};
  if (!picture.meshes.empty()) json["meshes"] = meshes_of(picture);
  if (!picture.strokes.empty()) json["strokes"] = strokes_of(picture);
  if (picture.without_bodies) json["without_bodies"] = true;
  return json;
}

Json motion_json(const Picture& picture, const Motion& motion) {
  double translation_scale = 0, gap_scale = 0;
  for (const Motion::Frame& frame : motion.frames) {
    for (std::size_t k = 0; k < picture.bodies.size(); ++k)
      if (picture.bodies[k].translations)
        translation_scale =
            std::max(translation_scale, frame.translation[k].lpNorm<Eigen::Infinity>());
    for (const auto& gap : frame.gap) gap_scale = std::max(gap_scale, gap.norm());
  }
  std::vector<std::int16_t> data;
  const auto track = [&](const auto& number) {
    for (const Motion::Frame& frame : motion.frames) data.push_back(number(frame));
  };
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const Picture::Body& body = picture.bodies[k];
    if (body.turn == Picture::Turn::about_axis) {
      track([&](const Motion::Frame& frame) {
        const Eigen::Quaterniond turn = body.rest.conjugate() * frame.turn[k];
        return angle_of(2 * std::atan2(turn.vec().dot(body.axis), turn.w()));
      });
    } else if (body.turn == Picture::Turn::freely) {
      for (const int i : {3, 0, 1, 2})  // Eigen keeps x y z w
        track([&](const Motion::Frame& f) { return part_of(f.turn[k].coeffs()[i], 1); });
    }
    for (int i = 0; body.translations && i < 3; ++i)
      track(
          [&](const Motion::Frame& f) { return part_of(f.translation[k][i], translation_scale); });
  }
  for (std::size_t i = 0; i < picture.loops.size(); ++i)
    for (int j = 0; j < (picture.planar ? 2 : 3); ++j)
      track([&](const Motion::Frame& f) {
        return part_of(picture.planar ? f.gap[i].dot(picture.view.col(j)) : f.gap[i][j], gap_scale);
      });
  return {{"run", motion.run},
          {"start", motion.start},
          {"every", motion.every},
          {"count", motion.frames.size()},
          {"slide_scale", translation_scale},
          {"gap_scale", gap_scale},
          {"data", base64(data)}};
}

int film_intervals(const Picture& picture, std::size_t runs) {
  constexpr std::size_t budget = 1'000'000;
  constexpr int least = 32, most = 8192;
  const std::size_t frame =
      std::max<std::size_t>(1, bytes_a_frame(picture) * std::max<std::size_t>(1, runs));
  if (least * frame > budget) return 0;
  int intervals = least;
  while (intervals < most && static_cast<std::size_t>(2 * intervals) * frame <= budget)
    intervals *= 2;
  return intervals;
}

}  // namespace momenta
