#include <klu.h>
#include <momenta/core/scalar/all_finite.h>
#include <momenta/dae/integrator/ida_matrix.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <algorithm>
#include <stdexcept>

namespace momenta {

IdaMatrix::IdaMatrix(DaeSystem& system, const sundials::Context& context, N_Vector like)
    : system_(system) {
  const sunindextype n = system.size();
  if (LocalJacobian* local = system.local()) {
    local_ = std::make_unique<LocalNewton>(*local, system.size(), context);
    return;
  }
  const JacobianPattern& pattern = system.pattern();
  sparse_ = !pattern.column_start.empty();
  if (!sparse_) {
    matrix_.reset(sundials::require(SUNDenseMatrix(n, n, context)));
    solver_.reset(sundials::require(SUNLinSol_Dense(like, matrix_.get(), context)));
    return;
  }
  if (pattern.column_start.size() != static_cast<std::size_t>(n) + 1 ||
      static_cast<std::size_t>(pattern.column_start.back()) != pattern.row.size())
    throw std::invalid_argument("the Jacobian pattern does not fit the system");
  const auto entries = static_cast<sunindextype>(pattern.row.size());
  matrix_.reset(sundials::require(SUNSparseMatrix(n, n, entries, CSC_MAT, context)));
  solver_.reset(sundials::require(SUNLinSol_KLU(like, matrix_.get(), context)));
}

IdaMatrix::Filled IdaMatrix::fill(double t, const double* y, const double* ydot, double c,
                                  SUNMatrix matrix) {
  if (local_) return local_->evaluate(t, y, ydot, c) ? Filled::yes : Filled::not_evaluated;
  double* values = nullptr;
  long entries = 0;
  if (sparse_) {
    // SUNDIALS clears the pattern with the values before each call.
    const JacobianPattern& pattern = system_.pattern();
    std::copy(pattern.column_start.begin(), pattern.column_start.end(),
              SUNSparseMatrix_IndexPointers(matrix));
    std::copy(pattern.row.begin(), pattern.row.end(), SUNSparseMatrix_IndexValues(matrix));
    values = SUNSparseMatrix_Data(matrix);
    entries = static_cast<long>(pattern.row.size());
  } else {
    values = SUNDenseMatrix_Data(matrix);
    entries = SUNDenseMatrix_LData(matrix);
  }
  if (!system_.jacobian(t, y, ydot, c, values)) return Filled::not_evaluated;
  return all_finite(values, entries) ? Filled::yes : Filled::not_finite;
}

}  // namespace momenta
