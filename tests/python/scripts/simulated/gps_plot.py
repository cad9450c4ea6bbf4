#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Collects positions of the GPS, and plots the track as SVG and as a CSV of metres."""
import csv
import math
import sys
import time
from pymavlink import mavutil

conn = mavutil.mavlink_connection(sys.argv[1])
conn.wait_heartbeat()
conn.mav.command_long_send(conn.target_system, conn.target_component, mavutil.mavlink.MAV_CMD_SET_MESSAGE_INTERVAL, 0,
                           mavutil.mavlink.MAVLINK_MSG_ID_GPS_RAW_INT, 20000, 0, 0, 0, 0, 0)
points, start = [], time.time()
while len(points) < 50 and time.time() - start < 60:
    gps = conn.recv_match(type="GPS_RAW_INT", blocking=True, timeout=5)
    if gps is None or gps.fix_type < mavutil.mavlink.GPS_FIX_TYPE_3D_FIX:
        continue
    points.append((gps.lat * 1e-7, gps.lon * 1e-7, gps.alt * 1e-3, gps.satellites_visible, conn.messages["HEARTBEAT"]))
home = conn.messages["HOME"]
rows = []
for lat, lon, alt, satellites, beat in points:
    x = (lon - home.lon * 1e-7) * 111319.5 * math.cos(math.radians(lat))
    y = (lat - home.lat * 1e-7) * 111319.5
    rows.append((x, y, alt))
with open(sys.argv[2] + ".csv", "w", newline="") as out:
    writer = csv.writer(out)
    writer.writerow(["x", "y", "alt"])
    writer.writerows(rows)
with open(sys.argv[2] + ".svg", "w") as out:
    line = " ".join("%.2f,%.2f" % (50 + x, 50 - y) for x, y, _ in rows)
    out.write('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><polyline points="%s"/></svg>\n' % line)
print(len(rows), "points,", points[0][3] >= 6, max(math.hypot(x, y) for x, y, _ in rows) < 10)
print("lat %.3f lon %.3f" % (points[0][0], points[0][1]), conn.location().alt > 0)
