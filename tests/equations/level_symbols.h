#pragma once
// Code compiled for one instruction level must not be shared with the rest of a program: whatever
// such an object file defines for others to share has to carry the level in its name.

#include "equations/output_of.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <sstream>
#include <string>

namespace momenta::equations {

/// Every shared symbol of the object files `pattern` below `folder` holds one of `own`, or is plain
/// data.
inline void expect_own_symbols(const char* folder, const char* pattern,
                               std::initializer_list<const char*> own) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "one level alone is compiled: it shares with none";
#endif
  std::string command = "for f in $(find '";
  command.append(folder).append("' -name '").append(pattern);
  command.append("'); do nm -C \"$f\"; done 2>/dev/null");
  std::istringstream lines(output_of(command));
  int symbols = 0;
  for (std::string text; std::getline(lines, text);) {
    if (text.size() < 20 || (text[17] != 'W' && text[17] != 'V' && text[17] != 'u')) continue;
    ++symbols;
    bool fine = false;
    for (const char* mark : own) fine |= text.find(mark) != std::string::npos;
    // Data, and what clang puts beside every noexcept: a call of std::terminate.
    for (const char* data : {"typeinfo", "DW.ref", "__clang_call_terminate"})
      fine |= text.find(data) != std::string::npos;
    EXPECT_TRUE(fine) << text;
  }
#ifdef __OPTIMIZE__
  EXPECT_GT(symbols, 20);
#endif
}

}  // namespace momenta::equations
