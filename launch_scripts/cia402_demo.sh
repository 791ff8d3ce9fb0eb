#!/usr/bin/env bash
# Runs the weeding graph in real time against four simulated CiA 402 drives, programs of their own
# that speak Modbus TCP on the loopback (ports 1502 to 1505). Arguments go to `furrow run`, but for
# --profile-only: drives that offer no cyclic positions.
set -euo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/furrow.sh"

drive=$furrow_root/install/furrow_actuation/bin/cia402_drive_simulator
[[ -x $drive ]] || drive=$furrow_root/install/bin/cia402_drive_simulator # colcon's --merge-install
if [[ ! -x $drive ]]; then
  echo "cia402_demo.sh: Furrow is not built yet; run $here/build.sh" >&2
  exit 2
fi

options=()
if [[ ${1-} == --profile-only ]]; then
  options=("$1")
  shift
fi
# A drive has a processor of its own: it must answer in time, whatever this computer does.
realtime=()
if chrt --fifo 50 true 2>/dev/null; then realtime=(chrt --fifo 50); fi
drives=()
trap 'kill "${drives[@]}" 2>/dev/null || true; wait' EXIT
for port in 1502 1503 1504 1505; do
  "${realtime[@]}" "$drive" "${options[@]}" "$port" &
  drives+=($!)
done

arguments=("$@")
has_option --length "$@" || arguments+=(--length 10)
has_option --out "$@" || arguments+=(--out "$furrow_root/out/cia402_demo")
furrow run --graph weeding_cia402 --clock real --no-dds "${arguments[@]}"
