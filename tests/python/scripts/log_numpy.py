#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Statistics of a flight with numpy."""
import math
import sys

import numpy as np
from pymavlink import mavutil

log = mavutil.mavlink_connection(sys.argv[1], robust_parsing=True)
times, rolls, pitches, altitudes, speeds = [], [], [], [], []
while True:
    m = log.recv_match(type=["ATTITUDE", "GLOBAL_POSITION_INT", "VFR_HUD"])
    if m is None:
        break
    t = m.get_type()
    if t == "ATTITUDE":
        times.append(m.time_boot_ms * 1e-3)
        rolls.append(math.degrees(m.roll))
        pitches.append(math.degrees(m.pitch))
    elif t == "GLOBAL_POSITION_INT":
        altitudes.append(m.relative_alt * 0.001)
    elif t == "VFR_HUD":
        speeds.append(m.groundspeed)

rolls, pitches, altitudes, speeds = map(np.array, (rolls, pitches, altitudes, speeds))
rate = 1.0 / np.median(np.diff(np.array(times)))
print(f"{len(rolls)} attitudes at {rate:.1f} Hz")
print(f"roll   mean {rolls.mean():.4f} std {rolls.std():.4f} max {np.abs(rolls).max():.4f}")
print(f"pitch  mean {pitches.mean():.4f} std {pitches.std():.4f} max {np.abs(pitches).max():.4f}")
print(f"height {altitudes.min():.2f} to {altitudes.max():.2f} m, speed up to {speeds.max():.3f} m/s")
print(np.histogram(altitudes, bins=8)[0].tolist())
