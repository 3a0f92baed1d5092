#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What passes an interface of levels or an open boundary, and what comes back; writes the tables of docs/validation.md:
# tools/validate_interfaces.sh [NAME...] makes the runs named, without names it makes all and measures the open boundaries; with
# --table it only writes the tables from what is there (tools/validation_runs.sh).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/validation_runs.sh
runs=runs/validation_interfaces

# name | case | what differs | arguments of ./drogue run
matrix() {
  cat <<END
vortex|vortex_through_interface|vortex, one refined box|
vortex-two-levels|vortex_through_interface|vortex, two boxes within each other|--set grid.finest=1/64
vortex-coarse|vortex_through_interface|vortex, cells twice as large|--set grid.coarsest=1/8 --set grid.finest=1/16 --set domain.upper=[12,4,2]
vortex-one-level|vortex_through_interface|vortex, no refinement|--set grid.finest=1/16
pulse|pulse_through_interface|pulse, one refined box|
pulse-one-level|pulse_through_interface|pulse, no refinement|--set grid.finest=1/16
closed|closed_box|closed box, no slip, moving lid, three levels|
closed-rest|closed_box|closed box, no slip, lid at rest|--set domain.z_max.velocity=[0,0,0]
END
}

[[ ${1:-} == --table ]] || make_runs "$@"
if (($# == 0)); then
  build/test_lbm --gtest_also_run_disabled_tests --gtest_filter='OpenBoundary.DISABLED_table' | grep '^|' | sed '1a |---|---|---|---|---|---|---|---|' >"$runs/boundaries.txt"
fi
{
  heading run 'what passes, where' residual 'mass drift'
  rows '' residual mass_drift
} | write_table interfaces
[[ ! -f $runs/boundaries.txt ]] || write_table 'open boundaries' <"$runs/boundaries.txt"
