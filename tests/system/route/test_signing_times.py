# SPDX-License-Identifier: MIT
"""sign= and verify= over a restart: a recording of before is a replay after it, and what is signed never goes back in
time."""
import json
import os
import re
import signal
import socket
import time

import pytest

import frames
from frames import mavlink

pytestmark = pytest.mark.short

EPOCH_S = 1420070400  # 2015-01-01, in Unix time
KEY = bytes([7] * 32)


def ticks(at=None):
    return int(((at or time.time()) - EPOCH_S) * 100_000)


class Signer:
    """pymavlink as a sender that signs, with a time of the test's choice."""

    def __init__(self):
        self.mav = mavlink.MAVLink(None, srcSystem=1, srcComponent=1)
        self.mav.signing.secret_key, self.mav.signing.sign_outgoing, self.mav.signing.link_id = KEY, True, 5

    def heartbeat(self, timestamp):
        self.mav.signing.timestamp = timestamp
        frame = mavlink.MAVLink_heartbeat_message(2, 12, 81, 0, 4, 3).pack(self.mav)
        self.mav.seq = (self.mav.seq + 1) % 256
        return frame


def time_of(frame):
    return int.from_bytes(frame[-12:-6], "little")


class Border:
    """A router between signed and unsigned: what comes in signed goes out signed at `far`."""

    def __init__(self, spawn, run, key, ports, far):
        self.run, self.near, self.name = run, ("127.0.0.1", ports[0]), f"signing-{ports[0]}"
        self.router = spawn("route", f"udpin://127.0.0.1:{ports[0]}?name=near&verify={key}",
                            f"udpout://127.0.0.1:{far.getsockname()[1]}?name=far&sign={key}", "--name", self.name)
        self.router.wait_output("far: up")

    def links(self):
        return {o["link"]: o for o in map(json.loads, self.run("ctl", self.name, "links").lines)}

    def refused(self):
        return sum(o["bad_signature"] for o in self.links().values()) + self.endpoint("near")["stray_bytes"]

    def endpoint(self, name):
        stats = map(json.loads, self.run("ctl", self.name, "stats").lines)
        return next(o for o in stats if o["kind"] == "endpoint" and o["endpoint"] == name)


@pytest.fixture
def key(tmp_path):
    path = tmp_path / "link.key"
    path.write_text(KEY.hex())
    path.chmod(0o600)
    return path


@pytest.fixture
def border(spawn, run, key, udp_port, udp_socket):
    ports, far = [udp_port()], udp_socket()
    return lambda: (Border(spawn, run, key, ports, far), far)


def state_of(key):
    return (key.parent / "link.key.state").read_text()


def end_cleanly(border, _key, _wait_for):
    assert border.router.stop(signal.SIGTERM).status == 143


def kill(border, key, wait_for):
    wait_for(lambda: "heard 5 1 1 " in state_of(key), what="the file beside the key")
    border.router.kill()


@pytest.mark.parametrize("end", [end_cleanly, kill])
def test_a_frame_of_before_the_restart_is_a_replay_after_it(border, udp_socket, key, wait_for, end):
    vehicle, sender = udp_socket(), Signer()
    first, far = border()
    recorded = sender.heartbeat(ticks())
    vehicle.sendto(recorded, first.near)
    before = far.recv(1000)
    assert before[:-15] == recorded[:-15]
    end(first, key, wait_for)

    second, _ = border()
    vehicle.sendto(recorded, second.near)
    wait_for(second.refused, what="the replay to be refused")
    fresh = sender.heartbeat(time_of(recorded) + 1)
    vehicle.sendto(fresh, second.near)
    after = far.recv(1000)
    assert after[4] == fresh[4]  # its sequence number: the replay did not get through
    assert time_of(after) > time_of(before)


