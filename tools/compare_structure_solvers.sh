#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs the structures without a fluid by each of their two solvers and by what is chosen, and prints the table of docs/benchmarks.md:
# tools/compare_structure_solvers.sh [FOLDER of the runs]. DROGUE names another program than ./drogue.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=${1:-runs/structure_solvers}
drogue=${DROGUE:-./drogue}
export OMP_NUM_THREADS=1
TIMEFORMAT=%U

# name | case | result | key of the solver | solvers | other arguments
matrix() {
  local n
  for n in 16 32 64; do echo "cook $n x $n|cook_membrane|tip_displacement|structure.solver|relaxation newton equilibrium|--set body.panel.mesh.elements=[$n,$n,1]"; done
  echo "cantilever, alpha = 1|cantilever_large_deflection|deflection_over_length|structure.solver|relaxation newton equilibrium|"
  echo "cantilever, alpha = 4|cantilever_large_deflection|deflection_over_length|structure.solver|relaxation newton equilibrium|--set body.beam.force.0.force=[0,0,4]"
  for n in 12 24 48; do echo "membrane $n x 4|membrane_inflation_circular|apex_over_radius|structure.solver|relaxation newton equilibrium|--set body.membrane.mesh.elements=[$n,$n]"; done
  for n in 16 32; do echo "airbag $n x $n|airbag_square|centre_displacement|structure.solver|relaxation newton equilibrium|--set body.airbag.mesh.elements=[$n,$n]"; done
  echo "cable|cable_catenary|sag_over_span|structure.solver|relaxation newton equilibrium|"
  echo "pendulum|cable_pendulum|period|body.pendulum.integrator|explicit implicit auto|"
}

number() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\),\{0,1\}$/\1/p" "$1" | head -n 1; }
# The only entry of "structure": { "NAME": "solver" }.
chosen() { sed -n '/^  "structure": {/{n;s/.*: "\(.*\)"/\1/p}' "$1"; }
iterations() { awk -F, 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i ~ /substeps/) column = i } END { print $column }' "$1"; }

echo '| run | solver | iterations or sub-steps | processor time [s] | result |'
echo '|---|---|---|---|---|'
while IFS='|' read -r name case result key solvers arguments; do
  for solver in $solvers; do
    run=$folder/${name//[ =,]/_}_$solver
    # shellcheck disable=SC2086
    seconds=$({ time $drogue run "cases/$case" --set "$key=$solver" $arguments -o "$run" --force --quiet </dev/null; } 2>&1) || continue
    picked=$(chosen "$run/summary.json")
    [[ $picked == "$solver" ]] || picked="$solver: $picked"
    awk -v name="$name" -v solver="$picked" -v n="$(iterations "$run/history.csv")" -v seconds="$seconds" \
      -v result="$(number "$run/summary.json" "$result")" \
      'BEGIN { printf "| %s | %s | %d | %.2g | %.6g |\n", name, solver, n, seconds, result }'
  done
done < <(matrix)
