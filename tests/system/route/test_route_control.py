# SPDX-License-Identifier: MIT
"""Around the routing: ctl, stat, metrics, reload, --explain, keys and signatures at the border, recordings, and what
bad input gets."""
import contextlib
import fcntl
import json
import os
import pathlib
import random
import re
import shutil
import signal
import socket
import stat
import subprocess
import tempfile
import time
import urllib.error
import urllib.request

import pytest
from prometheus_client.parser import text_string_to_metric_families

import frames
import harness
import routers
from frames import mavlink
from routers import Net, Router, UdpEnd, attitude, command, damaged, heartbeat, unknown
from pymavlink import mavutil  # after frames, which sets MAVLink 2

pytestmark = pytest.mark.short

GCS, VEHICLE = (255, 190), (1, 1)
CLOCK_STEP_S = 0.02  # the router reads its clock once a turn of its loop


@pytest.fixture
def net(spawn):
    made = []

    def build(kind, count=2, **options):
        made.append(Net(spawn, kind, count if isinstance(kind, str) else len(kind), **options))
        return made[-1]
    yield build
    for one in made:
        one.__exit__()


@pytest.fixture
def ctl(run):
    def call(router, *args, command="ctl"):
        return run(command, router.name, *args, env=router.env)
    return call


def lines_of(done):
    assert done.status == 0, done
    return [json.loads(line) for line in done.lines]


# ---- ctl -------------------------------------------------------------------------------------------------------------

def test_ctl_links_counts_what_came_and_went(net, ctl):
    sut = net(("udpout", "tcpin"))
    first, second = attitude(), attitude()
    assert sut.send(1, first, second) == [[2], [2]]
    links = {link["endpoint"]: link for link in lines_of(ctl(sut.router, "links"))}

    assert set(links) == {"A", "B"}
    # Two frames and a mark came on A, one mark on B; and each went out on the other.
    a, b, mark = links["A"], links["B"], len(heartbeat())
    assert (a["frames_in"], a["frames_out"], b["frames_in"], b["frames_out"]) == (3, 1, 1, 3)
    assert a["bytes_in"] == b["bytes_out"] == len(first) + len(second) + mark
    assert a["forwarded"] == 3 and a["up"] is True and a["kind"] == "link"


@pytest.mark.parametrize("kind", ["peers", "clients"])
def test_ctl_remove_closes_one_link(net, ctl, kind):
    sut = net(kind, 3)
    sut.hears(1, VEHICLE)
    gone, stays = sut.link(1)["link"], sut.link(2)["link"]
    assert ctl(sut.router, "remove", gone).status == 0

    assert gone not in {link["link"] for link in sut.router.links()}
    assert stays in {link["link"] for link in sut.router.links()}
    assert sut.router.routes() == {route for route in sut.router.routes() if route[2] != gone}
    frame = attitude((2, 1))
    sut[2].send(frame)
    assert sut[3].next() == frame and gone not in {link["link"] for link in sut.router.links()}
    if kind == "clients":
        assert sut[1].sock.recv(1) == b"", "it was disconnected"
    else:
        back = heartbeat(VEHICLE)
        sut[1].send(back)
        assert sut[2].next() == back, "it is a new link when it speaks again"
    again = ctl(sut.router, "remove", f"{gone}0")
    assert again.status == 1 and "there is no endpoint" in again.stderr


def test_a_group_has_one_mode(net, ctl, run, udp_port):
    sut = net("udpout", 2, options={1: "group=air&group_mode=best"})
    other = ctl(sut.router, "add", f"udpin://127.0.0.1:{udp_port()}?group=air&group_mode=primary")
    assert other.status == 1 and "group 'air' already has group_mode=best; a group has one" in other.stderr
    assert ctl(sut.router, "add", f"udpin://127.0.0.1:{udp_port()}?group=air").status == 0, "it takes the group's"

    assert ctl(sut.router, "add", f"udpin://127.0.0.1:{udp_port()}?group=sea&group_mode=primary&name=boat").status == 0
    assert ctl(sut.router, "add",
               f"udpin://127.0.0.1:{udp_port()}?group=sea").status == 0, "of a group that came by ctl too"

    both = [f"udpin://127.0.0.1:{udp_port()}?group=air&group_mode={mode}" for mode in ("best", "all")]
    done = run("route", *both, "--for", "1s")
    assert done.status == 2 and "group 'air' already has group_mode=best; a group has one" in done.stderr


def test_ctl_routes_are_what_was_heard(net, ctl):
    sut = net(("udpout", "tcpin"))
    sut.hears(1, VEHICLE)
    begin = time.monotonic()
    sut.hears(1, VEHICLE)
    heard = time.monotonic()
    harness.wait_for(lambda: time.monotonic() > heard + 0.2, what="an age")
    sut.hears(2, GCS)
    asked = time.monotonic()
    routes = lines_of(ctl(sut.router, "routes"))
    now = time.monotonic()

    assert {(r["kind"], r["sys"], r["comp"], r["frames"]) for r in routes} == {
        ("route", 1, 1, 2), ("route", 255, 190, 1)}
    vehicle, station = sorted(routes, key=lambda route: route["sys"])
    assert vehicle["link"] == "A"
    assert asked - heard - CLOCK_STEP_S <= vehicle["age_s"] <= now - begin + CLOCK_STEP_S
    assert 0 <= station["age_s"] <= now - heard - 0.2 + CLOCK_STEP_S


def test_ctl_stats_has_sources_messages_and_unknown_targets(net, ctl):
    sut = net(("udpout", "udpout"))
    mav = frames.sender(7, 1)
    for sequence in (0, 1, 5):  # three are missing
        mav.seq = sequence
        sut[1].send(mavlink.MAVLink_attitude_message(sequence, 0, 0, 0, 0, 0, 0).pack(mav))
    sut[2].count(3)
    sut.command(1, VEHICLE, (66, 6))
    stats = lines_of(ctl(sut.router, "stats"))

    assert {line["kind"] for line in stats} == {"router", "endpoint", "gone", "link", "source", "message",
                                                "unknown_target"}
    source = next(s for s in stats if s["kind"] == "source" and s["sys"] == 7)
    assert (source["frames"], source["lost"], source["link"]) == (3, 3, "A")
    message = next(m for m in stats if m["kind"] == "message" and m["name"] == "ATTITUDE")
    assert (message["frames"], message["id"], message["sys"], message["comp"]) == (3, 30, 7, 1)
    assert [(u["sys"], u["comp"], u["frames"]) for u in stats if u["kind"] == "unknown_target"] == [(66, 6, 1)]


def test_stats_keep_what_a_link_had_that_is_gone(net):
    sut = net("clients", 2)
    for _ in range(5):
        sut.send(2, attitude(VEHICLE))
    had = sut.link(2)
    sut[2].close()
    sut.router.wait_links(1)

    (gone,) = sut.router.stats("gone")
    assert gone["frames_in"] == had["frames_in"] >= 5 and gone["frames_out"] == had["frames_out"]
    assert gone["endpoint"] == had["endpoint"]


VERDICTS = ("forwarded", "nowhere", "filtered", "rate_limited", "duplicate", "echo", "unknown_target", "consumed",
            "tap", "private_link")


def test_each_frame_of_a_link_is_in_one_of_its_verdicts(net):
    sut = net(("udpout", "udpout", "udpout", "udpout"), rules={"dedup_ms": 60_000, "heartbeat": "7/191"},
              options={2: "tap=true", 3: "private=true", 4: "in_block=ATTITUDE&max_rate=HEARTBEAT:0.01"})
    sent = attitude(VEHICLE)
    wanted = {number: dict.fromkeys(VERDICTS, 0) for number in (1, 2, 3, 4)}
    for number, frame, verdict in (
            (1, heartbeat(VEHICLE), "forwarded"), (1, heartbeat(VEHICLE), "rate_limited"), (1, sent, "forwarded"),
            (1, sent, "duplicate"), (4, sent, "filtered"), (1, command(GCS, VEHICLE), "nowhere"),
            (1, command(GCS, (66, 6)), "unknown_target"), (1, command(GCS, (7, 191)), "consumed"),
            (2, attitude((7, 2)), "tap"), (3, attitude((7, 3)), "private_link")):
        sut[number].send(frame)
        wanted[number][verdict] += 1
        sut.router.wait_counter(sut[number], verdict, wanted[number][verdict])
    there = command(GCS, (5, 5))
    sut[4].send(heartbeat((5, 5)))
    wanted[4]["forwarded"] += 1
    sut.router.wait_counter(sut[4], "forwarded", 1)
    for number, verdict in ((1, "forwarded"), (4, "echo")):  # out to the only link that has its target, and back
        sut[number].send(there)
        wanted[number][verdict] += 1
        sut.router.wait_counter(sut[number], verdict, wanted[number][verdict])

    for number, verdicts in wanted.items():
        link = sut.link(number)
        assert {verdict: link[verdict] for verdict in VERDICTS} == verdicts
        assert link["frames_in"] == sum(verdicts.values())


