#!/usr/bin/env bash
# Writes the documents that the furrow command knows best.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../launch_scripts/furrow.sh"
furrow graph topics >"$furrow_root/docs/topics.md.new"
furrow params describe --markdown >"$furrow_root/docs/parameters.md.new"
for document in topics parameters; do
  mv "$furrow_root/docs/$document.md.new" "$furrow_root/docs/$document.md"
done
