#include <momenta/dae/report/embedded.h>
#include <momenta/dae/report/plain_page.h>
#include <momenta/dae/report/template.h>

namespace momenta {

std::string section(const std::string& title, const std::string& inside) {
  return "<section><h2>" + escape_html(title) + "</h2>" + inside + "</section>\n";
}
std::string preformatted(const std::string& text) {
  return "<pre class=\"frame\" tabindex=\"0\">" + escape_html(text) + "</pre>";
}
std::string drawn(const std::string& svg) {
  return "<figure class=\"frame\" tabindex=\"0\">" + svg + "</figure>";
}

std::string how_section(const Environment& environment, const std::string& command) {
  const auto pair = [](const char* what, const std::string& value) {
    return std::string("<dt>") + what + "</dt><dd>" + escape_html(value) + "</dd>";
  };
  std::string versions;
  for (const auto& [name, version] : environment.versions)
    versions += (versions.empty() ? "" : ", ") + name + " " + version;
  return section("How it was made",
                 "<dl>" + pair("Command", command) + pair("Versions", versions) +
                     pair("Compiler", environment.compiler + ", " + environment.flags) +
                     pair("Processor", environment.cpu) + pair("Date", environment.date) + "</dl>");
}

std::string plain_page(const std::string& title, const char* kind, const std::string& answer,
                       const std::string& main) {
  return filled(embedded::stress_html(), {{"title", escape_html(title)},
                                          {"kind", kind},
                                          {"about", kind},
                                          {"answer", answer},
                                          {"main", main},
                                          {"page_css", std::string(embedded::page_css())},
                                          {"stress_css", std::string(embedded::stress_css())}});
}

}  // namespace momenta
