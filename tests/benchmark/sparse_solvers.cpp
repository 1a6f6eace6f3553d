#include "sparse_solvers.h"

#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>
#include <suitesparse/umfpack.h>
#include <suitesparse/SuiteSparseQR.hpp>

#include <algorithm>

namespace momenta::benchmark_solvers {
namespace {

// The libraries take pointers to data that they only read.
int* start_of(const SymmetricMatrix& a) {
  return const_cast<int*>(a.start.data());
}
int* rows_of(const SymmetricMatrix& a) {
  return const_cast<int*>(a.row.data());
}
double* values_of(const SymmetricMatrix& a) {
  return const_cast<double*>(a.values().data());
}
/// A matrix and a right side as CHOLMOD and SPQR take them: views, nothing copied.
cholmod_sparse view_of(const SymmetricMatrix& a, int index_type, void* start, void* row) {
  cholmod_sparse view{};
  view.nrow = view.ncol = static_cast<std::size_t>(a.size());
  view.nzmax = a.row.size();
  view.p = start;
  view.i = row;
  view.x = values_of(a);
  view.itype = index_type;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}
cholmod_dense view_of(std::vector<double>& x) {
  cholmod_dense b{};
  b.nrow = b.nzmax = b.d = x.size();
  b.ncol = 1;
  b.x = x.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  return b;
}

class Klu final : public SparseSolver {
 public:
  explicit Klu(bool by_columns) : by_columns_(by_columns) {
    klu_defaults(&common_);
    if (by_columns) common_.btf = 0, common_.ordering = 1;
  }
  ~Klu() override {
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
  }
  std::string name() const override { return by_columns_ ? "KLU, COLAMD" : "KLU, BTF and AMD"; }
  bool analyse(const SymmetricMatrix& a) override {
    if (symbolic_) klu_free_symbolic(&symbolic_, &common_);
    if (numeric_) klu_free_numeric(&numeric_, &common_);
    n_ = a.size();
    symbolic_ = klu_analyze(n_, start_of(a), rows_of(a), &common_);
    return symbolic_ != nullptr;
  }
  bool factor(const SymmetricMatrix& a) override {
    if (numeric_)
      return klu_refactor(start_of(a), rows_of(a), values_of(a), symbolic_, numeric_, &common_) ==
                 1 &&
             common_.status == KLU_OK;
    numeric_ = klu_factor(start_of(a), rows_of(a), values_of(a), symbolic_, &common_);
    return numeric_ && common_.status == KLU_OK;
  }
  void solve(std::vector<double>& x) override {
    klu_solve(symbolic_, numeric_, n_, 1, x.data(), &common_);
  }
  double entries() const override { return static_cast<double>(numeric_->lnz + numeric_->unz); }
  double quality() const override {
    klu_rcond(symbolic_, numeric_, &common_);
    return common_.rcond;
  }

 private:
  bool by_columns_;
  int n_ = 0;
  mutable klu_common common_{};
  klu_symbolic* symbolic_ = nullptr;
  klu_numeric* numeric_ = nullptr;
};

class Umfpack final : public SparseSolver {
 public:
  Umfpack() {
    umfpack_di_defaults(control_);
    control_[UMFPACK_IRSTEP] = 0;  // refined outside, as the others are
  }
  ~Umfpack() override { forget(); }
  std::string name() const override { return "UMFPACK"; }
  bool analyse(const SymmetricMatrix& a) override {
    forget();
    n_ = a.size();
    return umfpack_di_symbolic(n_, n_, start_of(a), rows_of(a), values_of(a), &symbolic_, control_,
                               info_) == UMFPACK_OK;
  }
  bool factor(const SymmetricMatrix& a) override {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    a_ = &a;
    return umfpack_di_numeric(start_of(a), rows_of(a), values_of(a), symbolic_, &numeric_, control_,
                              info_) == UMFPACK_OK;
  }
  void solve(std::vector<double>& x) override {
    b_ = x;
    umfpack_di_solve(UMFPACK_A, start_of(*a_), rows_of(*a_), values_of(*a_), x.data(), b_.data(),
                     numeric_, control_, nullptr);
  }
  double entries() const override { return info_[UMFPACK_LNZ] + info_[UMFPACK_UNZ]; }
  double quality() const override { return info_[UMFPACK_RCOND]; }

