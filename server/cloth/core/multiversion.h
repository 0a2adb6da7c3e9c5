#pragma once

/// Several instruction sets in one binary, chosen at load time (glibc's ifunc). A function so marked holds
/// plain loops that the compiler vectorises, and nothing of Eigen (its alignment depends on the instruction
/// set). With a third version, for AVX-512, nine presets took 0.93 to 1.11 times as long as without it on a
/// processor that has it (Zen 4), and the kernels half as long again to compile. clang 14 does not know the
/// attribute; sanitizers instrument before the resolver may run. Both get the plain function.
#if defined(WEFT_MULTIVERSION)
// The build's own choice: tests/bench makes it empty, to measure what the versions are worth.
#elif defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define WEFT_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define WEFT_MULTIVERSION
#endif

/// Before a loop whose iterations do not depend on one another although its arrays could overlap for all the
/// compiler can see.
#if defined(__clang__)
#define WEFT_INDEPENDENT_ITERATIONS _Pragma("clang loop vectorize(assume_safety)")
#else
#define WEFT_INDEPENDENT_ITERATIONS _Pragma("GCC ivdep")
#endif

/// A lambda so marked becomes part of the loop that calls it, and with it of the instruction set's version.
#define WEFT_INLINE_LAMBDA __attribute__((always_inline))
