#pragma once
// The picture of a mechanism and its motion, for pages and figures.
//
// The pose of a body follows from that of its parent and from their joint. For body k with axes R
// and origin x:
//
//   R_k = R_j T(t),   x_k = x_j + R_j s(t) − R_k c        j: parent, T: turn, s: slide
//
// c is the point of the joint in the child. T and s are sampled, not poses: interpolated poses
// would separate the two bodies at a joint, while with T and s their points coincide at every
// instant, between the samples too. For loops this is not true; their gap is sampled:
//
//   g(t) = the part of x_A − x_B that the loop does not allow,   ground axes

#include <momenta/core/scene/scene.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace momenta {

struct Picture {
  enum class Turn { none, about_axis, freely };
  struct Body {
    std::string name, joint, joint_kind;
    int parent = -1;  ///< place among the bodies, before this one; −1: ground
    Eigen::Vector3d at_parent = Eigen::Vector3d::Zero();  ///< s where the joint does not slide
    Eigen::Vector3d at_child = Eigen::Vector3d::Zero();   ///< c
    /// T = rest · R(axis, angle) of joints that turn about one axis, fixed in both bodies.
    Turn turn = Turn::none;
    bool translations = false;
    Eigen::Quaterniond rest = Eigen::Quaterniond::Identity();
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< in the joint frame
    std::optional<std::array<double, 2>> limits;      ///< limits of the joint [rad or m]
    /// Whether the joint has a spring, a damper, a drive, a torque.
    bool sprung = false, damped = false, driven = false, pushed = false;
    Shape shape;
    double mass = 0;
    Eigen::Vector3d com = Eigen::Vector3d::Zero();
    /// Points of joints, loops and springs, and ends of a rod; no two the same.
    std::vector<Eigen::Vector3d> ends;
  };
  /// Two points, in body axes; −1: ground.
  struct Pair {
    std::string name, kind;
    int parent = -1, child = -1;
    Eigen::Vector3d at_parent = Eigen::Vector3d::Zero(), at_child = Eigen::Vector3d::Zero();
  };
  /// A solid fixed in a body; −1: the ground.
  struct Solid {
    int body = -1;
    VisualSpec visual;
    int mesh = -1;  ///< mesh: place among `meshes`; −1: not drawn
  };
  /// Triangles of a mesh, scaled: in axes of its solid [m].
  struct Triangles {
    std::vector<Eigen::Vector3d> points;
    std::vector<std::array<std::uint32_t, 3>> corners;  ///< counter-clockwise from outside
  };
  /// A curve fixed in a body (−1: the ground): a slot, an outline of a cam, a rack.
  struct Stroke {
    int body = -1;
    std::vector<Eigen::Vector3d> points;  ///< in body axes [m]
    bool closed = false;
  };
  /// Bodies whose joints a coupler ties: Σ ratios[i] q_i.
  struct Coupler {
    std::string name;
    std::vector<int> bodies;
    std::vector<double> ratios;
  };
  /// A constant force and torque on a point of a body.
  struct Load {
    int body = -1;
    Eigen::Vector3d at = Eigen::Vector3d::Zero(), force = Eigen::Vector3d::Zero(),
                    torque = Eigen::Vector3d::Zero();
    bool in_body_axes = false;
  };
  struct Marker {
    std::string name;
    int body = -1;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();
  };

  bool without_bodies = false;  ///< formulas: nothing is drawn
  bool planar = false;
  /// Columns: right, up and towards the viewer, ground axes; of a planar mechanism its plane.
  Eigen::Matrix3d view = Eigen::Matrix3d::Identity();
  double length = 1;  ///< natural length of the scene [m]
  std::vector<Body> bodies;
  std::vector<Pair> loops;    ///< all but couplers
  std::vector<Pair> springs;  ///< between points of bodies: spring, damper or spring-damper
  std::vector<Solid> solids;
  std::vector<Triangles> meshes;
  std::vector<Stroke> strokes;
  std::vector<Coupler> couplers;
  std::vector<Load> loads;
  std::vector<Marker> markers;
};

/// Coordinates at equal times: start, start + every, … [s].
struct Film {
  double start = 0, every = 0;
  std::vector<std::vector<double>> frames;  ///< q of each
};

/// T and s of every body and g of every loop, at the times of a film.
struct Motion {
  int run = -1;  ///< run of a study; −1: the start, before any
  struct Frame {
    std::vector<Eigen::Quaterniond> turn;  ///< unit; of `about_axis` with its vector along the axis
    std::vector<Eigen::Vector3d> translation;  ///< [m]
    std::vector<Eigen::Vector3d> gap;          ///< [m]
  };
  double start = 0, every = 0;
  std::vector<Frame> frames;
};

}  // namespace momenta
