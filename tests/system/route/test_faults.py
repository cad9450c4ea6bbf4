# SPDX-License-Identifier: MIT
"""Faults on purpose, kind by kind: what a router, `listen`, `stat` and a simulator count must equal what was injected,
and what arrives must agree with both. The statistics of each fault have unit tests (tests/unit/fault)."""
import contextlib
import json
import os
import time

import pytest

import frames
import harness
import routers
from disks import SmallDisk
from routers import Router, UdpEnd

pytestmark = pytest.mark.short

LOCALHOST = "127.0.0.1"
VEHICLE = (1, 1)
COUNT = 1500
LONGEST_FRAME = 280


class Path:
    """vehicle -> a router whose link to it, or to the station, has faults -> station."""

    def __init__(self, spawn, kind="udpin", inward="", outward="", more=()):
        self.port = routers.udp_port() if kind == "udpin" else routers.tcp_port()
        self.station = UdpEnd(label="station")
        self.router = Router(spawn, f"{kind}://{LOCALHOST}:{self.port}?name=vehicle{inward}",
                             f"udpout://{LOCALHOST}:{self.station.port}?name=station&queue_age=60{outward}", *more)
        self.vehicle = UdpEnd((LOCALHOST, self.port)) if kind == "udpin" else routers.tcp_client(self.port)
        self.sent = []

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.vehicle.close()
        self.station.close()

    def send(self, count=COUNT, pause=0.0):
        """Frames with running sequence numbers, and different bytes."""
        for _ in range(count):
            self.sent.append(routers.attitude(VEHICLE))
            self.vehicle.send(self.sent[-1])
            if pause or len(self.sent) % 100 == 0:
                time.sleep(pause or 0.002)  # room for the receive buffers; no verdict depends on it

    def link(self, label):
        return next((link for link in self.router.links() if link["endpoint"] == label), None)

    def arrived(self, is_settled, label="vehicle"):
        """The frames at the station, and the counters of the link with faults, once all have met their fate."""
        def settled():
            link, out = self.link(label), self.link("station")
            return link and is_settled(link) and out["frames_out"] + out["fault_queue"] + out["fault_lost"] and link
        link = harness.wait_for(settled, what="the fate of the last frame")
        got = self.station.count(self.link("station")["frames_out"])
        return got, link


def numbers(got):
    """Sequence numbers that continue after 255, of frames whose numbers rise."""
    result = []
    for frame in got:
        result.append(frame[4] if not result else result[-1] + (frame[4] - result[-1]) % 256)
    return result


def gap_sum(got):
    """Frames missing between the first and the last."""
    all_of = numbers(got)
    return all_of[-1] - all_of[0] + 1 - len(all_of)


@pytest.mark.parametrize("kind", ["udpin", "tcpin"])
@pytest.mark.parametrize("loss", ["loss:0.1", "loss:0.1/5"])
def test_loss(spawn, kind, loss):
    with Path(spawn, kind, inward=f"&in_fault={loss}") as path:
        path.send()
        got, link = path.arrived(lambda link: link["frames_in"] + link["fault_lost"] == COUNT)

    kept = set(got)
    assert got == [frame for frame in path.sent if frame in kept] and len(got) == COUNT - link["fault_lost"]
    assert link["lost"] == gap_sum(got) and 0 < link["fault_lost"] < COUNT / 2
    assert link["late"] == link["repeated"] == link["resync"] == link["junk_bytes"] == link["crc_error"] == 0


def test_loss_of_what_is_sent(spawn):
    with Path(spawn, outward="&out_fault=loss:0.1/5") as path:
        path.send()
        got, link = path.arrived(lambda link: link["frames_out"] + link["fault_lost"] == COUNT, "station")

    assert len(got) == COUNT - link["fault_lost"] and 0 < link["fault_lost"] < COUNT / 2
    kept = set(got)
    assert got == [frame for frame in path.sent if frame in kept]
    assert path.router.links()[0]["lost"] == 0


