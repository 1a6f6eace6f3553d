// Evaluations in dual numbers: exact Jacobians of the DAE forms.

#include <momenta/dae/mechanism/sweep_rows.h>

namespace momenta {

template std::unique_ptr<Evaluation<Dual8>> Mechanism::evaluation<Dual8>() const;

}  // namespace momenta