def test_ctl_add_moves_no_file_away_that_is_no_recording(net, ctl, tmp_path):
    sut = net(("udpout",))
    hosts = tmp_path / "hosts"
    hosts.write_text("127.0.0.1 localhost\n")
    refused = ctl(sut.router, "add", f"tlog://{hosts}")

    assert refused.status == 1 and f"{hosts} exists and is not a tlog recording" in refused.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["hosts"]
    assert hosts.read_text() == "127.0.0.1 localhost\n"


def test_ctl_add_and_remove_while_it_runs(net, ctl):
    sut = net(("udpout", "tcpin"))
    port, near = UdpEnd(), routers.udp_port()
    port.target = ("127.0.0.1", near)
    url = f"udpout://127.0.0.1:{port.port}?bind=127.0.0.1:{near}&name=tablet"
    assert lines_of(ctl(sut.router, "add", url)) == []
    frame = attitude()
    sut[1].send(frame)
    assert port.until(frame) == []
    port.send(heartbeat(GCS))
    sut[1].next()
    sut[2].count(2)
    before = sut.link(2)
    assert lines_of(ctl(sut.router, "remove", "tablet")) == []
    time = r"\d{4}-\d\d-\d\d \d\d:\d\d:\d\d"
    sut.router.process.wait_output(
        rf"^mavloom: {time} tablet: added by ctl\n(.*\n)*mavloom: {time} tablet: removed by ctl$", stream="err")
    assert sut.send(1, attitude()) == [2]

    assert port.now() == []
    assert {link["endpoint"] for link in sut.router.links()} == {"A", "B"}
    assert (255, 190) not in {route[:2] for route in sut.router.routes()}
    assert sut.link(2)["frames_in"] == before["frames_in"] + 1  # the others were left alone
    assert lines_of(ctl(sut.router, "add", url)) == []  # its port is free again
    port.close()


@pytest.mark.parametrize("arguments, said", [
    (("add", "udpout://0.0.0.0:14550"), "0.0.0.0"),
    (("add", "udpin://127.0.0.1:0"), "other programs must know a router's port"),
    (("add", "udpout://127.0.0.1:14550?nmae=x"), "did you mean 'name'?"),
    (("add", "udpout://127.0.0.1:14550?name=A"), "two endpoints are named A"),
    (("add", "udpout://127.0.0.1:14550?in_block=HARTBEAT"), "did you mean 'HEARTBEAT'?"),
    (("remove", "C"), "there is no endpoint C"),
])
def test_ctl_refuses_with_the_cure(net, ctl, arguments, said):
    sut = net(("udpout", "tcpin"))
    done = ctl(sut.router, *arguments)

    assert done.status == 1 and said in done.stderr and len(done.stderr.splitlines()) == 1
    assert len(sut.router.links()) == 2
    assert sut.send(1, attitude()) == [2]


@pytest.mark.parametrize("arguments", [("jump",), ("add",), ("remove",), ("links", "x"), ()])
def test_ctl_that_is_used_wrongly(run, arguments):
    assert run("ctl", "router", *arguments).status == 2


@pytest.mark.parametrize("args", [("ctl", "nobody-at-all", "links"), ("stat", "nobody-at-all")])
def test_nobody_of_that_name(run, args):
    done = run(*args)

    assert done.status == 1 and "no router or simulator called 'nobody-at-all' runs here" in done.stderr


def test_without_a_router_the_names_of_others_are_listed(spawn, run, tmp_path):
    env = {"MAVLOOM_RUN": str(tmp_path)}
    spawn("sim", "--listen", "tcpin://127.0.0.1:0", "--name", "bird", env=env)
    harness.wait_for(lambda: run("ctl", "bird", "state", env=env).status == 0, what="the simulator's answer")

    for command in (("stat", "nobody-at-all"), ("ctl", "nobody-at-all", "links")):
        done = run(*command, env=env)
        assert done.status == 1 and done.stderr.endswith("; running: bird (simulator)\n"), done


def test_the_socket_survives_whatever_is_sent(net):
    sut = net(("udpout", "tcpin"))
    path = control_path(sut.router)
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
    for said, refused in ((b"garbage\n", True), (b"[1,2]\n", True), (b'{"cmd":7}\n', True), (b'{"cmd":"jump"}\n', True),
                          (b'{"cmd":"add"}\n', True), (b"\xff\xfe\n", True), (b"x" * 100_000, True),
                          (b'{"cmd":"links"', False), (b"", False)):
        with socket.socket(socket.AF_UNIX) as client:
            client.connect(str(path))
            client.settimeout(harness.DEFAULT_TIMEOUT_S)
            answer = b""
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # it hangs up in too long a line
                client.sendall(said)
                client.shutdown(socket.SHUT_WR)
            with contextlib.suppress(ConnectionResetError):
                while data := client.recv(65536):
                    answer += data
        if refused:
            assert json.loads(answer)["ok"] is False and json.loads(answer)["error"]
        else:
            assert answer == b""
    clients = [socket.socket(socket.AF_UNIX) for _ in range(100)]
    for client in clients:
        client.settimeout(harness.DEFAULT_TIMEOUT_S)
        client.connect(str(path))
    for client in clients:
        client.close()

    assert sut.send(1, attitude()) == [2]
    assert len(sut.router.links()) == 2


def control_path(router):
    return str(harness.RUN / f"{router.name}.ctl")


def test_two_of_one_name(spawn, run):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    done = run("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", router.name, env=router.env)

    assert done.status == 1
    assert f"{router.name}.ctl is served by another process; give this one another name with --name" in done.stderr
    assert len(router.ask("links")) == 0


def test_idle_clients_lock_nobody_out(spawn, run):
    port = routers.tcp_port()
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}", "--metrics", f"127.0.0.1:{port}")
    with contextlib.ExitStack() as opened:
        idle = []
        for _ in range(64):
            idle.append(opened.enter_context(socket.socket(socket.AF_UNIX)))
            idle[-1].connect(control_path(router))
        crowd = [opened.enter_context(socket.create_connection(("127.0.0.1", port))) for _ in range(64)]
        for client in (*idle, *crowd):
            client.settimeout(harness.DEFAULT_TIMEOUT_S)

        assert run("ctl", router.name, "links", env=router.env).status == 0
        assert fetch(port)[1]
        assert idle[0].recv(1) == b"" and crowd[0].recv(1) == b""  # the longest idle went
        idle[-1].sendall(b'{"cmd":"links"}\n')
        assert json.loads(idle[-1].recv(65536)) == {"ok": True}


def test_a_control_socket_that_somebody_removes_is_created_again(spawn, run):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path = control_path(router)
    os.unlink(path)
    router.process.wait_output(f"control socket {path} was removed; it is created again", stream="err")
    assert run("ctl", router.name, "links", env=router.env).status == 0
    assert stat.S_IMODE(os.stat(path).st_mode) == 0o600
    assert router.links() == []  # connections stay
    os.unlink(f"{path}.lock")
    os.unlink(path)
    harness.wait_for(lambda: os.path.exists(path), what="the socket")

    assert os.path.exists(f"{path}.lock")
    assert router.process.stop(signal.SIGTERM).status == 143
    assert not os.path.exists(path) and not os.path.exists(f"{path}.lock")


@pytest.mark.parametrize("what", ["file", "folder"])
def test_what_takes_the_place_of_the_control_socket_is_reported_and_stays(spawn, run, what):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path = pathlib.Path(control_path(router))
    aside = path.with_suffix(".aside")
    aside.mkdir() if what == "folder" else aside.write_text("precious")
    os.unlink(path)
    os.rename(aside, path)
    router.process.wait_output(f"control socket {path} was (removed|replaced): a {what} is in the place of the socket "
                               f"{path}; remove it", stream="err")
    assert path.is_dir() if what == "folder" else path.read_text() == "precious"

    os.rename(path, aside)
    router.process.wait_output(f"control socket {path} was removed; it is created again", stream="err")
    assert run("ctl", router.name, "links", env=router.env).status == 0
    aside.rmdir() if what == "folder" else aside.unlink()


def test_a_file_in_the_place_of_the_control_socket_is_named_at_the_start(run):
    path = harness.RUN / f"test-{os.getpid()}-in-the-way.ctl"
    path.write_text("precious")
    refused = run("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", path.stem)

    assert refused.status == 1 and f"a file is in the place of the socket {path}; remove it" in refused.stderr
    assert path.read_text() == "precious"
    path.unlink()


def test_without_a_name_a_second_router_does_without_a_socket(spawn, tmp_path):
    env = {"MAVLOOM_RUN": str(tmp_path)}
    first, second = (spawn("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--metrics", "127.0.0.1:0", env=env)
                     for _ in range(2))
    for router in (first, second):
        router.wait_output(r"metrics on port \d+", stream="err")

    assert any("no control socket: " in router.stderr and "give this one another name with --name" in router.stderr
               for router in (first, second))
    assert first.alive and second.alive


@pytest.mark.parametrize("left", [False, True], ids=["nothing there", "left by a killed one"])
def test_of_routers_that_start_at_once_one_gets_the_socket(spawn, left):
    killed = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path = control_path(killed)
    killed.process.send(signal.SIGKILL)
    killed.process.process.wait()
    if not left:
        os.unlink(path)
    starting = [spawn("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", killed.name, env=killed.env)
                for _ in range(6)]
    harness.wait_for(lambda: sum(not router.alive for router in starting) == 5, what="five to be refused")
    refused = [router.wait() for router in starting if not router.alive]

    assert all(done.status == 1 and "is served by another process" in done.stderr for done in refused), refused
    killed._connect_to(path).close()


