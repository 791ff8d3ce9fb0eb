#!/usr/bin/env python3
"""Holds the workspace against its architecture and prints what breaks it.

    architecture.py [ROOT] [--install PREFIX]

Checked: the layers of the packages and that they have no cycle, package.xml against CMakeLists.txt
and against the includes, where Fast DDS and other libraries may be used, and `#pragma once`. With
--install also the libraries that the built ones link. Exit code 1 when something breaks the rules.
The size of files and functions is checked by test/format/check_language.py.
"""

import argparse
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as xml

SOURCE_SUFFIXES = {".hpp", ".h", ".cpp", ".cc", ".cxx"}

ALGORITHMS = {
    "furrow_core", "furrow_geometry", "furrow_annotation", "furrow_field", "furrow_vision",
    "furrow_localization", "furrow_tracking", "furrow_planning", "furrow_actuation", "furrow_simulation", "furrow_ledger",
}
# What a package may depend on; a package that is not here has no place yet.
BASE = {"furrow_cmake", "furrow_core"}
GEOMETRIC = BASE | {"furrow_geometry"}
SYSTEM = BASE | {"furrow_log", "furrow_msgs", "furrow_graph", "furrow_configuration", "furrow_dds"}
LAYERS = {
    "furrow_cmake": set(),
    "furrow_core": {"furrow_cmake"},
    "furrow_geometry": BASE,
    "furrow_field": GEOMETRIC,
    "furrow_annotation": GEOMETRIC,
    "furrow_vision": GEOMETRIC | {"furrow_annotation"},
    "furrow_localization": GEOMETRIC,
    "furrow_tracking": GEOMETRIC,
    "furrow_planning": GEOMETRIC,
    "furrow_actuation": GEOMETRIC,
    "furrow_simulation": GEOMETRIC | {"furrow_field", "furrow_actuation"},
    "furrow_ledger": GEOMETRIC | {"furrow_field"},
    "furrow_log": BASE,
    "furrow_msgs": BASE,
    "furrow_graph": BASE | {"furrow_log", "furrow_msgs"},
    "furrow_configuration": BASE | {"furrow_graph"},
    "furrow_dds": BASE | {"furrow_log", "furrow_msgs", "furrow_graph"},
    "furrow_recording": BASE | {"furrow_msgs", "furrow_graph", "furrow_dds"},
    "furrow_components": ALGORITHMS | BASE | {"furrow_msgs", "furrow_graph", "furrow_configuration"},
    "furrow_experiments": ALGORITHMS | BASE | {"furrow_msgs", "furrow_graph", "furrow_components"},
    "furrow_launch": SYSTEM | {"furrow_components", "furrow_ledger", "furrow_field",
                               "furrow_geometry", "furrow_recording"},
    "furrow_supervisor": SYSTEM | {"furrow_actuation", "furrow_launch", "furrow_components"},
    "furrow_evaluation": ALGORITHMS | SYSTEM | {"furrow_components", "furrow_launch"},
    "furrow_diagnosis": SYSTEM | {"furrow_components", "furrow_geometry", "furrow_launch",
                                  "furrow_vision"},
    "furrow_benchmarks": SYSTEM | {"furrow_evaluation", "furrow_launch", "furrow_recording",
                                   "furrow_supervisor", "furrow_vision"},
    "furrow_cli": ALGORITHMS | SYSTEM | {"furrow_benchmarks", "furrow_components",
                                         "furrow_diagnosis",
                                         "furrow_evaluation", "furrow_experiments",
                                         "furrow_launch", "furrow_recording",
                                         "furrow_supervisor"},
    "furrow_system_tests": {"furrow_cli"},
}

# Libraries that only some packages may use: include path, CMake name, those packages.
RESTRICTED = [
    ("Fast DDS", re.compile(r"^(fastdds|fastrtps)/"), {"fastrtps", "fastdds"}, {"furrow_dds"}),
    ("Fast CDR", re.compile(r"^fastcdr/"), {"fastcdr"}, {"furrow_dds", "furrow_msgs"}),
    ("yaml-cpp", re.compile(r"^yaml-cpp/"), {"yaml-cpp"},
     {"furrow_annotation", "furrow_configuration", "furrow_recording", "furrow_vision"}),
    ("spdlog", re.compile(r"^spdlog/"), {"spdlog"}, {"furrow_log"}),
    ("CLI11", re.compile(r"^CLI/"), {"CLI11"}, {"furrow_cli"}),
]
# Where a package's use is for one purpose only.
RESTRICTED_FILES = {
    # spdlog's headers take seconds to compile.
    ("furrow_log", "spdlog"): {"packages/furrow_log/src/spdlog_sinks.cpp"},
    # The annotations of this data set are YAML.
    ("furrow_annotation", "yaml-cpp"): {"packages/furrow_annotation/src/cwfid.cpp"},
    ("furrow_vision", "yaml-cpp"): {"packages/furrow_vision/src/model_file.cpp"},
}
DDS_NAMES = re.compile(r"\beprosima::(fastdds|fastrtps)\b")

