# SPDX-License-Identifier: MIT
"""docs/guide/route.md names every key that a router answers with, and no other; the metrics too."""
import json
import re
import urllib.request

import pytest

import frames
import harness

pytestmark = pytest.mark.short

PAGE = (harness.ROOT / "docs" / "guide" / "route.md").read_text()


def keys_by_kind():
    table = re.search(r"\| kind \| keys \|\n\|---\|---\|\n((?:\|.*\n)+)", PAGE)[1]
    return {row.split("|")[1].strip(" `"): set(re.findall(r"`(\w+)`", row.split("|")[2])) for row in table.splitlines()}


def metrics_keys_by_kind():
    """The keys of answers, and those of kinds that only the metrics have."""
    own = re.findall(r"^\| `(\w+)` \(([^)]+)\) \|", PAGE, re.MULTILINE)
    return {**keys_by_kind(), **{kind: set(re.findall(r"`(\w+)`", keys)) for kind, keys in own}}


@pytest.fixture
def router(spawn, udp_port, udp_socket, tmp_path):
    """(name, metrics URL) of a router whose answers contain every kind."""
    port = udp_port()
    name = f"guide-{port}"
    running = spawn("route", f"udpin://127.0.0.1:{port}", tmp_path / "all.tlog", "--name", name, "--metrics",
                    "127.0.0.1:0")
    metrics = running.wait_output(r"metrics on port (\d+)")[1]
    vehicle, ground = udp_socket(), udp_socket()
    vehicle.sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))
    running.wait_output(r"#127\.0\.0\.1:%d: up" % vehicle.getsockname()[1])
    ground.sendto(next(frames.heartbeats(1, 255, 190)), ("127.0.0.1", port))
    ground.sendto(frames.mavlink.MAVLink_command_long_message(77, 1, 400, 0, 1, 0, 0, 0, 0, 0,
                                                              0).pack(frames.sender(255, 190, 1)),
                  ("127.0.0.1", port))
    assert vehicle.recv(1000)
    return name, f"http://127.0.0.1:{metrics}/metrics"


def asked(run, name, what):
    done = run("ctl", name, what)
    assert done.status == 0, done
    return [json.loads(line) for line in done.lines]


def test_every_key_is_in_the_guide(run, router, wait_for):
    name, _ = router
    documented = keys_by_kind()

    def answers():
        got = asked(run, name, "stats") + asked(run, name, "routes")
        return {o["kind"] for o in got} == set(documented) and got
    for answer in wait_for(answers, what="an object of every kind"):
        has_mode = answer["kind"] != "message" or answer["name"] == "HEARTBEAT"
        assert set(answer) - {"kind"} == documented[answer["kind"]] - (set() if has_mode else {"mode"}), answer["kind"]
    assert {o["kind"] for o in asked(run, name, "links")} == {"link"}


def test_every_key_is_explained():
    explained = set(re.findall(r"`(\w+)`",
                               "".join(re.findall(r"^\| (`\w+`(?:, `\w+`)*) \| ", PAGE.split("| key | is |")[1],
                                                  re.MULTILINE))))
    undescribed = set().union(*keys_by_kind().values()) - explained
    assert undescribed <= {"scheme", "up", "frames", "bytes"}  # the names explain themselves


def test_metrics_have_the_documented_names(router):
    _, url = router
    text = urllib.request.urlopen(url, timeout=harness.DEFAULT_TIMEOUT_S).read().decode()
    counts = metrics_keys_by_kind()
    names = set(re.findall(r"^mavloom_(\w+)_total\{", text, re.MULTILINE))

    assert names
    for metric in names:
        kind, key = metric.split("_", 1)
        assert key in counts[kind], metric
