"""What the devices do by themselves when the driver's process is killed, stopped or ended: a simulated
CiA 402 drive and a simulated output module, each a process of its own."""

import os
import re
import signal
import subprocess
import time
import unittest

from deployment_case import DeploymentCase
from furrow_case import furrow_program


def installed(name):
    """A program of furrow_actuation, in either layout of colcon's install folder."""
    prefix = furrow_program().parents[2]
    for folder in (prefix / "furrow_actuation", prefix, furrow_program().parents[1]):
        if (folder / "bin" / name).exists():
            return folder / "bin" / name
    raise FileNotFoundError(name)


class Simulator:
    """A simulated device as a process; what it says, with the time of each line."""

    def __init__(self, case, name, *arguments):
        self.log = case.folder / f"{name}_{len(list(case.folder.iterdir()))}.log"
        with open(self.log, "w", encoding="utf-8") as file:
            self.process = subprocess.Popen([installed(name), *map(str, arguments)], stdout=file,
                                            stderr=subprocess.STDOUT)
        case.addCleanup(self.stop)
        case.wait(lambda: "listening on" in self.text(), f"{name} did not start")
        self.port = int(re.search(r"listening on [\d.]+:(\d+)", self.text()).group(1))

    def text(self):
        return self.log.read_text(encoding="utf-8")

    def times(self, what):
        return [float(t) for t, rest in re.findall(r"^(\d+\.\d+) (.*)$", self.text(), re.M)
                if rest == what]

    def stop(self):
        self.process.terminate()
        self.process.wait(10)


# A driver that is restarted in time shuts its valve itself, before the module's watchdog has to.
NOT_RESTARTED = """deployment: not_restarted
processes:
  robot: {components: ["robot?", "description?"], restart: false}
  scorer: {components: ["scorer?", "markers?"], restart: false}
  driver_axis_1: {components: ["driver_axis_1"], restart: false}
  others: {components: "*", each: true}
"""


class WatchdogTest(DeploymentCase):
    DRIVE_WATCHDOG_S = 0.3
    MODULE_WATCHDOG_S = 0.5

    def wait(self, condition, message, seconds=60, up=None):
        """Waits for at most `seconds`, and no longer than `up` lives."""
        deadline = time.monotonic() + seconds
        while not condition():
            if up is not None and up.process.poll() is not None:
                self.fail(f"{message}: furrow up ended with {up.process.poll()}:\n{up.text()}")
            self.assertLess(time.monotonic(), deadline, message)
            time.sleep(0.005)

    def start(self):
        """Four axes on simulated devices; the first one's are returned, running."""
        drives = [Simulator(self, "cia402_drive_simulator", 0) for _ in range(4)]
        module = Simulator(self, "modbus_output_simulator", 0)
        settings = {f"driver_axis_{axis}.{name}": value
                    for axis, drive in enumerate(drives, 1)
                    for name, value in (("drive_port", drive.port),
                                        ("drive_watchdog_index", 8208),
                                        ("drive_watchdog_s", self.DRIVE_WATCHDOG_S),
                                        ("drive_homing_speed_mps", 0.5),
                                        # What a busy computer delays is not what is tested.
                                        ("drive_timeout_s", 0.05),
                                        ("reading_deadline_s", 0.2),
                                        ("heartbeat_deadline_s", 0.5))}
        # The output module takes one connection: the first axis'. The others' valves are simulated.
        settings |= {"driver_axis_1.valve": "modbus_coils",
                     "driver_axis_1.coil_port": module.port,
                     "driver_axis_1.coil_watchdog": "wago_750",
                     "driver_axis_1.coil_watchdog_s": self.MODULE_WATCHDOG_S}
        deployment = self.folder / "not_restarted.yaml"
        deployment.write_text(NOT_RESTARTED)
        up = self.up("--graph", "weeding_cia402", "--deploy", deployment, "--length", 40,
                     *(argument for name, value in settings.items()
                       for argument in ("--set", f"{name}={value}")))
        self.wait(lambda: drives[0].times("operation_enabled"), "the drive was not enabled", up=up)
        self.wait(lambda: module.times("coil 0 on"), "the valve was never opened", 90, up)
        return up, drives[0], module

    def after(self, simulator, what, since_s, within_s):
        """Seconds from `since_s` until the device did it."""
        self.wait(lambda: any(t >= since_s for t in simulator.times(what)),
                  f"no '{what}': {simulator.text()[-2000:]}", 20)
        took_s = min(t for t in simulator.times(what) if t >= since_s) - since_s
        print(f"{self.id().split('.')[-1]}: {what} after {1e3 * took_s:.0f} ms")
        self.assertLessEqual(took_s, within_s)
        return took_s

    def test_a_killed_driver_leaves_a_drive_that_stops_and_a_module_that_shuts(self):
        up, drive, module = self.start()
        pid = up.children()["driver_axis_1"]
        os.kill(pid, signal.SIGKILL)
        killed_s = time.time()
        # The machine's own delays are on top of the watchdogs' times.
        self.after(drive, "quick_stop_active", killed_s, self.DRIVE_WATCHDOG_S + 0.1)
        self.after(drive, "switch_on_disabled", killed_s, self.DRIVE_WATCHDOG_S + 0.4)
        self.after(module, "watchdog expired", killed_s, self.MODULE_WATCHDOG_S + 0.1)

    def test_a_stopped_driver_is_the_same(self):
        up, drive, module = self.start()
        pid = up.children()["driver_axis_1"]
        os.kill(pid, signal.SIGSTOP)
        stopped_s = time.time()
        self.addCleanup(os.kill, pid, signal.SIGCONT)
        self.after(drive, "quick_stop_active", stopped_s, self.DRIVE_WATCHDOG_S + 0.1)
        self.after(module, "watchdog expired", stopped_s, self.MODULE_WATCHDOG_S + 0.1)

    def test_at_the_end_of_the_program_the_drive_stands_without_power(self):
        up, drive, module = self.start()
        ended_s = time.time()
        up.process.send_signal(signal.SIGINT)
        self.after(drive, "switch_on_disabled", ended_s, 10.0)
        self.wait(lambda: not module.times("coil 0 on") or
                  (module.times("coil 0 off") or [0])[-1] >= module.times("coil 0 on")[-1],
                  "the coil is on")


if __name__ == "__main__":
    unittest.main()