def test_a_frame_behind_noise_does_not_wait_for_more_bytes(spawn):
    with Path(spawn, "tcpin", inward="&in_fault=loss:0.000001") as path:
        frame = routers.attitude(VEHICLE)
        path.vehicle.send(b"\xfd" + frame)
        assert path.station.count(1) == [frame]


@pytest.mark.parametrize("kind", ["udpin", "tcpin"])
def test_copies(spawn, kind):
    with Path(spawn, kind, inward="&in_fault=duplicate:0.1") as path:
        path.send()
        got, link = path.arrived(lambda link: link["frames_in"] == COUNT + link["fault_duplicated"])

    assert link["repeated"] == link["fault_duplicated"] > 0
    assert len(got) == COUNT + link["fault_duplicated"]
    assert list(dict.fromkeys(got)) == path.sent and link["lost"] == link["late"] == 0


def test_frames_that_were_held_back(spawn):
    with Path(spawn, inward="&in_fault=reorder:0.1/15ms") as path:
        path.send(500, pause=0.002)
        got, link = path.arrived(lambda link: link["frames_in"] == 500)

    place = {frame: number for number, frame in enumerate(path.sent)}
    order = [place[frame] for frame in got]
    overtaken = sum(number < max(order[:i], default=-1) for i, number in enumerate(order))
    assert sorted(order) == list(range(500)) and overtaken > 0
    # A busy machine may send so slowly that nothing overtakes a frame, or read so late that too much does.
    assert overtaken <= link["fault_reordered"]
    if link["resync"] == 0 and link["repeated"] == 0:
        assert link["late"] == overtaken and link["lost"] == 0


@pytest.mark.parametrize("kind", ["udpin", "tcpin"])
def test_corruption(spawn, kind):
    with Path(spawn, kind, inward="&in_fault=corrupt:0.1") as path:
        def undecided(link):
            return sum(map(len, path.sent)) - link["bytes_in"] - link["junk_bytes"]
        path.send()
        harness.wait_for(lambda: (link := path.link("vehicle")) and undecided(link) <= LONGEST_FRAME, what="the frames")
        # The rest of a damaged frame may look like the start of a long frame, until more bytes arrive.
        path.router.ask("fault", name="vehicle", **{"in": "off"})
        path.send(10)
        got, link = path.arrived(lambda link: undecided(link) == 0)

    kept = set(got)
    whole = [frame for frame in path.sent if frame in kept]
    assert len(path.sent) - len(whole) == link["fault_corrupted"] > 0
    # An inverted bit of the message id may leave a frame of an unknown message.
    strange = [frame for frame in got if frame not in set(path.sent)]
    assert len(strange) == link["unknown_ids"] and link["frames_in"] == len(whole) + len(strange)
    assert link["lost"] == gap_sum(got) and link["late"] == link["repeated"] == link["resync"] == 0
    assert 0 < link["crc_error"]


def test_cut_frames(spawn):
    with Path(spawn, "tcpin", inward="&in_fault=cut:0.1") as path:
        path.send()
        got, link = path.arrived(lambda link: link["frames_in"] + link["fault_cut"] == COUNT)

    kept = set(got)
    assert got == [frame for frame in path.sent if frame in kept]
    assert COUNT - len(got) == link["fault_cut"] > 0
    assert link["lost"] == gap_sum(got) and link["junk_bytes"] > 0


def test_cut_frames_of_what_is_sent(spawn):
    port = routers.tcp_port()
    # Without a second start byte, so that the cuts can be found.
    sent = [frame for frame in (routers.attitude(VEHICLE) for _ in range(2 * COUNT)) if 0xFD not in frame[1:]][:COUNT]
    with UdpEnd((LOCALHOST, routers.udp_port())) as vehicle:
        router = Router(spawn, f"udpin://{LOCALHOST}:{vehicle.target[1]}",
                        f"tcpin://{LOCALHOST}:{port}?name=station&queue_age=60&out_fault=cut:0.1")
        station = routers.tcp_client(port)
        router.wait_links(1)
        for frame in sent:
            vehicle.send(frame)
        link = harness.wait_for(lambda: next((link for link in router.links() if link["endpoint"] == "station"
                                              and link["frames_out"] == COUNT), None), what="the last frame")
        data = b""
        while len(data) < link["bytes_out"]:
            data += station.sock.recv(65536)
        station.close()
    assert len(data) == link["bytes_out"] < sum(map(len, sent)) and link["fault_cut"] > 0
    for frame in sent:  # of each frame a beginning, and of most the whole
        size = next(size for size in range(len(frame), 0, -1) if data[:size] == frame[:size])
        data = data[size:]
        link["fault_cut"] -= size < len(frame)
    assert data == b"" and link["fault_cut"] == 0