def test_a_user_who_may_only_look_into_the_folder_cannot_delay_routers(spawn):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    folder = os.open(os.path.dirname(control_path(router)), os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(folder, fcntl.LOCK_EX)
        assert Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}", env=router.env).stats("router")
    finally:
        os.close(folder)


def test_a_socket_that_nobody_serves_in_time_is_not_taken(spawn):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path, name = control_path(router), router.name
    assert router.process.stop(signal.SIGTERM).status == 143
    with socket.socket(socket.AF_UNIX) as hung, socket.socket(socket.AF_UNIX) as waiting:
        hung.bind(path)
        hung.listen(0)
        waiting.connect(path)  # its backlog is full now
        refused = spawn("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", name, env=router.env).wait()
    os.unlink(path)

    assert refused.status == 1 and "is served by another process" in refused.stderr


def test_a_name_of_another_user_is_one_that_is_taken(spawn, program, tmp_path):
    if os.geteuid() != 0:
        pytest.skip("two users need root")
    folder = tmp_path / "mavloom"
    folder.mkdir()
    (folder / "router.ctl.lock").touch(0o600)
    for place in (*list(tmp_path.parents)[:3], tmp_path, folder):
        place.chmod(0o777)
    script = ("mount -t tmpfs -o mode=755 none /run && exec setpriv --reuid=12345 --clear-groups "
              f"{program} route udpin://127.0.0.1:{routers.udp_port()} --for 100ms")
    other = subprocess.run(["unshare", "--mount", "sh", "-c", script], capture_output=True, text=True, timeout=60,
                           env=harness.environment({"MAVLOOM_RUN": None, "XDG_RUNTIME_DIR": str(tmp_path)}))

    assert (other.returncode == 0 and "no control socket: " in other.stderr
            and "is served by another process" in other.stderr), other


def test_the_end_of_a_router_leaves_the_socket_of_another(spawn):
    first = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path = control_path(first)
    first.process.send(signal.SIGSTOP)  # else it creates them again
    os.unlink(path)
    os.unlink(f"{path}.lock")
    second = spawn("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", first.name, env=first.env)
    harness.wait_for(lambda: os.path.exists(path), what="the second one's socket")
    first.process.send(signal.SIGCONT)
    assert first.process.stop(signal.SIGTERM).status == 143

    assert sorted(name for name in os.listdir(os.path.dirname(path)) if name.startswith(first.name + ".")) == \
        [f"{first.name}.ctl", f"{first.name}.ctl.lock"]
    assert second.stop(signal.SIGTERM).status == 143
    assert not os.path.exists(path) and not os.path.exists(f"{path}.lock")


def test_the_socket_goes_with_its_router_and_a_dead_ones_is_taken(spawn):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    path = control_path(router)
    router.process.send(signal.SIGKILL)
    router.process.process.wait()
    assert os.path.exists(path)
    again = spawn("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", router.name, env=router.env)
    harness.wait_for(lambda: router._connect_to(path), what="the new router's socket")
    done = again.stop(signal.SIGTERM)

    assert done.status == 143
    assert not os.path.exists(path)


def as_somebody(program):
    """The program, and Popen's options with which it runs as an ordinary user."""
    if os.geteuid() != 0:
        return program, {}
    folder = tempfile.mkdtemp(prefix="mv-")
    os.chmod(folder, 0o755)
    return shutil.copy(program, folder), {"user": 65534, "group": 65534, "extra_groups": []}


def test_a_key_of_somebody_else_is_a_bad_input_file(program, tmp_path):
    copy, user = as_somebody(program)
    if not user:
        pytest.skip("only root can make a file that its user may not read")
    folder = pathlib.Path(tempfile.mkdtemp(prefix="mv-"))
    folder.chmod(0o755)
    key = folder / "x.key"
    key.write_text("ab" * 32 + "\n")
    key.chmod(0o600)
    done = subprocess.run([copy, "route", f"udpin://127.0.0.1:{routers.udp_port()}?verify={key}"], capture_output=True,
                          text=True, timeout=harness.DEFAULT_TIMEOUT_S, **user)
    shutil.rmtree(folder)
    shutil.rmtree(os.path.dirname(copy))

    assert done.returncode == 3 and f"{key}: Permission denied" in done.stderr


def test_a_folder_whose_name_is_too_long_for_a_socket(program):
    copy, user = as_somebody(program)
    folder = tempfile.mkdtemp(prefix="mv-" + "x" * 100)
    os.chmod(folder, 0o777)
    try:
        env = harness.environment({"MAVLOOM_RUN": folder})
        for args in (("ctl", "x", "links"), ("route", f"udpin://127.0.0.1:{routers.udp_port()}", "--name", "x")):
            done = subprocess.run([copy, *args], env=env, capture_output=True, text=True,
                                  timeout=harness.DEFAULT_TIMEOUT_S, **user)
            assert done.returncode == 1 and "a socket's path has at most 107 bytes" in done.stderr, done
        unnamed = harness.Running([copy, "route", f"udpin://127.0.0.1:{routers.udp_port()}", "--for", "200ms"], env=env,
                                  **user)
        done = unnamed.wait()
        assert done.status == 0 and "a socket's path has at most 107 bytes" in done.stderr
    finally:
        shutil.rmtree(folder)
        if user:
            shutil.rmtree(os.path.dirname(copy))


# ---- stat, metrics ---------------------------------------------------------------------------------------------------

def test_stat_as_text_and_as_json(net, ctl):
    sut = net(("udpout", "tcpin"))
    sut.hears(1, VEHICLE)
    sut.send(1, unknown())
    sut.command(1, VEHICLE, (66, 6))
    text = ctl(sut.router, command="stat")
    lines = lines_of(ctl(sut.router, "--json", command="stat"))

    assert text.status == 0
    for pattern in (r"^up \d+ s; ", r"^link A$", r"^link B#127.0.0.1:\d+$",
                    r"^  in 6 frames, \d+ bytes; out 3 frames, \d+ bytes$", r"unknown_target 1",
                    r"^source 1/1 on A: 3 frames, 0 lost \(0\.00 %\)$",
                    r"^message HEARTBEAT +1/1 +1 frame +0\.00 Hz  A$", r"^message 70371 ",
                    r"^not routed: 1 frame for 66/6, which was not heard on any link$"):
        assert re.search(pattern, text.stdout, re.MULTILINE), f"{pattern}\n{text.stdout}"

    def steady(all_lines):
        return [{key: value for key, value in line.items() if key not in ("uptime_s", "rate_hz")} for line in all_lines]
    assert steady(lines) == steady(lines_of(ctl(sut.router, "stats")))


def fetch(port, path="/metrics", method="GET"):
    with urllib.request.urlopen(urllib.request.Request(f"http://127.0.0.1:{port}{path}", method=method),
                                timeout=harness.DEFAULT_TIMEOUT_S) as answer:
        return answer.headers["Content-Type"], answer.read().decode()


def metrics_of(text):
    """{(name, frozenset of labels): value} by Prometheus' own parser."""
    return {(sample.name, frozenset(sample.labels.items())): sample.value
            for family in text_string_to_metric_families(text) for sample in family.samples}


def test_metrics_are_what_prometheus_reads(net, run, tmp_path):
    port, third = routers.tcp_port(), UdpEnd()
    sut = net(("udpout", "tcpin"), extra=["--metrics", f"127.0.0.1:{port}", "--metrics-detail",
                                          f"tlog://{tmp_path}/x.tlog",
                                          f"udpout://127.0.0.1:{third.port}?name=a%22b%5Cc%20d"])
    sut.hears(1, VEHICLE)
    sut.send(1, unknown())
    sut.command(1, VEHICLE, (66, 6))
    harness.wait_for(lambda: sut.router.stats("recording")[0]["frames"] == 9, what="the recording")
    content_type, text = fetch(port)
    read = metrics_of(text)

    assert content_type.startswith("text/plain; version=0.0.4")
    expected = {}
    label_of = {"router": (), "endpoint": ("endpoint",), "gone": ("endpoint",), "link": ("link",),
                "source": ("link", "sys", "comp"), "recording": ("endpoint",)}
    for line in sut.router.ask("stats"):
        if line["kind"] not in label_of:
            continue
        labels = frozenset((key, str(line[key])) for key in label_of[line["kind"]])
        for key, value in line.items():
            name = f"mavloom_{line['kind']}_{key}_total"
            if isinstance(value, int) and (name, labels) in read:
                expected[name, labels] = value
    assert {key: read[key] for key in expected} == expected
    version, = (dict(labels)["version"] for name, labels in read if name == "mavloom_build_info")
    assert version in run("--version").stdout
    assert all(f"# HELP {name} " in text for name, _ in read)
    assert not re.findall(r"^# HELP \w+ Of each \w+: \W*$", text, re.M), "names without help"
    others = {key for key in set(read) - set(expected) if key[0] != "mavloom_build_info"}
    assert others == {key for key in read if key[0].startswith(("mavloom_message_", "mavloom_system_"))}
    assert read["mavloom_system_frames_total", frozenset({("link", "A"), ("sys", "1")})] == sum(
        line["frames"] for line in sut.router.stats("source") if (line["link"], line["sys"]) == ("A", 1))
    assert read["mavloom_link_frames_in_total", frozenset({("link", "A")})] == 6
    assert read["mavloom_link_unknown_target_total", frozenset({("link", "A")})] == 1
    assert ("mavloom_endpoint_send_errors_total", frozenset({("endpoint", 'a"b\\c d')})) in read
    message = frozenset({("link", "A"), ("sys", "1"), ("comp", "1"), ("message", "HEARTBEAT")})
    assert read["mavloom_message_frames_total", message] == 1
    for sent in range(3):  # counters only grow
        sut.send(1, attitude())
    again = metrics_of(fetch(port)[1])
    assert all(again[key] >= value for key, value in read.items())
    third.close()


