#pragma once
// Savings of other cut joints, in words.

#include <momenta/dae/cut/recut.h>

#include <string>

namespace momenta::program {

/// One sentence.
std::string cuts_in_words(const Recut& recut);

}  // namespace momenta::program
