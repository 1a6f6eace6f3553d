#pragma once
// Files built into the library by embed.cmake: the parts of a page.

#include <string_view>

namespace momenta::embedded {

std::string_view page_html();
std::string_view stress_html();
std::string_view stress_css();
std::string_view page_css();
std::string_view text_js();
std::string_view signs_js();
std::string_view table_js();
std::string_view chart_js();
std::string_view history_js();
std::string_view scatter_js();
std::string_view mechanism_js();
std::string_view page_js();
std::string_view uplot_js();
std::string_view uplot_css();
std::string_view uplot_license();

}  // namespace momenta::embedded
