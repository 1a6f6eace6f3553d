#pragma once
// The scene, its mechanism and the settings of its runs, from the options.

#include <momenta/dae/mechanism/mechanism.h>
#include <momenta/dae/run/run_form.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "options.h"

namespace momenta::program {

/// --set. @throws std::invalid_argument
std::vector<Setting> settings_of(const Options& o);
MechanismOptions mechanism_options(const Options& o);
/// Prints remarks of the scene's reader unless --quiet is given.
Scene read(const Options& o);
std::unique_ptr<Mechanism> load(const Options& o);
RunSettings run_settings(const Options& o, const RunDefaults& defaults);
/// Bound to the mechanism's columns; null without --reference.
std::unique_ptr<Reference> load_reference(const Options& o, const Mechanism& mechanism);

/// Empty without a file.
std::string content_of(const std::filesystem::path& file);
/// Whether the named file holds equations, not a scene.
bool names_equations(const Options& o);

}  // namespace momenta::program
