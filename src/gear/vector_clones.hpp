// SPDX-License-Identifier: BSD-3-Clause
#pragma once

/// Before a function whose loops over the teeth vectorise: compiled for every x86-64 and for AVX2; the processor
/// decides when the library is loaded, before the thread sanitizer could watch it. Elsewhere it says nothing. Not for
/// AVX-512, which brings FMA: GCC 12 makes vfmaddsub of a product's sum beside its difference, whatever -ffp-contract
/// says.
#if defined(HJT_AVX2) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_THREAD__)
#define HJT_VECTOR_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define HJT_VECTOR_CLONES
#endif
