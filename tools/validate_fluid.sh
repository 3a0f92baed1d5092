#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the rigid bodies over grids, deltas and time steps, and writes the table of docs/validation.md. A run that exists is kept,
# so the table can be extended one run at a time: tools/validate_fluid.sh [NAME...] makes the runs named, without names it makes
# all; with --table it only writes the table from what is there. DROGUE names another program than ./drogue.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
runs=runs/validation_fluid
page=docs/validation.md
drogue=${DROGUE:-./drogue}

# Of a case around a body of 1 m that refines by boxes: the finest cells 1/$1 m; the boxes are 2 and 4 times as coarse.
cells() {
  local coarsest=1/2
  case $1 in 12 | 24 | 48) coarsest=1/3 ;; esac
  echo "--set grid.coarsest=$coarsest --set grid.finest=1/$1 --set grid.region.1.spacing=2/$1 --set grid.region.2.spacing=4/$1"
}

# name | case | what it changes | arguments of ./drogue run
matrix() {
  local n re tube="--set body.cylinder.shape.length=8/3 --set body.cylinder.shape.centre=[0,0,\"4/3\"]"
  for re in 100 200; do
    for n in 12 16 24 32 48; do
      echo "sphere$re-$n|sphere_re$re|$n cells|$(cells $n)"
    done
    for n in 16 32; do
      echo "sphere$re-$n-unretracted|sphere_re$re|$n cells, markers on the surface|$(cells $n) --set body.sphere.coupling.retraction=0"
    done
  done
  for n in 16 32; do
    echo "sphere100-$n-peskin3|sphere_re100|$n cells, three-point delta|$(cells $n) --set body.sphere.coupling.delta=peskin3"
  done
  echo "sphere100-16-passes|sphere_re100|16 cells, four passes of forcing|$(cells 16) --set body.sphere.coupling.iterations=4"
  echo "sphere100-16-step-half|sphere_re100|16 cells, half the time step and Mach number|$(cells 16) --set fluid.lattice_velocity=0.025"
  echo "sphere100-16-step-double|sphere_re100|16 cells, twice the time step and Mach number|$(cells 16) --set fluid.lattice_velocity=0.1"
  echo "sphere100-16-wide|sphere_re100|16 cells, domain 1.5 times as wide|$(cells 16) --set domain.lower=[-24,-24,-24] --set domain.upper=[32,24,24]"
  echo "sphere100-16-fine-wake|sphere_re100|16 cells, finest ones to 3 m|$(cells 16) --set grid.region.1.spacing=1/16"
  echo "cylinder-16|oscillating_cylinder|16 cells|--set grid.finest=1/16"
  echo "cylinder-24|oscillating_cylinder|24 cells|--set grid.coarsest=1/6 --set grid.finest=1/24 --set grid.region.1.spacing=1/12 --set domain.lower=[-13.3333333333333333,-13.3333333333333333,0] --set domain.upper=[13.3333333333333333,13.3333333333333333,\"8/3\"] $tube"
  echo "cylinder-32|oscillating_cylinder|32 cells|"
  echo "cylinder-32-unretracted|oscillating_cylinder|32 cells, markers on the surface|--set body.cylinder.coupling.retraction=0"
  for n in 16 24 32; do echo "disk-$n|disk_normal|$n cells|$(cells $n)"; done
  for n in 16 24 32; do echo "plate-$n|plate_normal|$n cells|$(cells $n)"; done
}

value() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\|null\|true\|false\),\{0,1\}$/\1/p" "$1" | head -n 1; }

row() {
  local name=$1 what=$2 summary=$runs/$1/summary.json key results=()
  [[ -f $summary ]] || return 0
  for key in cd_stable cd_stable_drift cd_peak wake_length slip_rms_stable; do
    results+=("$(value "$summary" $key | awk '{ printf $1 == "null" || $1 == "" ? "-" : "%.4g", $1 }')")
  done
  [[ $(value "$summary" finished) == true ]] || what+=" (ended at $(value "$summary" t_end | awk '{ printf "%.2f", $1 }') s)"
  printf '| `%s` | %s | %s | %s | %s | %s | %s |\n' "$name" "$what" "${results[@]}"
}

write_table() {
  local table name what
  table=$(mktemp)
  {
    echo '| run | cells across the body; what differs | C_D stable | drift | C_D peak | wake length | slip, rms [m/s] |'
    echo '|---|---|---|---|---|---|---|'
    while IFS='|' read -r name _ what _; do row "$name" "$what"; done < <(matrix)
  } >"$table"
  sed -i -e "/<!-- rigid bodies -->/,/<!-- end -->/ { /<!--/! d }" -e "/<!-- rigid bodies -->/r $table" "$page"
  rm "$table"
}

if [[ ${1:-} != --table ]]; then
  while IFS='|' read -r name folder what arguments; do
    [[ $# -eq 0 || " $* " == *" $name "* ]] || continue
    [[ -f $runs/$name/summary.json ]] && continue
    echo "$name: $what"
    # shellcheck disable=SC2086
    $drogue run cases/$folder $arguments -o "$runs/$name" --force --quiet </dev/null || echo "  exit code $?"
  done < <(matrix)
fi
write_table
