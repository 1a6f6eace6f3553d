#pragma once
// Text put into the places that a page leaves for it.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace momenta {

/// `page` with each {{name}} replaced, in one pass: braces inside a replacement are never taken for
/// a name. A name without replacement becomes nothing.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& replacements);

/// & < > " ' as entities.
std::string escape_html(std::string_view text);

}  // namespace momenta
