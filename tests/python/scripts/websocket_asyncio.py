#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Streams the messages of a vehicle to a web socket, with asyncio (RFC 6455, without a library)."""
import asyncio
import base64
import hashlib
import sys
from pymavlink import mavutil

GUID = "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
vehicle = mavutil.mavlink_connection(sys.argv[1])
vehicle.wait_heartbeat()


def text_frame(payload):
    data = payload.encode()
    head = bytes([0x81, len(data)]) if len(data) < 126 else bytes([0x81, 126]) + len(data).to_bytes(2, "big")
    return head + data


async def serve(reader, writer, done):
    key = None
    while (line := (await reader.readline()).strip()):
        if line.lower().startswith(b"sec-websocket-key:"):
            key = line.split(b":", 1)[1].strip().decode()
    accept = base64.b64encode(hashlib.sha1((key + GUID).encode()).digest()).decode()
    writer.write(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                  "Sec-WebSocket-Accept: %s\r\n\r\n" % accept).encode())
    vehicle.mav.request_data_stream_send(vehicle.target_system, vehicle.target_component, 10, 4, 1)
    loop = asyncio.get_running_loop()
    sent = 0
    while sent < 20:
        msg = await loop.run_in_executor(None, lambda: vehicle.recv_match(type="ATTITUDE", blocking=True, timeout=1))
        if msg is not None:
            writer.write(text_frame(msg.to_json()))
            sent += 1
    await writer.drain()
    writer.close()
    done.set_result(sent)


async def main():
    done = asyncio.get_running_loop().create_future()
    server = await asyncio.start_server(lambda r, w: serve(r, w, done), "127.0.0.1", int(sys.argv[2]))
    print("sent", await done)
    server.close()


asyncio.run(main())
