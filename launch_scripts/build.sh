#!/usr/bin/env bash
# Builds the workspace. Names the packages that it builds, and shows output only where one fails.
#
#   build.sh [--profile release|debug|address|thread|fuzz] [colcon build arguments...]
#
# A profile is a file of tools/colcon; each builds into folders of its own.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
profile=release
if [[ ${1-} == --profile ]]; then
  profile=${2-}
  shift "$(($# < 2 ? $# : 2))"
fi
if [[ ! -f tools/colcon/$profile.yaml ]]; then
  echo "build.sh: no profile '$profile'; there are: $(cd tools/colcon && echo *.yaml | sed 's/\.yaml//g')" >&2
  exit 2
fi
export COLCON_DEFAULTS_FILE=$PWD/tools/colcon/$profile.yaml
# By default colcon lets make start no job while the load is as high as the number of cores. Its own
# jobs keep the load there, and a third of the time would be lost.
export MAKEFLAGS=${MAKEFLAGS:--j$(nproc)}
exec colcon build "$@" </dev/null
