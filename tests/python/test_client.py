"""A flight over the network by the client: processes of the simulation, requests, streams, setpoints, a mission."""
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np

import swiftlet

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = pathlib.Path(os.environ["SWIFTLET_BUILD"]) / "bin"
sys.path.insert(0, str(ROOT / "tests" / "docs"))
sys.path.insert(0, str(ROOT / "docs" / "site"))
from run_commands import lock_domain  # noqa: E402

PATIENCE_S = 60.0


class Client(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.domain, cls.lock = lock_domain()
        cls.folder = tempfile.TemporaryDirectory()
        cls.context = swiftlet.Context(cls.domain, open_network=False)

    @classmethod
    def tearDownClass(cls):
        os.close(cls.lock)
        cls.folder.cleanup()

    def setUp(self):
        self.running = []

    def tearDown(self):
        for process in self.running:
            process.send_signal(signal.SIGTERM)
        for process in self.running:
            process.wait(PATIENCE_S)

    def start(self, *programs):
        for name in programs:
            with open(f"{self.folder.name}/{name}.log", "w", encoding="utf-8") as log:
                self.running.append(subprocess.Popen([PROGRAMS / name, "--domain", str(self.domain), "--localhost-only"],
                                                     stdout=log, stderr=subprocess.STDOUT))

    def test_says_what_it_found_instead_of_a_controller(self):
        vehicle = swiftlet.Vehicle(self.context, "kl9")
        with self.assertRaisesRegex(swiftlet.RequestError, "vehicle kl9 in domain") as refused:
            vehicle.connect(timeout_s=0.2)
        self.assertEqual(refused.exception.kind, "no_control")
        self.assertFalse(vehicle.connected)
        self.assertTrue(np.isnan(vehicle.state().position_ned_m).all())

    def test_a_wait_can_be_interrupted(self):
        vehicle = swiftlet.Vehicle(self.context, "kl9")
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            vehicle.connect(timeout_s=PATIENCE_S)
        timer.join()

    def test_waits_without_limit_and_refuses_other_times(self):
        vehicle = swiftlet.Vehicle(self.context, "kl9")
        for timeout_s in (float("nan"), -1.0, float("-inf")):
            with self.assertRaisesRegex(swiftlet.InputError, "^timeout_s is .*, must be at least 0"):
                vehicle.connect(timeout_s=timeout_s)
        timer = threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            vehicle.connect(timeout_s=float("inf"))
        timer.join()

    def test_flies(self):
        self.start("swiftlet-plant", "swiftlet-mocap", "swiftlet-control")
        vehicle = swiftlet.Vehicle(self.context)
        vehicle.connect(timeout_s=PATIENCE_S)
        self.assertTrue(vehicle.wait_until(lambda state: state.has_pose, PATIENCE_S))
        self.assertEqual(self.context.discovered_vehicles(), ["kl1"])

        with self.assertRaisesRegex(swiftlet.RequestError, r"\w{3}") as refused:
            vehicle.go_to([0.0, 0.0, -1.0])
        self.assertEqual(refused.exception.kind, "refused")

        poses = swiftlet.stream(self.context, "kl1", "mocap_pose")
        estimates = swiftlet.stream(self.context, "kl1", "estimate")
        statuses = swiftlet.stream(self.context, "kl1", "control_status")
        with self.assertRaisesRegex(RuntimeError, "'nothing' is no topic of a vehicle. Topics: imu"):
            swiftlet.stream(self.context, "kl1", "nothing")

        # Other threads go on while it waits.
        ticks, ended = [], threading.Event()
        counter = threading.Thread(target=lambda: [ticks.append(1) for _ in iter(lambda: ended.wait(0.01), True)])
        counter.start()
        self.arm(vehicle)
        vehicle.take_off(0.6, timeout_s=float("inf")).wait(float("inf"))
        ended.set()
        counter.join()
        self.assertGreater(len(ticks), 50)
        self.assertEqual(vehicle.state().mode, "holding")

        vehicle.go_to([0.3, 0.0, -0.6], yaw_rad=0.2, speed_m_s=0.8).wait(PATIENCE_S)
        np.testing.assert_allclose(vehicle.state().position_ned_m, [0.3, 0.0, -0.6], atol=0.05)
        with self.assertRaises(swiftlet.RequestError) as refused:
            vehicle.go_to([90.0, 0.0, -0.6])
        self.assertRegex(str(refused.exception), "fence|limit")

        # An action that is replaced says so.
        action = vehicle.go_to([-0.5, 0.0, -0.6])
        vehicle.hold().wait(PATIENCE_S)
        with self.assertRaises(swiftlet.ActionError) as canceled:
            action.wait(PATIENCE_S)
        self.assertEqual(canceled.exception.kind, "canceled")

        before = vehicle.state().setpoints_accepted
        start_s = vehicle.clock_s
        while vehicle.clock_s < start_s + 0.5:
            self.assertTrue(vehicle.send_velocity([0.1, 0.0, 0.0]))
            estimates.next(PATIENCE_S)
        self.assertTrue(vehicle.wait_until(lambda state: state.setpoints_accepted > before, PATIENCE_S))
        self.assertTrue(vehicle.wait_until(lambda state: state.mode == "holding", PATIENCE_S))

        there = vehicle.state().position_ned_m
        text = "items:\n  - {kind: waypoint, position_m: [0, 0, -0.6], speed_m_s: 0.8}\n  - {kind: land, speed_m_s: 0.4}\n"
        mission = swiftlet.parse_mission("tolerance_m: 0.1\nframe: ned\n" + text)
        vehicle.follow(mission).wait(PATIENCE_S)
        # The status of the mission is a message of its own, which may come later than the result of the request.
        self.assertTrue(vehicle.wait_until(lambda state: state.mission_state == "completed", PATIENCE_S))
        self.assertGreater(np.linalg.norm(there - vehicle.state().position_ned_m), 0.1)
        self.assertTrue(vehicle.wait_until(lambda state: state.mode == "disarmed", PATIENCE_S))

        pose, estimate = poses.next(PATIENCE_S), estimates.next(PATIENCE_S)
        self.assertEqual((pose["position_ned"].shape, pose["q_ned_from_frd"].shape), ((3,), (4,)))
        self.assertEqual(estimate["position_ned"].shape, (3,))
        reasons = {next(statuses)["reason"] for _ in range(20)}
        self.assertTrue(reasons)
        self.assertEqual(statuses.dropped, 0)
        received = [next(poses)["stamp_ns"] for _ in range(100)]
        self.assertEqual(received, sorted(received))

    def arm(self, vehicle):
        """Until the estimate has settled, arming is refused."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            try:
                return vehicle.arm().wait(PATIENCE_S)
            except swiftlet.RequestError:
                if time.monotonic() > deadline:
                    raise
                vehicle.wait_until(lambda state: False, 0.2)
