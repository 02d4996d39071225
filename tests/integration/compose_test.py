#!/usr/bin/env python3
"""docker/run-compose and the compose files.

usage: compose_test.py SOURCE_FOLDER BIN_FOLDER
Reads all compose files, refuses what it would ignore, and flies a short mission with docker/sil.yaml, as root.
"""

import importlib.machinery
import importlib.util
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE, BIN = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
RUN_COMPOSE = SOURCE / "docker/run-compose"
HOP = """frame: ned
tolerance_m: 0.1
items:
  - {kind: takeoff, height_m: 0.3, speed_m_s: 0.5}
  - {kind: land, speed_m_s: 0.3}
"""
ADDRESSES = {"VEHICLE": "10.79.9.20", "MOCAP": "10.79.9.21"}


def load_run_compose():
    loader = importlib.machinery.SourceFileLoader("run_compose", str(RUN_COMPOSE))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("run_compose", loader))
    loader.exec_module(module)
    return module


run_compose = load_run_compose()


def read(file, environment=None, profiles=()):
    return run_compose.ComposeFile(SOURCE / "docker" / file, environment or {}, set(profiles))


def run(*arguments, environment=None):
    return subprocess.run([RUN_COMPOSE, *arguments], env={**os.environ, **(environment or {})}, capture_output=True,
                          text=True, check=False)


class ComposeFiles(unittest.TestCase):
    def test_services_start_after_those_that_they_depend_on(self):
        self.assertEqual([service.name for service in read("sil.yaml").in_order()], ["plant", "mocap", "control", "ground"])
        self.assertEqual(read("secure.yaml").in_order()[0].name, "keys")
        fleet = [service.name for service in read("fleet.yaml").in_order()]
        self.assertEqual((fleet[0], fleet[-1], len(fleet)), ("discovery", "ground", 11))

    def test_variables_are_replaced(self):
        self.assertEqual(read("sil.yaml").services["plant"].command, ["--clock", "realtime"])
        self.assertEqual(read("sil.yaml", {"CLOCK": "lockstep"}).services["plant"].command, ["--clock", "lockstep"])
        with self.assertRaisesRegex(run_compose.Refused, "set VEHICLE: the address of the vehicle"):
            read("hil.yaml")
        self.assertIn("10.79.9.20", read("hil.yaml", ADDRESSES).services["control"].command)

    def test_profiles_add_services(self):
        self.assertEqual(set(read("hil.yaml", ADDRESSES).services), {"control", "ground"})
        self.assertEqual(set(read("hil.yaml", ADDRESSES, ["simulated"]).services), {"control", "ground", "vehicle", "mocap"})

    def refusal(self, text):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "c.yaml"
            file.write_text(text, encoding="utf-8")
            with self.assertRaises(run_compose.Refused) as raised:
                run_compose.ComposeFile(file, {}, set()).in_order()
            return str(raised.exception)

    def test_what_would_be_ignored_is_refused_by_name(self):
        service = "services: {a: {image: swiftlet, %s}}"
        self.assertIn("unknown key 'secrets'", self.refusal("secrets: {}"))
        self.assertIn("services.a: unknown key 'restart'", self.refusal(service % "restart: always"))
        self.assertIn("services.a.ulimits: unknown key 'nofile'", self.refusal(service % "ulimits: {nofile: 9}"))
        self.assertIn("networks.n: unknown key 'driver'", self.refusal("networks: {n: {driver: macvlan}}"))
        self.assertIn("'n' is not in the networks", self.refusal(service % "networks: [n]"))
        self.assertIn("'v' is not in the volumes", self.refusal(service % "volumes: ['v:/v']"))
        self.assertIn("unknown option 'z'", self.refusal(service % "volumes: ['./v:/v:z']"))
        self.assertIn("condition is 'service_healthy'", self.refusal(service % "depends_on: {a: {condition: service_healthy}}"))
        self.assertIn("there is no service 'b'", self.refusal(service % "depends_on: [b]"))
        self.assertIn("depends on itself", self.refusal(service % "depends_on: [a]"))
        self.assertIn("'container:x', must be host or service:NAME", self.refusal(service % "network_mode: 'container:x'"))
        self.assertIn("must be a list of words", self.refusal(service % "command: fly square"))
        self.assertIn("is no compose file", self.refusal("[]"))
        self.assertIn("services.a: must be", self.refusal("services: {a: }"))
        self.assertIn("services.a.environment: 'FOO', must be NAME=TEXT", self.refusal(service % "environment: [FOO]"))
        self.assertIn("services.a.depends_on.b: condition is 'None'", self.refusal(service % "depends_on: {b: {}}"))
        self.assertIn("networks.n: subnet is missing", self.refusal("networks: {n: {ipam: {}}}"))
        self.assertIn("there is no service 'b', as its profiles are off", self.refusal(
            "services: {a: {image: swiftlet, depends_on: [b]}, b: {image: swiftlet, profiles: [p]}}"))

    def test_wrong_usage_exits_with_2_and_one_sentence(self):
        for arguments in (["no_such.yaml", "--bin", str(BIN)], [str(SOURCE / "docker/sil.yaml")],
                          [str(SOURCE / "docker/sil.yaml"), "--bin", "/no/such/folder"]):
            result = run(*arguments)
            self.assertEqual((result.returncode, len(result.stderr.splitlines())), (2, 1), result.stderr)

    def fly(self, file):
        """Flies a hop in lockstep. Returns the lines about the services."""
        if os.geteuid() != 0 or subprocess.run(["unshare", "--net", "--mount", "true"], check=False).returncode != 0:
            self.skipTest("network namespaces need root")
        with tempfile.TemporaryDirectory() as folder:
            work = pathlib.Path(folder) / "work"
            work.mkdir()
            (pathlib.Path(folder) / "hop.yaml").write_text(HOP, encoding="utf-8")
            result = run(str(SOURCE / "docker" / file), "--bin", str(BIN), "--volume", f"flights={folder}",
                         environment={"CLOCK": "lockstep", "MISSION": "/flights/hop.yaml", "TMPDIR": str(work)})
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("hop: completed", result.stdout)
            report = json.loads((pathlib.Path(folder) / "record/report.json").read_text(encoding="utf-8"))
            self.assertTrue(report["completed"])
            self.assertEqual(list(work.iterdir()), [])
        return result.stderr

    def test_sil_flies_a_mission(self):
        self.assertIn("plant | ", self.fly("sil.yaml"))

    def test_secure_flies_a_mission_with_the_keys_of_its_roles(self):
        self.assertIn("keys | made lab", self.fly("secure.yaml"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
