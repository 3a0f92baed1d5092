#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Checks that the sources keep to the layers: which folder of src/ may include which, which files alone may include
# which package, and that every file names its licence. Prints file:line of each offence and exits 1; long files are
# only pointed out.
set -euo pipefail
cd "$(dirname "$0")/.."

find src tests bench -name '*.[ch]pp' | sort | xargs awk '
  BEGIN {
    # The layers below each layer.
    below["core"]     = ""
    below["geometry"] = "core"
    below["amr"]      = "core"
    below["fluid"]    = "core amr"
    below["lbm"]      = "core amr fluid"
    below["ns"]       = "core amr fluid"
    below["ib"]       = "core geometry amr fluid"
    below["fem"]      = "core geometry"
    below["fsi"]      = "core geometry amr fluid ib fem"
    below["io"]       = "core geometry amr fluid fem"
    below["app"]      = "core geometry amr fluid lbm ns ib fem fsi io"
    below["bench"]    = "core geometry amr fluid lbm ns ib fem fsi io app"
    below["render"]   = "core amr fluid fem io"

    # Beginnings of the headers of packages, and where alone they may be included.
    home["p4est"] = home["p8est"] = home["sc.h"] = home["sc_"] = home["mpi.h"] = "src/amr/"
    home["hdf5"]      = "src/io/hdf5"
    home["toml++/"]   = "src/app/"
    home["CLI/"]      = "src/app/ src/bench/ src/render/"
    home["nlohmann/"] = "src/io/ src/app/"
    home["muParser"]  = "src/core/"
    home["vtk"]       = "src/render/"
  }

  function offence(what) { print FILENAME ":" FNR ": " what; failed = 1 }

  function is_below(one, layer) { return one == layer || index(" " below[layer] " ", " " one " ") }

  function at_home(places,    place, n) {
    for (n = split(places, place, " "); n > 0; n--)
      if (index(FILENAME, place[n]) == 1) return 1
    return 0
  }

  FNR == 1 {
    depth = split(FILENAME, folder, "/")
    layer = folder[1] == "src" && depth > 2 ? folder[2] : ""
    if (layer != "" && !(layer in below)) offence("src/" layer " is not a layer")
    if ($0 != "// SPDX-License-Identifier: GPL-3.0-or-later") offence("the first line is not the SPDX line")
  }
  FNR == 401 { print FILENAME " is longer than 400 lines" >"/dev/stderr" }

  layer != "" && /^[ \t]*#[ \t]*include[ \t]*[<"]/ {
    ours = /"/
    header = $0
    sub(/^[^<"]*[<"]/, "", header)
    sub(/[>"].*/, "", header)
    for (beginning in home)
      if (!ours && index(header, beginning) == 1 && !at_home(home[beginning]))
        offence("<" header "> belongs to " home[beginning])
    split(header, folder, "/")
    if (ours && !(folder[1] in below))
      offence("\"" header "\" does not begin with the name of a layer")
    else if (ours && !is_below(folder[1], layer))
      offence("\"" header "\" is not below " layer)
  }

  END { exit failed }
' || failed=1

for script in drogue .ci/run tools/* CMakeLists.txt */CMakeLists.txt; do
  head -n 2 "$script" | grep -qx '# SPDX-License-Identifier: GPL-3.0-or-later' ||
    { echo "$script:1: no SPDX line"; failed=1; }
done

exit "${failed:-0}"