def test_the_file_names_the_router_and_its_metrics(spawn, run, tmp_path):
    port, name, file = routers.tcp_port(), f"file-{os.getpid()}", tmp_path / "router.toml"
    env = {"MAVLOOM_RUN": str(tmp_path)}
    endpoint = f'[[endpoint]]\nurl = "udpin://127.0.0.1:{routers.udp_port()}"\n'
    file.write_text(f'[router]\nname = "{name}"\nmetrics = "127.0.0.1:{port}"\n{endpoint}')
    router = spawn("route", "--config", file, env=env)
    harness.wait_for(lambda: run("ctl", name, "links", env=env).status == 0, what="the control socket")

    assert "mavloom_router_heartbeats_sent_total" in fetch(port)[1]
    file.write_text(f'[router]\nname = "other"\n{endpoint}')
    router.send(signal.SIGHUP)
    router.wait_output("changed name and metrics take effect when the router restarts", stream="err")
    assert fetch(port)[1]


def test_metrics_answers_what_it_does_not_serve(net):
    port = routers.tcp_port()
    sut = net(("udpout",), extra=["--metrics", f"127.0.0.1:{port}"])
    for path, method, status in (("/", "GET", 404), ("/metrics", "POST", 405)):
        with pytest.raises(urllib.error.HTTPError) as error:
            fetch(port, path, method)
        assert error.value.code == status
    with socket.create_connection(("127.0.0.1", port)) as client:
        client.sendall(b"HEAD /metrics HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")
        head = client.makefile("rb").read()
        assert head.startswith(b"HTTP/1.1 200 OK\r\n") and head.endswith(b"\r\n\r\n") and head.count(b"\r\n\r\n") == 1
    with socket.create_connection(("127.0.0.1", port)) as client:
        client.sendall(b"\x00\xffnot http\r\n\r\n")
        client.settimeout(harness.DEFAULT_TIMEOUT_S)
        assert client.recv(65536) == b""

    assert fetch(port)[1]
    assert sut.router.process.alive


@pytest.mark.parametrize("host, status", [("127.0.0.1", 200), ("127.0.0.1:9090", 200), ("localhost:1", 200),
                                          ("LocalHost", 200), ("localhost.:9090", 200), ("[::1]", 200),
                                          ("[::1]:9090", 200), ("127.0.0.2", 200), (None, 200), ("evil.example", 403),
                                          ("localhost..", 403), ("localhost.evil.example", 403), ("10.0.0.1", 403),
                                          ("[::1", 403), ("[::2]", 403), (".", 403),
                                          ("127.0.0.1.evil.example:9090", 403)])
def test_a_web_page_cannot_read_the_metrics_of_this_machine(net, host, status):
    """A page's own name may lead to 127.0.0.1 (DNS rebinding); its Host header then still has that name."""
    port = routers.tcp_port()
    net(("udpout",), extra=["--metrics", f"127.0.0.1:{port}"])
    with socket.create_connection(("127.0.0.1", port)) as client:
        name = f"Host: {host}\r\n" if host else ""
        client.sendall(f"GET /metrics HTTP/1.1\r\n{name}Connection: close\r\n\r\n".encode())
        assert client.makefile("rb").readline().split()[1] == str(status).encode()


def test_an_idle_client_of_the_metrics_is_disconnected(net):
    port = routers.tcp_port()
    net(("udpout",), extra=["--metrics", f"127.0.0.1:{port}"])
    with socket.create_connection(("127.0.0.1", port)) as idle:
        idle.settimeout(harness.DEFAULT_TIMEOUT_S)
        assert idle.recv(1) == b""


# ---- reload ----------------------------------------------------------------------------------------------------------

class Reloadable:
    """A router with a file: `air` is udpin, `base` tcpin, and what a test adds."""

    def __init__(self, spawn, folder, *more, router_table="", arguments=()):
        self.file = folder / "router.toml"
        self.air_port, self.base_port = routers.udp_port(), routers.tcp_port()
        self.write(*more, router_table=router_table)
        self.router = Router(spawn, "--config", str(self.file), *arguments)
        self.peer, self.client = UdpEnd(("127.0.0.1", self.air_port)), routers.tcp_client(self.base_port)
        self.peer.send(heartbeat(VEHICLE))
        self.client.next()

    def write(self, *more, router_table="", air="idle=60"):
        urls = [f"udpin://127.0.0.1:{self.air_port}?name=air&{air}", f"tcpin://127.0.0.1:{self.base_port}?name=base",
                *more]
        self.file.write_text(router_table + "".join(f"[[endpoint]]\nurl = '{url}'\n" for url in urls))

    def reload(self, says="was read again"):
        seen = self.router.process.stderr.count(says)
        self.router.process.send(signal.SIGHUP)
        harness.wait_for(lambda: self.router.process.stderr.count(says) > seen, what=says)

    def passes(self):
        """Both ways over the connections that there are."""
        down, up = attitude(), command(GCS, VEHICLE)
        self.peer.send(down)
        self.client.until(down)
        self.client.send(up)
        self.peer.until(up)

    def names(self):
        return sorted(link["link"] for link in self.router.links())


@pytest.fixture
def reloadable(spawn, tmp_path):
    made = []

    def build(*more, **options):
        made.append(Reloadable(spawn, tmp_path, *more, **options))
        return made[-1]
    yield build
    for one in made:
        one.peer.close()
        one.client.close()


def test_reload_leaves_what_did_not_change_alone(reloadable):
    first, second = routers.udp_port(), routers.udp_port()
    sut = reloadable(f"udpout://127.0.0.1:{first}?name=copy")
    sut.passes()
    before = {link["link"]: link for link in sut.router.links()}
    routes = sut.router.routes()
    sut.write(f"udpout://127.0.0.1:{second}?name=copy", f"udpout://127.0.0.1:{first}?name=more")
    sut.reload()
    after = {link["link"]: link for link in sut.router.links()}

    kept = {name for name in before if name.startswith(("air#", "base#"))}
    assert len(kept) == 2 and {name: after[name] for name in kept} == {name: before[name] for name in kept}
    assert sut.router.routes() == routes
    sut.passes()
    assert (sut.router.link_of(sut.peer)["frames_in"]
            == before[next(n for n in kept if n.startswith("air"))]["frames_in"] + 1)
    assert sorted(e["endpoint"] for e in sut.router.stats("endpoint")) == ["air", "base", "copy", "more"]
    for said in ("copy: removed", "copy: added", "more: added"):
        assert said in sut.router.process.stderr


def test_reload_opens_a_changed_endpoint_again(reloadable):
    sut = reloadable()
    sut.write(air="idle=30")
    sut.reload()
    assert not any(name.startswith("air#") for name in sut.names())
    sut.peer.send(heartbeat(VEHICLE))
    sut.passes()

    assert sum(name.startswith("base#") for name in sut.names()) == 1


@pytest.mark.parametrize("broken, said", [
    ("[router\n", "router.toml:1: "),
    ("[router]\ndedup_sm = 1\n", "router.toml:2: [router] has no key 'dedup_sm', did you mean 'dedup_ms'?"),
    ("[[endpoint]]\nurl = 'udpin://127.0.0.1:14550?idel=2'\n", "did you mean 'idle'?"),
    ("[[endpoint]]\nurl = 'udpin://127.0.0.1:14550?out_block=ATITUDE'\n", "did you mean 'ATTITUDE'?"),
    (None, "cannot read"),
    ("", "has no endpoint"),
])
def test_a_broken_file_changes_nothing(reloadable, broken, said):
    sut = reloadable(f"udpout://127.0.0.1:{routers.udp_port()}?name=copy")
    before = sut.names()
    if broken is None:
        sut.file.unlink()
    else:
        sut.file.write_text(broken)
    sut.reload(says="nothing was changed")

    assert said in sut.router.process.stderr
    assert sut.names() == before
    sut.passes()


