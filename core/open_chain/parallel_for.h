#pragma once
#include <cstddef>
#include <functional>

namespace momenta {

/// Calls work(i) for i < count on several threads, each taking the next free i. An exception of a
/// call ends the others at their next i and is thrown again.
void parallel_for(int threads, std::size_t count, const std::function<void(std::size_t)>& work);

}  // namespace momenta