# package.xml has the keys of rosdep; CMake has names of its own.
CMAKE_NAMES = {
    "cyclonedds-dev": "CycloneDDS",
    "eigen": "Eigen3",
    "libbz2-dev": "BZip2",
    "libbenchmark-dev": "benchmark",
    "libcli11-dev": "CLI11",
    "libconsole-bridge-dev": "console_bridge",
    "libdeflate-dev": "libdeflate",
    "libfastcdr-dev": "fastcdr",
    "libfastrtps-dev": "fastrtps",
    "liblemon-dev": "LEMON",
    "liblz4-dev": "liblz4",
    "libgeographiclib-dev": "geographiclib",
    "libpng-dev": "libpng",
    "libsqlite3-dev": "sqlite3",
    "libturbojpeg0-dev": "libturbojpeg",
    "libgpiod-dev": "libgpiod",
    "libmodbus-dev": "libmodbus",
    "libopencv-dev": "OpenCV",
    "libspdlog-dev": "spdlog",
    "liburdfdom-dev": "urdfdom",
    "libyaml-cpp-dev": "yaml-cpp",
    "libzstd-dev": "libzstd",
    "nlohmann-json-dev": "nlohmann_json",
}
# Of the compiler, or found by furrow_package().
CMAKE_IGNORED = {"Threads", "PkgConfig", "Python3", "GTest"}

# Libraries that must not be loaded, directly or through others: pattern and reason.
LOAD_LIMITS = {
    "libfurrow_component_axis_driver.so": (
        re.compile(r"libopencv_|libfurrow_(ledger|field|vision|simulation|planning|tracking)\."),
        "an axis driver runs on a small computer"),
}

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
FOREACH = re.compile(r"foreach\((\w+)\s+IN\s+ITEMS\s+([^)]*)\)(.*?)endforeach\(\)", re.DOTALL)
FIND = re.compile(r"find_package\(\s*([\w.+-]+)|pkg_check_modules\(\s*\w+\s+(?:(?:REQUIRED|"
                  r"IMPORTED_TARGET|QUIET)\s+)*([\w.+-]+)|find_path\(\s*(\w+)_INCLUDE_DIR")


class Package:
    """A package of the tree: its manifest, its CMake code, its sources."""

    def __init__(self, folder):
        self.folder = folder
        manifest = xml.parse(folder / "package.xml").getroot()
        self.name = manifest.findtext("name", "").strip()

        def names(*tags):
            return {e.text.strip() for tag in tags for e in manifest.iter(tag) if e.text}

        self.depends = names("depend", "build_depend", "build_export_depend", "exec_depend")
        self.test_depends = names("test_depend")
        self.runtime_only = names("exec_depend") - names("depend", "build_depend")
        cmake = folder / "CMakeLists.txt"
        text = cmake.read_text() if cmake.exists() else ""
        text = re.sub(r"#[^\n]*", "", text)
        self.cmake = FOREACH.sub(
            lambda loop: "\n".join(loop[3].replace("${" + loop[1] + "}", item)
                                   for item in loop[2].split()), text)
        self.found = {next(filter(None, groups)) for groups in FIND.findall(self.cmake)}
        self.sources = sorted(path for path in folder.rglob("*") if path.is_file() and
                              path.suffix in SOURCE_SUFFIXES | {".py"})


def load_packages(root):
    manifests = sorted(root.glob("packages/*/package.xml")) + sorted(root.glob("test/package.xml"))
    return [Package(path.parent) for path in manifests]


def check_layers(packages):
    names = {package.name for package in packages}
    graph = {p.name: (p.depends | p.test_depends) & names for p in packages}
    for name, depends in graph.items():
        if name not in LAYERS:
            yield f"{name}: has no place in the layers (test/architecture/architecture.py)"
            continue
        for other in sorted(depends - LAYERS[name]):
            yield f"{name}: must not depend on {other}"
    done, path = set(), []

    def visit(name):
        if name in path:
            return path[path.index(name):] + [name]
        if name in done:
            return None
        path.append(name)
        for other in sorted(graph[name]):
            if cycle := visit(other):
                return cycle
        path.pop()
        done.add(name)
        return None

    for name in sorted(graph):
        if cycle := visit(name):
            yield "cycle: " + " -> ".join(cycle)
            return


