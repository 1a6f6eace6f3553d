#pragma once
#include <momenta/dae/form/form.h>

#include <string>

namespace momenta {

/// One sentence on rates that the scene gives and its loops do not let be, "start rates replaced by
/// the nearest that the loops allow: P.u0 from 0.3 to 0.0052 m/s"; empty where all are kept to a
/// thousandth of the largest. Rates of zero are not counted as given.
std::string replaced_rates_in_words(const Mechanism& mechanism, const Start& start);

}  // namespace momenta
