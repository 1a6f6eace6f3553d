#pragma once
// Rows of numbers in order of arrival, each in one piece that stays in place. Blocks double up to
// 32 MB and ask for huge pages: a run of seconds keeps tens of megabytes, and the first touch of a
// page of 4 kB takes longer than writing it.

#include <cstddef>
#include <new>
#include <vector>

namespace momenta {

class StepArena {
 public:
  StepArena() = default;
  StepArena(const StepArena&) = delete;
  StepArena& operator=(const StepArena&) = delete;
  ~StepArena();
  /// Room for `count` numbers, not set. @throws std::bad_alloc
  double* next(std::size_t count);

 private:
  void begin_block(std::size_t count);

  struct Block {
    double* first;
    std::align_val_t alignment;
  };
  std::vector<Block> blocks_;
  std::size_t size_ = 0, used_ = 0;  ///< numbers in the last block
};

}  // namespace momenta
