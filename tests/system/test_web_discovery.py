# SPDX-License-Identifier: MIT
"""`mavloom web` without a source. Each case has a /dev/shm and a network of its own, so that it finds no other program,
and the usual port is free."""
import json
import re
import sys

import netns

# Runs the programs of argv[2:] and `web`, waits for a vehicle or a hop, and prints the reports and what `web` said.
CASE = r"""
import json, shlex, subprocess, sys, time, urllib.request
program, seconds = sys.argv[1], float(sys.argv[2])
started = [subprocess.Popen([program, *shlex.split(words)]) for words in sys.argv[3:]]
end = time.monotonic() + seconds
def get(report):
    return json.load(urllib.request.urlopen(f"http://127.0.0.1:8088/api/v1/{report}", timeout=seconds))
def is_there(name):
    return subprocess.run([program, "stat", name], capture_output=True).returncode == 0
while not all(is_there(words.split()[-1]) for words in sys.argv[3:]) and time.monotonic() < end:
    time.sleep(0.05)
web = subprocess.Popen([program, "web", "--listen", "127.0.0.1:8088"], stderr=subprocess.PIPE, text=True)
systems, hops = [], []
while not (systems and len(hops) > len(started)) and time.monotonic() < end:
    time.sleep(0.05)
    try:
        systems, hops = get("systems"), get("links")["hops"]
    except OSError:
        pass
web.terminate()
said = web.communicate()[1]
for other in started:
    other.terminate()
    other.wait()
print(json.dumps({"systems": systems, "hops": {hop["name"]: hop for hop in hops}, "said": said}))
"""


def alone(program, folder, case, *arguments):
    """Runs a script of Python in such a place."""
    return netns.alone(folder, sys.executable, "-c", case, program, *arguments)


def reports_beside(program, folder, *commands):
    return json.loads(alone(program, folder, CASE, "30", *commands).stdout)


def test_rings_and_routers_are_found(program, tmp_path):
    got = reports_beside(program, tmp_path, "route udpin://127.0.0.1:14541 -q --ring with",
                         "route udpin://127.0.0.1:14542 -q --name without",
                         "sim --to udpout://127.0.0.1:14541 --to udpout://127.0.0.1:14542 -q --name vehicles")

    assert [s["sys"] for s in got["systems"]] == [1], got
    assert "found the ring with of process" in got["said"]
    assert ("without has no ring, so only those of its messages are shown that it sends to a program that has one: to "
            "see all, start it with --ring without") in got["said"]
    assert "14550" not in got["said"]
    assert got["hops"]["with"]["hint"] is None and "--ring without" in got["hops"]["without"]["hint"]
    assert got["hops"]["vehicles"]["kind"] == "sim" and got["hops"]["with"]["kind"] == "router"


def test_without_a_ring_it_listens_where_vehicles_send(program, tmp_path):
    got = reports_beside(program, tmp_path, "sim -q --name sim")

    assert [s["sys"] for s in got["systems"]] == [1], got
    assert "listening on udpin://0.0.0.0:14550" in got["said"]
    hint = "sim has no ring, so only those of its messages are shown that it sends to udpin://0.0.0.0:14550"
    assert hint in got["said"] and got["hops"]["sim"]["hint"].startswith(hint)


def test_the_owner_of_the_usual_port_is_named(program, tmp_path):
    script = """import socket, subprocess, sys
taken = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
taken.bind(("0.0.0.0", 14550))
sys.exit(subprocess.run([sys.argv[1], "web"]).returncode)"""
    done = alone(program, tmp_path, script)

    assert done.returncode == 1 and re.search(r"no ring is in use, and cannot bind UDP 0.0.0.0:14550: "
                                              r"Address already in use by \w+.* \(process \d+\); end that program, or "
                                              r"name another source", done.stderr), done
