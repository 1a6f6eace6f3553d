// The picture of a mechanism and its motion: places rebuilt from turns and slides are those of the
// kernel, gaps are the point rows of Φ, films are made without disturbing the run, and what a page
// is given reads back to all of it within its quantisation.
#include <gtest/gtest.h>
#include <momenta/core/format/files/read_scene.h>
#include <momenta/core/open_chain/open_chain.h>
#include <momenta/dae/output/picture_data.h>
#include <momenta/dae/run/motion.h>
#include <momenta/dae/run/run_form.h>
#include <momenta/dae/run/upright.h>
#include <momenta/dae/topology/assembly/assembly.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "equations/examples.h"
#include "equations/runs.h"

namespace momenta::dae_picture {
namespace {

namespace fs = std::filesystem;
using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using equations::example;

/// One scene with every kind of joint, one on another.
Scene every_joint() {
  return parse_scene(R"(
name = "every joint"
[[body]]
name = "a"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[body]]
name = "b"
mass = 1.0
shape = { kind = "cylinder", length = 0.5, radius = 0.1, axis = "z" }
[[body]]
name = "c"
mass = 1.0
shape = { kind = "sphere", radius = 0.1 }
[[body]]
name = "d"
mass = 1.0
shape = { kind = "rod", length = 0.5, axis = "y" }
com = [0, 0.25, 0]
[[body]]
name = "e"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[body]]
name = "f"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[body]]
name = "g"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[body]]
name = "h"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[body]]
name = "i"
mass = 1.0
shape = { kind = "box", size = [0.2, 0.3, 0.4] }
[[joint]]
name = "J1"
kind = "free"
child = "a"
origin = { parent = [1, 0, 0], child = [0, 0.1, 0] }
rotation = { rpy = [0.1, 0.2, 0.3] }
[[joint]]
name = "J2"
kind = "revolute"
parent = "a"
child = "b"
axis = [1, 2, 3]
origin = { parent = [0.1, 0.2, 0], child = [0, 0, 0.25] }
rotation = { rpy = [0.4, -0.2, 0.3] }
[[joint]]
name = "J3"
kind = "prismatic"
parent = "b"
child = "c"
axis = [1, 0, 1]
origin = { parent = [0, 0, 0.25], child = [0.1, 0, 0] }
rotation = { rpy = [0, 0.7, 0] }
[[joint]]
name = "J4"
kind = "helical"
parent = "c"
child = "d"
axis = "x"
pitch = 0.1
origin = { parent = [0.1, 0, 0], child = [0, 0.5, 0] }
[[joint]]
name = "J5"
kind = "cylindrical"
parent = "d"
child = "e"
axis = "y"
[[joint]]
name = "J6"
kind = "universal"
parent = "e"
child = "f"
axis = "z"
axis2 = "x"
origin = { parent = [0.1, 0.1, 0.2], child = [0, 0, -0.2] }
[[joint]]
name = "J7"
kind = "spherical"
parent = "f"
child = "g"
origin = { parent = [0.1, 0.1, 0.2], child = [0, 0, -0.2] }
[[joint]]
name = "J8"
kind = "planar"
parent = "d"
child = "h"
axis = [0, 1, 1]
[[joint]]
name = "J9"
kind = "weld"
parent = "h"
child = "i"
origin = { parent = [0.1, 0.1, 0.2], child = [0, 0, -0.2] }
rotation = { rpy = [0.4, -0.2, 0.3] }
)",
                     "every_joint.toml");
}

/// Coordinates at random, quaternions of length 1.
std::vector<double> random_coordinates(const Mechanism& mechanism, std::mt19937_64& bits) {
  std::uniform_real_distribution<double> number(-1.5, 1.5);
  std::vector<double> q(static_cast<std::size_t>(mechanism.nq()));
  for (double& x : q) x = number(bits);
  for (const Tree::Body& body : mechanism.tree().bodies)
    if (body.nq >= 4) {
      const auto at = q.begin() + body.q + body.nq - 4;
      double size = 0;
      for (int i = 0; i < 4; ++i) size += at[i] * at[i];
      for (int i = 0; i < 4; ++i) at[i] /= std::sqrt(size);
    }
  return q;
}

Film film_at(std::vector<std::vector<double>> frames) {
  return {0, 0.1, std::move(frames)};
}

