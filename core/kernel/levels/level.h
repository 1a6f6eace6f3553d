#pragma once
// The x86-64 levels kernels are compiled for: 1 is plain x86-64 (and any other architecture), 3 has
// AVX2 and fused multiply-add, 4 has AVX-512. The build decides which a library holds; a chain or
// mechanism chooses when it is made.

namespace momenta {

/// The highest level up to `level` that machine and library have, else their lowest. @throws
/// std::runtime_error where the machine runs none of the library's.
int level_at_most(int level);

/// The default level of kernels: that of use_level(), else of the environment variable
/// MOMENTA_LEVEL, else the machine's best. @throws std::invalid_argument for a MOMENTA_LEVEL that
/// is no level of this machine and library.
int best_level();

/// Sets the level of chains and mechanisms made from now on. @throws std::invalid_argument where
/// the machine or the library does not have it.
void use_level(int level);

}  // namespace momenta
