# SPDX-License-Identifier: MIT
"""Code as users type it, for type checkers. The examples also run in the tests whose names contain their numbers."""
import asyncio
import os

import mavloom
import numpy
import pyarrow.parquet as pq


def live() -> None:
    with mavloom.connect("udpin://127.0.0.1:14550") as link:
        for msg in link:
            print(msg.time_ns, msg.get_srcSystem(), msg.name, msg.to_dict())
    link = mavloom.connect("udpin:127.0.0.1:14550", buffer=1 << 20)
    link.wait_heartbeat()
    m = link.recv_match(type=("ATTITUDE", "VFR_HUD"), blocking=True, timeout=2.0)
    if m is not None:
        print(m.roll, link.messages["ATTITUDE"].pitch, link.target_system, link.target_component)
    link.send("STATUSTEXT", severity=6, text="höhe 10°")
    link.mav.heartbeat_send(6, 8, 0, 0, 4)
    pos = link.latest("GLOBAL_POSITION_INT", system=1, max_age=1.0)
    print(pos.lat / 1e7 if pos else None, link.stats.missed)


async def watch(link: mavloom.Link, system: int) -> None:
    async for msg in link.subscribe("ATTITUDE", system=system):
        print(msg)


def recorded() -> None:
    log = mavloom.read("flight.tlog")
    n = sum(1 for m in log if m.name == "HEARTBEAT")
    print(n, log.stats.junk_bytes)
    att = mavloom.columns("flight.tlog", "ATTITUDE", system=1)
    print(att["roll"].dtype, len(att["time_ns"]), att.units["roll"])
    bat = mavloom.columns("flight.tlog", "BATTERY_STATUS", instance=0)
    print(bat["voltages"].shape)
    df = att.to_pandas()
    pq.write_table(att.to_arrow(), "att.parquet")
    print(df["roll"].rolling("1s").mean().iloc[-1])


def rings(frame: bytes, t: int) -> None:
    w = mavloom.RingWriter("px4", capacity=8 << 20)
    w.write(frame, time_ns=t, link=0)
    w.write(numpy.array([1.0, 2.0]))
    with w.claim(4) as view:
        view[:] = b"abcd"
    with mavloom.RingReader("px4", lossless=True) as r:
        for batch in r.batches(timeout=1.0):
            v = memoryview(batch[0])
            print(numpy.frombuffer(v, "u1"), bytes(batch[0]))
            v.release()
            batch.release()


def own_dialect() -> bytes:
    link = mavloom.connect("udpin://127.0.0.1:0")
    if os.fork() == 0:
        link.recv(timeout=None)
    d = mavloom.Dialect("mine.xml")
    mavloom.connect("tcpout://127.0.0.1:5760", dialect=d)
    return d.encode("SECURE_PAYLOAD", key_id=7)


asyncio.run(watch(mavloom.connect("udpin://127.0.0.1:0"), 1))
