#pragma once
// Rows of numbers in the order in which they come, each in one piece that stays where it is. Blocks
// double up to 32 MB; those of whole huge pages ask for such: a run of seconds keeps tens of
// megabytes, and in pages of 4 kB the first touch of each took longer than what is written there.

#include <cstddef>
#include <new>
#include <vector>

namespace momenta {

class KeptNumbers {
 public:
  KeptNumbers() = default;
  KeptNumbers(const KeptNumbers&) = delete;
  KeptNumbers& operator=(const KeptNumbers&) = delete;
  ~KeptNumbers();
  /// Room for so many numbers, not set. Throws std::bad_alloc.
  double* next(std::size_t count);

 private:
  void begin_block(std::size_t count);

  struct Block {
    double* first;
    std::align_val_t alignment;
  };
  std::vector<Block> blocks_;
  std::size_t size_ = 0, used_ = 0;  ///< of the last block, numbers
};

}  // namespace momenta
