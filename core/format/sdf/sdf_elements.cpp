// Elements of SDF 1.4 to 1.12. Sensors, plugins, lights and others reported as a whole have no row.

#include <momenta/core/format/xml/known_elements.h>

#include <array>

namespace momenta::reading {
namespace {

#define DRAKE_TIES "drake:joint drake:linear_bushing_rpy drake:ball_constraint"

constexpr std::array elements{
    KnownElement{"sdf", "version world model", "", "light actor"},
    KnownElement{"world", "name model frame joint gravity physics include population actor",
                 "namespace magnetic_field atmosphere gui scene spherical_coordinates audio road",
                 "light plugin wind state"},
    KnownElement{"physics", "gravity",
                 "name default type max_step_size real_time_factor real_time_update_rate "
                 "max_contacts dart simbody bullet ode",
                 ""},
    KnownElement{"model",
                 "name canonical_link placement_frame link joint frame model include pose "
                 "static " DRAKE_TIES,
                 "namespace self_collide allow_auto_disable enable_wind", "plugin gripper"},
    KnownElement{"include", "merge uri name static pose placement_frame", "", "plugin"},
    KnownElement{"link", "name pose inertial gravity kinematic visual collision sensor plugin",
                 "self_collide enable_wind must_be_base_link",
                 "velocity_decay projector audio_sink audio_source battery light "
                 "particle_emitter"},
    KnownElement{"inertial", "auto pose mass inertia fluid_added_mass",
                 "density "
                 "auto_inertia_params",
                 ""},
    KnownElement{"inertia", "ixx iyy izz ixy ixz iyz", "", ""},
    KnownElement{"pose", "relative_to frame degrees rotation_format", "", ""},
    KnownElement{"frame", "name attached_to pose", "", ""},
    KnownElement{"visual", "name pose geometry material",
                 "cast_shadows laser_retro transparency visibility_flags meta plugin", ""},
    KnownElement{"geometry", "box sphere cylinder capsule ellipsoid mesh",
                 "plane heightmap image polyline empty cone", ""},
    KnownElement{"mesh", "uri scale", "submesh convex_decomposition optimization", ""},
    KnownElement{"joint",
                 "name type parent child pose axis axis2 gearbox_ratio gearbox_reference_body "
                 "thread_pitch screw_thread_pitch drake:rotor_inertia drake:gear_ratio",
                 "", "physics sensor"},
    KnownElement{"axis", "xyz use_parent_model_frame dynamics limit mimic", "initial_position", ""},
    KnownElement{"axis2", "xyz use_parent_model_frame dynamics limit mimic", "initial_position",
                 ""},
    KnownElement{"xyz", "expressed_in", "", ""},
    KnownElement{"dynamics", "damping friction spring_reference spring_stiffness", "", ""},
    KnownElement{"limit", "lower upper", "effort velocity drake:acceleration",
                 "stiffness dissipation"},
    KnownElement{"mimic", "joint axis multiplier offset reference", "", ""},
};

}  // namespace

std::span<const KnownElement> sdf_elements() {
  return elements;
}

}  // namespace momenta::reading