def test_a_file_whose_group_has_another_mode_on_the_command_line_changes_nothing(reloadable):
    sut = reloadable(arguments=[f"udpin://127.0.0.1:{routers.udp_port()}?name=own&group=radios&group_mode=best"])
    before = sut.names()
    sut.file.write_text('[router]\nheartbeat = "7/191"\n[[endpoint]]\n'
                        f'url = "udpin://127.0.0.1:{routers.udp_port()}?group=radios&group_mode=primary"\n')
    sut.reload(says="nothing was changed")
    assert sut.names() == before and "was read again" not in sut.router.process.stderr


def test_reload_leaves_out_what_cannot_be_opened(reloadable):
    sut = reloadable()
    taken = socket.create_server(("127.0.0.1", 0))
    free = routers.udp_port()
    sut.write(f"tcpin://127.0.0.1:{taken.getsockname()[1]}?name=taken", f"udpout://127.0.0.1:{free}?name=good")
    sut.reload()
    assert re.search("left out: taken: .*Address already in use", sut.router.process.stderr)
    assert [e["endpoint"] for e in sut.router.stats("endpoint")] == ["air", "base", "good"]
    sut.passes()
    taken.close()
    sut.reload()

    assert sorted(e["endpoint"] for e in sut.router.stats("endpoint")) == ["air", "base", "good", "taken"]


def test_a_changed_endpoint_that_cannot_be_opened_continues_as_it_was(reloadable):
    sut = reloadable()
    sut.write(air="iface=none0")
    sut.reload()
    assert "none0" in sut.router.process.stderr
    assert "air: continues with its former options" in sut.router.process.stderr
    sut.peer.send(heartbeat(VEHICLE))
    sut.passes()

    sut.write(air="idle=30")
    sut.reload()
    assert sut.router.process.stderr.count("air: added") == 1


@pytest.mark.parametrize("make, said", [(lambda path: None, "No such file"),
                                        (lambda path: os.mkfifo(path, 0o600), "is not a regular file"),
                                        (lambda path: (path.touch(), path.chmod(0o644)), "can be read by others")],
                         ids=["missing", "fifo", "readable"])
def test_reload_with_a_bad_key_changes_nothing(reloadable, tmp_path, make, said):
    sut = reloadable()
    key = tmp_path / "bad.key"
    make(key)
    sut.write(air=f"verify={key}")
    sut.reload(says="nothing was changed")

    assert re.search(rf"router.toml:2: verify: .*{key}.*{said}", sut.router.process.stderr)
    sut.passes()


def test_an_endpoint_of_the_command_line_stays_although_its_key_went(reloadable, tmp_path):
    key = tmp_path / "air.key"
    key.write_text("11" * 32)
    key.chmod(0o600)
    other = tmp_path / "other.key"
    other.write_text("22" * 32)
    other.chmod(0o600)
    sut = reloadable(arguments=[f"udpin://127.0.0.1:{routers.udp_port()}?name=signed&verify={key}&sign={other}"])
    key.unlink()
    other.write_text("33" * 32)  # this alone would be a reason to open it again
    sut.reload()

    assert "signed" in [e["endpoint"] for e in sut.router.stats("endpoint")]
    sut.passes()


def test_reload_takes_what_a_key_file_holds_now(reloadable, tmp_path):
    key = tmp_path / "air.key"
    key.write_text("11" * 32)
    key.chmod(0o600)
    sut = reloadable()
    sut.write(air=f"verify={key}")
    sut.reload()
    now = ticks_now()
    first, again, other = (heartbeat(VEHICLE, signing=(bytes([byte]) * 32, 5, now + i))
                           for i, byte in enumerate((0x11, 0x11, 0x22)))
    sut.peer.send(first)
    sut.client.until(first)
    sut.reload()
    assert sut.router.process.stderr.count("air: added") == 1  # the key is the same

    key.write_text("22" * 32)
    sut.reload()
    sut.peer.send(again)
    sut.peer.send(other)
    assert sut.client.until(other) == []
    assert sut.router.process.stderr.count("air: added") == 2


def test_what_the_holder_of_a_lost_key_did_goes_with_the_key(reloadable, tmp_path):
    key = tmp_path / "air.key"
    key.write_text("11" * 32)
    key.chmod(0o600)
    sut = reloadable()
    sut.write(air=f"verify={key}")
    sut.reload()
    now = ticks_now()
    of_next_year = heartbeat(VEHICLE, signing=(b"\x11" * 32, 5, now + 365 * 86400 * 100_000))
    sut.peer.send(of_next_year)
    sut.client.until(of_next_year)
    key.write_text("22" * 32)
    sut.reload()
    for link_id in (5, 6):  # the same sender, and one that is new
        good = heartbeat(VEHICLE, signing=(b"\x22" * 32, link_id, ticks_now()))
        sut.peer.send(good)
        assert sut.client.until(good) == []


def test_a_pipe_is_read_once(spawn, tmp_path):
    pipe = tmp_path / "router.toml"
    os.mkfifo(pipe)
    process = spawn("route", "--config", str(pipe), "--name", f"pipe-{os.getpid()}")
    pipe.write_text(f"[[endpoint]]\nurl = 'udpin://127.0.0.1:{routers.udp_port()}?name=air'\n")
    process.wait_output("air: listening", stream="err")
    process.send(signal.SIGHUP)
    process.wait_output("is a pipe or a terminal, which can be read only once; nothing was changed", stream="err")

    assert process.stop().status == 130


def test_reload_takes_other_rules_and_keeps_the_connections(reloadable):
    sut = reloadable()
    sut.passes()
    before = sut.names()
    sut.write(router_table="[router]\nunknown_target = 'flood'\n")
    sut.reload()
    lost = command(GCS, (66, 6))
    sut.client.send(lost)
    sut.peer.until(lost)

    assert sut.names() == before


def test_reload_of_rules_keeps_what_was_counted_and_learned(reloadable):
    sut = reloadable()
    sut.passes()
    sut.client.send(command(GCS, (66, 6)))
    harness.wait_for(lambda: any(row["unknown_target"] for row in sut.router.stats("link")), what="the count")
    harness.wait_for(lambda: sut.router.process.stderr.count(": up") == 2, what="both links to be reported")
    counters = ("forwarded", "nowhere", "unknown_target", "frames_in")
    before = [[row[name] for name in counters] for row in sut.router.stats("link")]
    routes = sut.router.ask("routes")
    sut.write(router_table="[router]\ndedup_ms = 5\nroute_timeout = 40\n")
    sut.reload()

    assert [[row[name] for name in counters] for row in sut.router.stats("link")] == before
    assert [r["frames"] for r in sut.router.ask("routes")] == [r["frames"] for r in routes] and routes
    assert sut.router.process.stderr.count(": up") == 2
    sut.passes()


def test_reload_takes_the_level_of_the_log(reloadable):
    sut = reloadable()
    sut.router.process.wait_output(r"air#.*: up", stream="err")
    sut.write(router_table="[log]\nlevel = 'error'\n")
    sut.reload()
    newcomer = UdpEnd(("127.0.0.1", sut.air_port))
    newcomer.send(heartbeat((3, 3)))
    harness.wait_for(lambda: len(sut.names()) == 3, what="the newcomer")

    assert f":{newcomer.port}: up" not in sut.router.process.stderr
    newcomer.close()


def test_reload_leaves_the_command_line_and_the_recording_alone(reloadable, tmp_path):
    log = tmp_path / "x.tlog"
    sut = reloadable(arguments=(f"udpout://127.0.0.1:{routers.udp_port()}?name=typed",),
                     router_table=f"[record]\npath = '{log}'\n")
    sut.write(f"udpout://127.0.0.1:{routers.udp_port()}?name=more", router_table=f"[record]\npath = '{log}'\n")
    sut.reload()

    assert sorted(e["endpoint"] for e in sut.router.stats("endpoint")) == ["air", "base", "more", "typed"]
    assert "typed: removed" not in sut.router.process.stderr
    sut.passes()
    sut.router.process.stop()
    assert not (tmp_path / "x.tlog.1").exists()
    assert len(frames.read_tlog(log)) == 3


def test_reload_keeps_a_groups_order_of_the_file(spawn, tmp_path):
    """The first link of a `primary` group stays the first when it alone is opened again."""
    first, second, station = (routers.UdpEnd(label=label) for label in ("first", "second", "station"))
    for end in (first, second, station):
        end.target = ("127.0.0.1", routers.udp_port())
    path = tmp_path / "router.toml"

    def write(first_options=""):
        group = "&group=sky&group_mode=primary"
        urls = [f"udpout://127.0.0.1:{end.port}?name={end.label}&bind=127.0.0.1:{end.target[1]}{options}"
                for end, options in ((first, group + first_options), (second, group), (station, ""))]
        path.write_text("".join(f'[[endpoint]]\nurl = "{url}"\n' for url in urls))
    write()
    router = Router(spawn, "--config", path)
    router.wait_links(3)

    def both_hear_and_carries():
        """Which of the two gets a command, sent before a heartbeat that both get."""
        for end in (first, second):
            end.send(heartbeat(VEHICLE))
        station.count(2)
        sent, last = command(GCS, VEHICLE), heartbeat(GCS)
        station.send(sent)
        station.send(last)
        return [end.label for end in (first, second) if sent in end.until(last)]
    assert both_hear_and_carries() == ["first"]
    write("&queue_age=1")
    router.process.send(signal.SIGHUP)
    router.process.wait_output("was read again", stream="err")
    router.wait_links(3)

    assert both_hear_and_carries() == ["first"]
    for end in (first, second, station):
        end.close()


