#!/usr/bin/env bash
# Runs the weeding graph on this host with a process for each component, in real time. Arguments go
# to `furrow up`.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/furrow.sh"
furrow up --deploy distributed "$@"
