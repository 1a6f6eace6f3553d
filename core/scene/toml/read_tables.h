#pragma once
// One function per table of the scene format. Each checks keys, types and the values which can be
// judged alone; what concerns several tables is left to validate().

#include <momenta/core/scene/scene.h>
#include <momenta/core/scene/toml/fields.h>

#include <cstddef>
#include <span>
#include <string_view>

namespace momenta::reading {

BodySpec read_body(const Fields& table);
JointSpec read_joint(const Fields& table);
/// `drives`: those of the scene, which may stand for numbers of the loop.
LoopSpec read_loop(const Fields& table, std::span<const DriveSpec> drives);
DriveSpec read_drive(const Fields& table);
ForceSpec read_force(const Fields& table);
MarkerSpec read_marker(const Fields& table);
VisualSpec read_visual(const Fields& table);
RunDefaults read_run(const Fields& table);
LagrangianSpec read_lagrangian(const Fields& table);

/// The value of `kind`, one of `kinds`; else fails with the kinds there are. `others` are those of
/// another table, whose name the sentence says when they are asked for here. @return its index in
/// `kinds`
std::size_t read_kind(const Fields& table, std::span<const std::string_view> kinds,
                      std::span<const std::string_view> others = {},
                      std::string_view table_of_others = {});

/// joints, coordinates and ratios of a coupler or a coordinate spring.
void read_sum(const Fields& table, std::vector<std::string>& joints, std::vector<int>& coordinates,
              std::vector<double>& ratios);

/// origin = { parent = [..], child = [..] }, both zero by default.
struct Origins {
  Eigen::Vector3d parent = Eigen::Vector3d::Zero();
  Eigen::Vector3d child = Eigen::Vector3d::Zero();
};
Origins read_origins(const Fields& table);

/// rotation = { rpy = [roll, pitch, yaw] } | { quaternion = [w, x, y, z] } | { axis = .., angle =
/// .. }; rpy means Rz(yaw) Ry(pitch) Rx(roll).
Eigen::Quaterniond read_rotation(const Fields& table);

}  // namespace momenta::reading
