#!/usr/bin/env bash
# Builds the fuzz programs with clang and runs each for some seconds from its seeds.
#
#   fuzz.sh [SECONDS] [NAME...]      SECONDS: 60; NAME: recording_mcap, recording_bag, ...
#
# A finding is left in build-fuzz/findings/ and ends this with exit code 1: mend it, and add the
# file to packages/PACKAGE/fuzz/findings/TARGET, which a test of the package runs.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
seconds=${1:-60}
shift "$(($# < 1 ? $# : 1))"

if ! command -v clang++ >/dev/null; then
  echo "fuzz.sh: needs Debian's packages clang and libclang-rt-14-dev" >&2
  exit 2
fi
# The packages that have fuzz programs, and those that they use.
launch_scripts/build.sh --profile fuzz --packages-select furrow_cmake furrow_core furrow_msgs \
  furrow_recording

found=0
findings=$PWD/build-fuzz/findings
mkdir -p "$findings"
for program in build-fuzz/*/*_fuzzer; do
  name=$(basename "$program" _fuzzer)
  if [[ $# -gt 0 && " $* " != *" $name "* ]]; then
    continue
  fi
  package=$(basename "$(dirname "$program")")
  target=${name#"${package#furrow_}"_}
  "packages/$package/fuzz/make_seeds.py" "build-fuzz/seeds/$package"
  seeds=build-fuzz/seeds/$package/$target
  if [[ -d packages/$package/fuzz/findings/$target ]]; then
    cp "packages/$package/fuzz/findings/$target"/* "$seeds"
  fi
  grown=build-fuzz/corpus/$name
  mkdir -p "$grown"
  echo "$name: $seconds s from $(find "$seeds" -type f | wc -l) seeds"
  # UBSan's and ASan's findings, memory above 512 MB and inputs of more than 10 s all end the run.
  if ! "$program" "$grown" "$seeds" -max_total_time="$seconds" -timeout=10 -rss_limit_mb=512 \
      -max_len=16384 -artifact_prefix="$findings/$name-" -print_final_stats=1 \
      >"build-fuzz/$name.log" 2>&1; then
    echo "$name: FOUND something, see build-fuzz/$name.log and $findings"
    found=1
  fi
  grep -E "stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)|cov: [0-9]+" \
    "build-fuzz/$name.log" | tail -4 | sed 's/^/  /'
done
exit "$found"
