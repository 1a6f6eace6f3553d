#pragma once
// Text for the places in a page.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace momenta {

/// Replaces each {{name}} in one pass: braces in replacements are plain text. A name without
/// replacement is removed.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& replacements);

/// & < > " ' as entities.
std::string escape_html(std::string_view text);

}  // namespace momenta