def test_a_hangup_without_a_file_is_noted(spawn):
    router = Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}")
    router.process.send(signal.SIGHUP)

    router.process.wait_output("SIGHUP: there is no --config to reread", stream="err")
    assert router.process.alive


# ---- explain ---------------------------------------------------------------------------------------------------------

def explained(sut, pattern):
    return sut.router.process.wait_output(pattern, stream="out")


def test_explain_states_for_every_link_why(net):
    sut = net(("udpout", "udpout", "udpout", "udpout"), options={3: "out_block=ATTITUDE", 4: "tap=true"},
              extra=["--explain"])
    sut[2].send(heartbeat(GCS))
    sut[1].until(sut[4].next())
    sut[1].send(attitude(VEHICLE))
    sut[1].send(command(VEHICLE, GCS))
    sut[1].send(command(VEHICLE, (66, 6)))
    sut[1].send(unknown(VEHICLE))
    explained(sut, r"^id 70371 .*\n(  .*\n){4}")
    text = sut.router.process.stdout

    def block(head):
        found = re.search(rf"^{head}\n((?:  .*\n)+)", text, re.MULTILINE)
        assert found, f"{head}\n{text}"
        return [line.strip() for line in found[1].splitlines()]
    assert block(r"ATTITUDE 1/1 seq \d+ from A: forwarded") == [
        "x A: it came from this link", "-> B: sent", "x C: filtered on the way out",
        "-> D: sent, a tap gets everything"]
    assert block(r"COMMAND_LONG 1/1 seq \d+ from A: forwarded") == [
        "x A: it came from this link", "-> B: sent", "x C: its target has no route on this link",
        "-> D: sent, a tap gets everything"]
    assert block(r"COMMAND_LONG 1/1 seq \d+ from A: unknown_target")[1:] == [
        "x B: the frame goes to no link", "x C: the frame goes to no link", "-> D: sent, a tap gets everything"]
    assert block(r"id 70371 1/1 seq \d+ from A: forwarded")[1:3] == ["-> B: sent", "-> C: sent"]


@pytest.mark.parametrize("named", ["COMMAND_LONG", "76"])
def test_explain_of_one_message(net, named):
    sut = net(("udpout", "udpout"), extra=["--explain", named])
    sut.hears(2, GCS)
    sut.command(1, VEHICLE, GCS)
    explained(sut, r"^COMMAND_LONG 1/1 .*\n(  .*\n){2}")

    assert len(re.findall("^[A-Z]", sut.router.process.stdout, re.MULTILINE)) == 1


def explaining_to_a_pipe(spawn):
    """A router between two sockets: its process, the end of the pipe that it explains to, and what sends a frame
    through it and returns what came."""
    port, station = routers.udp_port(), harness.udp_socket()
    reading, writing = os.pipe()
    process = spawn("route", f"udpin://127.0.0.1:{port}", f"udpout://127.0.0.1:{station.getsockname()[1]}", "--explain",
                    "--name", f"explain-{port}", stdout=writing)
    os.close(writing)
    vehicle = harness.udp_socket()

    def passes():
        vehicle.sendto(attitude(VEHICLE), ("127.0.0.1", port))
        return station.recv(2048)
    process.wait_output("listening", stream="err")
    return process, reading, passes


def test_routing_outlives_a_reader_of_the_explanations(spawn):
    process, reading, passes = explaining_to_a_pipe(spawn)
    assert passes() and os.read(reading, 100).startswith(b"ATTITUDE 1/1")
    os.close(reading)
    assert passes()
    process.wait_output("the reader closed the output of --explain, which ended; routing continues", stream="err")
    for _ in range(10):
        assert passes()
    assert process.stderr.count("--explain") == 1
    assert process.stop().status == 130


@pytest.mark.parametrize("resumes", [False, True], ids=["for ever", "for a while"])
def test_routing_does_not_wait_for_a_reader_of_the_explanations(spawn, resumes):
    process, reading, passes = explaining_to_a_pipe(spawn)
    frames = 3000
    for _ in range(frames):
        assert passes()
    process.wait_output("explanations are left out, and routing continues", stream="err")

    with open(reading, "rb") as pipe:
        if resumes:
            process.send(signal.SIGINT)
            said = pipe.read()
            done = process.wait()
        else:
            done = process.stop()
            said = pipe.read()
    assert done.status == 130 and done.stderr.count("are left out") == 1
    left_out = int(re.search(r"--explain left out (\d+) lines", done.stderr)[1])
    lines = said.decode().splitlines(keepends=True)
    assert len(lines) + left_out == 3 * frames
    assert all(re.fullmatch(r"(ATTITUDE 1/1 seq \d+ from |  -> |   x )udp.*\n", line) for line in lines)


# ---- keys and signatures ---------------------------------------------------------------------------------------------

def test_key_new_writes_a_key_that_nobody_else_reads(run, tmp_path):
    first, second = tmp_path / "a.key", tmp_path / "b.key"
    old = os.umask(0)
    try:
        assert run("key", "new", first).status == 0
    finally:
        os.umask(old)
    assert run("key", "new", second).status == 0

    assert stat.S_IMODE(first.stat().st_mode) == stat.S_IMODE(second.stat().st_mode) == 0o600
    assert len(bytes.fromhex(first.read_text())) == 32
    assert first.read_text() != second.read_text()


def test_key_new_never_replaces(run, tmp_path):
    key = tmp_path / "a.key"
    run("key", "new", key)
    before = key.read_text()
    done = run("key", "new", key)

    assert done.status == 1 and "a.key" in done.stderr and len(done.stderr.splitlines()) == 1
    assert key.read_text() == before


def new_key(run, path):
    assert run("key", "new", path).status == 0
    return bytes.fromhex(path.read_text())


def verifier(key):
    """pymavlink, taking only what is signed with this key."""
    mav = mavlink.MAVLink(None)
    mav.signing.secret_key = key
    mav.signing.sign_outgoing = True
    mav.signing.allow_unsigned_callback = None
    return mav


def ticks_now():
    """10 us since 2015."""
    return int((time.time() - 1420070400) * 100_000)


def unsigned_part(frame):
    """The bytes that signing must not change: all but the flag, the checksum and the signature."""
    return frame[:2] + bytes([frame[2] & ~1]) + frame[3:10 + frame[1]]


def test_signatures_at_the_border(net, run, tmp_path):
    inner, outer = new_key(run, tmp_path / "inner.key"), new_key(run, tmp_path / "outer.key")
    sut = net(("udpout", "udpout", "udpout", "udpout"),
              options={1: f"verify={tmp_path}/inner.key", 2: f"sign={tmp_path}/outer.key",
                       4: f"verify={tmp_path}/inner.key&sign={tmp_path}/inner.key"})
    sent = [attitude(VEHICLE, signing=(inner, 1, ticks_now() + i)) for i in range(3)]
    for frame in sent:
        sut[1].send(frame)

    # Signed again on B and D, untouched on C.
    assert sut[3].count(3) == sent
    for end, key in ((2, outer), (4, inner)):
        got, mav = sut[end].count(3), verifier(key)
        assert [unsigned_part(frame) for frame in got] == [unsigned_part(frame) for frame in sent]
        assert all(frame[2] == 1 and frame not in sent for frame in got)
        decoded = [mav.decode(bytearray(frame)) for frame in got]
        assert [m.time_boot_ms for m in decoded] == [mavlink.MAVLink(None).decode(bytearray(f)).time_boot_ms
                                                     for f in sent]
    with pytest.raises(mavlink.MAVError):
        verifier(inner).decode(bytearray(sut_frame(sut, 1, attitude(VEHICLE, signing=(inner, 1, ticks_now() + 10)), 2)))

    # Not signed, wrongly signed, an old signature again, MAVLink 1: not taken.
    for refused in (attitude(VEHICLE), attitude(VEHICLE, signing=(outer, 1, ticks_now() + 100)), sent[2],
                    attitude(VEHICLE, version=1)):
        sut[1].send(refused)
    last = attitude(VEHICLE, signing=(inner, 1, ticks_now() + 200))
    sut[1].send(last)
    assert sut[3].until(last) == [sut.last]
    assert sut.link(1)["bad_signature"] == 4


def sut_frame(sut, start, frame, end):
    sut.last = frame
    sut[start].send(frame)
    return sut[end].next()


def test_with_sign_all_what_own_links_brought_is_signed_too(net, run, tmp_path):
    key = new_key(run, tmp_path / "link.key")
    sut = net(("udpout", "udpin", "udpout"),
              options={1: f"sign={tmp_path}/link.key&sign_all=true", 2: "trusted=false"})
    sut.settle()
    sut[3].send(own := attitude(VEHICLE))
    got = sut[1].next()
    assert unsigned_part(got) == unsigned_part(own) and got[2] == 1
    verifier(key).decode(bytearray(got))

    before = sut.router.stats("router")[0]["not_signed"]
    sut[2].send(foreign := attitude((5, 5)))
    assert sut[1].next() == foreign, "nobody vouches for a stranger"
    assert sut.router.stats("router")[0]["not_signed"] == before + 1


