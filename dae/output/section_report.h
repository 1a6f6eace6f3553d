#pragma once
// Output of `momenta section`: points, a picture of them, a page. Columns of the CSV and keys of
// the JSON are public interface.

#include <momenta/dae/study/section_study.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// A section and its drawn columns.
struct SectionPicture {
  std::string scene;
  std::string when;       ///< formula
  std::string direction;  ///< up, down or both
  std::string varied;     ///< varied start value; empty: none
  std::string x, y;       ///< columns of the trajectory, with units
};

/// A row a point: start (its number), its varied value, t, direction, columns of the trajectory.
std::string section_csv(const SectionPicture&, const std::vector<SectionOrbit>&);
nlohmann::ordered_json section_json(const SectionPicture&, const std::vector<SectionOrbit>&);
/// Points, energy error and end of each start, in columns.
std::string section_table(const SectionPicture&, const std::vector<SectionOrbit>&);
/// Points in the plane of two columns, a colour a start. @pre the columns exist
std::string section_svg(const SectionPicture&, const std::vector<SectionOrbit>&);
std::string section_page(const SectionPicture&, const std::vector<SectionOrbit>&,
                         const Environment&, const std::string& command);

}  // namespace momenta