TEST(Picture, PlacesRebuiltFromTurnsAndSlidesAreThoseOfTheKernel) {
  for (const Scene& scene :
       {every_joint(), example("driven/scene.toml"), example("bricard/scene.toml"),
        example("andrews/scene.toml"), example("driven/swing.toml")}) {
    const Mechanism mechanism(scene);
    std::mt19937_64 bits(7);
    std::vector<std::vector<double>> frames;
    for (int i = 0; i < 5; ++i) frames.push_back(random_coordinates(mechanism, bits));
    const Picture picture = picture_of(mechanism);
    const Motion motion = motion_of(mechanism, film_at(frames));
    ASSERT_EQ(picture.bodies.size(), scene.bodies.size());
    Scene open = scene;
    open.loops.clear();
    std::erase_if(open.drives, [](const DriveSpec& drive) { return !drive.loop.empty(); });
    OpenChain chain(open);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const double t = 0.1 * static_cast<double>(f);
      const auto truth = chain.poses(t, Eigen::Map<const Eigen::VectorXd>(
                                            frames[f].data(), static_cast<long>(frames[f].size())));
      const auto rebuilt = places(picture, motion.frames[f]);
      for (std::size_t k = 0; k < rebuilt.size(); ++k) {
        const auto& body = picture.bodies[k];
        const auto& pose = truth[static_cast<std::size_t>(mechanism.tree().body(body.name))];
        EXPECT_LT((rebuilt[k].matrix() - pose.matrix()).norm(), 1e-12) << scene.name << body.name;
        EXPECT_NEAR(motion.frames[f].turn[k].norm(), 1, 1e-14);
        if (body.turn == Picture::Turn::about_axis) {
          const Quaterniond about = body.rest.conjugate() * motion.frames[f].turn[k];
          EXPECT_LT(about.vec().cross(body.axis).norm(), 1e-12) << body.name;
        }
        if (!body.translations) {
          EXPECT_LT((motion.frames[f].translation[k] - body.at_parent).norm(), 1e-12) << body.name;
        }
      }
    }
  }
}

TEST(Picture, GapsAreThePointRowsOfTheLoops) {
  for (const char* name : {"four_bar/scene.toml", "bricard/scene.toml", "andrews/scene.toml",
                           "spatial_slider_crank/scene.toml", "slider_crank/scene.toml",
                           "driven/scene.toml", "driven/swing.toml", "extremes/governor.toml"}) {
    const Scene scene = example(name);
    const Mechanism mechanism(scene);
    std::mt19937_64 bits(11);
    const std::vector<double> q = random_coordinates(mechanism, bits);
    const Motion motion = motion_of(mechanism, film_at({q, q}));
    const auto e = mechanism.evaluation<double>();
    Eigen::VectorXd phi(mechanism.m());
    const double t = 0.1;  // of the second frame
    e->place(t, q.data());
    e->positions(phi.data());
    std::size_t drawn = 0;
    for (const LoopSpec& loop : scene.loops) {
      if (loop.kind == LoopKind::coupler) continue;
      double squares = 0;
      for (std::size_t row = 0; row < mechanism.rows().size(); ++row)
        if (mechanism.rows()[row].loop == loop.name &&
            mechanism.rows()[row].what.rfind("point", 0) == 0)
          squares += phi[static_cast<long>(row)] * phi[static_cast<long>(row)];
      if (loop.kind != LoopKind::distance) {
        EXPECT_NEAR(motion.frames[1].gap[drawn].norm(), std::sqrt(squares), 1e-12)
            << name << " " << loop.name;
      }
      ++drawn;
    }
    EXPECT_EQ(drawn, motion.frames[1].gap.size());
  }
}

TEST(Picture, GapOfADistanceIsWhatItIsLongerThan) {
  Scene scene = example("four_bar/scene.toml");
  LoopSpec& loop = scene.loops.front();
  loop.kind = LoopKind::distance;
  loop.length = 0.25;
  const Mechanism mechanism(scene);
  std::mt19937_64 bits(3);
  const auto q = random_coordinates(mechanism, bits);
  const Motion motion = motion_of(mechanism, film_at({q}));
  const auto at = places(picture_of(mechanism), motion.frames[0]);
  const Picture picture = picture_of(mechanism);
  const auto point = [&](int k, const Vector3d& p) {
    return k < 0 ? p : Vector3d(at[static_cast<std::size_t>(k)] * p);
  };
  const auto& pair = picture.loops.front();
  const double distance =
      (point(pair.child, pair.at_child) - point(pair.parent, pair.at_parent)).norm();
  EXPECT_NEAR(motion.frames[0].gap[0].norm(), std::abs(distance - 0.25), 1e-12);
}

