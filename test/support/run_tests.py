#!/usr/bin/env python3
"""Runs the unittest cases of one file and writes their results as a JUnit report.

    run_tests.py FILE REPORT.xml
"""

import importlib.util
import pathlib
import sys
import time
import unittest
import xml.etree.ElementTree as xml


class Report(unittest.TextTestResult):
    """Keeps one XML element for every case."""

    def __init__(self, *arguments, **options):
        super().__init__(*arguments, **options)
        self.cases = []

    def startTest(self, test):
        super().startTest(test)
        self._case = self._element(test)
        self._started = time.monotonic()

    def stopTest(self, test):
        self._case.set("time", f"{time.monotonic() - self._started:.3f}")
        super().stopTest(test)

    def addFailure(self, test, err):
        super().addFailure(test, err)
        self._mark(test, "failure", self._exc_info_to_string(err, test))

    def addError(self, test, err):
        super().addError(test, err)
        self._mark(test, "failure", self._exc_info_to_string(err, test))

    def addSubTest(self, test, subtest, err):
        super().addSubTest(test, subtest, err)
        if err:
            self._mark(test, "failure", f"{subtest}\n{self._exc_info_to_string(err, test)}")

    def addSkip(self, test, reason):
        super().addSkip(test, reason)
        self._mark(test, "skipped", reason)

    def _element(self, test):
        folder, _, name = test.id().rpartition(".")
        self.cases.append(xml.Element("testcase", classname=folder, name=name, time="0"))
        return self.cases[-1]

    def _mark(self, test, tag, text):
        # setUpClass fails or skips outside of any case.
        case = self._case if isinstance(test, unittest.TestCase) else self._element(test)
        xml.SubElement(case, tag, message=text.strip().splitlines()[-1]).text = text


def main():
    file, report = map(pathlib.Path, sys.argv[1:3])
    sys.path[:0] = [str(file.parent), str(pathlib.Path(__file__).parent)]
    specification = importlib.util.spec_from_file_location(file.stem, file)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    suite = unittest.defaultTestLoader.loadTestsFromModule(module)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2, resultclass=Report).run(suite)
    failed = sum(case.find("failure") is not None for case in result.cases)
    skipped = sum(case.find("skipped") is not None for case in result.cases)
    root = xml.Element("testsuite", name=file.stem, tests=str(len(result.cases)),
                       failures=str(failed), errors="0", skipped=str(skipped))
    root.extend(result.cases)
    report.parent.mkdir(parents=True, exist_ok=True)
    xml.ElementTree(root).write(report, encoding="utf-8", xml_declaration=True)
    return 0 if result.wasSuccessful() and result.cases else 1


if __name__ == "__main__":
    sys.exit(main())
