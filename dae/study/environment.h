#pragma once
#include <momenta/dae/study/run_result.h>

#include <string_view>

namespace momenta {

/// Of momenta: "0.1.0".
const char* version();

/// Processor, compiler, flags, versions of the libraries, date: what stands beside every figure.
Environment environment();

/// Tells this build of the program on this processor from others: what may change a result's
/// digits.
std::string build_digest();

/// How many threads to run: those asked for, or with 0 one for each processor.
int threads_of(int asked);

/// 64-bit FNV-1a digest of a text, in hexadecimal: tells one scene from another, nothing more.
std::string digest(std::string_view text);

}  // namespace momenta
