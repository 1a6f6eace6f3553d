#pragma once
// What a reader owes to any input: a result, or one sentence.

#include <string>
#include <string_view>

namespace momenta::equations {

/// Empty for one line of words; else what is wrong with it as the reason of `about`.
std::string wrong_as_a_sentence(const std::string& words, const std::string& about);

/// Reads a text as a scene. Empty when that gives a scene or one sentence, else what went wrong.
/// `is_scene` (may be null) is told which.
std::string wrong_in_reading(std::string_view text, bool* is_scene = nullptr);

}  // namespace momenta::equations
