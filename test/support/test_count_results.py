"""The counting of test cases, on made-up results."""

import pathlib
import tempfile
import unittest

import count_results

CASE = '<testcase name="{0}" status="run">{1}</testcase>'
FAILURE = '<failure message="no"/>'


class CountTest(unittest.TestCase):
    TEST = ('<Test Status="{1}"><Name>{0}</Name><Results><NamedMeasurement name="Completion Status">'
            "<Value>{2}</Value></NamedMeasurement></Results></Test>")

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = pathlib.Path(folder.name)

    def write(self, path, text):
        file = self.build / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def ctest(self, package, **statuses):
        tests = "".join(self.TEST.format(name, *{"skipped": ("notrun", "SKIP_RETURN_CODE=77")}.get(
            status, (status, "Completed"))) for name, status in statuses.items())
        self.write(f"{package}/Testing/TAG", "20240101-0000\nExperimental\n")
        self.write(f"{package}/Testing/20240101-0000/Test.xml",
                   f"<Site><Testing>{tests}</Testing></Site>")

    def report(self, package, name, *cases):
        body = "".join(CASE.format(i, inner) for i, inner in enumerate(cases))
        self.write(f"{package}/test_results/{package}/{name}.gtest.xml",
                   f"<testsuites><testsuite>{body}</testsuite></testsuites>")

    def totals(self):
        return count_results.count(self.build)[0]

    def test_cases_are_counted_where_there_is_a_report(self):
        self.ctest("a", one="passed", two="failed")
        self.report("a", "one", "", "", "<skipped/>")
        self.report("a", "two", "", FAILURE)
        self.assertEqual(self.totals(), [3, 1, 1])

    def test_programs_are_counted_where_there_is_none(self):
        self.ctest("a", one="passed", two="failed", three="notrun")
        self.assertEqual(self.totals(), [1, 2, 0])

    def test_a_skipped_program_is_neither(self):
        self.ctest("a", one="skipped", two="passed")
        self.assertEqual(self.totals(), [1, 0, 1])

    def test_a_crash_counts_as_a_failure(self):
        self.ctest("a", one="failed")
        self.report("a", "one", "", "")
        self.assertEqual(self.totals(), [2, 1, 0])

    def test_a_damaged_report_does_not_hide_a_program(self):
        self.ctest("a", one="failed")
        self.write("a/test_results/a/one.gtest.xml", "<testsuites><testsui")
        self.assertEqual(self.totals(), [0, 1, 0])

    def test_missing_results_are_a_failure(self):
        self.write("a/Testing/TAG", "20240101-0000\n")
        self.assertEqual(self.totals(), [0, 1, 0])

    def test_folders_without_tests_count_nothing(self):
        self.write("a/CMakeCache.txt", "")
        self.assertEqual(self.totals(), [0, 0, 0])


if __name__ == "__main__":
    unittest.main()
