#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Publishes the messages of a vehicle to an MQTT broker as JSON (QoS 0, MQTT 3.1.1, without a library)."""
import json
import socket
import struct
import sys
from pymavlink import mavutil

TOPICS = {"ATTITUDE": "attitude", "GLOBAL_POSITION_INT": "position", "STATUSTEXT": "text"}


def packet(kind, body):
    length, digits = len(body), b""
    while True:
        length, digit = divmod(length, 128)
        digits += bytes([digit | (0x80 if length else 0)])
        if not length:
            return bytes([kind]) + digits + body


def text(value):
    return struct.pack(">H", len(value)) + value.encode()


host, port = sys.argv[2].split(":")
broker = socket.create_connection((host, int(port)))
broker.sendall(packet(0x10, text("MQTT") + b"\x04\x02\x00\x3c" + text("bridge")))
vehicle = mavutil.mavlink_connection(sys.argv[1])
vehicle.wait_heartbeat()
vehicle.mav.request_data_stream_send(vehicle.target_system, vehicle.target_component, 0, 4, 1)
published = 0
while published < 30:
    msg = vehicle.recv_match(type=list(TOPICS), blocking=True, timeout=5)
    if msg is None:
        break
    topic = "vehicle/%u/%s" % (msg.get_srcSystem(), TOPICS[msg.get_type()])
    broker.sendall(packet(0x30, text(topic) + json.dumps(msg.to_dict()).encode()))
    published += 1
broker.sendall(packet(0xe0, b""))
broker.close()
print(published, "messages published")
