#pragma once
// UTF-8, the encoding of all texts here (RFC 3629: no overlong forms, no surrogates).

#include <cstddef>
#include <string>
#include <string_view>

namespace momenta::reading {

/// Bytes of the character at the start of `text`; 0: it is empty or no UTF-8.
std::size_t utf8_length(std::string_view text);
/// Place of the first byte that is no UTF-8; npos: none.
std::size_t first_not_utf8(std::string_view text);
/// The same text with bytes that are not UTF-8 written \xNN.
std::string as_utf8(std::string_view text);

}  // namespace momenta::reading
