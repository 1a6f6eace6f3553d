#pragma once
// A zeroed array of doubles that starts on a cache line and never changes its size.

#include <algorithm>
#include <cstddef>
#include <memory>
#include <new>

namespace momenta::explicit_rk {

inline constexpr std::size_t cache_line = 64;  ///< bytes

/// n doubles rounded up to whole cache lines: loops over padded arrays need no remainder.
constexpr std::size_t padded(std::size_t n) {
  constexpr std::size_t line = cache_line / sizeof(double);
  return (n + line - 1) / line * line;
}

class AlignedArray {
 public:
  explicit AlignedArray(std::size_t size)
      : data_(static_cast<double*>(
            ::operator new[](size * sizeof(double), std::align_val_t{cache_line}))) {
    std::fill_n(data_.get(), size, 0.0);
  }
  double* data() { return data_.get(); }
  const double* data() const { return data_.get(); }
  double& operator[](std::size_t i) { return data_[i]; }
  double operator[](std::size_t i) const { return data_[i]; }
  void swap(AlignedArray& other) { data_.swap(other.data_); }

 private:
  struct Release {
    void operator()(double* p) const { ::operator delete[](p, std::align_val_t{cache_line}); }
  };
  std::unique_ptr<double[], Release> data_;
};

}  // namespace momenta::explicit_rk