def test_no_frame_of_an_unverified_link_is_signed(net, run, tmp_path):
    key = new_key(run, tmp_path / "link.key")
    sut = net(("udpout", "udpout", "udpout"),
              options={1: f"verify={tmp_path}/link.key", 2: f"sign={tmp_path}/link.key"})
    foreign = [attitude((5, 5)), attitude((5, 5), version=1), attitude((5, 5), signing=(key, 9, ticks_now())),
               unknown((5, 5))]
    for frame in foreign:
        sut[3].send(frame)

    assert sut[2].count(4) == foreign  # byte for byte: even a right signature from a link that is not verified
    assert sut.router.stats("router")[0]["not_signed"] == 4
    own = attitude(VEHICLE, signing=(key, 1, ticks_now()))
    sut[1].send(own)
    signed = sut[2].next()
    assert signed != own and verifier(key).decode(bytearray(signed)).get_type() == "ATTITUDE"
    assert sut.router.stats("router")[0]["not_signed"] == 4


def test_in_a_group_what_came_by_another_link_long_ago_is_a_replay(net, run, tmp_path):
    key, options = new_key(run, tmp_path / "link.key"), f"verify={tmp_path}/link.key&group=air"
    sut = net(("udpout", "udpout", "udpout"), options={1: options, 2: options})
    begin = ticks_now()
    stream = [attitude(VEHICLE, signing=(key, 1, begin + number)) for number in range(6)]  # a clock that hardly runs
    sut[1].send(stream[0])
    assert sut[3].next() == stream[0]
    time.sleep(2.1)  # longer than bytes are remembered
    sut[1].send(stream[2])
    assert sut[3].next() == stream[2]
    for late in (stream[1], stream[0]):  # on the way for as long as that; and a replay, on a link that has not heard it
        sut[2].send(late)
    sut[2].send(stream[3])

    assert sut[3].until(stream[3]) in ([], [stream[1]])
    assert sum(link["bad_signature"] for link in sut.router.links()) >= 1


@pytest.mark.parametrize("group, heard", [("", 1), ("&group=air", 2)])
def test_what_one_endpoint_took_is_a_replay_at_the_others_but_in_a_group(net, run, tmp_path, group, heard):
    key, options = new_key(run, tmp_path / "link.key"), f"verify={tmp_path}/link.key{group}"
    shutil.copy(tmp_path / "link.key", tmp_path / "same.key")
    sut = net(("udpout", "udpout", "udpout"), options={1: options, 2: options.replace("link.key", "same.key")})
    own = attitude(VEHICLE, signing=(key, 1, ticks_now()))
    sut[1].send(own)
    assert sut[3].next() == own
    sut[2].send(own)
    mark = attitude(VEHICLE, signing=(key, 2, ticks_now()))
    sut[2].send(mark)

    assert sut[3].next() == mark
    assert sum(link["bad_signature"] for link in sut.router.links()) == 2 - heard
    assert sum(link["duplicate"] for link in sut.router.links()) == heard - 1


def test_the_own_heartbeat_is_signed(net, run, tmp_path):
    key = new_key(run, tmp_path / "link.key")
    sut = net(("udpout", "udpout"), options={1: f"sign={tmp_path}/link.key"}, rules={"heartbeat": "7/191"})
    beats, mav = sut[1].count(3), verifier(key)

    assert [mav.decode(bytearray(frame)).get_srcSystem() for frame in beats] == [7, 7, 7]
    assert all(frame[2] == 0 for frame in sut[2].count(3))


def test_a_pymavlink_station_with_signing_through_the_border(spawn, run, tmp_path):
    key, port = new_key(run, tmp_path / "link.key"), routers.tcp_port()
    vehicle, near = UdpEnd(), routers.udp_port()
    vehicle.target = ("127.0.0.1", near)
    # Trusted inside, signed outside: what comes from the vehicle's own link counts as verified only with verify=; so it
    # signs, too.
    keys = f"verify={tmp_path}/link.key&sign={tmp_path}/link.key"
    router = Router(spawn, f"tcpin://127.0.0.1:{port}?{keys}",
                    f"udpout://127.0.0.1:{vehicle.port}?bind=127.0.0.1:{near}&{keys}")
    station = mavutil.mavlink_connection(f"tcp:127.0.0.1:{port}", source_system=255, source_component=190)
    station.setup_signing(key, sign_outgoing=True)
    router.wait_links(2)
    station.mav.heartbeat_send(6, 8, 0, 0, 3)
    beat = verifier(key).decode(bytearray(vehicle.next()))
    vehicle.send(attitude(VEHICLE, signing=(key, 1, ticks_now())))
    got = station.recv_match(type="ATTITUDE", blocking=True, timeout=harness.DEFAULT_TIMEOUT_S)

    assert (beat.get_type(), beat.get_srcSystem(), beat.get_srcComponent()) == ("HEARTBEAT", 255, 190)
    assert got is not None and got.get_signed()
    station.close()
    vehicle.close()


# ---- recordings ------------------------------------------------------------------------------------------------------

def test_n19_a_recording_holds_everything_that_arrived(net, tmp_path):
    log = tmp_path / "flight.tlog"
    sut = net(("udpout", "tcpin", "udpout"), options={3: "in_block=ATTITUDE"}, extra=[f"tlog://{log}"])
    begin = time.time()
    sent = [heartbeat(GCS), command(VEHICLE, GCS), command(VEHICLE, (66, 6)), attitude(VEHICLE), unknown(VEHICLE),
            attitude((9, 9), version=1)]
    sut[2].send(sent[0])
    sut[1].until(sent[0])
    for frame in sent[1:5]:
        sut[1].send(frame)
        sut.router.wait_counter(sut[1], "frames_in", sent.index(frame))
    sut[3].send(sent[5])  # filtered on the way in, and recorded all the same
    sut.router.wait_counter(sut[3], "filtered", 1)
    sut[1].send(damaged())
    sut.router.wait_counter(sut[1], "crc_error", 1)
    # The records can be read while the router runs.
    harness.wait_for(lambda: log.stat().st_size == sum(8 + len(frame) for frame in sent), what="the records")
    recording = harness.wait_for(lambda: (r := sut.router.stats("recording")[0])["frames"] == 6 and r,
                                 what="the counters")
    sut.router.process.stop()
    end = time.time()

    assert (recording["frames"], recording["bytes"], recording["queue_full"],
            recording["write_error"]) == (6, sum(map(len, sent)), 0, 0)
    records = frames.read_tlog(log)
    assert [frame for _, frame in records] == sent
    assert all(begin - 0.001 <= time_us / 1e6 <= end + 0.001 for time_us, _ in records)
    reader = mavutil.mavlink_connection(str(log))
    read = []
    while (message := reader.recv_msg()) is not None:
        read.append((message.get_type(), message.get_srcSystem(), getattr(message, "target_system", None)))
    assert read == [("HEARTBEAT", 255, None), ("COMMAND_LONG", 1, 255), ("COMMAND_LONG", 1, 66), ("ATTITUDE", 1, None),
                    ("UNKNOWN_70371", 0, None), ("ATTITUDE", 9, None)]


def test_a_recording_is_no_link(net, tmp_path):
    sut = net(("udpout", "tcpin"), extra=[f"tlog://{tmp_path}/x.tlog"])

    assert [e["endpoint"] for e in sut.router.stats("endpoint")] == ["A", "B"]
    assert sut.send(1, attitude()) == [2]


def test_an_old_recording_is_kept(spawn, tmp_path):
    log = tmp_path / "x.tlog"
    frames.write_tlog(log, [(1, attitude())])
    precious = log.read_bytes()
    Router(spawn, f"udpin://127.0.0.1:{routers.udp_port()}", f"tlog://{log}").process.stop()

    assert (tmp_path / "x.tlog.1").read_bytes() == precious
    assert log.read_bytes() == b""


def test_recordings_come_and_go_while_it_runs(net, ctl, tmp_path):
    sut = net(("udpout", "tcpin"))
    log, frame = tmp_path / "x.tlog", attitude()
    assert ctl(sut.router, "add", f"tlog://{log}?name=log").status == 0
    sut.send(1, frame)
    assert ctl(sut.router, "remove", "log").status == 0
    sut.send(1, attitude())

    assert [recorded for _, recorded in frames.read_tlog(log)][0] == frame
    assert len(frames.read_tlog(log)) == 3  # and the two marks
    assert sut.router.stats("recording") == []


# ---- bad input and what it gets --------------------------------------------------------------------------------------

