"""Recorded flights as arrays and tables."""
import json
import os
import pathlib
import subprocess
import tempfile
import unittest

import numpy as np

import swiftlet

SWIFTLET = pathlib.Path(os.environ["SWIFTLET_BUILD"]) / "bin" / "swiftlet"


class Records(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.record = pathlib.Path(cls.folder.name) / "A"
        cls.flight = swiftlet.simulate("square", record=str(cls.record))
        cls.log = swiftlet.read_mcap(str(cls.record / "flight.mcap"))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_is_that_of_the_flight(self):
        self.assertEqual(self.flight.record, str(self.record))
        self.assertEqual(json.loads((self.record / "report.json").read_text())["rms_3d_m"], self.flight.rms_3d_m)
        truth, recorded = self.flight.truth(), self.log["/kl1/ground_truth"]
        known = np.isin(truth["stamp_ns"], recorded["stamp_ns"])
        np.testing.assert_array_equal(truth["position_ned"][known], recorded["position_ned"])

    def test_has_what_the_command_lists(self):
        shown = subprocess.run([SWIFTLET, "log", "info", self.record / "flight.mcap", "--json"], capture_output=True, text=True,
                               check=True).stdout
        counts = {row["topic"]: row["messages"] for row in json.loads(shown)["topics"] if row["messages"]}
        self.assertEqual({topic: len(columns["log_time_ns"]) for topic, columns in self.log.items()}, counts)
        self.assertEqual(swiftlet.mcap_vehicles(str(self.record / "flight.mcap")), ["kl1"])
        self.assertLessEqual(set(self.log), set(swiftlet.mcap_topics(str(self.record / "flight.mcap"))))

    def test_columns_have_the_types_of_their_messages(self):
        estimate, status = self.log["/kl1/estimate"], self.log["/kl1/control_status"]
        self.assertEqual((estimate["q_ned_from_frd"].shape[1], estimate["q_ned_from_frd"].dtype), (4, np.float64))
        self.assertEqual((estimate["stamp_ns"].dtype, estimate["poses_accepted"].dtype), (np.int64, np.uint64))
        self.assertEqual(set(status["reason"]), {"started", "requested", "landed"})

    def test_reads_only_the_topics_that_are_asked_for(self):
        log = swiftlet.read_mcap(str(self.record / "flight.mcap"), ["/kl1/battery"])
        self.assertEqual(list(log), ["/kl1/battery"])
        with self.assertRaisesRegex(swiftlet.InputError, "no_such"):
            swiftlet.read_mcap(str(self.record / "flight.mcap"), ["/kl1/no_such"])
        with self.assertRaises(swiftlet.InputError):
            swiftlet.read_mcap(str(self.record / "none.mcap"))

    def test_reads_sensors_of_a_record_and_its_file_alike(self):
        record = swiftlet.read_sensors(str(self.record))
        mcap = swiftlet.read_sensors(str(self.record / "flight.mcap"))
        self.assertEqual(record["throttle"].shape[1], 4)
        np.testing.assert_array_equal(record["specific_force_frd"], mcap["specific_force_frd"])
        self.assertEqual(record["pose_q_ned_from_frd"].shape, (len(record["pose_time_s"]), 4))

    def test_becomes_a_table(self):
        table = swiftlet.to_pandas(self.log["/kl1/estimate"])
        self.assertEqual(len(table), len(self.log["/kl1/estimate"]["stamp_ns"]))
        np.testing.assert_array_equal(table["position_ned[2]"], self.log["/kl1/estimate"]["position_ned"][:, 2])
