#pragma once
// What a text says: output, the sentence that bad input is refused with, an exception.

#include <gtest/gtest.h>
#include <momenta/core/scene/scene.h>

#include <functional>
#include <string>
#include <string_view>

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

/// Whether `part` is in `text`, which the reader of a failure sees.
inline testing::AssertionResult says(std::string_view text, std::string_view part) {
  const bool found = text.find(part) != std::string_view::npos;
  return (found ? testing::AssertionSuccess() : testing::AssertionFailure())
         << "'" << part << (found ? "' is in:\n" : "' is not in:\n") << text;
}

/// What an exception of this kind says that `action` throws; empty where it throws none.
template <class Thrown = std::exception, class Action>
std::string thrown(Action&& action) {
  try {
    action();
  } catch (const Thrown& error) {
    return error.what();
  }
  return "";
}

}  // namespace momenta::equations
