"""Vehicles, settings, missions, and gains."""
import json
import pathlib
import os
import subprocess
import unittest

import numpy as np

import swiftlet

ROOT = pathlib.Path(__file__).resolve().parents[2]
SWIFTLET = pathlib.Path(os.environ["SWIFTLET_BUILD"]) / "bin" / "swiftlet"


class Vehicles(unittest.TestCase):
    def test_reads_a_vehicle_by_name_and_by_path(self):
        by_name = swiftlet.load_vehicle("kaylion")
        by_path = swiftlet.load_vehicle(str(ROOT / "config" / "vehicles" / "kaylion.yaml"))
        self.assertEqual(by_name.mass_kg, 0.04)
        np.testing.assert_array_equal(by_name.inertia, by_path.inertia)
        self.assertEqual([mount.spin for mount in by_name.rotors].count("clockwise"), 2)

    def test_arrays_are_replaced_as_a_whole(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        with self.assertRaises(ValueError):
            vehicle.inertia[0, 0] *= 2.0  # would be lost if it were a copy
        vehicle.inertia = vehicle.inertia * [[2, 1, 1], [1, 1, 1], [1, 1, 1]]
        self.assertEqual(vehicle.inertia[0, 0], 2.0 * swiftlet.load_vehicle("kaylion").inertia[0, 0])

    def test_a_copy_is_independent(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        other = vehicle.copy()
        other.motor.k2 = 1.0
        self.assertNotEqual(vehicle.motor.k2, 1.0)

    def test_rotors_are_replaced_as_a_whole(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        with self.assertRaises(ValueError):
            vehicle.rotors[0].position_frd[0] = 1.0
        vehicle.rotors = [swiftlet.RotorMount(2.0 * mount.position_frd, mount.spin) for mount in vehicle.rotors]
        self.assertAlmostEqual(np.linalg.norm(vehicle.rotors[0].position_frd), 0.139, places=6)

    def test_says_which_rules_a_vehicle_breaks(self):
        vehicle = swiftlet.load_vehicle("kaylion")
        self.assertEqual(vehicle.validate(), [])
        vehicle.mass_kg = -1.0
        self.assertEqual([(one.key, one.message) for one in vehicle.validate()],
                         [("mass", "is -1, must be a finite number above 0")])

    def test_a_written_vehicle_reads_back(self):
        vehicle = swiftlet.load_vehicle("crazyflie2")
        vehicle.mass_kg = 0.0315
        again = swiftlet.parse_vehicle(vehicle.text("Heavier."))
        self.assertEqual(again.mass_kg, 0.0315)
        np.testing.assert_array_equal(again.inertia, vehicle.inertia)
        self.assertEqual(again.battery.open_circuit_voltage_v, vehicle.battery.open_circuit_voltage_v)

    def test_bad_input_is_one_sentence(self):
        with self.assertRaisesRegex(swiftlet.InputError, "^No vehicle 'kaylon'. Did you mean 'kaylion'"):
            swiftlet.load_vehicle("kaylon")
        text = swiftlet.load_vehicle("kaylion").text().replace("time_constant", "time_konstant")
        with self.assertRaisesRegex(swiftlet.InputError, r"^mine:\d+: motor\..*time_[ck]onstant"):
            swiftlet.parse_vehicle(text, "mine")
        with self.assertRaises(ValueError, msg="InputError is one"):
            swiftlet.load_vehicle("kaylon")


class Settings(unittest.TestCase):
    def test_are_those_of_the_files(self):
        control, simulation = swiftlet.load_control(), swiftlet.load_simulation()
        control.estimator.detectors.recovery.poses = 7
        control.failsafe.ground_link_action = "hold"
        simulation.gps.rate_hz = 5.0
        self.assertEqual(control.estimator.detectors.recovery.poses, 7)
        self.assertEqual(control.failsafe.ground_link_action, "hold")
        self.assertEqual((control.validate(), simulation.validate()), ([], []))
        with self.assertRaisesRegex(swiftlet.InputError, "ground_link_action is 'pray', must be 'none', 'hold' or 'land'"):
            control.failsafe.ground_link_action = "pray"
        control.failsafe.battery_delay_s = -1.0
        self.assertEqual([one.key for one in control.validate()], ["failsafe.battery_delay_s"])


class Gains(unittest.TestCase):
    def test_equal_those_of_the_command(self):
        for vehicle, control in (("kaylion", "motor_lag"), ("crazyflie2", "paper")):
            command = [SWIFTLET, "gains", "--vehicle", vehicle, "--control", control]
            shown = subprocess.run([*command, "--json"], capture_output=True, text=True, check=True).stdout
            self.assertEqual(swiftlet.gains(vehicle, control), json.loads(shown))
            table = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            self.assertEqual(swiftlet.gains_table(vehicle, control), table)

    def test_follow_changed_models(self):
        vehicle, control = swiftlet.load_vehicle("kaylion"), swiftlet.load_control("motor_lag")
        before = swiftlet.gains(vehicle, control)
        self.assertEqual(before["attitude"], swiftlet.gains()["attitude"])
        control.attitude.roll.q = control.attitude.roll.q * [4.0, 1.0, 1.0]
        after = swiftlet.gains(vehicle, control)
        self.assertAlmostEqual(after["attitude"]["roll"]["k"][0], 2.0 * before["attitude"]["roll"]["k"][0], places=6)
        self.assertLess(after["attitude"]["roll"]["phase_margin_deg"], before["attitude"]["roll"]["phase_margin_deg"])

    def test_name_unstable_loops(self):
        control = swiftlet.load_control("paper")
        self.assertEqual(swiftlet.unstable_loops("kaylion", control), [])
        control.attitude.roll.q = control.attitude.roll.q * 1e6
        self.assertIn("attitude.roll", [loop.key for loop in swiftlet.unstable_loops("kaylion", control)])

    def test_refuse_weights_that_break_a_rule(self):
        control = swiftlet.load_control()
        control.attitude.roll.r = 0.0
        with self.assertRaisesRegex(swiftlet.InputError, "attitude.roll"):
            swiftlet.gains("kaylion", control)


class Missions(unittest.TestCase):
    def test_reads_files_and_texts(self):
        self.assertEqual(swiftlet.load_mission("square").name, "square")
        with self.assertRaisesRegex(swiftlet.InputError, "^mission:1"):
            swiftlet.parse_mission("items: []\n")

    def test_makes_a_mission_of_positions(self):
        mission = swiftlet.waypoint_mission([[0, 0, -1], [1, 0, -1], [1, 1, -1.2]], name="corner")
        self.assertEqual((mission.name, mission.item_count), ("corner", 5))
        for wrong, why in (([0, 0, -1], "shape"), ([[0, 0, np.nan]], "finite"), ([[0, 0, -1], [9, 0, -1]], "fence|limit")):
            with self.assertRaisesRegex(swiftlet.InputError, why):
                swiftlet.waypoint_mission(wrong)
