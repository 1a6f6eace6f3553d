#pragma once
#include <momenta/dae/form/form.h>

#include <string>

namespace momenta {

/// One sentence on rates of the scene that its loops do not allow, "start rates replaced by the
/// nearest that the loops allow: P.u0 from 0.3 to 0.0052 m/s"; empty where all are kept to a
/// thousandth of the largest. Rates of zero do not count as given.
std::string replaced_rates_in_words(const Mechanism& mechanism, const Start& start);

}  // namespace momenta
