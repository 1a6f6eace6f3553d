#pragma once
// Parts of a page, built into the library by embed.cmake.

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
std::string_view film_js();
std::string_view camera_js();
std::string_view solids_js();
std::string_view strokes_js();
std::string_view stage_js();
std::string_view player_js();
std::string_view timeline_js();
std::string_view making_js();
std::string_view study_page_js();
std::string_view modes_page_js();
std::string_view run_page_js();
std::string_view uplot_js();
std::string_view uplot_css();
std::string_view uplot_license();

}  // namespace momenta::embedded