std::vector<std::int16_t> numbers_in(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int held = 0;
  for (const char c : base64) {
    if (c == '=') break;
    bits = (bits << 6) | static_cast<unsigned>(digits.find(c));
    held += 6;
    if (held >= 8) bytes += static_cast<char>((bits >> (held -= 8)) & 255U);
  }
  std::vector<std::int16_t> numbers;
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
    numbers.push_back(static_cast<std::int16_t>(static_cast<unsigned char>(bytes[i]) |
                                                (static_cast<unsigned char>(bytes[i + 1]) << 8)));
  return numbers;
}

TEST(PictureData, TracksReadBackWithinTheirUnits) {
  const Mechanism mechanism(every_joint());
  std::mt19937_64 bits(5);
  std::vector<std::vector<double>> frames;
  for (int i = 0; i < 7; ++i) frames.push_back(random_coordinates(mechanism, bits));
  const Picture picture = picture_of(mechanism);
  const Motion motion = motion_of(mechanism, film_at(frames));
  const auto json = motion_json(picture, motion);
  const auto numbers = numbers_in(json["data"]);
  std::size_t at = 0;
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    const auto& body = picture.bodies[k];
    const auto track = [&](std::size_t number, std::size_t f) {
      return static_cast<double>(numbers[at + number * 7 + f]);
    };
    std::size_t tracks = 0;
    for (std::size_t f = 0; f < 7; ++f) {
      Quaterniond turn = body.rest;
      tracks = 0;
      if (body.turn == Picture::Turn::about_axis) {
        turn = body.rest * Eigen::AngleAxisd(track(0, f) * std::numbers::pi / 32768, body.axis);
        tracks = 1;
      } else if (body.turn == Picture::Turn::freely) {
        turn = Quaterniond(track(0, f), track(1, f), track(2, f), track(3, f)).normalized();
        tracks = 4;
      }
      EXPECT_LT(turn.angularDistance(motion.frames[f].turn[k]), 1e-4) << body.name;
      for (int i = 0; body.translations && i < 3; ++i)
        EXPECT_NEAR(track(tracks + static_cast<std::size_t>(i), f) *
                        json["slide_scale"].get<double>() / 32767,
                    motion.frames[f].translation[k][i], json["slide_scale"].get<double>() / 60000)
            << body.name;
    }
    at += 7 * (tracks + (body.translations ? 3 : 0));
  }
  EXPECT_EQ(at, numbers.size());
}

TEST(Film, ShowsTheRunAtEqualTimesWithoutDisturbingIt) {
  const Mechanism mechanism(example("four_bar/scene.toml"));
  const Assembly a = assemble(mechanism);
  for (const std::string form : {"momentum", "acceleration-index3", "partitioned"}) {
    RunRequest request = equations::kept(equations::adaptive(form, "", "none", 1e-8, 2, 64));
    const RunResult plain = run_form(mechanism, a.start, request);
    request.film_intervals = 64;
    const RunResult filmed = run_form(mechanism, a.start, request);
    EXPECT_TRUE(plain.film.frames.empty());
    ASSERT_EQ(filmed.film.frames.size(), 65u);
    EXPECT_EQ(plain.series.position_drift, filmed.series.position_drift) << form;
    for (std::size_t k = 0; k < 65; ++k)
      for (std::size_t i = 0; i < filmed.film.frames[k].size(); ++i)
        EXPECT_NEAR(filmed.film.frames[k][i], filmed.trajectory.rows[k][1 + i], 1e-6)
            << form << " frame " << k;
  }
}

