#!/usr/bin/env bash
# Runs the weeding graph on a recording of camera and odometry, as fast as it goes.
#
# usage: replay.sh FILE.mcap... [option of furrow run]...
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/furrow.sh"
files=()
while [[ ${1-} == *.mcap ]]; do
  files+=("$1")
  shift
done
if [[ ${#files[@]} -eq 0 ]]; then
  echo "usage: replay.sh FILE.mcap... [option of furrow run]..." >&2
  exit 2
fi
arguments=("$@")
has_option --clock "$@" || arguments+=(--clock lockstep)
has_option --out "$@" || arguments+=(--out "$furrow_root/out/replay")
furrow run --no-dds --recording "${files[@]}" "${arguments[@]}"
