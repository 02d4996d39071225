"""Flights in the process of Python: one, many, in steps, and without a controller."""
import contextlib
import json
import os
import pathlib
import signal
import subprocess
import tempfile
import threading
import unittest

import numpy as np

import swiftlet

SWIFTLET = pathlib.Path(os.environ["SWIFTLET_BUILD"]) / "bin" / "swiftlet"


@contextlib.contextmanager
def alarm_after(seconds):
    """SIGALRM after this time, 0: never by itself; its handler raises TimeoutError."""
    def raise_timeout(*_):
        raise TimeoutError("too late")

    before = signal.signal(signal.SIGALRM, raise_timeout)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


class Flights(unittest.TestCase):
    def test_equal_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            shown = subprocess.run([SWIFTLET, "sim", "fly", "square", "--seed", "7", "--json", "--record", f"{folder}/A"],
                                   capture_output=True, text=True, check=True).stdout
        flight = swiftlet.simulate("square", seed=7)
        mine, its = json.loads(flight.report_json()), json.loads(shown)
        for only_here in ("wall_s", "real_time_factor", "record_dir"):
            mine.pop(only_here), its.pop(only_here)
        self.assertEqual(mine, its)
        self.assertTrue(flight.completed)
        self.assertLess(flight.rms_3d_m, 0.002)

    def test_gives_arrays_that_hold_the_flight(self):
        flight = swiftlet.simulate("square")
        truth, reference = flight.truth(), flight.reference()
        rows = len(truth["stamp_ns"])
        self.assertEqual(truth["position_ned"].shape, (rows, 3))
        self.assertEqual(truth["q_ned_from_frd"].shape, (rows, 4))
        np.testing.assert_allclose(np.linalg.norm(truth["q_ned_from_frd"], axis=1), 1.0, atol=1e-9)
        np.testing.assert_allclose(np.diff(truth["time_s"]), 0.002, atol=1e-9)
        # The RMS error of the report follows from the arrays, over about the same time.
        landing_ns = reference["stamp_ns"][np.flatnonzero(np.abs(reference["position_ned"][:, 2] + 1.0) < 1e-3)[-1]]
        known = np.isin(reference["stamp_ns"], truth["stamp_ns"]) & (reference["mode"] == 4) & (
            reference["stamp_ns"] < landing_ns)
        places = np.searchsorted(truth["stamp_ns"], reference["stamp_ns"][known])
        errors = np.linalg.norm(truth["position_ned"][places] - reference["position_ned"][known], axis=1)
        self.assertAlmostEqual(np.sqrt(np.mean(errors**2)), flight.rms_3d_m, delta=0.2 * flight.rms_3d_m)
        self.assertEqual(flight.estimate()["position_ned"].shape, (len(flight.estimate()["stamp_ns"]), 3))

    def test_flies_models_that_are_in_no_file(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        vehicle.mass_kg *= 1.02
        simulation = swiftlet.load_simulation()
        simulation.air.wind_ned = [0.5, 0.0, 0.0]
        mission = swiftlet.waypoint_mission([[0, 0, -1], [1, 0, -1]])
        flight = swiftlet.simulate(mission, vehicle=vehicle, simulation=simulation)
        self.assertTrue(flight.completed, flight.reason)
        np.testing.assert_allclose(flight.truth()["position_ned"][-1, :2], [1, 0], atol=0.05)

    def test_refuses_what_cannot_be_flown(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        vehicle.mass_kg = -1.0
        for arguments, why in ((dict(vehicle=vehicle), "^vehicle: mass: is -1"),
                               (dict(vehicle=swiftlet.load_vehicle(), record="A"), "^a record holds the files"),
                               (dict(vehicle=swiftlet.load_vehicle(), dispersion="uncertainty"), "^dispersion"),
                               (dict(level="wings"), "^level is 'wings'"),
                               (dict(mission="sqare"), "^No mission 'sqare'")):
            with self.assertRaisesRegex(swiftlet.InputError, why):
                swiftlet.simulate(**arguments)

    def test_can_be_interrupted(self):
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            swiftlet.simulate_batch("square", 100_000)
        timer.join()

    def test_keep_the_exception_of_a_signal_handler(self):
        for fly in (lambda: swiftlet.simulate_batch("square", 100_000), lambda: swiftlet.Simulation().step(1e6)):
            with alarm_after(0.2), self.assertRaisesRegex(TimeoutError, "^too late$"):
                fly()

    def test_refuse_too_many_threads(self):
        with self.assertRaisesRegex(swiftlet.InputError, "^jobs is 5000, must be from 1 to 1024"):
            swiftlet.simulate_batch("square", 2, jobs=5000)


class Batches(unittest.TestCase):
    def test_do_not_depend_on_the_number_of_threads(self):
        one = swiftlet.simulate_batch("square", 6, dispersion="kaylion", jobs=1)
        two = swiftlet.simulate_batch("square", 6, dispersion="kaylion", jobs=2)
        for key in ("seed", "completed", "rms_3d_m", "peak_3d_m", "duration_s", "margins_deg", "values"):
            np.testing.assert_array_equal(one[key], two[key], key)
        self.assertEqual(one["margins_deg"].shape, (6, 6))
        self.assertEqual(one["values"].shape, (6, len(one["parameters"])))
        self.assertGreater(np.ptp(one["rms_3d_m"]), 0.0)

    def test_a_run_repeats_as_a_flight(self):
        batch = swiftlet.simulate_batch("square", 3, dispersion="kaylion", seed=5)
        flight = swiftlet.simulate("square", dispersion="kaylion", seed=6)
        self.assertEqual(flight.rms_3d_m, batch["rms_3d_m"][1])

    def test_other_threads_go_on(self):
        ticks, ended = [], threading.Event()

        def count():
            while not ended.is_set():
                ticks.append(1)
                ended.wait(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        before = len(ticks)
        swiftlet.simulate_batch("square", 8, jobs=1)
        during = len(ticks) - before
        ended.set()
        thread.join()
        self.assertGreater(during, 10, "a batch of 8 takes 0.3 s: the GIL was not released")


class Steps(unittest.TestCase):
    def fly(self, seed):
        simulation = swiftlet.Simulation("kaylion", seed=seed)
        with self.assertRaises(swiftlet.RequestError) as refused:
            simulation.take_off(1.0)
        self.assertEqual(refused.exception.kind, "refused")
        simulation.step(1.0)
        simulation.arm()
        simulation.step(0.5)
        simulation.take_off(1.0)
        simulation.step(6.0)
        self.assertEqual(simulation.mode, "holding")
        simulation.go_to([0.5, 0.0, -1.0], yaw_rad=0.3)
        simulation.step(6.0)
        np.testing.assert_allclose(simulation.state()["position_ned"], [0.5, 0.0, -1.0], atol=0.01)
        for _ in range(20):
            simulation.send_velocity([0.0, 0.2, 0.0])
            simulation.step(0.05)
        self.assertGreater(simulation.state()["velocity_ned"][1], 0.1)
        simulation.hold()
        simulation.step(3.0)
        simulation.land()
        simulation.step(8.0)
        self.assertEqual(simulation.mode, "disarmed")
        return np.concatenate([simulation.state()["position_ned"], simulation.estimate()["position_ned"]])

    def test_fly_by_requests_and_setpoints_and_repeat(self):
        first = self.fly(1)
        np.testing.assert_array_equal(first, self.fly(1))
        self.assertFalse(np.array_equal(first, self.fly(2)))


    def test_refuse_times_that_are_none(self):
        simulation = swiftlet.Simulation()
        for duration_s in (float("inf"), float("nan"), -1.0, 1e300):
            with self.assertRaisesRegex(swiftlet.InputError, "^duration_s is "):
                simulation.step(duration_s)
        self.assertEqual(simulation.time_s, 0.0)
        with self.assertRaisesRegex(swiftlet.InputError, "^step_s "):
            swiftlet.load_simulation().step_s = float("nan")

    def test_refuse_a_second_thread(self):
        simulation, refusals = swiftlet.Simulation(), []

        def look():
            while not refusals:
                try:
                    simulation.state()
                except RuntimeError as error:
                    refusals.append(str(error))
            os.kill(os.getpid(), signal.SIGALRM)

        thread = threading.Thread(target=look, daemon=True)
        with alarm_after(0), self.assertRaises(TimeoutError):
            thread.start()
            simulation.step(1e6)
        thread.join()
        self.assertIn("another thread uses this object", refusals[0])
        self.assertGreater(simulation.state()["time_s"], 0.0)


class OpenLoop(unittest.TestCase):
    def test_falls_and_climbs_by_the_pulses(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        low = vehicle.esc.pulse_min_us
        high = low + vehicle.esc.pulse_range_us
        start = np.zeros(17)
        start[6] = 1.0
        moved = {}
        for name, pulse in (("low", low), ("high", high)):
            motion = swiftlet.simulate_open_loop(vehicle, [0.0, 0.5], np.full((2, 4), pulse), initial=start)
            self.assertEqual(motion["position_ned"].shape, (501, 3))
            self.assertEqual(motion["rotor_speeds"].shape, (501, 4))
            moved[name] = motion["position_ned"][-1, 2]
        self.assertGreater(moved["low"], 0.5)
        self.assertLess(moved["high"], 0.0)

    def test_refuses_wrong_shapes_and_pulses(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        for times, pulses, why in (([0.0, 1.0], np.zeros((2, 3)), "shape"), ([0.0], np.zeros((1, 4)), "2 rows"),
                                   ([0.0, 1.0], np.zeros((2, 4)), "pwm1: is 0"), ([1.0, 0.0], np.full((2, 4), 1500.0), "t: is 0")):
            with self.assertRaisesRegex(swiftlet.InputError, why):
                swiftlet.simulate_open_loop(vehicle, times, pulses)
