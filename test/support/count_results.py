#!/usr/bin/env python3
"""Counts the test cases of a workspace and closes with "N passed, N failed".

    count_results.py BUILD_FOLDER

ctest knows programs, their reports (GoogleTest's and JUnit's XML) know cases. A program without a
report counts as one case, as does one that failed though no case of its report did: a crash, or a
time limit. Exit code 1 when a case failed, or when there was none.
"""

import pathlib
import sys
import xml.etree.ElementTree as xml


def report_counts(report):
    """Passed, failed, skipped of a report; None when it cannot be read."""
    try:
        root = xml.parse(report).getroot()
    except (OSError, xml.ParseError):
        return None
    passed = failed = skipped = 0
    for case in root.iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None or case.get("status") == "notrun":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


def ctest_entries(build):
    """Name and status of each entry of the newest ctest run of a package's build folder."""
    tag = build / "Testing" / "TAG"
    if not tag.exists():
        return []
    results = build / "Testing" / tag.read_text().split()[0] / "Test.xml"
    try:
        tests = xml.parse(results).getroot().findall("Testing/Test")
    except (OSError, xml.ParseError):
        return [(f"{build.name} (ctest wrote no results)", "failed")]
    return [(test.findtext("Name"), "skipped" if is_skipped(test) else test.get("Status"))
            for test in tests]


def is_skipped(test):
    """Whether a program said so by its exit code; ctest calls that "not run"."""
    return any((value.findtext("Value") or "").startswith("SKIP_")
               for value in test.iter("NamedMeasurement")
               if value.get("name") == "Completion Status")


def count(build_folder):
    """Totals, and a line for every program that failed or skipped a case."""
    totals = [0, 0, 0]
    remarks = []
    for build in sorted(path for path in build_folder.iterdir() if path.is_dir()):
        for name, status in ctest_entries(build):
            report = build / "test_results" / build.name / f"{name}.gtest.xml"
            counts = report_counts(report)
            if counts is None:
                counts = (int(status == "passed"), int(status not in {"passed", "skipped"}),
                          int(status == "skipped"))
            elif status not in {"passed", "skipped"} and counts[1] == 0:
                counts = (counts[0], 1, counts[2])
            totals = [a + b for a, b in zip(totals, counts)]
            if counts[1]:
                remarks.append(f"failed: {build.name} {name}: {counts[1]}")
            if counts[2]:
                remarks.append(f"skipped: {build.name} {name}: {counts[2]}")
    return totals, remarks


def main():
    (passed, failed, _), remarks = count(pathlib.Path(sys.argv[1]))
    for remark in remarks:
        print(remark)
    print(f"{passed} passed, {failed} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main())
