// Bodies by their depth in the tree, or coordinates and formulas, and loops.

#include <momenta/core/scene/kinds.h>

#include <cstdio>
#include <map>
#include <vector>

#include "checked.h"

namespace momenta::program {
namespace {

/// Lines about bodies, and about loops.
constexpr int most_lines = 200;

/// "ground - rocker", "A, B" for a coupler; and whether drives prescribe a part of it.
std::string loop_in_words(const Scene& scene, const LoopSpec& loop) {
  std::string words;
  if (has_equation(loop)) return loop.equation + " = 0";
  if (loop.kind == LoopKind::coupler) {
    for (const std::string& joint : loop.joints) words += (words.empty() ? "" : ", ") + joint;
  } else {
    words = loop.parent + " - " + loop.child;
  }
  for (const DriveSpec& drive : scene.drives)
    if (drive.loop == loop.name) return words + ", driven";
  return words;
}

/// A formula in one line, with single spaces.
std::string in_one_line(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (!space) line += c;
    if (space && !line.empty() && line.back() != ' ') line += ' ';
  }
  return line;
}

void print_formulas(const LagrangianSpec& spec) {
  std::string names;
  for (const auto& c : spec.coordinates) names += (names.empty() ? "" : ", ") + c.name;
  std::printf("  coordinates %s\n", names.c_str());
  const auto print = [](const std::string& what, const std::string& text) {
    if (!text.empty()) std::printf("  %s = %s\n", what.c_str(), in_one_line(text).c_str());
  };
  print("L", spec.lagrangian.text);
  print("T", spec.kinetic.text);
  print("V", spec.potential.text);
  for (const auto& f : spec.forces) print("Q of " + f.coordinate, f.value.text);
  for (const auto& c : spec.constraints)
    std::printf("  constraint %s: 0 = %s\n", c.name.c_str(), in_one_line(c.equation.text).c_str());
}

}  // namespace

void print_structure(const Checked& c) {
  std::printf("%s\n\n%s\n", c.tree.name.c_str(), c.bodies ? "Tree" : "Lagrangian");
  if (!c.bodies) print_formulas(*c.mechanism.scene().lagrangian);
  std::map<std::string, JointKind> kinds;
  for (const auto& joint : c.mechanism.scene().joints) kinds[joint.name] = joint.kind;
  const int count = static_cast<int>(c.tree.bodies.size());
  std::vector<int> depths(c.tree.bodies.size());
  int lines = 0, left_out = 0;
  for (int last = 0; last < count; ++last) {
    const auto& b = c.tree.bodies[static_cast<std::size_t>(last)];
    const int depth = b.parent < 0 ? 0
                                   : depths[static_cast<std::size_t>(b.parent)] +
                                         c.tree.carries_scene_body(b.parent);
    depths[static_cast<std::size_t>(last)] = depth;
    if (!c.tree.carries_scene_body(last)) continue;
    int drives = 0;
    for (int k = c.tree.first_part(last); k <= last; ++k)
      drives += c.tree.bodies[static_cast<std::size_t>(k)].drive >= 0;
    if (depth > 12 || lines == most_lines) {  // the first bodies show the pattern
      ++left_out;
      continue;
    }
    ++lines;
    std::printf("  %*s%s (%s%s) %s, %.4g kg\n", 2 * depth, "", b.joint.c_str(),
                drives == 0         ? ""
                : drives == b.parts ? "driven "
                                    : "partly driven ",
                std::string(reading::name_of(kinds.at(b.joint))).c_str(), b.name.c_str(), b.mass);
  }
  if (left_out > 0) std::printf("  … and %d bodies more\n", left_out);
  lines = 0;
  for (const auto& loop : c.mechanism.scene().loops) {
    if (lines++ == most_lines) break;
    std::printf("  loop %s: %s\n", loop.name.c_str(),
                loop_in_words(c.mechanism.scene(), loop).c_str());
  }
  if (const auto loops = static_cast<int>(c.mechanism.scene().loops.size()); loops > most_lines)
    std::printf("  … and %d loops more\n", loops - most_lines);
}

}  // namespace momenta::program
