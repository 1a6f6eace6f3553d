#pragma once
// The assemblies of a mechanism as text, CSV, JSON and a page of pictures; keys and columns are
// public interface: docs/reference/assemblies.md.

#include <momenta/dae/analysis/kinematics/assemblies.h>
#include <momenta/dae/study/environment.h>

#include <nlohmann/json.hpp>
#include <string>

namespace momenta {

/// Assemblies, of starts or paths: numbers and completeness.
std::string assemblies_in_words(const Mechanism& mechanism, const AssembliesRequest& request,
                                const Assemblies& found);
/// One line an assembly.
std::string assemblies_table(const Mechanism& mechanism, const Assemblies& found);
/// The same with all digits.
std::string assemblies_csv(const Mechanism& mechanism, const Assemblies& found);
nlohmann::ordered_json assemblies_json(const Mechanism& mechanism, const AssembliesRequest& request,
                                       const Assemblies& found);

inline constexpr std::size_t most_assemblies_drawn = 60;
/// Pictures, the own assembly first, above words and table.
std::string assemblies_page(const Mechanism& mechanism, const AssembliesRequest& request,
                            const Assemblies& found, const Environment& environment,
                            const std::string& command);

}  // namespace momenta
