#pragma once
// State of a run between two steps, as numbers: written down and read back into new objects of the
// same sizes, the run goes on to the last bit as if nothing had been between. Every part lists what
// it carries once, for both ways.

#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

namespace momenta {

class Memory {
 public:
  /// Writes down.
  Memory() = default;
  /// Reads back.
  explicit Memory(std::vector<double> numbers) : numbers_(std::move(numbers)), reads_(true) {}

  bool reads() const { return reads_; }
  const std::vector<double>& numbers() const { return numbers_; }

  /// Counts up to 2⁵³ keep their last digit. @throws std::invalid_argument where numbers to read
  /// are at an end
  template <class T>
  void operator()(T& x) requires std::is_arithmetic_v<T> || std::is_enum_v<T> {
    if (!reads_)
      numbers_.push_back(static_cast<double>(x));
    else if (next_ == numbers_.size())
      throw std::invalid_argument("what a run carried is incomplete");
    else if constexpr (std::is_enum_v<T>)
      x = static_cast<T>(static_cast<int>(numbers_[next_++]));
    else
      x = static_cast<T>(numbers_[next_++]);
  }
  template <class T>
  void operator()(T* x, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) (*this)(x[i]);
  }
  template <class T>
  void operator()(std::vector<T>& x) {
    (*this)(x.data(), x.size());
  }

 private:
  std::vector<double> numbers_;
  std::size_t next_ = 0;
  bool reads_ = false;
};

}  // namespace momenta
