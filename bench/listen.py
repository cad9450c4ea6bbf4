#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench listen: runs `mavloom listen` on UDP under load, and prints every message.

Compares the number of messages sent with the number printed, and watches memory."""
import argparse
import json
import pathlib
import re
import signal
import subprocess
import sys
import threading
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent


def resident_kib(pid):
    return int(re.search(r"VmRSS:\s+(\d+)", pathlib.Path(f"/proc/{pid}/status").read_text())[1])


def measure(program, load, flight, rate, seconds, form):
    listen = subprocess.Popen([program, "listen", "udpin://127.0.0.1:0", *form], stdout=subprocess.PIPE,
                              stderr=subprocess.PIPE)
    port = int(re.search(rb"listening on port (\d+)", listen.stderr.readline())[1])
    counted = []

    def count():
        lines = 0
        while chunk := listen.stdout.read1(1 << 20):
            lines += chunk.count(b"\n")
        counted.append(lines)
    reader = threading.Thread(target=count, daemon=True)
    reader.start()
    generator = subprocess.Popen([load, "127.0.0.1", str(port), flight, str(rate), str(seconds)],
                                 stdout=subprocess.PIPE)
    memory = []
    while generator.poll() is None:
        time.sleep(0.5)
        memory.append(resident_kib(listen.pid))
    sent = json.loads(generator.stdout.read())
    time.sleep(0.5)
    listen.send_signal(signal.SIGINT)
    reader.join()
    talk = listen.stderr.read().decode()
    listen.wait()
    half = len(memory) // 2
    return {"form": " ".join(form) or "text", "asked_per_s": rate, "sent": sent["sent"], "sent_per_s": sent["rate"],
            "printed": counted[0], "lost": sent["sent"] - counted[0], "rss_kib_first_half": max(memory[:half] or [0]),
            "rss_kib_second_half": max(memory[half:] or [0]), "said": talk.strip()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "build/release/bin/mavloom"))
    parser.add_argument("--load", default=str(ROOT / "build/release/bench/bin/load_bench"))
    parser.add_argument("--flight", default=str(ROOT / "tests/data/px4_gcs_flight.tlog"))
    parser.add_argument("--rate", type=int, default=200_000)
    parser.add_argument("--seconds", type=float, default=10)
    options = parser.parse_args()
    worst = 0
    for form in ([], ["--json"]):
        result = measure(options.program, options.load, options.flight, options.rate, options.seconds, form)
        print(json.dumps(result))
        worst = max(worst, result["lost"])
    return 4 if worst else 0


if __name__ == "__main__":
    sys.exit(main())
