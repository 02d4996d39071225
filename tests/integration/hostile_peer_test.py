#!/usr/bin/env python3
"""A peer without a key joins a flight as RTPS prescribes, and then says what no sound peer would.

usage: hostile_peer_test.py BIN_FOLDER SOURCE_FOLDER
Runs itself in a network namespace of its own. The flight must complete, and no process may grow: `./dev soak hostile`
changes single datagrams, which do not belong to a conversation.
"""

import collections
import itertools
import os
import pathlib
import re
import select
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

BIN, SOURCE = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
DOMAIN = 5
FIRST_PORT = 7400 + 250 * DOMAIN + 10  # RTPS 2.5, 9.6.2.3
DATA, DATA_FRAG, ACKNACK, HEARTBEAT, GAP, INFO_DST, NACK_FRAG = 0x15, 0x16, 0x06, 0x07, 0x08, 0x0E, 0x12
LITTLE_ENDIAN, WITH_QOS, WITH_DATA = 1, 2, 4
ANYONE = bytes(4)
SPDP_WRITER = bytes([0, 1, 0, 0xC2])
PUBLICATIONS, SUBSCRIPTIONS = 3, 4  # SEDP (9.3.1.3)
READER = bytes([0, 0, 1, 4])
PL_CDR_LE = bytes([0, 3, 0, 0])
MIB = 1 << 20


def sedp(number, kind):
    return bytes([0, 0, number, kind])


def number(value):
    return struct.pack("<II", value >> 32, value & 0xFFFFFFFF)


def submessage(kind, body, flags=0):
    return struct.pack("<BBH", kind, flags | LITTLE_ENDIAN, len(body)) + body


def parameter(identifier, value):
    value += bytes(-len(value) % 4)
    return struct.pack("<HH", identifier, len(value)) + value


def string(text):
    return struct.pack("<I", len(text) + 1) + text.encode() + b"\0"


def text(value):
    return value[4:3 + struct.unpack("<I", value[:4])[0]].decode()


def parameters(payload):
    """Returns the values of each parameter of a list."""
    order, rest, found = ("<" if payload[1] == 3 else ">"), payload[4:], {}
    while len(rest) >= 4:
        identifier, length = struct.unpack(order + "HH", rest[:4])
        if identifier == 1:
            break
        found.setdefault(identifier, []).append(rest[4:4 + length])
        rest = rest[4 + length:]
    return found


def submessages(message):
    rest = message[20:]
    while len(rest) >= 4:
        order = "<" if rest[1] & LITTLE_ENDIAN else ">"
        length = struct.unpack(order + "H", rest[2:4])[0] or len(rest) - 4
        yield rest[0], rest[1], order, rest[4:4 + length]
        rest = rest[4 + length:]


Participant = collections.namedtuple("Participant", "prefix name port sample_ports")


