#!/usr/bin/env bash
# Fails when clang-format would change a source file, and names the files. Exit code 77, which ctest
# takes for skipped, where clang-format is not installed.
#
#   check_format.sh [ROOT]
set -euo pipefail

cd "${1-$(dirname "${BASH_SOURCE[0]}")/../..}"
if ! command -v clang-format >/dev/null; then
  echo "SKIPPED: clang-format is not installed (apt-get install clang-format)"
  exit 77
fi
find packages -type f \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  if xargs -0 -r clang-format --dry-run --Werror 2>&1 |
    sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: error: .*/\1/p' | sort -u | grep .; then
    echo "These files are not formatted; run: clang-format -i FILE"
    exit 1
  fi
