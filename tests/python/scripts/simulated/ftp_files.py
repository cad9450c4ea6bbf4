#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Lists, writes, reads and removes files of a vehicle with MAVFTP."""
import logging
import os
import sys
from pymavlink import mavutil, mavftp

logging.basicConfig(level=logging.ERROR)
master = mavutil.mavlink_connection(sys.argv[1])
master.wait_heartbeat()
folder, local = sys.argv[2], sys.argv[3]
settings = mavftp.MAVFTPSettings([
    ("debug", int, 0), ("pkt_loss_tx", int, 0), ("pkt_loss_rx", int, 0), ("max_backlog", int, 5),
    ("burst_read_size", int, 80), ("write_size", int, 80), ("write_qsize", int, 5), ("idle_detection_time", float, 0.4),
    ("read_retry_time", float, 0.3), ("retry_time", float, 0.3)])
ftp = mavftp.MAVFTP(master, target_system=master.target_system, target_component=master.target_component,
                    settings=settings)

listing = ftp.cmd_list(["/"])
print("list", listing.error_code, any(entry.is_dir for entry in listing.directory_listing))
data = bytes(range(256)) * 9
with open(local, "wb") as f:
    f.write(data)
remote = folder + "/hello.bin"
ftp.cmd_put([local, remote])
print("put", ftp.process_ftp_reply("CreateFile", timeout=20).error_code)
ftp.cmd_get([remote, local + ".back"])
print("get", ftp.process_ftp_reply("OpenFileRO", timeout=20).error_code)
with open(local + ".back", "rb") as f:
    print("same", f.read() == data)
print([(entry.name, entry.size_b) for entry in ftp.cmd_list([folder]).directory_listing if entry.name == "hello.bin"])
print("rm", ftp.cmd_rm([remote]).error_code)
ftp.cmd_get([remote, local + ".none"])
print("gone", ftp.process_ftp_reply("OpenFileRO", timeout=20).error_code == mavftp.FtpError.FileNotFound)
os.remove(local + ".back")
