// Evaluations in series along a motion, with two directions each: the derivative arrays of the DAE
// forms.

#include <momenta/dae/mechanism/sweep_rows.h>

namespace momenta {

template std::unique_ptr<Evaluation<Jet>> Mechanism::evaluation<Jet>() const;

}  // namespace momenta
