// SPDX-License-Identifier: GPL-3.0-or-later
// MPI and p4est's log, which the process may start only once. Nothing outside this folder knows of either.
#pragma once

namespace drogue::amr {

/// Starts MPI, unless somebody has, and silences p4est; what was started is finalised when the process exits.
/// Every use of p4est must be preceded by a call. Not thread safe for the first call.
void start_mpi();

}  // namespace drogue::amr
