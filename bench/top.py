#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench top: what the screen of `mavloom top` costs.

load: processor time of `top`, in a terminal of tmux, beyond that of `listen --stats`, while --rate recorded frames come
each second by UDP. The two take turns, so that what else the machine does disturbs both alike.
start: time from the start of `top` to the first row of a message on its terminal."""
import argparse
import json
import os
import pathlib
import pty
import re
import select
import signal
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "system"))
import routers  # noqa: E402
import terminals  # noqa: E402

A_ROW = re.compile(rb"[A-Z][A-Z0-9]+(_[A-Z0-9]+)+")
SETTLES_S = 1.5


def cpu_s(pid):
    fields = pathlib.Path(f"/proc/{pid}/stat").read_text().rsplit(") ", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def drops(port):
    """Datagrams that the kernel dropped at this port."""
    lines = pathlib.Path("/proc/net/udp").read_text().splitlines()
    return sum(int(line.split()[-1]) for line in lines if f":{port:04X} " in line)


class Load:
    def __init__(self, options, port, rate, seconds):
        self.command = [options.load, "127.0.0.1", str(port), options.flight, str(rate), str(seconds)]

    def __enter__(self):
        self.process = subprocess.Popen(self.command, stdout=subprocess.PIPE)
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()


def listening_on(port):
    while not re.search(rf":{port:04X} ", pathlib.Path("/proc/net/udp").read_text()):
        time.sleep(0.01)


def cost(options, port, pid):
    """Percent of a core that the process uses while the load comes."""
    with Load(options, port, options.rate, SETTLES_S + options.seconds + 1):
        time.sleep(SETTLES_S)
        before, begin = cpu_s(pid), time.monotonic()
        time.sleep(options.seconds)
        used = 100 * (cpu_s(pid) - before) / (time.monotonic() - begin)
        return used, drops(port)


def cost_of_listen(options):
    port = routers.udp_port()
    listen = subprocess.Popen([options.program, "listen", f"udpin://127.0.0.1:{port}", "--stats"],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    listening_on(port)
    try:
        return cost(options, port, listen.pid)
    finally:
        listen.send_signal(signal.SIGINT)
        listen.wait()


def cost_of_top(options):
    port = routers.udp_port()
    with tempfile.TemporaryDirectory() as folder, terminals.opened(pathlib.Path(folder), options.program,
                                                                   "top") as start:
        terminal = start(f"udpin://127.0.0.1:{port}", columns=options.columns, lines=options.lines)
        listening_on(port)
        shell = terminal.call("display-message", "-p", "#{pane_pid}").strip()
        pid = subprocess.run(["pgrep", "-P", shell, "mavloom"], capture_output=True, text=True, check=True).stdout
        return cost(options, port, int(pid))


def load(options):
    listens, tops, differences, dropped = [], [], [], 0
    for _ in range(options.pairs):
        (listen, lost), (top, lost_too) = cost_of_listen(options), cost_of_top(options)
        listens.append(listen)
        tops.append(top)
        differences.append(top - listen)
        dropped += lost + lost_too
    return {"case": "load", "frames_per_s": options.rate, "listen_percent": round(statistics.median(listens), 1),
            "top_percent": round(statistics.median(tops), 1),
            "more_percent": round(statistics.median(differences), 1),
            "more_least": round(min(differences), 1), "more_most": round(max(differences), 1), "dropped": dropped}


def first_row_ms(options, port):
    begin = time.monotonic()
    pid, terminal = pty.fork()
    if pid == 0:
        os.execve(options.program, ["mavloom", "top", f"udpin://127.0.0.1:{port}"],
                  {**os.environ, "TERM": "xterm-256color", "COLUMNS": "120", "LINES": "40"})
    shown = b""
    while not A_ROW.search(shown):
        if not select.select([terminal], [], [], 30)[0]:
            sys.exit(f"top shows no row: {shown[-2000:]!r}")
        shown += os.read(terminal, 1 << 16)
    took = time.monotonic() - begin
    os.kill(pid, signal.SIGKILL)
    os.waitpid(pid, 0)
    os.close(terminal)
    return 1000 * took


def start(options):
    port = routers.udp_port()
    with Load(options, port, 2000, 600):
        times = [first_row_ms(options, port) for _ in range(options.starts)]
    return {"case": "start", "first_row_ms": round(statistics.median(times), 1), "least": round(min(times), 1),
            "most": round(max(times), 1)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/mavloom"))
    parser.add_argument("--load", default=str(ROOT / "build/release/bench/bin/load_bench"))
    parser.add_argument("--flight", default=str(ROOT / "tests/data/px4_gcs_flight.tlog"))
    parser.add_argument("--rate", type=int, default=100_000)
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--pairs", type=int, default=7)
    parser.add_argument("--starts", type=int, default=15)
    parser.add_argument("--columns", type=int, default=120)
    parser.add_argument("--lines", type=int, default=40)
    options = parser.parse_args()
    for case in (start, load):
        print(json.dumps(case(options)), flush=True)


if __name__ == "__main__":
    main()
