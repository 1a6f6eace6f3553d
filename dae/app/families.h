#pragma once
// Families of scenes of `momenta make`. The same family, n and plane give the same text on every
// machine.

#include <span>

#include "scene_text.h"

namespace momenta::program {

struct Family {
  const char* name;
  const char* what;  ///< a few words; N is the size
  int least, most, usual;
  void (*print)(int n);                             ///< printer in space; null: planar
  void (*print_in)(int n, const Plane&) = nullptr;  ///< printer in a plane
};

std::span<const Family> families();

// planar
void print_chain(int n, const Plane& plane);
void print_n_four_bar(int n, const Plane& plane);
void print_scissor_ladder(int n, const Plane& plane);
void print_closed_chain(int n, const Plane& plane);
void print_grid(int n, const Plane& plane);
void print_jansen_legs(int n, const Plane& plane);
// in space
void print_random_chain(int n);
void print_rope(int n);
void print_spherical_chain(int n);
void print_tree(int n);
void print_star(int n);
void print_humanoid(int n);
void print_stewart(int n);

}  // namespace momenta::program
