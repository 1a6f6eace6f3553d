#include <momenta/dae/gradient/step_arena.h>

#include <algorithm>
#if __has_include(<sys/mman.h>)
#include <sys/mman.h>
#endif

namespace momenta {
namespace {

constexpr std::size_t bytes = sizeof(double), cache_line = 64, huge_page = std::size_t{1} << 21,
                      first_block = std::size_t{1} << 16, largest_block = std::size_t{1} << 25;

}  // namespace

StepArena::~StepArena() {
  for (const Block& block : blocks_) ::operator delete(block.first, block.alignment);
}

double* StepArena::next(std::size_t count) {
  if (used_ + count > size_) begin_block(count);
  double* const room = blocks_.back().first + used_;
  used_ += count;
  return room;
}

void StepArena::begin_block(std::size_t count) {
  const std::size_t wanted =
      std::max(count * bytes, std::clamp(2 * size_ * bytes, first_block, largest_block));
  const bool huge = wanted >= huge_page;
  const std::size_t unit = huge ? huge_page : cache_line, all = (wanted + unit - 1) / unit * unit;
  const std::align_val_t alignment{unit};
  blocks_.reserve(blocks_.size() + 1);
  blocks_.push_back({static_cast<double*>(::operator new(all, alignment)), alignment});
#ifdef MADV_HUGEPAGE
  if (huge) ::madvise(blocks_.back().first, all, MADV_HUGEPAGE);  // harmless if refused
#endif
  size_ = all / bytes;
  used_ = 0;
}

}  // namespace momenta
