#!/usr/bin/env bash
# Writes the reference documents that are made from the code.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../launch_scripts/furrow.sh"
reference=$furrow_root/docs/reference

furrow graph topics >"$reference/topics.md.new"
furrow params describe --markdown >"$reference/parameters.md.new"
for document in topics parameters; do
  mv "$reference/$document.md.new" "$reference/$document.md"
done
