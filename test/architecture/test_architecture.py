"""The architecture check against made-up workspaces: a good one, and one for every rule broken."""

import pathlib
import tempfile
import unittest

import architecture

CORE_CMAKE = "find_package(furrow_cmake REQUIRED)\nfind_package(Threads REQUIRED)\n"


class ArchitectureTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.package("furrow_cmake", [], cmake="")
        self.package("furrow_core", ["furrow_cmake"], cmake=CORE_CMAKE)
        self.package("furrow_geometry", ["furrow_cmake", "furrow_core", "eigen"],
                     cmake="find_package(furrow_cmake REQUIRED)\nfind_package(furrow_core REQUIRED)\n"
                           "find_package(Eigen3 REQUIRED)\n")
        self.write("packages/furrow_core/include/furrow_core/time.hpp", "#pragma once\n")
        self.write("packages/furrow_geometry/src/pose.cpp",
                   '#include <Eigen/Core>\n#include "furrow_core/time.hpp"\n')

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def package(self, name, depends, cmake, tests=()):
        lines = [f"<depend>{other}</depend>" for other in depends]
        lines += [f"<test_depend>{other}</test_depend>" for other in tests]
        self.write(f"packages/{name}/package.xml",
                   f'<package format="3"><name>{name}</name>{"".join(lines)}</package>')
        self.write(f"packages/{name}/CMakeLists.txt", cmake)

    def assert_violations(self, *expected):
        found = list(architecture.check(self.root))
        self.assertEqual(len(found), len(expected), found)
        for violation, part in zip(found, expected):
            self.assertIn(part, violation)

    def test_good_workspace(self):
        self.assert_violations()

    def test_empty_workspace(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(len(list(architecture.check(pathlib.Path(empty)))), 1)

    def test_lower_layer_depends_on_higher(self):
        self.package("furrow_graph", ["furrow_cmake"], cmake="find_package(furrow_cmake)\n")
        self.package("furrow_geometry", ["furrow_cmake", "furrow_graph"],
                     cmake="find_package(furrow_cmake)\nfind_package(furrow_graph)\n")
        self.write("packages/furrow_geometry/src/pose.cpp", "")
        self.assert_violations("furrow_geometry: must not depend on furrow_graph")

    def test_cycle(self):
        self.package("furrow_core", ["furrow_cmake", "furrow_geometry"],
                     cmake=CORE_CMAKE + "find_package(furrow_geometry)\n")
        self.assert_violations("furrow_core: must not depend on furrow_geometry",
                               "cycle: furrow_core -> furrow_geometry -> furrow_core")

    def test_package_without_a_layer(self):
        self.package("furrow_new", [], cmake="")
        self.assert_violations("furrow_new: has no place in the layers")

    def test_cmake_finds_what_the_manifest_does_not_name(self):
        self.package("furrow_core", ["furrow_cmake"],
                     cmake=CORE_CMAKE + "find_package(PkgConfig REQUIRED)\n"
                                        "pkg_check_modules(lz REQUIRED IMPORTED_TARGET liblz4)\n")
        self.assert_violations("CMakeLists.txt finds liblz4, package.xml does not name it")

    def test_find_package_in_a_comment_does_not_count(self):
        self.package("furrow_core", ["furrow_cmake"], cmake=CORE_CMAKE + "# find_package(OpenCV)\n")
        self.assert_violations()

    def test_find_package_in_a_loop(self):
        loop = "foreach(p IN ITEMS cmake core)\n  find_package(furrow_${p} REQUIRED)\nendforeach()\n"
        self.package("furrow_field", ["furrow_cmake", "furrow_core"], cmake=loop)
        self.assert_violations()

    def test_manifest_names_what_cmake_does_not_find(self):
        self.package("furrow_core", ["furrow_cmake", "libopencv-dev"], cmake=CORE_CMAKE)
        self.assert_violations("package.xml names OpenCV, CMakeLists.txt does not find it")

    def test_fast_dds_included_outside_its_package(self):
        self.write("packages/furrow_core/src/a.cpp", "#include <fastdds/dds/topic/Topic.hpp>\n")
        self.write("packages/furrow_core/src/b.cpp", "eprosima::fastrtps::rtps::GUID_t guid;\n")
        self.assert_violations("a.cpp: includes fastdds/dds/topic/Topic.hpp",
                               "b.cpp: names Fast DDS")

    def test_fast_dds_linked_outside_its_package(self):
        self.package("furrow_core", ["furrow_cmake", "libfastrtps-dev"],
                     cmake=CORE_CMAKE + "find_package(fastrtps REQUIRED)\n")
        self.assert_violations("furrow_core: CMakeLists.txt names Fast DDS")

    def test_fast_dds_is_allowed_in_its_package(self):
        self.package("furrow_dds", ["furrow_cmake", "libfastrtps-dev"],
                     cmake="find_package(furrow_cmake)\nfind_package(fastrtps REQUIRED)\n")
        self.write("packages/furrow_dds/src/a.cpp",
                   "#include <fastdds/dds/topic/Topic.hpp>\neprosima::fastdds::dds::Topic* topic;\n")
        self.assert_violations()

    def test_algorithm_reads_yaml_or_messages(self):
        self.write("packages/furrow_geometry/src/pose.cpp",
                   "#include <yaml-cpp/yaml.h>\n#include <furrow_msgs/topics.hpp>\n")
        self.assert_violations("pose.cpp: includes yaml-cpp/yaml.h",
                               "pose.cpp: includes furrow_msgs/topics.hpp")

    def test_yaml_in_a_file_that_has_no_reason_for_it(self):
        self.package("furrow_vision", ["furrow_cmake", "yaml-cpp"],
                     cmake="find_package(furrow_cmake)\nfind_package(yaml-cpp)\n")
        yaml = "#include <yaml-cpp/yaml.h>\n"
        self.write("packages/furrow_vision/src/model_file.cpp", yaml)
        self.assert_violations()
        self.write("packages/furrow_vision/src/detector.cpp", yaml)
        self.assert_violations("detector.cpp: includes yaml-cpp/yaml.h")

    def test_test_dependency_used_in_a_library(self):
        self.package("furrow_field", ["furrow_cmake"], tests=["furrow_core"],
                     cmake="find_package(furrow_cmake)\nfind_package(furrow_core)\n")
        include = '#include "furrow_core/time.hpp"\n'
        self.write("packages/furrow_field/test/a_test.cpp", include)
        self.assert_violations()
        self.write("packages/furrow_field/src/a.cpp", include)
        self.assert_violations("src/a.cpp: includes furrow_core/time.hpp")

    def test_header_without_pragma_once(self):
        self.write("packages/furrow_core/src/a.hpp", "// #pragma once\nint a();\n")
        self.assert_violations("a.hpp: no #pragma once")

    def test_folder_and_package_have_different_names(self):
        self.write("packages/furrow_core/package.xml",
                   '<package format="3"><name>furrow_cmake</name></package>')
        self.assertIn("packages/furrow_core: holds the package 'furrow_cmake'",
                      list(architecture.check(self.root)))

    def test_library_loaded_through_another(self):
        driver = "libfurrow_component_axis_driver.so"
        needs = {driver: ["libfurrow_a.so", "libc.so.6"], "libfurrow_a.so": ["libfurrow_b.so"],
                 "libfurrow_b.so": ["libfurrow_a.so"]}
        self.assertEqual(list(architecture.check_loads(needs)), [])
        needs["libfurrow_b.so"].append("libopencv_core.so.406")
        self.assertEqual(len(list(architecture.check_loads(needs))), 1)
        self.assertIn("loads libopencv_core.so.406 through libfurrow_b.so",
                      next(architecture.check_loads(needs)))

    def test_library_that_is_missing_is_not_passed(self):
        self.assertIn("not found", next(architecture.check_loads({})))


if __name__ == "__main__":
    unittest.main()
