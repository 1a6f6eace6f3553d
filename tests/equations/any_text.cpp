#include "equations/any_text.h"

#include <momenta/core/format/files/read_scene.h>

#include <exception>

namespace momenta::equations {

std::string wrong_as_a_sentence(const std::string& words, const std::string& about) {
  if (words.empty()) return about + ": no reason given";
  if (words.find_first_of("\r\n") != std::string::npos)
    return about + ": more than one line: " + words;
  return "";
}

std::string wrong_in_reading(std::string_view text, bool* is_scene) {
  if (is_scene) *is_scene = false;
  try {
    parse_scene(text);
  } catch (const SceneError& error) {
    return wrong_as_a_sentence(error.what(), "refused");
  } catch (const std::exception& error) {
    return std::string("not a SceneError: ") + error.what();
  }
  if (is_scene) *is_scene = true;
  return "";
}

}  // namespace momenta::equations
