// Evaluations in sparse dual numbers: Newton matrices of large mechanisms, entry by entry.

#include <momenta/dae/mechanism/sweep_rows.h>

namespace momenta {

template std::unique_ptr<Evaluation<LocalDual>> Mechanism::evaluation<LocalDual>() const;

}  // namespace momenta
