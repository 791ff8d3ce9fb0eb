#!/usr/bin/env bash
# Writes the reference documents that are made from the code: topics, parameters, command line.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../launch_scripts/furrow.sh"
reference=$furrow_root/docs/reference
program=$furrow_root/install/furrow_cli/bin/furrow
[[ -x $program ]] || program=$furrow_root/install/bin/furrow # colcon's --merge-install

furrow graph topics >"$reference/topics.md.new"
furrow params describe --markdown >"$reference/parameters.md.new"
/usr/bin/env python3 "$furrow_root/tools/command_reference.py" "$program" \
  >"$reference/command_line.md.new"
for document in topics parameters command_line; do
  mv "$reference/$document.md.new" "$reference/$document.md"
done
