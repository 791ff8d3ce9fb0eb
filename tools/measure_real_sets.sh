#!/usr/bin/env bash
# Measures the detectors on the real image sets that are there, each at its ground resolution.
#
#   tools/measure_real_sets.sh OUT [DATA] [options of furrow eval vision]
#
# DATA defaults to $FURROW_DATA_DIR, else ../shared/data beside the project. Writes into OUT, for each
# set, NAME.json and NAME.html (figures, best and worst images), and table.md over all sets.
set -euo pipefail

source "$(dirname "${BASH_SOURCE[0]}")/../launch_scripts/furrow.sh"
if [[ $# -lt 1 || $1 == -* ]]; then
  sed -n '2,8s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
out=$1
shift
data=${FURROW_DATA_DIR:-$furrow_root/../shared/data}
if [[ $# -gt 0 && $1 != -* ]]; then
  data=$1
  shift
fi

# mm per px. CWFID, Carrot-Weed: estimates of docs/figures.md; soybean: unknown, taken as 1.
declare -A resolution=([sb20]=2.0 [phenobench]=1.0 [sugarbeets2016]=0.3 [weedsgalore]=2.5 [cwfid]=0.11
                       [carrot_weed]=0.3 [soybean]=1.0)
mkdir -p "$out"
measured=()
for name in sb20 phenobench sugarbeets2016 weedsgalore cwfid carrot_weed soybean; do
  if [[ ! -d $data/$name ]]; then
    echo "measure_real_sets.sh: $data/$name is not there; skipped" >&2
    continue
  fi
  furrow eval vision --dataset "$data/$name" --resolution "${resolution[$name]}" --force \
    --json "$out/$name.json" --html "$out/$name.html" "$@"
  measured+=("$out/$name.json")
done
if [[ ${#measured[@]} -eq 0 ]]; then
  echo "measure_real_sets.sh: no image set in $data" >&2
  exit 1
fi
python3 - "$out/table.md" "${measured[@]}" <<'PYTHON'
import json, pathlib, sys

COLUMNS = {"vegetation": "iou_vegetation", "crop": "iou_crop", "weed": "iou_weed", "mean": "miou",
           "crops sprayed %": "crops_sprayed_pct", "weeds found %": "weeds_found_pct",
           "false per m2": "false_per_m2"}


def cell(row, key):
    if row[key] is None:
        return "-"
    low, high = row["ci95"][key]
    interval = "" if low is None else f" [{low:.3g}, {high:.3g}]"
    return f"{row[key]:.3g}{interval}"


lines = ["| " + " | ".join(["set", "images", "detector", *COLUMNS]) + " |",
         "|" + "---|" * (3 + len(COLUMNS))]
for file in sys.argv[2:]:
    for row in json.loads(pathlib.Path(file).read_text())["rows"]:
        cells = [row["dataset"], str(row["images"]), row["detector"]]
        lines.append("| " + " | ".join(cells + [cell(row, key) for key in COLUMNS.values()]) + " |")
pathlib.Path(sys.argv[1]).write_text("\n".join(lines) + "\n")
print("\n".join(lines))
PYTHON
