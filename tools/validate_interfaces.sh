#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# What passes an interface of levels or an open boundary, and what comes back; writes the tables of docs/validation.md. A run that exists is kept;
# with --table only the tables are written. DROGUE names another program than ./drogue.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
runs=runs/validation_interfaces
page=docs/validation.md
drogue=${DROGUE:-./drogue}

# name | case | what differs | result | arguments of ./drogue run
matrix() {
  cat <<END
vortex|vortex_through_interface|the case, one refined box|residual|
vortex-two-levels|vortex_through_interface|two boxes within each other|residual|--set grid.finest=1/64
vortex-coarse|vortex_through_interface|cells twice as large|residual|--set grid.coarsest=1/8 --set grid.finest=1/16 --set domain.upper=[12,4,2]
vortex-one-level|vortex_through_interface|no refinement|residual|--set grid.finest=1/16
pulse|pulse_through_interface|the case, one refined box|residual|
pulse-one-level|pulse_through_interface|no refinement|residual|--set grid.finest=1/16
closed|closed_box|no slip, moving lid, three levels|mass_drift|
closed-rest|closed_box|no slip, lid at rest|mass_drift|--set domain.z_max.velocity=[0,0,0]
END
}

value() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\|null\),\{0,1\}$/\1/p" "$1" | head -n 1; }

replace_between() {  # marker, file with the lines
  sed -i -e "/<!-- $1 -->/,/<!-- end -->/ { /<!--/! d }" -e "/<!-- $1 -->/r $2" "$page"
}

table=$(mktemp)
if [[ ${1:-} != --table ]]; then
  while IFS='|' read -r name folder what _ arguments; do
    [[ -f $runs/$name/summary.json ]] && continue
    echo "$name: $what"
    # shellcheck disable=SC2086
    $drogue run cases/$folder $arguments -o "$runs/$name" --force --quiet </dev/null || echo "  exit code $?"
  done < <(matrix)
  build/test_lbm --gtest_also_run_disabled_tests --gtest_filter='OpenBoundary.DISABLED_table' | grep '^|' | sed '1a |---|---|---|---|---|---|---|---|' >"$runs/boundaries.txt"
fi
{
  echo '| run | case | what differs | result | value |'
  echo '|---|---|---|---|---|'
  while IFS='|' read -r name folder what result _; do
    [[ -f $runs/$name/summary.json ]] || continue
    printf '| `%s` | `%s` | %s | `%s` | %.2g |\n' "$name" "$folder" "$what" "$result" "$(value "$runs/$name/summary.json" "$result")"
  done < <(matrix)
} >"$table"
replace_between interfaces "$table"
[[ -f $runs/boundaries.txt ]] && replace_between 'open boundaries' "$runs/boundaries.txt"
rm "$table"
