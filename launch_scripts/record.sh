#!/usr/bin/env bash
# Records all topics of the running system into recording_DATE_TIME_0.mcap, until Ctrl-C. Arguments go
# to `furrow record`.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/furrow.sh"
furrow record "$@"
