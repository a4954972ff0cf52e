#!/usr/bin/env python3
"""OpenIGTLink over loopback: a client of its own, which knows the protocol and nothing of Incise.

    igtl_test.py PROGRAM SCENARIO

SPDX-License-Identifier: LGPL-3.0-or-later
"""

import pathlib
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SCENARIO = sys.argv[1:3]
HEADER = struct.Struct(">H12s20sQQQ")
PATIENCE = 60.0


def crc64(data: bytes) -> int:
    """CRC-64 of ECMA-182, as OpenIGTLink has it."""
    crc = 0
    for byte in data:
        crc ^= byte << 56
        for _ in range(8):
            crc = (crc << 1) ^ (0x42F0E1EBA9EA3693 if crc >> 63 else 0)
            crc &= 0xFFFFFFFFFFFFFFFF
    return crc


def message(kind: str, device: str, body: bytes, version: int = 1) -> bytes:
    head = HEADER.pack(version, kind.encode(), device.encode(), 0, len(body), crc64(body))
    return head + body


def newer(kind: str, device: str, content: bytes, metadata: bytes = b"") -> bytes:
    """A message of version 2 of the header, as 3D Slicer sends them."""
    index = struct.pack(">H", 1) + struct.pack(">HHI", 3, 3, len(metadata)) if metadata else b""
    extended = struct.pack(">HHII", 12, len(index), len(metadata), 0)
    return message(kind, device, extended + content + index + metadata, version=2)


def matrix(at_mm, columns=((1, 0, 0), (0, 1, 0), (0, 0, 1))) -> bytes:
    return struct.pack(">12f", *[x for column in columns for x in column], *at_mm)


def transform(device: str, at_mm, columns=((1, 0, 0), (0, 1, 0), (0, 0, 1))) -> bytes:
    return message("TRANSFORM", device, matrix(at_mm, columns))


def text(device: str, what: str) -> bytes:
    return message("STRING", device, struct.pack(">HH", 3, len(what)) + what.encode())


class Client:
    def __init__(self, port: int):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        self.received = b""

    def send(self, data: bytes):
        self.socket.sendall(data)

    def bytes(self, count: int) -> bytes:
        while len(self.received) < count:
            more = self.socket.recv(1 << 16)
            if not more:
                raise EOFError("the program has closed the connection")
            self.received += more
        head, self.received = self.received[:count], self.received[count:]
        return head

    def next(self):
        version, kind, device, _, size, crc = HEADER.unpack(self.bytes(HEADER.size))
        body = self.bytes(size)
        # Here a CRC takes longer than a surface may: those of small messages are enough.
        assert version == 1 and (size > 200 or crc == crc64(body))
        return kind.rstrip(b"\0").decode(), device.rstrip(b"\0").decode(), body

    def until(self, kind: str, device: str, is_wanted=lambda body: True):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            got, of, body = self.next()
            if (got, of) == (kind, device) and is_wanted(body):
                return body
        raise TimeoutError(f"no {kind} of {device}")


def points_of(polydata: bytes):
    count = struct.unpack(">I", polydata[:4])[0]
    numbers = struct.unpack(f">{3 * count}f", polydata[40:40 + 12 * count])
    return [numbers[i:i + 3] for i in range(0, len(numbers), 3)]


def sensor_of(body: bytes):
    count = body[0]
    return struct.unpack(f">{count}d", body[10:10 + 8 * count])


