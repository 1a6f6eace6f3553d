// A floating person of 75 kg and 1.75 m with 30 hinges: 6 per leg, 7 per arm, 3 in the torso, 1 in
// the neck. x forward, y left, z up. Masses and lengths are fractions of the whole as in D. Winter,
// Biomechanics and Motor Control of Human Movement, table 4.1 and figure 4.1; moments of inertia
// are those of the shapes. Small balls between hinges at one place take a share of the mass of the
// segment that the hinges carry, so that no body is massless. Springs and dampers hold the pose.

#include "families.h"
#include "scene_text.h"

namespace momenta::program {
namespace {

constexpr double person = 75, height = 1.75;
constexpr double share = 0.05;  // part of a segment's mass in each ball

void hinge(const std::string& name, const std::string& parent, const std::string& child,
           const Triple& at, const char* axis, double stiffness, double position = 0,
           double velocity = 0) {
  JointText joint;
  joint.name = name;
  joint.parent = parent;
  joint.child = child;
  joint.origin_parent = at;
  joint.axis = axis;
  if (position != 0) joint.position = number_text(position);
  if (velocity != 0) joint.velocity = number_text(velocity);
  joint.stiffness = stiffness;
  joint.damping = 0.05 * stiffness;
  print_joint(joint);
}

constexpr Triple here{};

void torso_and_head() {
  const double abdomen = 0.139 * person;
  print_box("pelvis", 0.142 * person, {0.18, 0.191 * height, 0.14}, {0, 0, 0.03});
  JointText base;
  base.name = "base";
  base.kind = "free";
  base.child = "pelvis";
  base.position = "[0, 0, 1, 1, 0, 0, 0]";
  base.velocity = "[0.5, 0, 2, 0.2, 0.5, 0.3]";
  print_joint(base);
  print_ball("waist", share * abdomen, 0.06, here);
  hinge("torso_yaw", "pelvis", "waist", {0, 0, 0.1}, "z", 200);
  print_box("abdomen", (1 - share) * abdomen, {0.18, 0.28, 0.15}, {0, 0, 0.075});
  hinge("torso_roll", "waist", "abdomen", here, "x", 200);
  print_box("thorax", 0.216 * person, {0.2, 0.32, 0.3}, {0, 0, 0.15});
  hinge("torso_pitch", "abdomen", "thorax", {0, 0, 0.15}, "y", 200, 0.1);
  print_ball("head", 0.081 * person, 0.1, {0.02, 0, 0.13});
  hinge("neck", "thorax", "head", {0, 0, 0.3}, "y", 20, 0, 0.5);
}

void leg(const std::string& side, double left, double swing) {
  const double thigh = 0.1 * person, thigh_length = 0.245 * height;
  const double shank_length = 0.246 * height, foot = 0.0145 * person;
  print_ball(side + "_hip_1", share * thigh, 0.05, here);
  hinge(side + "_hip_yaw", "pelvis", side + "_hip_1", {0, left * 0.052 * height, 0}, "z", 60);
  print_ball(side + "_hip_2", share * thigh, 0.05, here);
  hinge(side + "_hip_roll", side + "_hip_1", side + "_hip_2", here, "x", 100);
  print_cylinder(side + "_thigh", (1 - 2 * share) * thigh, thigh_length, 0.075, "-z");
  hinge(side + "_hip_pitch", side + "_hip_2", side + "_thigh", here, "y", 100, -0.2, swing);
  print_cylinder(side + "_shank", 0.0465 * person, shank_length, 0.05, "-z");
  hinge(side + "_knee", side + "_thigh", side + "_shank", {0, 0, -thigh_length}, "y", 60, 0.3);
  print_ball(side + "_ankle", share * foot, 0.03, here);
  hinge(side + "_ankle_pitch", side + "_shank", side + "_ankle", {0, 0, -shank_length}, "y", 20,
        -0.1);
  print_box(side + "_foot", (1 - share) * foot, {0.152 * height, 0.09, 0.039 * height},
            {0.05, 0, -0.5 * 0.039 * height});
  hinge(side + "_ankle_roll", side + "_ankle", side + "_foot", here, "x", 20);
}

void arm(const std::string& side, double left, double swing) {
  const double upper = 0.028 * person, upper_length = 0.186 * height;
  const double fore = 0.016 * person, fore_length = 0.146 * height;
  const double hand = 0.006 * person, hand_length = 0.108 * height;
  print_ball(side + "_shoulder_1", share * upper, 0.04, here);
  hinge(side + "_shoulder_pitch", "thorax", side + "_shoulder_1", {0, left * 0.129 * height, 0.254},
        "y", 30, 0, swing);
  print_ball(side + "_shoulder_2", share * upper, 0.04, here);
  hinge(side + "_shoulder_roll", side + "_shoulder_1", side + "_shoulder_2", here, "x", 30,
        left * 0.15);
  print_cylinder(side + "_upper_arm", (1 - 2 * share) * upper, upper_length, 0.045, "-z");
  hinge(side + "_shoulder_yaw", side + "_shoulder_2", side + "_upper_arm", here, "z", 15);
  print_ball(side + "_elbow", share * fore, 0.03, here);
  hinge(side + "_elbow_pitch", side + "_upper_arm", side + "_elbow", {0, 0, -upper_length}, "y", 15,
        -0.4);
  print_cylinder(side + "_forearm", (1 - share) * fore, fore_length, 0.035, "-z");
  hinge(side + "_forearm_twist", side + "_elbow", side + "_forearm", here, "z", 5);
  print_ball(side + "_wrist", share * hand, 0.02, here);
  hinge(side + "_wrist_pitch", side + "_forearm", side + "_wrist", {0, 0, -fore_length}, "y", 4);
  print_box(side + "_hand", (1 - share) * hand, {0.09, 0.03, hand_length},
            {0, 0, -0.5 * hand_length});
  hinge(side + "_wrist_roll", side + "_wrist", side + "_hand", here, "x", 4);
}

}  // namespace

void print_humanoid(int) {
  print_head("A person of 75 kg and 1.75 m in the air: a free pelvis and 30 hinges.", "Humanoid",
             {0, 0, -9.81}, 1);
  torso_and_head();
  for (const double left : {1.0, -1.0}) {
    const std::string side = left > 0 ? "left" : "right";
    leg(side, left, left);
    arm(side, left, -left);
    print_marker(side + "_sole", side + "_foot", {0.05, 0, -0.039 * height});
    print_marker(side + "_fingers", side + "_hand", {0, 0, -0.108 * height});
  }
  print_marker("crown", "head", {0, 0, 0.23});
}

}  // namespace momenta::program
