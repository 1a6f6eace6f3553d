#pragma once
#include <momenta/dae/run/run_result.h>

#include <string_view>

namespace momenta {

/// Version of momenta: "0.1.0".
const char* version();

/// Processor, compiler, flags, versions of the libraries, date.
Environment environment();

/// Digest of this build and processor, on which a result's digits may depend.
std::string build_digest();

/// Number of threads: as asked, or for 0 one per processor.
int threads_of(int asked);

/// 64-bit FNV-1a digest of a text, in hexadecimal, to tell scenes apart.
std::string digest(std::string_view text);

}  // namespace momenta
