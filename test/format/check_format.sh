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
# clang-format says by its exit code only that something is wrong: the files are in what it writes.
# It fails without such a line where it cannot read a file or the style.
status=0
said=$(find packages -type f \( -name '*.hpp' -o -name '*.cpp' \) -print0 |
  xargs -0 -r clang-format --dry-run --Werror 2>&1) || status=1
sed -n 's/^\([^:]*\):[0-9]*:[0-9]*: error: .*/\1/p' <<<"$said" | sort -u
if ((status != 0)); then
  grep -q ': error: ' <<<"$said" || echo "$said"
  echo "These files are not formatted; run: clang-format -i FILE"
  exit 1
fi
