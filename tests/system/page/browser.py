# SPDX-License-Identifier: MIT
"""A page of `mavloom web` in Debian's Chromium, and the vehicles that it shows."""
import contextlib
import pathlib

import harness
import pytest
import routers
from frames import mavlink

CHROMIUM = pathlib.Path("/usr/bin/chromium")
HTML = "<img src=x onerror=hit()>"


@contextlib.contextmanager
def chromium():
    if not CHROMIUM.is_file():
        pytest.skip(f"{CHROMIUM} is missing: the Debian package is chromium")
    playwright = pytest.importorskip("playwright.sync_api")
    with playwright.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=str(CHROMIUM), args=["--no-sandbox"])
        yield browser
        browser.close()


class Server:
    """`mavloom web`, which can be stopped and started again, and an end that sends it frames. The name of its link is
    HTML."""

    def __init__(self):
        self.port, self.source = routers.tcp_port(), routers.udp_port()
        self.running = []
        self.start()
        self.end = routers.UdpEnd(("127.0.0.1", self.source))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.end.__exit__(None, None, None)
        harness.end(self.running)

    def start(self):
        command = [harness.program_path(), "web", f"udpin://127.0.0.1:{self.source}?name={HTML}",
                   "--listen", f"127.0.0.1:{self.port}"]
        self.running.append(harness.Running(command, env=harness.environment()))
        self.running[-1].wait_output("open http", stream="err")

    def stop(self):
        harness.end(self.running)
        self.running.clear()

    def url(self, state=""):
        return f"http://127.0.0.1:{self.port}/{state}"

    def send(self, message, source=(1, 1)):
        self.end.send(routers.make(message, source))

    def send_vehicle(self, source=(1, 1), roll=0.5):
        """Hold, armed; two batteries; a text and a parameter that are HTML."""
        self.send(mavlink.MAVLink_heartbeat_message(2, 12, 0x81, 50593792, 4, 3), source)
        self.send(mavlink.MAVLink_attitude_message(5000, roll, -0.25, 3, 0, 0, 0), source)
        self.send(mavlink.MAVLink_gps_raw_int_message(9, 3, 473977418, 85455939, 489400, 70, 110, 500, 9000, 10),
                  source)
        for number, remaining in ((0, 90), (1, 40)):
            cells = [4200, 4100] + [65535] * 8
            self.send(mavlink.MAVLink_battery_status_message(number, 0, 1, 2500, cells, 100, -1, -1, remaining), source)
        self.send(mavlink.MAVLink_statustext_message(3, HTML.encode()), source)
        self.send(mavlink.MAVLink_param_value_message(b"<img onerror=1>", 1.5, 9, 1, 0), source)