def test_a_black_out(spawn):
    with Path(spawn, inward="&in_fault=blackout:200ms/1s") as path:
        path.send(600, pause=0.005)  # 40 frames a black-out, if the machine is not busy
        got, link = path.arrived(lambda link: link["frames_in"] + link["fault_blackout"] == 600)

    steps = [later - earlier for earlier, later in zip(numbers(got), numbers(got)[1:])]
    assert link["fault_blackout"] > 0 and len(got) == 600 - link["fault_blackout"]
    assert link["lost"] == gap_sum(got) and link["resync"] == 0
    assert 1 <= sum(step > 1 for step in steps) <= 1 + 600 * 0.005 * 50  # each black-out is one gap


def test_a_narrow_line(spawn):
    with Path(spawn, outward="&out_fault=rate:40k/8k") as path:
        begin = time.monotonic()
        path.send()
        got, link = path.arrived(lambda link: link["frames_out"] + link["fault_queue"] == COUNT, "station")
        took = time.monotonic() - begin

    assert len(got) == COUNT - link["fault_queue"] and link["fault_queue"] > 0
    kept = set(got)
    assert got == [frame for frame in path.sent if frame in kept]
    assert took >= sum(map(len, got)) / (40 * 1024)
    assert link["queue_bytes"] == link["queue_age"] == link["held_dropped"] == 0


def test_a_delay_takes_that_long_and_keeps_the_order(spawn):
    with Path(spawn, inward="&in_fault=delay:300ms~100ms") as path:
        begin = time.monotonic()
        path.send(50)
        assert path.station.count(50) == path.sent
        assert time.monotonic() - begin >= 0.2
        assert path.link("vehicle")["fault_delayed"] == 50


def test_the_same_seed_loses_the_same_frames(spawn):
    def lost(seed):
        with Path(spawn, inward=f"&in_fault=loss:0.2/3&fault_seed={seed}") as path:
            path.send(300)
            got, _ = path.arrived(lambda link: link["frames_in"] + link["fault_lost"] == 300)
            return [frame not in set(got) for frame in path.sent]

    first = lost(1)
    assert first == lost(1) and first != lost(2)


# ---- while it runs, and elsewhere ------------------------------------------------------------------------------------

def test_faults_change_while_a_router_runs(spawn, run):
    with Path(spawn) as path:
        path.send(10)
        path.arrived(lambda link: link["frames_in"] == 10)
        name = path.router.name
        assert path.link("vehicle")["faults"] == "off"
        assert run("ctl", name, "fault", "vehicle", "loss:1").status == 0
        assert path.link("vehicle")["faults"] == "in and out loss:1, seed 1"
        path.send(10)
        harness.wait_for(lambda: path.link("vehicle")["fault_lost"] == 10, what="ten lost frames")
        assert run("ctl", name, "fault", path.link("vehicle")["link"], "--out", "sik", "--seed", "5").status == 0
        assert path.link("vehicle")["faults"] == "in loss:1, out sik, seed 5"
        assert "  faults on purpose: in loss:1, out sik, seed 5\n" in run("stat", name).stdout
        assert run("ctl", name, "fault", path.link("vehicle")["link"], "--in", "off").status == 0
        assert path.link("vehicle")["faults"] == "in off, out sik, seed 5"
        assert run("ctl", name, "fault", "vehicle", "off").status == 0
        path.send(10)
        assert path.station.count(10) == path.sent[20:]
        assert path.link("vehicle")["lost"] == 10 and path.link("vehicle")["faults"] == "off"

        for wrong, why in ((["vehicle", "los:1"], "did you mean 'loss'?"), (["vehicle"], "fault takes faults"),
                           (["nobody", "sik"], "there is no endpoint or link 'nobody'"),
                           (["vehicle", "sik", "--in", "sik"], "fault takes faults")):
            done = run("ctl", name, "fault", *wrong)
            assert done.status != 0 and why in done.stderr, done
        assert "--seed are for fault" in run("ctl", name, "links", "--seed", "1").stderr


