#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A flight as pandas data frames, one for each type of message."""
import collections
import sys

import pandas as pd
from pymavlink import mavutil

mav = mavutil.mavlink_connection(sys.argv[1])
rows = collections.defaultdict(list)
while (msg := mav.recv_match()) is not None:
    if msg.get_type() == "BAD_DATA":
        continue
    row = msg.to_dict()
    row["timestamp"] = msg._timestamp
    rows[row.pop("mavpackettype")].append(row)

frames = {name: pd.DataFrame(data) for name, data in rows.items()}
for name in sorted(frames):
    print(name, frames[name].shape, list(frames[name].columns))
gps = frames["GPS_RAW_INT"]
print(gps[["lat", "lon", "alt", "eph", "satellites_visible"]].describe().to_string())
hud = frames["VFR_HUD"].set_index("timestamp")
print(hud["alt"].rolling(5).mean().dropna().round(4).tolist()[:20])