IN = "udpin://127.0.0.1:{free}"
BAD_ARGUMENTS = [
    ("no endpoint", [], 2, "give endpoints, or a --config"),
    ("no scheme", ["127.0.0.1:14550"], 2, "type udpout://127.0.0.1:14550 to send, udpin://127.0.0.1:14550 to listen"),
    ("udp://", ["udp://:14540"], 2, "udpin://"),
    ("sends to all", ["udpout://0.0.0.0:14550"], 2, "0.0.0.0"),
    ("unknown option of an endpoint", [IN + "?idel=2"], 2, "did you mean 'idle'?"),
    ("an option that the scheme has not", [IN + "?baud=9600"], 2, "baud"),
    ("an option given twice", [IN + "?idle=1&idle=2"], 2, "idle"),
    ("a value that is none", [IN + "?idle=soon"], 2, "soon"),
    ("unknown message in a filter", [IN + "?in_block=ATITUDE"], 2, "did you mean 'ATTITUDE'?"),
    ("two of one name", [IN, IN], 2, "remove one of them, or give it another name="),
    ("port 0", ["udpin://127.0.0.1:0"], 2, "choose one"),
    ("unknown option", [IN, "--fro", "1s"], 2, "did you mean '--for'?"),
    ("a bad time", [IN, "--for", "soon"], 2, "2s, 500ms, 1m or 1h"),
    ("a bad name", [IN, "--name", "a b"], 2,
     "--name: 'a b' is not a router name (letters, digits, '_' and '-', at most 64)"),
    ("metrics without host", [IN, "--metrics", "9090"], 2, "HOST:PORT, as in 127.0.0.1:9090"),
    ("metrics at a name", [IN, "--metrics", "localhost:9090"], 2, "numeric address"),
    ("explains an unknown message", [IN, "--explain", "ATITUDE"], 2, "ATITUDE"),
    ("--explain before the endpoint", ["--explain", IN], 2, "put it after the endpoints"),
    ("no serial port", ["serial:///dev/null"], 2, "/dev/null is not a serial port"),
    ("no key", [IN + "?verify={folder}/none.key"], 3, "none.key: No such file or directory"),
    ("a key that is none", [IN + "?sign={folder}/bad.key"], 3, "64 hexadecimal digits"),
    ("a key that others read", [IN + "?sign={folder}/open.key"], 3, "chmod 600"),
    ("no such file", ["--config", "{folder}/none.toml"], 3, "none.toml: No such file or directory"),
    ("UDP port in use", ["udpin://127.0.0.1:{udp}"], 1, "Address already in use by {holder}"),
    ("TCP port in use", ["tcpin://127.0.0.1:{tcp}"], 1, "Address already in use by {holder}"),
    ("metrics port in use", [IN, "--metrics", "127.0.0.1:{tcp}"], 1, "Address already in use by {holder}"),
    ("calls itself", ["udpin://0.0.0.0:{free}", "udpout://127.0.0.1:{free}"], 2,
     "udpout://127.0.0.1:{free} is where udpin://0.0.0.0:{free} listens: the router would send to itself"),
    ("a replay that is meant", ["{folder}/flight.tlog", "udpout://127.0.0.1:{free}"], 2,
     "type mavloom replay {folder}/flight.tlog --to udpout://127.0.0.1:{free}; to record, tlog://"),
    ("streams without an id", [IN, "--request-streams", "4"], 2, "--request-streams needs --heartbeat SYS/COMP"),
    ("a heartbeat without an id", ["udpout://127.0.0.1:{free}?heartbeat=true"], 2, "--heartbeat SYS/COMP"),
    ("required device missing", ["serial:///dev/no-such-port?required=true"], 1, "No such file or directory"),
    ("no folder for a recording", [IN, "tlog://{folder}/none/x.tlog"], 1, "No such file or directory"),
    ("a ring", ["shm://ring"], 2, "shm://"),
]
BAD_FILES = [
    ("no TOML", "[router\n", "bad.toml:1: "),
    ("unknown key", "[router]\ndedup_sm = 5\n", "bad.toml:2: [router] has no key 'dedup_sm', did you mean 'dedup_ms'?"),
    ("unknown section", "[ruoter]\n", "bad.toml:1: "),
    ("a value that is none", "[router]\ndedup_ms = 'much'\n", "bad.toml:2: "),
    ("unknown option in a URL", "\n[[endpoint]]\nurl = 'udpin://127.0.0.1:14550?idel=2'\n", "bad.toml:3: "),
    ("unknown key of an endpoint", "[[endpoint]]\nurl = 'udpin://127.0.0.1:14550'\nidel = 2\n", "bad.toml:3: "),
    ("an endpoint without place", "[[endpoint]]\nname = 'x'\n", "bad.toml:1: "),
    ("unknown message", "[[endpoint]]\nurl = 'udpin://127.0.0.1:14550'\nin_block = ['ATITUDE']\n",
     "did you mean 'ATTITUDE'?"),
    ("two of one name",
     "[[endpoint]]\nurl = 'udpin://127.0.0.1:14550'\n[[endpoint]]\nurl = 'udpin://127.0.0.1:14550'\n", "bad.toml:3: "),
    ("port 0", "[[endpoint]]\nurl = 'udpin://127.0.0.1:0'\n", "port 0"),
    ("no key", "[[endpoint]]\nurl = 'udpin://127.0.0.1:14550?sign=/none.key'\n",
     "bad.toml:2: sign: cannot open key file /none.key"),
    ("the main.conf of mavlink-router", "[General]\nTcpServerPort=5760\n",
     "bad.toml:1: this is a configuration of mavlink-router; to convert it, type mavloom check --convert"),
    ("a place of the page that is none", "[web]\nlisten = '8088'\n", "bad.toml:2: listen: '8088' is not HOST:PORT"),
    ("a router that calls itself",
     "[[endpoint]]\nurl = 'tcpin://127.0.0.1:5760'\n[[endpoint]]\nurl = 'tcpout://localhost:5760'\n",
     "bad.toml:4: tcpout://localhost:5760 is where tcpin://127.0.0.1:5760 listens"),
    ("a rule of the router", "[[endpoint]]\nurl = 'udpin://127.0.0.1:14550?dedup=5'\n",
     "'dedup_ms' is a setting of the router"),
]


@pytest.mark.parametrize("arguments, status, said", [case[1:] for case in BAD_ARGUMENTS],
                         ids=[case[0] for case in BAD_ARGUMENTS])
def test_bad_arguments(run, tmp_path, arguments, status, said):
    (tmp_path / "bad.key").write_text("no key\n")
    (tmp_path / "bad.key").chmod(0o600)
    (tmp_path / "open.key").write_text("00" * 32)
    (tmp_path / "open.key").chmod(0o644)
    (tmp_path / "flight.tlog").write_bytes(frames.FLIGHT.read_bytes()[:100])
    udp, tcp = harness.udp_socket(), socket.create_server(("127.0.0.1", 0))
    with udp, tcp:
        values = {"free": routers.udp_port(), "udp": udp.getsockname()[1], "tcp": tcp.getsockname()[1],
                  "folder": tmp_path,
                  "holder": f"{pathlib.Path('/proc/self/comm').read_text().strip()} (process {os.getpid()})"}
        own_name = [] if "--name" in arguments else ["--name", f"bad-{os.getpid()}"]
        done = run("route", *(argument.format(**values) for argument in arguments), *own_name)

    assert done.status == status and said.format(**values) in done.stderr, done
    assert sorted(path.name for path in tmp_path.glob("flight*")) == ["flight.tlog"], "nothing is renamed"
    complaints = [line for line in done.stderr.splitlines() if "receive buffer" not in line
                  and "MAVLOOM_PROGRAM" not in line and not line.startswith("Try 'mavloom")]
    assert len(complaints) == 1 and complaints[0].startswith("mavloom: "), done
    assert done.stdout == ""


@pytest.mark.parametrize("text, said", [case[1:] for case in BAD_FILES], ids=[case[0] for case in BAD_FILES])
def test_bad_files(run, tmp_path, text, said):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    done = run("route", "--config", file)

    assert done.status == 3 and said in done.stderr and len(done.stderr.splitlines()) == 1, done


def test_a_bad_variable(run):
    done = run("route", f"udpin://127.0.0.1:{routers.udp_port()}", env={"MAVLOOM_ROUTER_DEDUP": "5"})

    assert done.status == 3 and "did you mean 'MAVLOOM_ROUTER_DEDUP_MS'?" in done.stderr


@pytest.mark.parametrize("url", ["udpout://no-such-host.invalid:14550", "tcpout://no-such-host.invalid:5760",
                                 "serial:///dev/no-such-port"])
def test_what_may_come_later_is_awaited(spawn, url):
    router = Router(spawn, url, f"udpin://127.0.0.1:{routers.udp_port()}")

    router.process.wait_output("trying again", stream="err")
    assert router.process.alive


def test_garbage_from_strangers_harms_no_link(net):
    # the same each time: in one run of sixty other bytes would hold a frame with a true checksum
    rng = random.Random(4)
    sut = net(("udpin", "udpout"))
    strangers = [UdpEnd(sut[1].target) for _ in range(5)]
    for number in range(200):
        for stranger in strangers:
            stranger.send(rng.randbytes(rng.randrange(1, 600)))
        if number % 20 == 0:
            assert sut.send(1, attitude()) == [2]
            assert sut.send(2, attitude(GCS)) == [1]
    counters = sut.router.stats("endpoint")[0]

    assert len(sut.router.links()) == 2
    assert counters["stray_bytes"] > 0
    assert all(stranger.now() == [] for stranger in strangers)
    for stranger in strangers:
        stranger.close()
