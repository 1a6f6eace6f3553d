#pragma once
// How much another choice of cut joints would save, in words.

#include <momenta/dae/cut/recut.h>

#include <string>

namespace momenta::program {

/// One sentence.
std::string cuts_in_words(const Recut& recut);

}  // namespace momenta::program
