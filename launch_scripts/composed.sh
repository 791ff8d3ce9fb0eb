#!/usr/bin/env bash
# Runs the weeding graph in one process, in real time. Arguments go to `furrow run`.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/furrow.sh"
furrow run --graph weeding --deploy composed "$@"