def check_manifest(package):
    if not package.cmake:
        return
    listed = package.depends | package.test_depends
    declared = {CMAKE_NAMES.get(name, name) for name in listed - package.runtime_only}
    found = package.found - CMAKE_IGNORED
    for name in sorted(found - declared):
        yield f"{package.name}: CMakeLists.txt finds {name}, package.xml does not name it"
    for name in sorted(declared - found):
        yield f"{package.name}: package.xml names {name}, CMakeLists.txt does not find it"


def check_source(package, path, shown):
    text = path.read_text(errors="replace")
    if path.suffix == ".py":
        return
    if path.suffix in {".hpp", ".h"} and not re.search(r"^#pragma once$", text, re.MULTILINE):
        yield f"{shown}: no #pragma once"
    if package.name != "furrow_dds" and DDS_NAMES.search(text):
        yield f"{shown}: names Fast DDS"
    inside = path.relative_to(package.folder).parts[0] in {"test", "bench"}
    known = package.depends | {package.name} | (package.test_depends if inside else set())
    for include in INCLUDE.findall(text):
        owner = include.split("/")[0]
        if owner.startswith("furrow_") and "/" in include and owner not in known:
            yield f"{shown}: includes {include}, but package.xml does not name {owner}"
        for library, pattern, _, users in RESTRICTED:
            if not pattern.match(include):
                continue
            files = RESTRICTED_FILES.get((package.name, library))
            if package.name not in users or (files is not None and shown not in files):
                yield f"{shown}: includes {include}; {library} is for {', '.join(sorted(users))}"


def check_links(package):
    words = set(re.findall(r"[\w.+-]+", package.cmake))
    for library, _, cmake_names, users in RESTRICTED:
        if package.name not in users and words & cmake_names:
            yield f"{package.name}: CMakeLists.txt names {library}, which is for " + \
                ", ".join(sorted(users))


def loaded(name, needs):
    """The libraries that `name` loads, directly or not, each with the library that loads it."""
    found, waiting = {}, [name]
    while waiting:
        user = waiting.pop()
        for library in needs.get(user, []):
            if library not in found:
                found[library] = user
                waiting.append(library)
    return found


def check_loads(needs):
    """Libraries that must not be loaded. `needs`: the direct dependencies of each library."""
    for name, (pattern, reason) in LOAD_LIMITS.items():
        if name not in needs:
            yield f"{name}: not found, so its libraries cannot be checked"
        for library, user in sorted(loaded(name, needs).items()):
            if pattern.match(library):
                yield f"{name}: loads {library} through {user}; {reason}"


def check_binaries(install):
    """What the built libraries and programs need, as the linker wrote it down."""
    needs = {}
    for path in sorted([*install.glob("furrow_*/lib/*.so"), *install.glob("furrow_*/bin/*")]):
        package = path.relative_to(install).parts[0]
        dynamic = subprocess.run(["readelf", "--dynamic", str(path)], capture_output=True,
                                 text=True, check=False).stdout
        needs[path.name] = re.findall(r"\(NEEDED\).*\[(.*)\]", dynamic)
        for needed in needs[path.name]:
            if re.match(r"libfast(rtps|dds)\.", needed) and package != "furrow_dds":
                yield f"{path.relative_to(install)}: links {needed}"
            if package in ALGORITHMS and re.match(r"libfurrow_(graph|msgs|dds)\.", needed):
                yield f"{path.relative_to(install)}: an algorithm library links {needed}"
    yield from check_loads(needs)


def check(root):
    """Every violation below `root`, in the order of the packages."""
    packages = load_packages(root)
    if not packages:
        yield f"{root}: no packages found"
    yield from check_layers(packages)
    for package in packages:
        if package.folder.name not in {package.name, "test"}:
            yield f"{package.folder.relative_to(root)}: holds the package '{package.name}'"
        yield from check_manifest(package)
        yield from check_links(package)
        for path in package.sources:
            yield from check_source(package, path, path.relative_to(root).as_posix())


def main():
    parser = argparse.ArgumentParser(description="Checks the architecture of the workspace.")
    parser.add_argument("root", type=pathlib.Path, nargs="?",
                        default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("--install", type=pathlib.Path, help="also check the binaries there")
    arguments = parser.parse_args()
    violations = list(check(arguments.root))
    if arguments.install:
        violations += check_binaries(arguments.install)
    for violation in violations:
        print(violation)
    print(f"{len(violations)} violations of the architecture")
    return 1 if violations else 0


if __name__ == "__main__":
    sys.exit(main())