def test_without_the_file_the_replay_would_pass(border, udp_socket, key):
    """That the test above tests the file."""
    vehicle, sender = udp_socket(), Signer()
    first, far = border()
    recorded = sender.heartbeat(ticks())
    vehicle.sendto(recorded, first.near)
    far.recv(1000)
    first.router.stop()
    (key.parent / "link.key.state").unlink()
    second, _ = border()
    vehicle.sendto(recorded, second.near)

    assert far.recv(1000)[4] == recorded[4]


@pytest.mark.parametrize("end", [end_cleanly, kill])
def test_a_clock_that_was_set_back_does_not_bring_old_times_again(border, udp_socket, key, wait_for, end):
    ahead = ticks() + 3600 * 100_000  # as if the clock had been an hour ahead when the router ran last
    (key.parent / "link.key.state").write_text(f"mavloom signing times 1\nsigned {ahead}\n")
    vehicle, sender, used = udp_socket(), Signer(), []
    for _ in range(2):
        border_now, far = border()
        vehicle.sendto(sender.heartbeat(ticks() + len(used)), border_now.near)
        used.append(time_of(far.recv(1000)))
        assert re.search("s ahead of the clock", border_now.router.stderr)
        end(border_now, key, wait_for)
        assert int(re.search(r"^signed (\d+)$", state_of(key), re.MULTILINE)[1]) >= used[-1]

    assert ahead < used[0] < used[1]


@pytest.mark.parametrize("sig", [signal.SIGTERM, signal.SIGKILL])
def test_a_relay_continues_where_the_last_one_stopped(spawn, udp_port, udp_socket, key, sig):
    ahead = ticks() + 3600 * 100_000
    (key.parent / "link.key.state").write_text(f"mavloom signing times 1\nsigned {ahead}\n")
    port, far, vehicle, used = udp_port(), udp_socket(), udp_socket(), []
    for _ in range(2):
        relay = spawn("relay", f"udpin://127.0.0.1:{port}", "--to", f"udpout://127.0.0.1:{far.getsockname()[1]}",
                      "--sign", key)
        relay.wait_output("listening")
        vehicle.sendto(next(frames.heartbeats(1)), ("127.0.0.1", port))
        used.append(time_of(far.recv(1000)))
        assert re.search("s ahead of the clock", relay.stderr)
        relay.send(sig)
        relay.wait()
        assert int(re.search(r"^signed (\d+)$", state_of(key), re.MULTILINE)[1]) >= used[-1]

    assert ahead < used[0] < used[1]


def test_the_file_is_for_its_owner_only(border, key):
    first, _ = border()
    first.router.stop()

    assert os.stat(key.parent / "link.key.state").st_mode & 0o777 == 0o600
    assert sorted(path.name for path in key.parent.iterdir()) == ["link.key", "link.key.state"]


def test_a_file_that_cannot_be_written_is_reported_and_routing_continues(border, udp_socket, key):
    (key.parent / "link.key.state").mkdir()
    vehicle, sender = udp_socket(), Signer()
    first, far = border()
    assert re.search(r"cannot write .*link\.key\.state", first.router.stderr)
    vehicle.sendto(sender.heartbeat(ticks()), first.near)

    assert far.recv(1000)