class Link(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.recording = pathlib.Path(self.folder.name) / "hands.jsonl"
        self.program = subprocess.Popen(
            [PROGRAM, "live", SCENARIO, "--port", "0", "--no-open", "--igtl", "0",
             "--record", str(self.recording),
             "--tool", 'knife={kind="blade", edge=[[0,0,0.03],[0,0,-0.03]]}',
             "--tool", 'jaws={kind="grasper", shape={sphere={radius=0.012}}}'],
            stderr=subprocess.PIPE, text=True)
        self.port = None
        for line in self.program.stderr:
            if "OpenIGTLink listens on" in line:
                self.port = int(line.rsplit(":", 1)[1])
            if "http://" in line:
                break

    def tearDown(self):
        self.stop()
        self.folder.cleanup()

    def client(self) -> Client:
        client = Client(self.port)
        self.addCleanup(client.socket.close)
        return client

    def stop(self):
        if self.program.poll() is None:
            self.program.send_signal(signal.SIGINT)
            self.program.communicate(timeout=PATIENCE)
        self.program.stderr.close()

    def test_surface_is_in_millimetres(self):
        client = self.client()
        points = points_of(client.until("POLYDATA", "tissue"))
        spans = [max(p[i] for p in points) - min(p[i] for p in points) for i in range(3)]
        for span, wanted in zip(spans, (100.0, 100.0, 50.0)):
            self.assertAlmostEqual(span, wanted, delta=5.0)

    def test_knife_cuts_where_transforms_lead_it(self):
        client = self.client()
        before = len(points_of(client.until("POLYDATA", "tissue")))
        for i in range(90):
            client.send(transform("knife", (50.0, -20.0 + 1.5 * i, 50.0)))
            client.until("SENSOR", "knife")
            time.sleep(0.01)
        client.send(text("knife", "drop"))
        client.until("POLYDATA", "tissue", lambda body: len(points_of(body)) > before)
        self.stop()
        replay = subprocess.run(
            [PROGRAM, "run", SCENARIO, "--replay", str(self.recording), "--quiet",
             "--out", str(pathlib.Path(self.folder.name) / "out")],
            capture_output=True, text=True)
        self.assertEqual(replay.returncode, 0, replay.stderr)
        edits = pathlib.Path(self.folder.name, "out", "edits.jsonl").read_text().splitlines()
        self.assertGreater(len(edits), 0)

    def test_knife_that_was_dropped_does_not_sweep_to_where_it_is_next(self):
        client = self.client()
        client.send(transform("knife", (50.0, -60.0, 50.0)))
        client.until("SENSOR", "knife")
        client.send(text("knife", "drop") + transform("knife", (50.0, 160.0, 50.0)))
        time.sleep(0.5)
        self.stop()
        recorded = self.recording.read_text()
        self.assertIn('"withdraw":"knife"', recorded)
        self.assertIn('"add":"knife_2"', recorded)
        self.assertEqual(recorded.count('"move":"knife"'), 0)

    def test_jaws_feel_what_they_pull_and_let_go_at_the_end(self):
        client = self.client()
        client.send(transform("jaws", (20.0, 20.0, 50.0)))
        client.until("SENSOR", "jaws")
        client.send(text("jaws", "close"))
        for i in range(20):
            client.send(transform("jaws", (20.0, 20.0, 50.0 + 0.5 * i)))
            time.sleep(0.02)
        force = sensor_of(client.until("SENSOR", "jaws", lambda b: sensor_of(b)[2] < -0.01))
        self.assertEqual(len(force), 6)
        client.socket.close()
        other = self.client()
        # The jaws are put away with the connection that led them.
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if other.next()[0] != "POLYDATA":
                continue
            if '"withdraw":"jaws"' in self.recording.read_text():
                return
        self.fail("the jaws are still there")

    def test_messages_of_3d_slicer_lead_tools(self):
        client = self.client()
        # It says its version first, and adds metadata to each transform.
        client.send(newer("STATUS", "Slicer", struct.pack(">Hq20s", 1, 0, b"") + b"fine\0"))
        client.send(newer("TRANSFORM", "knife", matrix((50.0, -60.0, 50.0)), b"abcdef"))
        client.until("SENSOR", "knife")
        client.send(newer("STRING", "knife", struct.pack(">HH", 3, 4) + b"drop"))
        client.send(newer("TRANSFORM", "jaws", matrix((20.0, 20.0, 90.0))))
        client.until("SENSOR", "jaws")
        time.sleep(0.2)
        self.stop()
        recorded = self.recording.read_text()
        self.assertIn('"add":"knife"', recorded)
        self.assertIn('"withdraw":"knife"', recorded)

    def test_what_cannot_be_used_is_told_once(self):
        client = self.client()
        for _ in range(20):
            client.send(transform("nosuch", (0, 0, 0)))
            client.send(transform("knife", (0, 0, 0), ((2, 0, 0), (0, 2, 0), (0, 0, 2))))
            client.send(text("knife", "frobnicate"))
            client.send(message("TRANSFORM", "jaws", matrix((0, 0, 0)), version=9))
        client.send(transform("knife", (0.0, 0.0, 500.0)))
        client.until("SENSOR", "knife")
        time.sleep(0.2)
        self.program.send_signal(signal.SIGINT)
        _, told = self.program.communicate(timeout=PATIENCE)
        for cause in ("no --tool has this name; there are: 'jaws', 'knife'", "is scaled",
                      "neither close, open nor drop", "unknown version of the protocol"):
            self.assertEqual(told.count(cause), 1, told)

    def test_rubbish_harms_nobody(self):
        good = self.client()
        good.until("POLYDATA", "tissue")
        for rubbish in (b"\xff" * 5000, b"GET / HTTP/1.1\r\n\r\n" * 10,
                        HEADER.pack(1, b"TRANSFORM", b"knife", 0, 1 << 40, 0)):
            bad = self.client()
            bad.send(rubbish)
            with self.assertRaises((EOFError, ConnectionError)):
                while True:
                    bad.next()
        # Whole messages that say nothing sensible are passed over.
        nan = struct.pack(">12f", *[float("nan")] * 12)
        for wrong in (message("TRANSFORM", "knife", nan),
                      message("TRANSFORM", "knife", b"short"),
                      message("TRANSFORM", "spoon", struct.pack(">12f", *range(12))),
                      message("STRING", "knife", b""), message("STRING", "knife", b"\0\3\xff\xff"),
                      message("FLY", "knife", b""), transform("knife", (0, 0, 0), ((2, 0, 0),) * 3),
                      HEADER.pack(1, b"TRANSFORM", b"knife", 0, 48, 7) + bytes(48)):
            good.send(wrong)
        good.send(transform("knife", (0.0, 0.0, 500.0)))
        good.until("SENSOR", "knife")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