class Peer:
    """A participant that announces itself, hears of the others, and may have one reader."""

    def __init__(self):
        self.prefix = bytes([1, 0x0F]) + os.urandom(10)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.bind(("127.0.0.1", 0))
        self.locator = struct.pack("<iI", 1, self.socket.getsockname()[1]) + bytes(12) + socket.inet_aton("127.0.0.1")
        self.count = 0
        self.participants = {}  # by name
        self.writers = {}  # topic -> (participant's prefix, entity, type)
        self.fragments = {}  # writer -> {number of a sample: its fragments}
        self.announced = 0.0

    def message(self, destination, *submessages_):
        head = b"RTPS" + bytes([2, 3, 1, 0x0F]) + self.prefix
        return head + (submessage(INFO_DST, destination) if destination else b"") + b"".join(submessages_)

    def data(self, reader, writer, at, payload):
        return submessage(DATA, struct.pack("<HH", 0, 16) + reader + writer + number(at) + payload, WITH_DATA)

    def next_count(self):
        self.count += 1
        return struct.pack("<I", self.count)

    def acknack(self, reader, writer, base, wanted):
        bits = struct.pack(">I", 0xFFFFFFFF << (32 - wanted) & 0xFFFFFFFF)[::-1] if wanted else b""
        return submessage(ACKNACK, reader + writer + number(base) + struct.pack("<I", wanted) + bits + self.next_count())

    def send(self, port, message):
        self.socket.sendto(message, ("127.0.0.1", port))

    def announce(self):
        own = self.prefix + bytes([0, 0, 1, 0xC1])
        payload = PL_CDR_LE + b"".join([
            parameter(0x15, bytes([2, 3])), parameter(0x16, bytes([1, 0x0F])), parameter(0x50, own),
            parameter(0x32, self.locator), parameter(0x31, self.locator), parameter(0x02, struct.pack("<iI", 100, 0)),
            parameter(0x58, struct.pack("<I", 0xC3F)), struct.pack("<HH", 1, 0)])
        for i in range(12):
            self.send(FIRST_PORT + 2 * i, self.message(None, self.data(ANYONE, SPDP_WRITER, 1, payload)))
        for other in self.participants.values():
            for topic in (PUBLICATIONS, SUBSCRIPTIONS):
                self.send(other.port, self.message(other.prefix, self.acknack(sedp(topic, 0xC7), sedp(topic, 0xC2), 0, 0)))

    def subscribe(self, topic):
        """Announces a reliable, transient-local reader of the topic to its writer."""
        prefix, _, type_name = self.writers[topic]
        payload = PL_CDR_LE + b"".join([
            parameter(0x5A, self.prefix + READER), parameter(0x05, string(topic)), parameter(0x07, string(type_name)),
            parameter(0x1A, struct.pack("<IiI", 2, 0, 0)), parameter(0x1D, struct.pack("<I", 1)),
            parameter(0x2F, self.locator), struct.pack("<HH", 1, 0)])
        writer, reader = sedp(SUBSCRIPTIONS, 0xC2), sedp(SUBSCRIPTIONS, 0xC7)
        beat = submessage(HEARTBEAT, reader + writer + number(1) + number(1) + self.next_count())
        self.send(self.port_of(prefix), self.message(prefix, self.data(reader, writer, 1, payload), beat))

    def port_of(self, prefix):
        return next(other.port for other in self.participants.values() if other.prefix == prefix)

    def send_to_writer(self, prefix, message):
        for port in next(other.sample_ports for other in self.participants.values() if other.prefix == prefix):
            self.send(port, message)

    def converse(self, until, seconds):
        """Answers the others until the condition holds; returns whether it does within this time."""
        end = time.monotonic() + seconds
        while time.monotonic() < end and not until():
            if time.monotonic() - self.announced > 0.5:
                self.announced = time.monotonic()
                self.announce()
            if select.select([self.socket], [], [], 0.05)[0]:
                self.hear(self.socket.recv(1 << 16))
        return until()

    def hear(self, message):
        prefix = message[8:20]
        for kind, flags, order, body in submessages(message):
            if kind == DATA and flags & WITH_DATA:
                self.hear_data(prefix, flags, order, body)
            elif kind == HEARTBEAT:
                self.answer(prefix, body[4:8], *struct.unpack(order + "4x I 4x I", body[8:24]))
            elif kind == DATA_FRAG:
                sample = struct.unpack(order + "I", body[16:20])[0]
                size, total = struct.unpack(order + "HI", body[26:32])
                self.fragments.setdefault(prefix + body[8:12], {})[sample] = -(-total // size)

    def hear_data(self, prefix, flags, order, body):
        at = 20
        while flags & WITH_QOS:
            identifier, length = struct.unpack(order + "HH", body[at:at + 4])
            at += 4 + length
            if identifier == 1:
                break
        if body[8:12] == SPDP_WRITER:
            found = parameters(body[at:])
            if 0x32 in found and 0x31 in found:
                port, *sample_ports = [struct.unpack("<I", value[4:8])[0] for value in found[0x32][:1] + found[0x31]]
                name = text(found[0x62][0]) if 0x62 in found else ""
                self.participants[name] = Participant(prefix, name, port, sample_ports)
        elif body[8:12] == sedp(PUBLICATIONS, 0xC2):
            found = parameters(body[at:])
            self.writers[text(found[0x05][0])] = (prefix, found[0x5A][0][12:], text(found[0x07][0]))

    def answer(self, prefix, writer, first, last):
        if not any(other.prefix == prefix for other in self.participants.values()) or last < first:
            return
        if writer == sedp(PUBLICATIONS, 0xC2):
            self.send(self.port_of(prefix), self.message(prefix, self.acknack(sedp(PUBLICATIONS, 0xC7), writer, first, min(32, last - first + 1))))
            if last - first >= 32:
                self.send(self.port_of(prefix), self.message(prefix, self.acknack(sedp(PUBLICATIONS, 0xC7), writer, first + 32, min(32, last - first - 31))))
        elif any(found[:2] == (prefix, writer) for found in self.writers.values()) and not self.fragments.get(prefix + writer):
            self.send_to_writer(prefix, self.message(prefix, self.acknack(READER, writer, first, 1)))


def allocated_bytes(process):
    """In memory, without the pages of its program, which come whenever the machine has time for them."""
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return int(re.search(r"RssAnon:\s+(\d+) kB", status).group(1)) * 1024


def child_of(process, program):
    for folder in pathlib.Path("/proc").glob("[0-9]*"):
        try:
            fields = (folder / "stat").read_text().rsplit(")", 1)[1].split()
            if int(fields[1]) == process and (folder / "exe").resolve().name == program:
                return int(folder.name)
        except OSError:  # has ended meanwhile
            continue
    raise LookupError(f"no {program} of process {process}")


class HostilePeer(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.log = open(f"{self.folder.name}/log", "w+", encoding="utf-8")
        self.addCleanup(self.log.close)
        self.flight = subprocess.Popen(
            [BIN / "swiftlet", "fly", SOURCE / "config/missions/tour.yaml", "--domain", str(DOMAIN), "--clock", "lockstep", "--speed", "1",
             "--record", f"{self.folder.name}/record"], stdout=self.log, stderr=subprocess.STDOUT, cwd=self.folder.name)
        self.addCleanup(self.end_flight)
        self.peer = Peer()
        self.addCleanup(self.peer.socket.close)

    def end_flight(self):
        if self.flight.poll() is None:
            self.flight.kill()
            self.flight.wait()

    def said(self):
        self.log.flush()
        return pathlib.Path(self.log.name).read_text(encoding="utf-8")

    def logs(self):
        return "".join(path.read_text(errors="replace") for path in pathlib.Path(self.folder.name).rglob("*") if path.is_file())

    def join(self, *names):
        self.assertTrue(self.peer.converse(lambda: all(name in self.peer.participants for name in names), 30), self.said())

    def assert_flies_on(self):
        self.assertTrue(self.peer.converse(lambda: self.flight.poll() is not None, 150), "still flying")
        self.assertEqual(self.flight.returncode, 0, self.said())

    def test_asks_for_fragments_that_a_mission_does_not_have(self):
        topic = "rt/kl1/flown_mission"
        self.join("control")
        self.assertTrue(self.peer.converse(lambda: topic in self.peer.writers, 30), self.said())
        prefix, entity, _ = self.peer.writers[topic]
        self.peer.subscribe(topic)
        self.assertTrue(self.peer.converse(lambda: self.peer.fragments.get(prefix + entity), 30), self.said())
        sample, fragments = next(iter(self.peer.fragments[prefix + entity].items()))
        for base, bits, bitmap in ((0xFFFFFFFF, 2, 0x40000000), (fragments + 1, 1, 0x80000000), (0xFFFFFF01, 32, 0xFFFFFFFF)) * 10:
            body = READER + entity + number(sample) + struct.pack("<III", base, bits, bitmap) + self.peer.next_count()
            self.peer.send_to_writer(prefix, self.peer.message(prefix, submessage(NACK_FRAG, body)))
            self.peer.converse(lambda: False, 0.1)
        self.assertTrue(self.peer.converse(lambda: "NACK_FRAG of fragments that" in self.logs(), 15), self.said())
        self.assert_flies_on()

    def test_fills_the_memory_neither_with_gaps_nor_with_endpoints(self):
        self.join("mocap")
        mocap = self.peer.participants["mocap"]
        process = child_of(self.flight.pid, "swiftlet-mocap")
        self.peer.converse(lambda: False, 2)  # so that it knows the peer too
        before = allocated_bytes(process)
        writer, reader = sedp(PUBLICATIONS, 0xC2), sedp(PUBLICATIONS, 0xC7)
        gaps = (submessage(GAP, reader + writer + number(start) + number(start + 1000) + struct.pack("<I", 0))
                for start in range(3, 2_000_000, 1000))
        endpoints = ([self.peer.data(reader, writer, i, PL_CDR_LE + b"".join([
            parameter(0x5A, self.peer.prefix + struct.pack(">I", i)[1:] + b"\x03"), parameter(0x05, string(f"topic{i}")),
            parameter(0x07, string("Type")), struct.pack("<HH", 1, 0)])) for i in range(first, first + 50)]
            for first in range(1, 40_001, 50))
        grown = 0
        for messages, pause_s in itertools.chain((([gap], 0.001) for gap in gaps), ((some, 0.01) for some in endpoints)):
            self.peer.send(mocap.port, self.peer.message(mocap.prefix, *messages))
            self.peer.converse(lambda: False, pause_s)
            try:
                grown = max(grown, allocated_bytes(process) - before)
            except OSError:  # the flight has ended
                break
        self.assertLess(grown, 32 * MIB)
        self.assert_flies_on()


if __name__ == "__main__":
    if os.environ.get("SWIFTLET_HOSTILE_PEER") != "1":
        inner = 'ip link set lo up && SWIFTLET_HOSTILE_PEER=1 exec "$@"'
        options = ["--net"] if os.geteuid() == 0 else ["--net", "--map-root-user"]
        os.execvp("unshare", ["unshare", *options, "sh", "-c", inner, "sh", sys.executable, "-B", *sys.argv])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
