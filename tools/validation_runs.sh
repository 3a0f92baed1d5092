#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the scripts that validate: makes the runs of a matrix and writes tables of their results into
# docs/validation.md. A script defines `runs`, a folder, and `matrix`, which prints a line for each run:
#   name | case | what it changes | arguments of ./drogue run
# A run that exists is kept, and so is the row of a run that is not here, so tables can be extended one run at a time. DROGUE names
# another program than ./drogue.
page=docs/validation.md
drogue=${DROGUE:-./drogue}

# make_runs [NAME...]: those named, or all.
make_runs() {
  local name folder what arguments
  while IFS='|' read -r name folder what arguments; do
    [[ $# -eq 0 || " $* " == *" $name "* ]] || continue
    [[ -f $runs/$name/summary.json ]] && continue
    echo "$name: $what"
    # shellcheck disable=SC2086
    $drogue run cases/$folder $arguments -o "$runs/$name" --force --quiet </dev/null || echo "  exit code $?"
  done < <(matrix)
}

value() { sed -n "s/^ *\"$2\": \([-0-9.e+]*\|null\|true\|false\),\{0,1\}$/\1/p" "$1" | head -n 1; }

# row NAME WHAT KEY...: the results of a run as a line of a table; without such a run, its line as it stands in the page, if any.
row() {
  local name=$1 what=$2 summary=$runs/$1/summary.json key results=()
  [[ -f $summary ]] || { grep "^| \`$name\` |" "$page" || true; return; }
  for key in "${@:3}"; do
    results+=("$(value "$summary" "$key" | { grep . || echo -; } | awk '{ printf $1 == "null" || $1 == "-" ? "-" : "%.4g", $1 }')")
  done
  [[ $(value "$summary" finished) == true ]] || what+=" (ended at $(value "$summary" t_end | awk '{ printf "%.2f", $1 }') s)"
  printf '| `%s` | %s |' "$name" "$what"
  printf ' %s |' "${results[@]}"
  echo
}

# rows PATTERN KEY...: those of the runs whose names begin so.
rows() {
  local name what
  while IFS='|' read -r name _ what _; do
    [[ $name != "$1"* ]] || row "$name" "$what" "${@:2}"
  done < <(matrix)
}

# heading TITLE...: the head of a table.
heading() {
  printf '|'
  printf ' %s |' "$@"
  printf '\n|'
  printf -- '---|%.0s' "$@"
  echo
}

# write_table MARKER: what comes in goes between <!-- MARKER --> and <!-- end -->.
write_table() {
  local table
  table=$(mktemp)
  cat >"$table"
  sed -i -e "/<!-- $1 -->/,/<!-- end -->/ { /<!--/! d }" -e "/<!-- $1 -->/r $table" "$page"
  rm "$table"
}
