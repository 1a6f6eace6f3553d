#include <momenta/core/text/utf8.h>

#include <algorithm>

namespace momenta::reading {

std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (text.empty()) return 0;
  const std::size_t size = byte(0) < 0x80                       ? 1
                           : byte(0) >= 0xc2 && byte(0) < 0xe0  ? 2
                           : byte(0) >= 0xe0 && byte(0) < 0xf0  ? 3
                           : byte(0) >= 0xf0 && byte(0) <= 0xf4 ? 4
                                                                : 0;
  if (size > text.size()) return 0;
  for (std::size_t i = 1; i < size; ++i)
    if ((byte(i) & 0xc0) != 0x80) return 0;
  // Overlong form, half of a surrogate pair, or beyond the last character.
  if (size > 2) {
    const unsigned second = byte(1);
    if ((byte(0) == 0xe0 && second < 0xa0) || (byte(0) == 0xed && second > 0x9f) ||
        (byte(0) == 0xf0 && second < 0x90) || (byte(0) == 0xf4 && second > 0x8f))
      return 0;
  }
  return size;
}

std::size_t first_not_utf8(std::string_view text) {
  for (std::size_t i = 0, size = 0; i < text.size(); i += size) {
    size = utf8_length(text.substr(i));
    if (size == 0) return i;
  }
  return std::string_view::npos;
}

std::string as_utf8(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string all;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t size = utf8_length(text.substr(i));
    if (size == 0) {
      const auto byte = static_cast<unsigned char>(text[i]);
      all += {'\\', 'x', hex[byte >> 4], hex[byte & 15]};
    }
    all += text.substr(i, size);
    i += std::max<std::size_t>(1, size);
  }
  return all;
}

}  // namespace momenta::reading
