#!/usr/bin/env bash
# From a fresh clone to a weeded row: installs what is missing, builds, runs the robot over 20 m of
# rendered sugar beet in simulated time, and names the report. Arguments go to `furrow run`.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/furrow.sh"

"$here/install_dependencies.sh"
# Without the tests the first build takes little more than half the time.
"$here/build.sh" --packages-up-to furrow_cli --cmake-args -DBUILD_TESTING=OFF

arguments=("$@")
has_option --clock "$@" || arguments+=(--clock lockstep)
has_option --length "$@" || arguments+=(--length 20)
has_option --out "$@" || arguments+=(--out "$furrow_root/out/demo")
furrow run --no-dds "${arguments[@]}"
