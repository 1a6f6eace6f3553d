#pragma once
// Owners of SUNDIALS objects and the check of its return codes: a handle frees what it holds, in
// the reverse order of construction, and no call's code goes unread.

#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>

#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace momenta::sundials {

/// Throws for a code that only a wrong call or want of memory can bring, never for a step that
/// fails.
inline void check(int code, const char* call) {
  if (code < 0) throw std::runtime_error(std::string(call) + " returned " + std::to_string(code));
}
template <class T>
T* require(T* object) {
  if (object == nullptr) throw std::bad_alloc();
  return object;
}

class Context {
 public:
  Context() { check(SUNContext_Create(nullptr, &context_), "SUNContext_Create"); }
  ~Context() { SUNContext_Free(&context_); }
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  operator SUNContext() const { return context_; }

 private:
  SUNContext context_ = nullptr;
};

struct Release {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
};
using Matrix = std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Release>;
using LinearSolver = std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Release>;
using NonlinearSolver = std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, Release>;

/// A serial vector whose numbers can be reached.
class Vector {
 public:
  Vector(int size, const Context& context) : vector_(require(N_VNew_Serial(size, context))) {
    N_VConst(0, vector_.get());
  }
  operator N_Vector() const { return vector_.get(); }
  double* data() { return N_VGetArrayPointer(vector_.get()); }
  const double* data() const { return N_VGetArrayPointer(vector_.get()); }
  int size() const { return static_cast<int>(N_VGetLength(vector_.get())); }
  double& operator[](int i) { return data()[i]; }

 private:
  std::unique_ptr<std::remove_pointer_t<N_Vector>, Release> vector_;
};

struct ReleaseIntegrator {
  void (*free)(void**);
  void operator()(void* memory) const { free(&memory); }
};
using Integrator = std::unique_ptr<void, ReleaseIntegrator>;

/// Error handler that keeps silent: codes carry what is needed.
inline void silent(int, const char*, const char*, char*, void*) {}

}  // namespace momenta::sundials