@pytest.mark.parametrize("wrong", [
    {}, {"faults": "off"}, {"seed": "3"}, {"in": None}, {"in": 1, "out": "sik"}, {"out": ["sik"]},
    {"in": "sik", "seed": True}, {"in": "sik", "seed": 1.5}, {"in": "sik", "seed": -1}, {"in": ""}])
def test_a_wrong_request_changes_nothing(spawn, wrong):
    with Path(spawn) as path:
        ask, right = path.router.ask, {"in": "loss:0.1", "out": "sik", "seed": 7}
        ask("fault", name="station", **right)
        with pytest.raises(AssertionError, match="'ok': False"):
            ask("fault", name="station", **wrong)
        assert path.link("station")["faults"] == "in loss:0.1, out sik, seed 7"
        ask("fault", name="station", **{"in": "off"})
        assert path.link("station")["faults"] == "in off, out sik, seed 7"


def test_a_router_reports_its_faults_at_start_and_in_stat(spawn, run):
    port, name = routers.udp_port(), f"faulty-{routers.udp_port()}"
    router = spawn("route", f"udpin://{LOCALHOST}:{port}?in_fault=loss:1", "--ring", name)
    router.wait_output(f"udpin://{LOCALHOST}:{port}: faults on purpose: in loss:1, out off, seed 1")
    with UdpEnd((LOCALHOST, port)) as vehicle:
        for _ in range(5):
            vehicle.send(routers.attitude())
        harness.wait_for(lambda: "fault_lost 5" in run("stat", name).stdout, what="the counter in stat")


def test_a_log_continues_on_a_new_line_when_its_disk_was_full(spawn, tmp_path):
    log = tmp_path / "faults.tsv"
    with contextlib.closing(SmallDisk(tmp_path)) as disk:
        with Path(spawn, inward="&in_fault=loss:1", more=("--fault-log", log)) as path:
            path.send(3000)
            harness.wait_for(lambda: path.link("vehicle")["fault_lost"] == 3000, what="the losses")
            full = log.stat().st_size
            disk.free(path.router.process.pid)
            path.send(10)
            harness.wait_for(lambda: path.link("vehicle")["fault_lost"] == 3010, what="the last losses")
        lines = [line.split("\t") for line in log.read_text().splitlines()]
    assert full < 3000 * 40, "the disk was full"
    assert all(len(line) == 8 for line in lines[-10:])
    assert sum(len(line) != 8 for line in lines) <= 1 and max(map(len, lines)) == 8


def test_the_log_has_a_line_for_each_fault(spawn, tmp_path):
    log = tmp_path / "faults.tsv"
    with Path(spawn, inward="&in_fault=loss:0.2,duplicate:0.1", more=("--fault-log", log)) as path:
        path.send(300)
        got, link = path.arrived(lambda link: link["frames_in"] - link["fault_duplicated"] + link["fault_lost"] == 300)
    head, *lines = [line.split("\t") for line in log.read_text().splitlines()]
    assert head == ["time_us", "link", "direction", "fault", "bytes", "message", "sender", "sequence"]
    kept = set(got)
    assert [line[3:] for line in lines if line[3] == "loss"] == [
        ["loss", str(len(frame)), "30", "1/1", str(frame[4])] for frame in path.sent if frame not in kept]
    assert sum(line[3] == "duplicate" for line in lines) == link["fault_duplicated"]
    assert {(line[1], line[2]) for line in lines} == {(link["link"], "in")}
    assert [int(line[0]) for line in lines] == sorted(int(line[0]) for line in lines)


