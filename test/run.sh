#!/usr/bin/env bash
# Installs what is missing, builds, runs every test, and closes with "N passed, N failed".
#
#   run.sh [--profile release|debug|address|thread] [colcon arguments, such as --packages-select X]
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
profile=release
if [[ ${1-} == --profile ]]; then
  profile=${2-}
  shift "$(($# < 2 ? $# : 2))"
fi
launch_scripts/install_dependencies.sh
launch_scripts/build.sh --profile "$profile" "$@"

build=build
[[ $profile == release ]] || build=build-$profile
# Fast DDS deletes some objects by another size than it allocated them with.
export ASAN_OPTIONS=new_delete_type_mismatch=0${ASAN_OPTIONS:+:$ASAN_OPTIONS}
export TSAN_OPTIONS=suppressions=$PWD/tools/sanitizers/thread.supp${TSAN_OPTIONS:+:$TSAN_OPTIONS}
export COLCON_DEFAULTS_FILE=$PWD/tools/colcon/$profile.yaml
export CTEST_OUTPUT_ON_FAILURE=1

# Results of an earlier run would be counted too.
rm -rf "$build"/*/Testing "$build"/*/test_results
status=0
if (($# == 0)); then
  # The system tests wait more than they compute: those of the packages go on beside them.
  colcon --log-base log/packages test --packages-skip furrow_system_tests </dev/null &
  colcon test --packages-select furrow_system_tests --ctest-args -j4 </dev/null || status=$?
  wait $! || status=$?
else
  colcon test "$@" </dev/null || status=$?
fi
colcon test-result --verbose </dev/null || status=1
/usr/bin/env python3 test/support/count_results.py "$build" || status=1
exit "$status"
