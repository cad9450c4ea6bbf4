#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench web: what `mavloom web` costs, and whether one client disturbs another.

idle, page: processor time of the server while `mavloom sim` sends from --vehicles, without clients and with one that
reads all that the page's table needs: /mavloom/vehicles, traffic, links and alarms, and one open message.
ring: the same as page, but the server reads the ring of the simulator.
clients: 100 clients with 5 channels of 10 Hz each, one of which never reads, while STATUSTEXT and COMMAND_ACK come
among them. The exit status is 4 if one of the other 99 lost a text or an acknowledgement."""
import argparse
import asyncio
import collections
import json
import os
import pathlib
import socket
import struct
import subprocess
import sys
import time

import websockets

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "system"))
import routers  # noqa: E402
from routers import mavlink  # noqa: E402

REPORTS = ["/mavloom/vehicles", "/mavloom/traffic", "/mavloom/links", "/mavloom/alarms"]
STREAMS = ["ATTITUDE", "LOCAL_POSITION_NED", "VFR_HUD", "GPS_RAW_INT", "SYS_STATUS"]
ESSENTIAL = ["STATUSTEXT", "COMMAND_ACK"]


class Server:
    def __init__(self, program, ring=None):
        self.source, self.port = routers.udp_port(), routers.tcp_port()
        self.sim_options = ["--ring", ring] if ring else ["--to", f"udpout://127.0.0.1:{self.source}"]
        source = f"shm://{ring}" if ring else f"udpin://127.0.0.1:{self.source}"
        self.process = subprocess.Popen([program, "web", source, "--listen", f"127.0.0.1:{self.port}"],
                                        stderr=subprocess.PIPE, text=True)
        while "open http" not in self.process.stderr.readline():
            pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()

    def cpu_s(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(") ", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def memory_kib(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(status.split("VmRSS:")[1].split()[0])


class Client:
    """Reads all messages of some topics. `counts` has how many came of each."""

    def __init__(self, server, topics):
        self.url, self.topics = f"ws://127.0.0.1:{server.port}", topics
        self.counts, self.names = collections.Counter(), {}

    async def open(self):
        self.socket = await websockets.connect(self.url, subprotocols=["foxglove.websocket.v1"], max_size=None)
        while len(self.names) < len(self.topics):
            text = json.loads(await self.socket.recv())
            for channel in text.get("channels", []) if text["op"] == "advertise" else []:
                if channel["topic"] in self.topics:
                    self.names[channel["id"]] = channel["topic"]
        wanted = [{"id": number, "channelId": number} for number in self.names]
        await self.socket.send(json.dumps({"op": "subscribe", "subscriptions": wanted}))

    async def read(self):
        async for got in self.socket:
            if isinstance(got, bytes):
                self.counts[self.names[struct.unpack_from("<I", got, 1)[0]]] += 1


def report(options, **values):
    print(json.dumps(values) if options.json else
          "  ".join(f"{key} {value}" for key, value in values.items()), flush=True)


async def page(options, server, topics, name):
    sim = subprocess.Popen([options.program, "sim", *server.sim_options, "--vehicles", str(options.vehicles)],
                           stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    try:
        await asyncio.sleep(2)
        client = Client(server, topics)
        reading = None
        if topics:
            await client.open()
            reading = asyncio.create_task(client.read())
        before, begin = server.cpu_s(), time.monotonic()
        await asyncio.sleep(options.seconds)
        used, took = server.cpu_s() - before, time.monotonic() - begin
        rows, frames = frames_of(server)
        report(options, case=name, cpu_percent=round(100 * used / took, 2), rows=rows,
               messages_per_s=round(frames / (took + 2)), reads_per_s=round(client.counts.total() / took, 1))
        if reading:
            reading.cancel()
            await client.socket.close()
    finally:
        sim.terminate()
        sim.wait()


def frames_of(server):
    import urllib.request
    rows = json.loads(urllib.request.urlopen(f"http://127.0.0.1:{server.port}/api/v1/traffic").read())["rows"]
    return len(rows), sum(row["count"] for row in rows)


def frame_makers():
    mav = mavlink.MAVLink(None, 1, 1)
    streams = [mavlink.MAVLink_attitude_message(0, 0, 0, 0, 0, 0, 0),
               mavlink.MAVLink_local_position_ned_message(0, 0, 0, 0, 0, 0, 0),
               mavlink.MAVLink_vfr_hud_message(0, 0, 0, 0, 0, 0),
               mavlink.MAVLink_gps_raw_int_message(0, 3, 0, 0, 0, 0, 0, 0, 0, 9),
               mavlink.MAVLink_sys_status_message(0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0)]
    essential = [mavlink.MAVLink_statustext_message(6, b"text"), mavlink.MAVLink_command_ack_message(400, 0)]
    return [lambda m=m: bytes(m.pack(mav)) for m in streams], [lambda m=m: bytes(m.pack(mav)) for m in essential]


async def clients(options, server):
    topics = [f"/1/1/{name}" for name in STREAMS + ESSENTIAL]
    streams, essential = frame_makers()
    vehicle = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    vehicle.connect(("127.0.0.1", server.source))
    for make in streams + essential:
        vehicle.send(make())
    all_clients = [Client(server, topics) for _ in range(99)]
    for client in all_clients:
        await client.open()
    readers = [asyncio.create_task(client.read()) for client in all_clients]
    before_stalled = server.memory_kib()
    stalled = Client(server, topics)
    await stalled.open()
    stalled.socket.transport.pause_reading()
    before, begin, rounds = server.cpu_s(), time.monotonic(), int(options.seconds * 10)
    for i in range(rounds):
        for make in streams + (essential if i % 5 == 0 else []):
            vehicle.send(make())
        await asyncio.sleep(max(0.0, begin + (i + 1) / 10 - time.monotonic()))
    used, took = server.cpu_s() - before, time.monotonic() - begin
    await asyncio.sleep(2)
    sent = {f"/1/1/{name}": 1 + len(range(0, rounds, 5)) for name in ESSENTIAL}
    sent |= {f"/1/1/{name}": 1 + rounds for name in STREAMS}
    lost = collections.Counter()
    for client in all_clients:
        for topic, count in sent.items():
            lost["essential" if topic.split("/")[-1] in ESSENTIAL else "telemetry"] += count - client.counts[topic]
    report(options, case="clients", cpu_percent=round(100 * used / took, 1), lost_essential=lost["essential"],
           lost_telemetry=lost["telemetry"], of_telemetry=99 * len(STREAMS) * (1 + rounds),
           memory_of_the_stalled_kib=max(0, server.memory_kib() - before_stalled))
    for reader in readers:
        reader.cancel()
    return lost["essential"]


async def run(options):
    shown = [*REPORTS, "/1/1/ATTITUDE"]
    for name, topics, ring in (("idle", [], None), ("page", shown, None), ("ring", shown, f"bench-{os.getpid()}")):
        with Server(options.program, ring) as server:
            await page(options, server, topics, name)
    with Server(options.program) as server:
        return 4 if await clients(options, server) else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/bin/mavloom")
    parser.add_argument("--vehicles", type=int, default=6)
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--json", action="store_true", help="print one JSON object per line")
    options = parser.parse_args()
    options.program = options.program.resolve()
    return asyncio.run(run(options))


if __name__ == "__main__":
    sys.exit(main())
