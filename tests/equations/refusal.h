#pragma once
// The sentence that bad input is refused with.

#include <gtest/gtest.h>
#include <momenta/core/scene/scene.h>

#include <functional>
#include <string>

namespace momenta::equations {

/// The sentence `action` fails with. Fails the test when it does not, or fails with anything else.
inline std::string sentence_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const SceneError& error) {
    const std::string sentence = error.what();
    EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
    return sentence;
  } catch (const std::exception& error) {
    ADD_FAILURE() << "not a SceneError: " << error.what();
    return "";
  }
  ADD_FAILURE() << "nothing was refused";
  return "";
}

}  // namespace momenta::equations