TEST(Film, ThinningKeepsTheEndsAndNeverTurnsFarBetweenFrames) {
  const Mechanism mechanism(example("four_bar/scene.toml"));
  const Assembly a = assemble(mechanism);
  RunRequest request;
  request.settings.integrator = "";
  request.settings.end_time = 3;
  request.film_intervals = 8192;
  const RunResult run = run_form(mechanism, a.start, request);
  const Picture picture = picture_of(mechanism);
  const Motion whole = motion_of(mechanism, run.film);
  Motion thinned = whole;
  thin(thinned, picture);
  EXPECT_LT(thinned.frames.size(), 1200u);
  EXPECT_GT(thinned.frames.size(), 100u);
  EXPECT_LT(largest_turn(thinned), 0.2);
  EXPECT_NEAR(thinned.every * static_cast<double>(thinned.frames.size() - 1), 3, 1e-12);
  for (std::size_t k = 0; k < picture.bodies.size(); ++k) {
    EXPECT_EQ(thinned.frames.back().turn[k].coeffs(), whole.frames.back().turn[k].coeffs());
    EXPECT_EQ(
        thinned.frames[1].turn[k].coeffs(),
        whole.frames[(whole.frames.size() - 1) / (thinned.frames.size() - 1)].turn[k].coeffs());
  }
}

TEST(Film, LargeMechanismsStayWithinTheirShareOfAPage) {
  Picture picture;
  picture.planar = true;
  for (const std::size_t bodies : {3u, 81u, 400u, 2000u}) {
    picture.bodies.assign(bodies, {});
    for (auto& body : picture.bodies) body.turn = Picture::Turn::about_axis;
    for (const std::size_t runs : {1u, 20u}) {
      const auto intervals = static_cast<std::size_t>(film_intervals(picture, runs));
      Motion motion;
      motion.frames.assign(intervals + 1,
                           {std::vector<Quaterniond>(bodies, Quaterniond::Identity()),
                            std::vector<Vector3d>(bodies, Vector3d::Zero()),
                            {}});
      EXPECT_TRUE(intervals >= 32 || (intervals == 0 && bodies * runs >= 40'000)) << bodies;
      if (intervals > 0) {
        EXPECT_LT(runs * motion_json(picture, motion).dump().size(), 1'100'000u) << bodies;
      }
    }
  }
}

// A pendulum in the plane of x and z hangs down, x to the right; whatever the plane and gravity
// are, the viewer stands before the plane and sees gravity act downwards.
TEST(Picture, PlanesAreSeenWithGravityDown) {
  const auto view = [](const std::string& axis, const std::string& gravity) {
    return picture_of(
               Mechanism(parse_scene(
                   "gravity = " + gravity +
                   "\n[[body]]\nname = 'a'\nmass = 1\nshape = { kind = 'rod', length = 1, axis "
                   "= '" +
                   (axis == "z" ? "x" : "z") +
                   "' }\n[[joint]]\nname = 'j'\nkind = 'revolute'\nchild = 'a'\naxis = '" + axis +
                   "'\n")))
        .view;
  };
  Eigen::Matrix3d of_xz, of_yz;
  of_xz << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  of_yz << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_EQ(view("y", "[0, 0, -9.81]"), of_xz);
  EXPECT_EQ(view("x", "[0, 0, -9.81]"), of_yz);
  EXPECT_EQ(view("y", "[0, -9.81, 0]"), of_xz);  // across the plane
  EXPECT_EQ(view("z", "[0, -9.81, 0]"), Eigen::Matrix3d::Identity());
  EXPECT_EQ(view("z", "[0, 0, 0]"), Eigen::Matrix3d::Identity());
  std::mt19937 random(3);
  std::normal_distribution<double> any;
  const auto direction = [&] {
    return Vector3d(any(random), any(random), any(random)).normalized();
  };
  for (int i = 0; i < 60; ++i) {
    Eigen::Matrix3d basis = Eigen::AngleAxisd(3 * any(random), direction()).toRotationMatrix();
    if (i < 30)
      basis << Vector3d::Unit(i % 3), Vector3d::Unit((i + 1) % 3), Vector3d::Unit((i + 2) % 3);
    const Vector3d gravity = 9.81 * direction();
    const Eigen::Matrix3d seen = upright(basis, gravity);
    EXPECT_LE((seen.transpose() * seen - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_GT(seen.determinant(), 0);
    EXPECT_LE(seen.col(2).cross(basis.col(2)).norm(), 1e-14);
    EXPECT_LT(seen.col(1).dot(gravity), 0);
    EXPECT_LE(std::abs(seen.col(0).dot(gravity)), -seen.col(1).dot(gravity));
    EXPECT_GT(seen.col(0).maxCoeff(), -seen.col(0).minCoeff());
  }
}

}  // namespace
}  // namespace momenta::dae_picture
