#include <momenta/core/text/number_text.h>
#include <momenta/dae/output/page.h>
#include <momenta/dae/output/svg.h>

#include <algorithm>

namespace momenta::svg {

std::string number(double value) {
  std::string digits = fixed(value, 2);
  if (digits.find('.') == std::string::npos) return digits;
  while (digits.back() == '0') digits.pop_back();
  if (digits.back() == '.') digits.pop_back();
  return digits == "-0" ? "0" : digits;
}

std::string element(std::string_view name, const Attributes& attributes,
                    const std::string& inside) {
  std::string markup = "<";
  markup += name;
  for (const auto& [key, value] : attributes) {
    markup += ' ';
    markup += key;
    markup += "=\"";
    markup += escape_html(value);
    markup += '"';
  }
  if (inside.empty()) return markup + "/>\n";
  markup += '>';
  markup += inside;
  markup += "</";
  markup += name;
  return markup + ">\n";
}

namespace {

/// Moves the dot of Φ̇ above its letter, where fonts put it inside: a spacing dot, moved back and
/// up.
std::string dotted(std::string words) {
  const std::string_view rate = "Φ\u0307";
  constexpr std::string_view lifted =
      "Φ<tspan dx=\"-0.565em\" dy=\"-0.17em\">\u02d9</tspan><tspan dx=\"0.235em\" "
      "dy=\"0.17em\">\u200b</tspan>";
  for (std::size_t at = 0; (at = words.find(rate, at)) != std::string::npos; at += lifted.size())
    words.replace(at, rate.size(), lifted);
  return words;
}

}  // namespace

std::string text(double x, double y, const std::string& words, const char* anchor,
                 const Attributes& more) {
  Attributes all{{"x", number(x)}, {"y", number(y)}, {"text-anchor", anchor}};
  all.insert(all.end(), more.begin(), more.end());
  return element("text", all, dotted(escape_html(words)));
}

std::string line(double x0, double y0, double x1, double y1, const char* stroke, double width) {
  return element("line", {{"x1", number(x0)},
                          {"y1", number(y0)},
                          {"x2", number(x1)},
                          {"y2", number(y1)},
                          {"stroke", stroke},
                          {"stroke-width", number(width)}});
}

std::string document(double width, double height, const std::string& title,
                     const std::string& description, const std::string& inside) {
  const std::string w = number(width), h = number(height);
  return element("svg",
                 {{"xmlns", "http://www.w3.org/2000/svg"},
                  {"width", w},
                  {"height", h},
                  {"viewBox", "0 0 " + w + " " + h},
                  {"font-family", "Helvetica, Arial, 'DejaVu Sans', sans-serif"},
                  {"font-size", "14"},
                  {"fill", "#17191d"}},
                 "\n" + element("title", {}, escape_html(title)) +
                     element("desc", {}, escape_html(description)) +
                     element("rect", {{"width", w}, {"height", h}, {"fill", "#ffffff"}}) + inside);
}

double width_of(const std::string& words) {
  return 7.4 * static_cast<double>(width(words));
}

}  // namespace momenta::svg
