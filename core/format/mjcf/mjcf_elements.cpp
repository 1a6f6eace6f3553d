// Elements of MJCF, after the schema of MuJoCo 3.3. Sections reported as a whole (contact, sensor,
// custom, …) and soft bodies, which are refused, have no row.

#include <momenta/core/format/xml/known_elements.h>

#include <array>

namespace momenta::reading {
namespace {

#define POSE "pos quat axisangle xyaxes zaxis euler"
#define SOLVER "solref solimp"

constexpr std::array elements{
    KnownElement{"mujoco",
                 "model compiler option default asset worldbody tendon actuator equality keyframe "
                 "contact sensor visual statistic size custom extension deformable flex",
                 "", ""},
    KnownElement{"compiler",
                 "autolimits boundmass boundinertia settotalmass balanceinertia strippath "
                 "coordinate angle eulerseq meshdir inertiafromgeom inertiagrouprange assetdir "
                 "exactmeshinertia",
                 "fitaabb texturedir discardvisual usethread fusestatic saveinertial conflict "
                 "convexhull lengthrange",
                 "alignfree"},
    KnownElement{"option", "gravity density viscosity actuatorgroupdisable flag",
                 "timestep apirate impratio tolerance ls_tolerance noslip_tolerance ccd_tolerance "
                 "mpr_tolerance sleep_tolerance wind magnetic o_margin o_solref o_solimp "
                 "o_friction integrator collision cone jacobian solver iterations ls_iterations "
                 "noslip_iterations ccd_iterations mpr_iterations sdf_iterations sdf_initpoints",
                 ""},
    KnownElement{"flag",
                 "constraint equality frictionloss limit passive spring damper gravity clampctrl "
                 "actuation",
                 "contact warmstart filterparent refsafe sensor midphase eulerdamp autoreset "
                 "nativeccd island multiccd override energy fwdinv invdiscrete sensornoise sleep "
                 "diagexact ipc",
                 ""},
    KnownElement{"default",
                 "class default mesh material joint geom site equality tendon general motor "
                 "position velocity damper intvelocity orientation pid cylinder muscle adhesion "
                 "dcmotor",
                 "camera light pair", ""},
    KnownElement{"asset", "mesh material model", "texture hfield skin", ""},
    KnownElement{"asset/mesh",
                 "name class file vertex face refpos refquat scale inertia builtin content_type "
                 "maxhullvert",
                 "normal texcoord smoothnormal params material", ""},
    KnownElement{"default/mesh", "scale inertia maxhullvert", "", ""},
    KnownElement{"material", "name class rgba",
                 "texture texrepeat texuniform emission specular shininess reflectance metallic "
                 "roughness layer",
                 ""},
    KnownElement{"worldbody", "geom site body frame replicate attach camera light childclass",
                 "name pos quat", "plugin"},
    KnownElement{"body",
                 "name childclass mocap gravcomp " POSE
                 " inertial joint freejoint geom site body frame replicate attach camera light "
                 "composite flexcomp",
                 "sleep simple fuse user", "plugin"},
    KnownElement{"frame",
                 "name childclass " POSE
                 " inertial joint freejoint geom site body frame replicate attach camera light "
                 "composite flexcomp",
                 "", "plugin"},
    KnownElement{"replicate", "count sep offset euler childclass replica", "", ""},
    KnownElement{"replica",
                 "joint freejoint geom site body frame replicate attach camera light composite "
                 "flexcomp inertial",
                 "", "plugin"},
    KnownElement{"attach", "model prefix body frame geom site camera light replicate attach", "",
                 ""},
    KnownElement{"inertial", "mass diaginertia fullinertia " POSE, "", ""},
    KnownElement{"joint",
                 "name class type pos axis springdamper limited stiffness range actuatorfrcrange "
                 "ref springref armature damping frictionloss",
                 "group actuatorfrclimited solreflimit solimplimit solreffriction solimpfriction "
                 "margin user",
                 "actuatorgravcomp"},
    KnownElement{"freejoint", "name class", "group", "align"},
    KnownElement{"geom",
                 "name class type group size material rgba mass density shellinertia fromto mesh "
                 "fitscale " POSE,
                 "contype conaffinity condim priority friction solmix " SOLVER
                 " margin gap surfacevel adhesion hfield fluidshape fluidcoef user",
                 "plugin"},
    KnownElement{"site", "name class fromto " POSE, "type group material mesh size rgba user", ""},
    KnownElement{"tendon", "fixed spatial", "", ""},
    KnownElement{
        "default/tendon", "limited range frictionloss springlength stiffness damping armature",
        "group solreflimit solimplimit solreffriction solimpfriction width material margin "
        "rgba user",
        ""},
    KnownElement{"fixed",
                 "name class limited range frictionloss springlength stiffness damping armature "
                 "joint",
                 "group actuatorfrclimited solreflimit solimplimit solreffriction solimpfriction "
                 "margin user",
                 "actuatorfrcrange"},
    KnownElement{"fixed/joint", "joint coef", "", ""},
    KnownElement{"spatial",
                 "name class limited range frictionloss springlength stiffness damping armature "
                 "site geom pulley",
                 "group actuatorfrclimited solreflimit solimplimit solreffriction solimpfriction "
                 "width material margin rgba user",
                 "actuatorfrcrange"},
    KnownElement{"spatial/site", "site", "", ""},
    KnownElement{"spatial/geom", "geom sidesite", "", ""},
    KnownElement{"pulley", "divisor", "", ""},
    KnownElement{"equality", "connect weld joint tendon flex flexvert flexstrain distance", "", ""},
    KnownElement{"default/equality", "active", "", SOLVER},
    KnownElement{"connect", "name class active body1 body2 anchor site1 site2", "", SOLVER},
    KnownElement{"weld", "name class active body1 body2 relpose anchor site1 site2 torquescale", "",
                 SOLVER},
    KnownElement{"equality/joint", "name class active joint1 joint2 polycoef", "", SOLVER},
    KnownElement{"equality/tendon", "name class active tendon1 tendon2 polycoef", "", SOLVER},
    KnownElement{"keyframe", "key", "", ""},
    KnownElement{"key", "name time qpos qvel act ctrl mpos mquat", "", ""},
};

#define ACTUATOR                                                                              \
  "name class gear ctrlrange ctrllimited forcerange forcelimited joint jointinparent tendon " \
  "slidersite cranksite site refsite "
#define ACTUATOR_SILENT "group lengthrange cranklength user"
#define ACTUATOR_TOLD "nsample interp delay damping armature"

constexpr std::array actuators{
    KnownElement{"actuator", "general motor position velocity damper", "", ""},
    KnownElement{"motor", ACTUATOR, ACTUATOR_SILENT, ACTUATOR_TOLD},
    KnownElement{"position", ACTUATOR "kp kv dampratio timeconst inheritrange", ACTUATOR_SILENT,
                 ACTUATOR_TOLD},
    KnownElement{"velocity", ACTUATOR "kv", ACTUATOR_SILENT, ACTUATOR_TOLD},
    KnownElement{"damper", ACTUATOR "kv", ACTUATOR_SILENT, ACTUATOR_TOLD},
    KnownElement{"general", ACTUATOR "body dyntype gaintype biastype gainprm biasprm",
                 ACTUATOR_SILENT " actlimited actrange actdim actearly dynprm input velrange "
                                 "ffrange",
                 ACTUATOR_TOLD},
};

}  // namespace

std::span<const KnownElement> mjcf_elements() {
  return elements;
}
std::span<const KnownElement> mjcf_actuator_elements() {
  return actuators;
}

}  // namespace momenta::reading
