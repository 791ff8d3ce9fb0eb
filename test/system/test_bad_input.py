"""Bad configuration and bad files: exit code 2, a message that says where and what, nothing left."""

import unittest

from furrow_case import ROOT, FurrowCase

GRAPH = "params/graph/weeding_true_detections.yaml"
DEPLOYMENT = "params/deploy/composed.yaml"
TOOL = "urdf/bonnbot.urdf"


class BadInputTest(FurrowCase):
    def setUp(self):
        super().setUp()
        self.share = self.copy_share()

    def write(self, path, content):
        file = self.share / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(content if isinstance(content, bytes) else content.encode())
        return file

    def assert_run_refused(self, arguments, *parts, graph=GRAPH, wire=False):
        self.assert_refused(["run", *([] if wire else ["--no-dds"]), "--clock", "lockstep",
                             "--graph", self.share / graph, "--out", self.out, *arguments], *parts)

    def assert_edit_refused(self, path, old, new, *parts, arguments=()):
        """The file with one change must be refused; {line} in a part is the line of the change."""
        line = self.edit(self.share / path, old, new)
        name = path.rsplit("/", 1)[-1]
        self.assert_run_refused(arguments, name, *(p.format(line=line) for p in parts))

    # Graphs

    def test_malformed_graph(self):
        self.assert_edit_refused(GRAPH, "components:", "components: [", ".yaml:")

    def test_empty_and_binary_graph(self):
        for content in ("", bytes(range(256))):
            self.write(GRAPH, content)
            self.assert_run_refused([], "weeding_true_detections.yaml:1:")

    def test_unknown_key_in_graph(self):
        self.assert_edit_refused(GRAPH, "external:", "externals:", ":{line}: externals: unknown key")

    def test_unknown_class(self):
        self.assert_edit_refused(GRAPH, "class: scorer", "class: scorrer",
                                 ":{line}: class: unknown component class 'scorrer'")

    def test_remap_of_a_port_that_is_not_there(self):
        self.assert_edit_refused(GRAPH, "perception/instances:", "perception/instance:",
                                 ":{line}: tracker.remap.perception/instance")

    def test_required_input_without_publisher(self):
        self.assert_edit_refused(GRAPH, "remap: {perception/instances: truth/instances}", "",
                                 "tracker: input 'perception/instances' is not connected")

    def test_name_of_no_graph(self):
        self.assert_refused(["run", "--no-dds", "--graph", "nope", "--out", self.out],
                            "'nope'", "weeding", "weeding_true_detections")

    def test_graph_check_finds_the_same(self):
        line = self.edit(self.share / GRAPH, "external:", "externals:")
        self.assert_refused(["graph", "check", self.share / GRAPH], f":{line}: externals")

    # Deployments

    def assert_deployment_refused(self, text, *parts, arguments=(), wire=False):
        self.write(DEPLOYMENT, text)
        self.assert_run_refused(["--deploy", self.share / DEPLOYMENT, *arguments], *parts, wire=wire)

    def test_malformed_deployment(self):
        self.assert_deployment_refused("deployment: x\nprocesses: {a: \n", "composed.yaml:")

    def test_unknown_key_in_deployment(self):
        self.assert_deployment_refused("deployment: x\nprocess: {a: '*'}\n",
                                       "composed.yaml:2: process: unknown key")

    def test_component_in_no_process(self):
        self.assert_deployment_refused("deployment: x\nprocesses: {a: [robot]}\n", "composed.yaml:",
                                       "'camera' is in no process")

    def test_component_in_two_processes(self):
        self.assert_deployment_refused("deployment: x\nprocesses: {a: '*', b: [robot], c: [robot]}\n",
                                       "composed.yaml:", "robot", arguments=["--process", "a"])

    def test_component_that_is_not_in_the_graph(self):
        self.assert_deployment_refused("deployment: x\nprocesses: {a: [robt]}\n",
                                       "composed.yaml:2:", "'robt'")

    def test_process_that_is_not_in_the_deployment(self):
        self.assert_run_refused(["--process", "nobody"], "composed.yaml:", "'nobody'")

    def test_parameter_of_the_wire_out_of_range(self):
        self.assert_deployment_refused(
            "deployment: x\nprocesses: {a: '*'}\nwire: {domain_id: 900}\n",
            "composed.yaml:3: domain_id: 900 is out of range", wire=True)

    # Parameters

    def test_missing_parameter_file(self):
        self.edit(self.share / GRAPH, "components/planner.yaml", "components/plannner.yaml")
        self.assert_run_refused([], "plannner.yaml: no such file")

    def test_malformed_parameter_file(self):
        self.assert_edit_refused("params/components/tracker.yaml", "confirm_matches: ",
                                 "confirm_matches: [", ".yaml:")

    def test_unknown_parameter(self):
        self.assert_edit_refused("params/components/planner.yaml", "planner:", "plannner:",
                                 ":{line}: plannner: unknown parameter", "'planner'")

    def test_parameter_out_of_range(self):
        self.assert_edit_refused("params/components/tracker.yaml", "confirm_matches: ",
                                 "confirm_matches: -", ":{line}: confirm_matches:", "out of range")

    def test_parameter_that_is_no_choice(self):
        self.assert_edit_refused("params/components/planner.yaml", "view: ", "view: un",
                                 ":{line}: view:", "is not one of")

    def test_parameter_of_another_type(self):
        self.assert_edit_refused("params/components/tracker.yaml", "confirm_matches: ",
                                 "confirm_matches: three # ", ":{line}: confirm_matches:", "integer")

    def test_parameter_that_is_not_a_number(self):
        self.assert_edit_refused("params/components/robot_simulator.yaml", "speed_mps: ",
                                 "speed_mps: .nan # ", "speed_mps: is not a number")

    def test_parameter_that_stands_twice(self):
        self.assert_edit_refused("params/components/tracker.yaml", "confirm_matches: ",
                                 "confirm_matches: 3\nconfirm_matches: ", "confirm_matches:")

    def test_settings(self):
        for setting, part in (("planner.nokey=3", "nokey: unknown parameter"),
                              ("tracker.confirm_matches=-1", "out of range"),
                              ("tracker.confirm_matches=some", "integer"),
                              ("other.key=1", "other: the graph has no such component"),
                              ("common.nokey=1", "nokey"),
                              ("common.length_m=0", "out of range"),
                              ("planner", "is not COMPONENT.KEY=VALUE")):
            with self.subTest(setting):
                self.assert_run_refused(["--set", setting], f"--set {setting}", part)

    # URDF

    def test_malformed_urdf(self):
        self.assert_edit_refused(TOOL, "</robot>", "", ".urdf:")

    def test_urdf_that_lacks_a_limit(self):
        self.assert_edit_refused(TOOL, ' acceleration="50"', "", ":{line}: joint 'axis_1'",
                                 "acceleration")

    def test_missing_urdf(self):
        self.assert_run_refused(["--set", f"common.tool_file={self.share / 'none.urdf'}"],
                                "none.urdf")

    # Fields

    def test_unknown_key_in_field(self):
        path = "params/fields/cn20_like.yaml"
        self.assert_edit_refused(path, "pattern:", "patern:", ":{line}: patern: unknown parameter",
                                 arguments=["--field", self.share / path])

    def test_field_out_of_range(self):
        path = "params/fields/cn20_like.yaml"
        self.assert_edit_refused(path, "weeds_per_m2: ", "weeds_per_m2: -",
                                 ":{line}: weeds_per_m2:", "out of range",
                                 arguments=["--field", self.share / path])

    def test_malformed_field_files(self):
        whole = self.folder / "whole.csv"
        done = self.furrow("field", "generate", "--length", 2, "--out", whole)
        self.assertEqual(done.returncode, 0, done.stderr)
        lines = whole.read_text().splitlines()
        words = lines[-1].split(",")
        for name, content, part in (
                ("header.csv", "a,b\n1,2\n", "header.csv:1"),
                ("number.csv", "\n".join(lines[:-1] + [",".join(words[:1] + ["x"] * (len(words) - 1))]),
                 f"number.csv:{len(lines)}"),
                ("cut.csv", "\n".join(lines)[:-len(lines[-1]) // 2], f"cut.csv:{len(lines)}"),
                ("cut.geojson", '{"type": "FeatureCollection",\n "features": [', "cut.geojson"),
                ("binary.geojson", bytes(range(256)), "binary.geojson")):
            with self.subTest(name):
                self.assert_run_refused(["--field", self.write(name, content)], part)

    def test_name_of_no_field(self):
        self.assert_run_refused(["--field", "nope"], "'nope'", "cn20_like")

    # Photographs

    def assert_photos_refused(self, folder, *parts):
        self.assert_run_refused(["--length", 3, "--ground", f"photos:{folder}"], *parts,
                                graph="params/graph/weeding.yaml")

    def test_missing_or_empty_photo_folder(self):
        (self.folder / "empty").mkdir()
        for name in ("none", "empty"):
            self.assert_photos_refused(self.folder / name, str(self.folder / name))

    def test_truncated_photographs(self):
        for name in ("images/001_image.png", "masks/001_mask.png", "annotations/001_annotation.png"):
            self.write(f"photos/{name}", b"\x89PNG\r\n\x1a\n\0\0")
        self.write("photos/annotations/001_annotation.yaml", "annotation: []\n")
        self.assert_photos_refused(self.share / "photos", str(self.share / "photos"), "001_")

    def test_ground_of_no_kind(self):
        self.assert_run_refused(["--ground", "moon"], "--ground", "'moon'")

    def test_network_in_place_of_its_model_file(self):
        (self.folder / "net.onnx").write_bytes(b"x" * (2 << 20))
        self.assert_refused(["detect", "photo.png", "--model", "net.onnx"], "net.onnx: a network",
                            "net.yaml")

    def test_plants_on_one_line_have_no_density(self):
        (self.folder / "line.csv").write_text("kind,x_m,y_m\ncrop,0,0\nweed,1,0\nweed,2,0\n")
        done = self.furrow("field", "import", "line.csv", "--out", "field.csv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 crops, 2 weeds, on one line: no density", done.stdout)

    # The command line

    def test_bad_usage(self):
        for arguments, part in ((["--bogus"], "--bogus"), (["--clock", "sundial"], "--clock"),
                                (["--threads", "0"], "--threads"), (["--length", "-1"], "length"),
                                (["--length", "nan"], "length"), (["--length", "far"], "--length"),
                                (["--deploy", "nope"], "composed")):
            with self.subTest(arguments):
                self.assert_refused(["run", "--no-dds", "--graph", "weeding_true_detections",
                                     "--out", self.out, *arguments], part)
        self.assert_refused([], "subcommand")
        self.assert_refused(["dig"], "subcommand")

    def test_report_folder_that_is_a_file(self):
        file = self.write("file", "kept")
        self.assert_refused(["run", "--no-dds", "--graph", "weeding_true_detections",
                             "--out", file], "file")
        self.assertEqual(file.read_text(), "kept")


class ShippedFilesTest(FurrowCase):
    """The shipped files are accepted, so that a refusal above is due to its change."""

    def test_every_shipped_graph(self):
        graphs = sorted((ROOT / "params/graph").glob("*.yaml"))
        self.assertGreaterEqual(len(graphs), 2)
        for graph in graphs:
            with self.subTest(graph.name):
                done = self.furrow("graph", "check", graph)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_shipped_deployment_places_the_weeding_graph(self):
        deployments = sorted((ROOT / "params/deploy").glob("*.yaml"))
        self.assertGreaterEqual(len(deployments), 1)
        for deployment in deployments:
            with self.subTest(deployment.name):
                done = self.furrow("graph", "check", "--deploy", deployment)
                self.assertEqual(done.returncode, 0, done.stderr)

    def test_every_shipped_field(self):
        fields = sorted((ROOT / "params/fields").glob("*.yaml"))
        self.assertGreaterEqual(len(fields), 5)
        for field in fields:
            with self.subTest(field.name):
                done = self.furrow("field", "show", field, "--length", 2)
                self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
