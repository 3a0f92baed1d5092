// SPDX-License-Identifier: GPL-3.0-or-later
// Debian's p4est is built with Open MPI, so even a forest on one rank needs MPI_Init. Its defaults suit a
// cluster: a process started without mpirun forks a daemon, which takes 0.5 s and fails without a network or
// without ssh. The settings below make it a rank of its own: 0.04 s, no daemon, no files, no messages.
#include "amr/mpi_runtime.hpp"

#include <mpi.h>
#include <p4est_base.h>
#include <sc.h>

#include <array>
#include <cstdlib>
#include <utility>

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace drogue::amr {
namespace {

/// Settings of Open MPI for a process that talks to nobody; the user's environment goes before them, and other
/// MPI libraries do not look at them.
constexpr std::array<std::pair<const char*, const char*>, 6> alone{{
    {"OMPI_MCA_ess_singleton_isolated", "1"},    // no daemon
    {"OMPI_MCA_orte_create_session_dirs", "0"},  // isolated processes would share one folder in /tmp and race for it
    {"OMPI_MCA_if", "^posix_ipv4"},              // warns where there is no network
    {"OMPI_MCA_btl", "self"},                    // do not probe for network cards
    {"OMPI_MCA_pml", "ob1"},
    {"OMPI_MCA_opal_signal", ""},  // leave the signal handlers alone
}};

class MpiRuntime {
 public:
  MpiRuntime() {
#ifdef __SANITIZE_ADDRESS__
    const __lsan::ScopedDisabler open_mpi_leaks;  // some 10 kB a process, not ours to find
#endif
    int running = 0;
    MPI_Initialized(&running);
    if (!running) {
      const bool under_mpirun = std::getenv("OMPI_COMM_WORLD_SIZE") != nullptr;
      if (!under_mpirun) {
        for (const auto& [name, value] : alone) setenv(name, value, 0);
      }
      int provided = 0;
      MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
      started_ = true;
    }
    sc_init(MPI_COMM_SELF, 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
  }

  ~MpiRuntime() {
    sc_finalize();
    int finished = 0;
    MPI_Finalized(&finished);
    if (started_ && !finished) MPI_Finalize();
  }

  MpiRuntime(const MpiRuntime&) = delete;
  MpiRuntime& operator=(const MpiRuntime&) = delete;

 private:
  bool started_ = false;
};

}  // namespace

void start_mpi() {
  // The one static object here: MPI itself is one per process and cannot be started again after its end.
  static const MpiRuntime runtime;
}

}  // namespace drogue::amr
