#pragma once
// Linkages of the tests, written by hand: N four-bars in a row, Bricard's, Stewart's.

#include <momenta/dae/study/extremes.h>

#include <string>
#include <vector>

namespace momenta::equations {

/// Angles by which a planar scene is turned to be judged by the worst: none, nearly none, near the
/// diagonals, and in between [rad].
std::vector<double> orientations();

/// A uniform rod of 1 m and 1 kg along x from its origin; `width` [m] of its square section.
BodySpec rod(const std::string& name, double width = 0);

JointSpec hinge(const std::string& name, const std::string& parent, const std::string& child,
                const Eigen::Vector3d& origin_parent, double angle);

/// N + 1 rods hinged at (i, 0), their tips joined by N level rods; `angle` of the hinged rods from
/// the x axis. Flat, and singular, at 0 and π.
Scene row_of_four_bars(int n, double angle, double rate = 0);

/// The four-bar of the examples with a weight welded to its rocker, at a point of it [m] and turned
/// by an angle [rad], and a wheel on the ground geared to its crank.
Scene geared(Scene four_bar, const Eigen::Vector3d& weight_at, double weight_turned);

/// Bricard's linkage of five rods and six hinges at right angles: five loop equations of rank four.
Scene bricard();

/// A Stewart platform, or one of other than six legs: each a universal and a prismatic joint, under
/// a free platform on spherical joints.
Scene platform(int legs);

/// A rod on a spherical joint carries a flying one by its end: q̇ is not u.
Scene flying_rod();

}  // namespace momenta::equations
