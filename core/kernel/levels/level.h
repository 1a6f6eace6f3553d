#pragma once
// The x86-64 levels kernels are compiled for: 1 is plain x86-64 (and any other architecture), 3 has
// AVX2 and fused multiply-add, 4 has AVX-512. Which of them a library holds is decided when it is
// built, which of those a program runs when it makes a chain or a mechanism.

namespace momenta {

/// The highest level up to `level` that this machine and this library have; below their lowest,
/// that. @throws std::runtime_error where the machine runs none of the library's.
int level_at_most(int level);

/// The level of kernels for which none is asked: that of use_level(), else that of the environment
/// variable MOMENTA_LEVEL, else the machine's best. @throws std::invalid_argument for a
/// MOMENTA_LEVEL that is no level of this machine and library.
int best_level();

/// Chains and mechanisms made from now on take this level. @throws std::invalid_argument where the
/// machine or the library does not have it.
void use_level(int level);

}  // namespace momenta
