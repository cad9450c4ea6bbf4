#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Downloads all parameters."""
import sys
import time
from pymavlink import mavutil

master = mavutil.mavlink_connection(sys.argv[1], source_system=254)
master.wait_heartbeat()
master.param_fetch_all()
got = {}
deadline = time.time() + 20
while time.time() < deadline:
    message = master.recv_match(type="PARAM_VALUE", blocking=True, timeout=5)
    if message is None:
        break
    got[message.param_id] = message.param_value
    if len(got) == message.param_count:
        break
for name in sorted(got):
    print("%-16s %f" % (name, got[name]))
print(len(master.params), master.param("RTL_ALT"), master.param("NO_SUCH", -1))