 private:
  void forget() {
    if (numeric_) umfpack_di_free_numeric(&numeric_);
    if (symbolic_) umfpack_di_free_symbolic(&symbolic_);
  }
  int n_ = 0;
  const SymmetricMatrix* a_ = nullptr;
  std::vector<double> b_;
  double control_[UMFPACK_CONTROL], info_[UMFPACK_INFO] = {};
  void *symbolic_ = nullptr, *numeric_ = nullptr;
};

class Cholmod final : public SparseSolver {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.final_ll = 0;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.print = 0;
  }
  ~Cholmod() override {
    cholmod_free_factor(&factor_, &common_);
    cholmod_finish(&common_);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  std::string name() const override { return "CHOLMOD LDLᵀ"; }
  bool analyse(const SymmetricMatrix& a) override {
    if (factor_) cholmod_free_factor(&factor_, &common_);
    cholmod_sparse view = upper_of(a);
    factor_ = cholmod_analyze(&view, &common_);
    entries_ = common_.lnz;
    return factor_ != nullptr;
  }
  bool factor(const SymmetricMatrix& a) override {
    cholmod_sparse view = upper_of(a);
    return cholmod_factorize(&view, factor_, &common_) == 1 && common_.status == CHOLMOD_OK;
  }
  void solve(std::vector<double>& x) override {
    cholmod_dense b = view_of(x);
    cholmod_dense* found = cholmod_solve(CHOLMOD_A, factor_, &b, &common_);
    std::copy_n(static_cast<double*>(found->x), x.size(), x.begin());
    cholmod_free_dense(&found, &common_);
  }
  double entries() const override { return entries_; }
  double quality() const override { return cholmod_rcond(factor_, &common_); }

 private:
  static cholmod_sparse upper_of(const SymmetricMatrix& a) {
    cholmod_sparse view = view_of(a, CHOLMOD_INT, start_of(a), rows_of(a));
    view.stype = 1;  // of both triangles the upper one is read
    return view;
  }
  mutable cholmod_common common_{};
  cholmod_factor* factor_ = nullptr;
  double entries_ = 0;
};

class Spqr final : public SparseSolver {
 public:
  Spqr() { cholmod_l_start(&common_); }
  ~Spqr() override {
    if (qr_) SuiteSparseQR_free(&qr_, &common_);
    cholmod_l_finish(&common_);
  }
  Spqr(const Spqr&) = delete;
  Spqr& operator=(const Spqr&) = delete;
  std::string name() const override { return "SPQR"; }
  bool analyse(const SymmetricMatrix& a) override {
    if (qr_) SuiteSparseQR_free(&qr_, &common_);
    start_.assign(a.start.begin(), a.start.end());
    row_.assign(a.row.begin(), a.row.end());
    cholmod_sparse view = whole_of(a);
    qr_ = SuiteSparseQR_symbolic<double>(SPQR_ORDERING_DEFAULT, 0, &view, &common_);
    return qr_ != nullptr;
  }
  bool factor(const SymmetricMatrix& a) override {
    cholmod_sparse view = whole_of(a);
    return SuiteSparseQR_numeric<double>(SPQR_NO_TOL, &view, qr_, &common_) == 1;
  }
  void solve(std::vector<double>& x) override {
    cholmod_dense b = view_of(x);
    cholmod_dense* y = SuiteSparseQR_qmult<double>(SPQR_QTX, qr_, &b, &common_);
    cholmod_dense* found = SuiteSparseQR_solve<double>(SPQR_RETX_EQUALS_B, qr_, y, &common_);
    std::copy_n(static_cast<double*>(found->x), x.size(), x.begin());
    cholmod_l_free_dense(&y, &common_);
    cholmod_l_free_dense(&found, &common_);
  }
  double entries() const override { return static_cast<double>(common_.SPQR_istat[0]); }
  double quality() const override { return 0; }

 private:
  cholmod_sparse whole_of(const SymmetricMatrix& a) {
    return view_of(a, CHOLMOD_LONG, start_.data(), row_.data());
  }
  mutable cholmod_common common_{};
  std::vector<SuiteSparse_long> start_, row_;
  SuiteSparseQR_factorization<double>* qr_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseSolver> make_klu(bool by_columns) {
  return std::make_unique<Klu>(by_columns);
}
std::unique_ptr<SparseSolver> make_umfpack() {
  return std::make_unique<Umfpack>();
}
std::unique_ptr<SparseSolver> make_cholmod() {
  return std::make_unique<Cholmod>();
}
std::unique_ptr<SparseSolver> make_spqr() {
  return std::make_unique<Spqr>();
}

}  // namespace momenta::benchmark_solvers
