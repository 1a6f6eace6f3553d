#pragma once
// UTF-8, the encoding of all texts here (RFC 3629: no overlong forms, no surrogates).

#include <cstddef>
#include <string>
#include <string_view>

namespace momenta::reading {

/// Bytes of the character that `text` begins with; 0: none does, or it is empty.
std::size_t utf8_length(std::string_view text);
/// Where the first byte stands that is no UTF-8; npos: none.
std::size_t first_not_utf8(std::string_view text);
/// The same text with bytes that are not UTF-8 written \xNN.
std::string as_utf8(std::string_view text);

}  // namespace momenta::reading
