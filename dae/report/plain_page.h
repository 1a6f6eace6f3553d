#pragma once
// Pages without script: a title, an answer, sections.

#include <momenta/dae/study/run_result.h>

#include <string>

namespace momenta {

/// A section under its title; `inside` is HTML.
std::string section(const std::string& title, const std::string& inside);
/// A table as printed.
std::string preformatted(const std::string& text);
/// A chart at its size; narrower windows scroll it.
std::string drawn(const std::string& svg);
/// Command, versions, compiler, processor and date.
std::string how_section(const Environment& environment, const std::string& command);
/// `kind`: one word beside the program's name; `answer` and `main` are HTML.
std::string plain_page(const std::string& title, const char* kind, const std::string& answer,
                       const std::string& main);

}  // namespace momenta
