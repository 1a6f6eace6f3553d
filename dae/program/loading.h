#pragma once
// What is asked for: the scene, its mechanism, the settings of its runs.

#include <momenta/dae/mechanism.h>
#include <momenta/dae/study/run_form.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "options.h"

namespace momenta::program {

/// --set. @throws std::invalid_argument
std::vector<Setting> settings_of(const Options& o);
MechanismOptions mechanism_options(const Options& o);
/// Reads the scene, and tells what its reader remarked unless --quiet is given.
Scene read(const Options& o);
std::unique_ptr<Mechanism> load(const Options& o);
/// The run that is asked for, of a scene with these defaults.
RunSettings run_settings(const Options& o, const RunDefaults& defaults);
/// The reference, bound to the mechanism's columns; empty when none is asked for.
std::unique_ptr<Reference> load_reference(const Options& o, const Mechanism& mechanism);

/// The bytes of a file; empty where there is none.
std::string content_of(const std::filesystem::path& file);
/// Whether the file that is named holds equations in place of a scene.
bool names_equations(const Options& o);

}  // namespace momenta::program
