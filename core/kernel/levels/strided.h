#pragma once
// Coordinates of a pack of states, loaded and stored by index: coordinate i of the pack's first
// state is at base[i * stride]. For one state they are contiguous.

#include <momenta/core/scalar/pack.h>

#include <cstddef>

namespace momenta {

template <class S>
struct StridedIn {
  const double* base;
  std::ptrdiff_t stride;
  MOMENTA_INLINE S operator[](int i) const { return S::load(base + i * stride); }
};
template <class S>
struct StridedOut {
  double* base;
  std::ptrdiff_t stride;
  struct Place {
    double* at;
    MOMENTA_INLINE void operator=(const S& x) const { x.store(at); }
    MOMENTA_INLINE operator S() const { return S::load(at); }
  };
  MOMENTA_INLINE Place operator[](int i) const { return {base + i * stride}; }
};
template <class S>
struct CoordinatesIn {
  const double* base;
  MOMENTA_INLINE S operator[](int i) const { return S(base[i]); }
};
template <class S>
struct CoordinatesOut {
  double* base;
  struct Place {
    double* at;
    MOMENTA_INLINE void operator=(const S& x) const { *at = x.v; }
    MOMENTA_INLINE operator S() const { return S(*at); }
  };
  MOMENTA_INLINE Place operator[](int i) const { return {base + i}; }
};

}  // namespace momenta
