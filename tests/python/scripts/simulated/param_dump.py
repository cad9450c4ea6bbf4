#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Saves all parameters to a file, changes one, shows the difference, and loads the file again."""
import sys
import time
from pymavlink import mavutil, mavparm

mav = mavutil.mavlink_connection(sys.argv[1])
mav.wait_heartbeat()
name = sys.argv[2]
mav.param_fetch_all()
params, indices = mavparm.MAVParmDict(), set()
last = time.time()
while True:
    m = mav.recv_match(type="PARAM_VALUE", blocking=True, timeout=2)
    if m is None:
        if time.time() - last > 20:
            sys.exit("only %u parameters arrived" % len(params))
        continue
    last = time.time()
    params[m.param_id] = m.param_value
    if m.param_index != 65535:
        indices.add(m.param_index)
    if len(indices) == m.param_count:
        break
print("got all parameters:", len(indices) > 100)
filename = sys.argv[3]
params.save(filename)
before = params[name]
print("set", params.mavset(mav, name, before + 1))
params.diff(filename, wildcard=name)
params.load(filename, wildcard=name, mav=mav)
mav.param_fetch_one(name)
m = mav.recv_match(type="PARAM_VALUE", blocking=True, timeout=5)
print(m.param_id, m.param_value == before)
