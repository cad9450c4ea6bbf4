#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Counts the messages of a recording, by source and type."""
import collections
import sys
from pymavlink import mavutil

m = mavutil.mavlink_connection(sys.argv[1])
counts, sizes = collections.Counter(), collections.Counter()
sources, links = collections.Counter(), collections.Counter()
first = last = None
while True:
    msg = m.recv_msg()
    if msg is None:
        break
    first = first or msg._timestamp
    last = msg._timestamp
    counts[msg.get_type()] += 1
    sizes[msg.get_type()] += len(msg.get_msgbuf())
    sources[(msg.get_srcSystem(), msg.get_srcComponent())] += 1
    links[msg._link] += 1
print("duration: %.3f s" % (last - first))
for (system, component), n in sorted(sources.items()):
    print("source %u/%u: %u" % (system, component, n))
for name, n in counts.most_common():
    print("%-36s %6u %8u bytes" % (name, n, sizes[name]))
print(sorted(links.items()), m.mav_count, m.mav_loss, "%.3f%%" % m.packet_loss())
