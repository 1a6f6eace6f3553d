#include <momenta/dae/report/template.h>

namespace momenta {

std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& replacements) {
  std::string text;
  while (true) {
    const auto open = page.find("{{");
    text += page.substr(0, open);
    if (open == std::string_view::npos) return text;
    const auto close = page.find("}}", open);
    const auto name = page.substr(open + 2, close - open - 2);
    for (const auto& [key, value] : replacements)
      if (key == name) text += value;
    page.remove_prefix(close + 2);
  }
}

std::string escape_html(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

}  // namespace momenta
