// Evaluations in quadruple precision: references made by the program itself.

#include <momenta/core/expression/functions_quad.h>
#include <momenta/core/scalar/quad.h>
#include <momenta/dae/mechanism/sweep_rows.h>

namespace momenta {

template std::unique_ptr<Evaluation<Quad>> Mechanism::evaluation<Quad>() const;

}  // namespace momenta
