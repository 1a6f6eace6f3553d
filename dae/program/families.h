#pragma once
// The families that `momenta make` prints. The same family and n give the same text everywhere.

#include <span>

namespace momenta::program {

struct Family {
  const char* name;
  const char* what;  ///< in a few words; N is the size
  int least, most, usual;
  void (*print)(int n);
};

std::span<const Family> families();

// planar
void print_chain(int n);
void print_n_four_bar(int n);
// in space
void print_random_chain(int n);
void print_rope(int n);
void print_spherical_chain(int n);
void print_tree(int n);
void print_star(int n);
void print_humanoid(int n);

}  // namespace momenta::program
