#!/usr/bin/env python3
"""Measures what a stop of the robot costs: the loss of rows with and without it, in lock-step.

    measure_standstill.py OUT [--rows N] [--draws N] [--length M] [--graph GRAPH] [--journeys NAME ...]

Two runs of one row differ by the noise of motion and sensors alone, by a point and more. So each row
is driven several times with noise of its own (`draws`), with and without the stop, and the means are
compared. Writes the reports of the runs, results.json and table.md into OUT.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]

# For each journey: times, speeds, and the stretches of time in which the robot stands or reverses.
# The stops begin over the weeds, at some 3 m of the row.
JOURNEYS = {
    "stop": ([0, 9, 10, 70, 71, 300], [0.5, 0.5, 0.0, 0.0, 0.5, 0.5], [(10, 70)]),
    "roll": ([0, 9, 10, 12, 12.5, 14.5, 15, 20, 21, 300],
             [0.5, 0.5, 0.0, 0.0, -0.12, -0.12, 0.0, 0.0, 0.5, 0.5], [(10, 20)]),
    "three": ([0, 7, 8, 13, 14, 16, 17, 22, 23, 25, 26, 31, 32, 300],
              [0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0.5, 0.5],
              [(8, 13), (17, 22), (26, 31)]),
}


def profile(journey):
    """Options of `furrow run` for a journey."""
    times_s, speeds_mps, _ = JOURNEYS[journey]
    return ("--set", f"robot.profile_time_s={list(times_s)}",
            "--set", f"robot.profile_speed_mps={list(speeds_mps)}")


def furrow(*arguments):
    program = ROOT / "install/furrow_cli/bin/furrow"
    if not program.exists():
        program = ROOT / "install/bin/furrow"  # colcon's --merge-install
    done = subprocess.run([program, *map(str, arguments)], stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"measure_standstill.py: furrow {arguments[0]} failed:\n{done.stdout}")


def sprays_within(out, stretches):
    features = json.loads((out / "as_applied.geojson").read_text())["features"]
    times_s = [feature["properties"]["time_s"] for feature in features]
    return sum(first <= t <= last for t in times_s for first, last in stretches)


def drive(options, row, journey, draw):
    """One run: its figures."""
    field = options.out / f"row{row}.csv"
    out = options.out / journey / f"row{row}_draw{draw}"
    # The first draw is that of `furrow run --seed ROW`.
    seed = row + 1000 * draw
    furrow("run", "--no-dds", "--force", "--clock", "lockstep", "--graph", options.graph, "--field",
           field, "--length", options.length, "--seed", seed, "--out", out,
           *(profile(journey) if journey in JOURNEYS else ()))
    summary = json.loads((out / "summary.json").read_text())
    standing = JOURNEYS[journey][2] if journey in JOURNEYS else []
    return {"loss_pct": summary["loss_pct"], "crops_hit": summary["crops_hit"],
            "placement_error_p95_mm": summary["placement_error_p95_mm"],
            "sprays_standing": sprays_within(out, standing),
            "safe_states": "Safe states" in (out / "report.html").read_text()}


def mean(runs, key="loss_pct"):
    return statistics.mean(run[key] for run in runs)


def deviation(runs):
    return statistics.stdev(run["loss_pct"] for run in runs) if len(runs) > 1 else float("nan")


def table(results, options):
    names = ["without", *options.journeys]
    lines = ["| row | without a stop, % | deviation of a draw | " +
             " | ".join(f"{name}: points, standard error" for name in options.journeys) + " |",
             "|---" * (3 + len(options.journeys)) + "|"]
    for row in range(1, options.rows + 1):
        runs = results["without"][row]
        cells = [f"{mean(runs):.2f}", f"{deviation(runs):.2f}"]
        for name in options.journeys:
            stopped = results[name][row]
            error = ((deviation(runs)**2 + deviation(stopped)**2) / len(runs))**0.5
            cells.append(f"{mean(stopped) - mean(runs):+.2f}, {error:.2f}")
        lines.append(f"| {row} | " + " | ".join(cells) + " |")
    every = {name: [run for runs in results[name].values() for run in runs] for name in names}
    differences = [f"{mean(every[name]) - mean(every['without']):+.2f}" for name in options.journeys]
    lines += [f"| mean | {mean(every['without']):.2f} | | " + " | ".join(differences) + " |", ""]
    for name in names:
        lines.append(f"{name}: {len(every[name])} runs, loss {mean(every[name]):.2f} %, placement p95 "
                     f"{mean(every[name], 'placement_error_p95_mm'):.2f} mm, "
                     f"{sum(run['crops_hit'] for run in every[name])} crops hit, "
                     f"{sum(run['sprays_standing'] for run in every[name])} sprays while standing, "
                     f"{sum(run['safe_states'] for run in every[name])} runs with a safe state")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--rows", type=int, default=10, help="rows, of the seeds from 1 on")
    parser.add_argument("--draws", type=int, default=10, help="runs of each row and journey")
    parser.add_argument("--length", type=float, default=20.0, help="length of a row, m")
    parser.add_argument("--graph", default="weeding_rtk_true_detections")
    parser.add_argument("--journeys", nargs="+", choices=JOURNEYS, default=list(JOURNEYS))
    options = parser.parse_args()
    if options.rows < 1 or options.draws < 1:
        parser.error("--rows and --draws must be at least 1")
    options.out.mkdir(parents=True, exist_ok=True)
    results = {name: {} for name in ("without", *options.journeys)}
    for row in range(1, options.rows + 1):
        furrow("field", "generate", "--force", "--length", options.length, "--seed", row, "--out",
               options.out / f"row{row}.csv")
        for name, rows in results.items():
            rows[row] = [drive(options, row, name, draw) for draw in range(options.draws)]
        print(f"row {row} of {options.rows}", file=sys.stderr)
    (options.out / "results.json").write_text(json.dumps(results, indent=2) + "\n")
    text = table(results, options)
    (options.out / "table.md").write_text(text)
    print(text, end="")


if __name__ == "__main__":
    main()