def connected(scheme, port):
    """A socket that sends to such an endpoint."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_STREAM if scheme == "tcpin" else socket.SOCK_DGRAM)
    sock.connect(("127.0.0.1", port))
    return sock


@pytest.mark.parametrize("scheme", ["udpin", "tcpin"])
def test_a_copy_of_a_signed_frame_proves_nothing(scheme, spawn, run, key, udp_port, tcp_port, udp_socket, wait_for):
    """One copy took all commands for a vehicle that is heard on an endpoint without verify=."""
    open_port, guarded_port = udp_port(), udp_port() if scheme == "udpin" else tcp_port()
    name = f"signing-{guarded_port}"
    router = spawn("route", f"udpin://127.0.0.1:{open_port}?name=open",
                   f"{scheme}://127.0.0.1:{guarded_port}?name=guarded&verify={key}", "--name", name)
    router.wait_output("guarded: ")
    vehicle, sender = udp_socket(), Signer()

    def ask(what):
        return list(map(json.loads, run("ctl", name, what).lines))

    def where():
        return {o["link"].split("#")[0] for o in ask("routes") if o.get("sys") == 1}

    def has_taken(frame):
        """A copy is junk of a stranger, and a frame of a client."""
        found = [o for o in ask("stats") if o["kind"] in ("endpoint", "link") and "guarded" in o["endpoint"]]
        return any(o.get("stray_bytes") == len(frame) or o.get("frames_in") == 1 for o in found)

    with connected(scheme, guarded_port) as other:
        vehicle.sendto(frame := sender.heartbeat(ticks()), ("127.0.0.1", open_port))
        wait_for(lambda: where() == {"open"}, what="the vehicle's route")
        other.send(frame)
        wait_for(lambda: has_taken(frame), what="the copy")
        assert where() == {"open"}

        other.send(sender.heartbeat(ticks()))
        wait_for(lambda: "guarded" in where(), what="the route that a new frame teaches")


def test_a_client_that_sends_only_copies_counts_as_silent(spawn, run, key, udp_port, tcp_port, udp_socket, wait_for):
    radio, port, options = udp_port(), tcp_port(), f"verify={key}&group=vehicle"
    name = f"signing-{radio}"
    router = spawn("route", f"udpin://127.0.0.1:{radio}?{options}",
                   f"tcpin://127.0.0.1:{port}?name=clients&max_peers=1&{options}", "--name", name)
    router.wait_output("clients: ")
    vehicle, sender, newcomer = udp_socket(), Signer(), Signer()
    newcomer.mav.srcSystem = 2

    def links():
        return list(map(json.loads, run("ctl", name, "links").lines))

    def heard_from_clients(count):
        return any(o["link"].startswith("clients#") and o["frames_in"] == count for o in links())

    with connected("tcpin", port) as copier:
        vehicle.sendto(frame := sender.heartbeat(ticks()), ("127.0.0.1", radio))
        wait_for(lambda: any(o["frames_in"] for o in links()), what="the frame")
        copier.send(frame)
        wait_for(lambda: heard_from_clients(1), what="the copy")
        with connected("tcpin", port) as other:
            other.send(newcomer.heartbeat(ticks()) + newcomer.heartbeat(ticks() + 1))
            wait_for(lambda: heard_from_clients(2), what="the newcomer's frames")


def test_a_client_that_sends_back_what_the_router_signed_proves_nothing(spawn, run, key, udp_port, tcp_port,
                                                                        udp_socket, wait_for):
    near, port, options = udp_port(), tcp_port(), f"verify={key}&sign={key}"
    name = f"signing-{near}"
    router = spawn("route", f"udpin://127.0.0.1:{near}?name=near&{options}",
                   f"tcpin://127.0.0.1:{port}?name=clients&{options}", "--name", name)
    router.wait_output("clients: ")
    vehicle, sender = udp_socket(), Signer()

    def ask(what):
        return list(map(json.loads, run("ctl", name, what).lines))

    with socket.create_connection(("127.0.0.1", port), timeout=10) as client:
        wait_for(lambda: any(o["link"].startswith("clients#") for o in ask("links")), what="the client's link")
        vehicle.sendto(sender.heartbeat(ticks()), ("127.0.0.1", near))
        client.sendall(client.recv(1000))
        wait_for(lambda: any(o["link"].startswith("clients#") and o["bad_signature"] + o["frames_in"] > 0
                             for o in ask("links")), what="what came back")

        assert [o["link"].split("#")[0] for o in ask("routes") if o.get("sys") == 1] == ["near"]
        assert [o["bad_signature"] for o in ask("links") if o["link"].startswith("clients#")] == [1]
