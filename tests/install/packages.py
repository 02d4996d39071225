#!/usr/bin/env python3
"""Which Debian package has which file, by debian/*.install, without building the packages.

usage: packages.py SOURCE PREFIX        PREFIX: where all was installed
"""

import fnmatch
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE, PREFIX = (pathlib.Path(argument) for argument in sys.argv[1:3])
PACKAGES = ("swiftlet", "swiftlet-analysis", "libswiftlet-dev", "python3-swiftlet", "ros-swiftlet-msgs")


def patterns_of(package):
    """The files of debian/PACKAGE.install, without where they go to."""
    lines = (SOURCE / f"debian/{package}.install").read_text().splitlines()
    return [line.split()[0].replace("usr/lib/*/", "usr/lib/") for line in lines]


def has(package, file):
    return any(fnmatch.fnmatch(file, pattern) or file.startswith(pattern + "/") for pattern in patterns_of(package))


# Beside /usr/lib, the folder of the libraries may be that of the architecture.
FILES = [re.sub("^lib/[^/]*-linux-gnu[^/]*/", "lib/", str(path.relative_to(PREFIX))) for path in PREFIX.rglob("*") if path.is_file()]
FILES = [f"usr/{file}" for file in FILES]


class Packages(unittest.TestCase):
    def test_each_file_is_in_one(self):
        self.assertGreater(len(FILES), 500)
        for file in FILES:
            with self.subTest(file):
                self.assertEqual(len([package for package in PACKAGES if has(package, file)]), 1)

    def test_each_has_what_its_list_names(self):
        for package in PACKAGES:
            for pattern in patterns_of(package):
                there = list(SOURCE.glob(pattern)) or [file for file in FILES if has(package, file)]
                is_of_python = pattern.startswith("usr/lib/python3")  # the component is not installed here
                with self.subTest(f"{package}: {pattern}"):
                    self.assertTrue(there or is_of_python)

    def test_a_flight_needs_swiftlet_alone(self):
        for file in FILES:
            if file.startswith("usr/bin/") and has("swiftlet", file):
                libraries = subprocess.run(["ldd", PREFIX / "bin" / pathlib.Path(file).name], capture_output=True, text=True, check=True).stdout
                with self.subTest(file):
                    self.assertNotRegex(libraries, "ceres|glog")
        self.assertEqual([file for file in sorted(FILES) if has("swiftlet-analysis", file)],
                         ["usr/bin/swiftlet-analysis", "usr/bin/swiftlet-identify"])

    def test_the_version_is_that_of_the_tree(self):
        version = re.search(r"project\(swiftlet VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertTrue((SOURCE / "debian/changelog").read_text().startswith(f"swiftlet ({version}) "))
        self.assertIn(f"<version>{version}</version>", (SOURCE / "ros2/swiftlet_msgs/package.xml").read_text())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
