#!/usr/bin/env bash
# Runs clang-tidy over the packages that are built, by what the compiler was told. It takes minutes,
# so that it is not part of test/run.sh.
#
#   tidy.sh [PACKAGE...]
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
command -v clang-tidy >/dev/null || { echo "tidy.sh: clang-tidy is not installed" >&2; exit 2; }
packages=("$@")
[[ ${#packages[@]} -gt 0 ]] ||
  mapfile -t packages < <(find packages -mindepth 1 -maxdepth 1 -type d -printf '%f\n' | sort)
status=0
for package in "${packages[@]}"; do
  commands=build/$package/compile_commands.json
  if [[ ! -f $commands ]]; then
    [[ $# -eq 0 ]] && continue # a package without code
    echo "tidy.sh: $package is not built; run launch_scripts/build.sh" >&2
    exit 2
  fi
  echo "clang-tidy $package"
  python3 -c 'import json, sys
for entry in json.load(open(sys.argv[1])):
    if "/gen/" not in entry["file"] and "cmake_pch" not in entry["file"]:
        print(entry["file"], end="\0")' "$commands" |
    xargs -0 -r -n 1 -P "$(nproc)" clang-tidy --quiet -p "build/$package" 2>/dev/null || status=1
done
exit $status
