// SPDX-License-Identifier: GPL-3.0-or-later
// The machine that a measurement was made on, and what it can do at best.
#pragma once

#include <string>

namespace drogue::bench {

/// Processor, threads, compiler, flags, version and date, on one line.
std::string describe_machine();

/// Bytes a second [GB/s] that `threads` threads copy with stores past the caches, reads and writes counted: best of
/// three. The arrays are several times as large as any cache.
double copy_bandwidth(int threads);

/// Single-precision operations a second [Gflop/s] that `threads` threads make in registers, a fused multiply-add being
/// two.
double arithmetic_peak(int threads);

}  // namespace drogue::bench