def test_a_log_that_cannot_be_written_is_an_error(run, tmp_path):
    for command in (["route", "udpin://127.0.0.1:1"], ["relay", "udpin://127.0.0.1:0", "--to", "udpout://127.0.0.1:1"],
                    ["sim"]):
        done = run(*command, "--fault-log", tmp_path / "missing" / "faults.tsv")
        assert done.status == 1 and "cannot create the fault log" in done.stderr, done


def test_a_log_continues_and_no_other_file_is_touched(run, tmp_path):
    log, other, pipe = tmp_path / "faults.tsv", tmp_path / "flight.tlog", tmp_path / "pipe"
    other.write_bytes(b"\0" * 100)
    os.mkfifo(pipe)
    for path in (other, pipe):
        done = run("sim", "--fault-log", path, "--for", "10ms")
        assert done.status == 1 and "is no fault log, and stays as it is" in done.stderr, done
    assert other.read_bytes() == b"\0" * 100
    for _ in range(2):
        run("sim", "--ring", f"log-{os.getpid()}", "--fault-log", log, "--for", "10ms")
    assert log.read_text() == "time_us\tlink\tdirection\tfault\tbytes\tmessage\tsender\tsequence\n"


@pytest.mark.parametrize("fault, injected, counted", [
    ("loss:0.1/5", "fault_lost", "lost"), ("duplicate:0.1", "fault_duplicated", "duplicate")])
def test_listen_counts_what_was_injected(spawn, run, fault, injected, counted):
    listen = spawn("listen", "udpin://127.0.0.1:0", "--json", "--stats")
    listening = int(listen.wait_output(r"listening on port (\d+)", stream="err")[1])
    port = routers.udp_port()
    router = Router(spawn, f"udpin://{LOCALHOST}:{port}", f"udpout://{LOCALHOST}:{listening}?name=station&queue_age=60")

    def station():
        return next(link for link in router.links() if link["endpoint"] == "station")

    with UdpEnd((LOCALHOST, port)) as vehicle:
        def pass_on(number):
            before = station()
            for _ in range(number):
                vehicle.send(routers.attitude((9, 1)))
            harness.wait_for(lambda: (now := station())["frames_out"] + now["fault_lost"] - now["fault_duplicated"]
                             == before["frames_out"] + before["fault_lost"] - before["fault_duplicated"] + number,
                             what="the last frame")
        pass_on(1)  # the faults are between the first and the last frame
        assert run("ctl", router.name, "fault", "station", fault).status == 0
        for _ in range(10):
            pass_on(100)
        assert run("ctl", router.name, "fault", "station", "off").status == 0
        pass_on(1)
        link = station()
        harness.wait_for(lambda: sum('"ATTITUDE"' in line for line in listen.stdout.splitlines())
                         == link["frames_out"], what="all frames in listen")
    source = next(source for source in json.loads(listen.stop().stdout.splitlines()[-1])["stats"]["sources"]
                  if source["sys"] == 9)
    assert source[counted] == link[injected] > 0
    others = {"lost", "duplicate", "late", "resync"} - {counted}
    assert not any(source[name] for name in others)


def test_a_relay_and_a_simulator_obey_too(spawn, run):
    with UdpEnd() as station:
        name = f"faulty-{station.port}"
        spawn("sim", "--to", f"udpout://{LOCALHOST}:{station.port}?name=station&out_fault=loss:0.5", "--name", name)
        def lost():
            links = [json.loads(line) for line in run("ctl", name, "links").stdout.splitlines()]
            link = next((o for o in links if o.get("link") == "station"), {})
            return link.get("fault_lost", 0) > 10 and link
        link = harness.wait_for(lost, what="lost frames")
        assert link["faults"] == "in off, out loss:0.5, seed 1"
        assert run("ctl", name, "fault", "station", "off").status == 0

        relay = spawn("relay", "udpin://127.0.0.1:0", "--to", f"udpout://{LOCALHOST}:{station.port}?fault=duplicate:1")
        port = int(relay.wait_output(r"listening on port (\d+)", stream="err")[1])
        with UdpEnd((LOCALHOST, port)) as vehicle:
            frame = routers.attitude((77, 1))
            vehicle.send(frame)
            station.until(frame)
            station.until(frame)
