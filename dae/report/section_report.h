#pragma once
// What `momenta section` prints and writes: points, a picture of them, a page. Columns of the CSV
// and keys of the JSON are public interface.

#include <momenta/dae/study/section_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// What a section is of, and what of it is drawn.
struct SectionPicture {
  std::string scene;      ///< its name
  std::string when;       ///< the formula
  std::string direction;  ///< up, down or both
  std::string varied;     ///< whose start value; empty: none
  std::string x, y;       ///< columns of the trajectory, with their units
};

/// One row per point: start (its number), its varied value, t, direction, columns of the
/// trajectory.
std::string section_csv(const SectionPicture&, const std::vector<SectionOrbit>&);
nlohmann::ordered_json section_json(const SectionPicture&, const std::vector<SectionOrbit>&);
/// Points, energy error and end of each start, in columns.
std::string section_table(const SectionPicture&, const std::vector<SectionOrbit>&);
/// The points in the plane of two columns, a colour a start. @pre the columns are there
std::string section_svg(const SectionPicture&, const std::vector<SectionOrbit>&);
std::string section_page(const SectionPicture&, const std::vector<SectionOrbit>&,
                         const Environment&, const std::string& command);

}  // namespace momenta
