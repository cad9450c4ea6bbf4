# SPDX-License-Identifier: MIT
"""The server of `mavloom web` beside a router and a simulator: --web, and [web] in their files."""
import json
import socket
import urllib.request

import pytest

import frames
import harness

pytestmark = pytest.mark.short


def place_of(program):
    return program.wait_output(r"open (http://\S+)")[1]


def get(place, report):
    with urllib.request.urlopen(f"{place}/api/v1/{report}", timeout=harness.DEFAULT_TIMEOUT_S) as answer:
        return json.load(answer)


def hop(place, kind):
    """The hop of this kind. The first report comes half a second after the start."""
    reported = [hop for hop in get(place, "links")["hops"] if hop["kind"] == kind]
    return reported[0] if reported else {"frames_in": None, "state": None}


@pytest.fixture
def vehicle(udp_socket):
    """vehicle(port, count): sends so many HEARTBEATs of system 1."""
    sock = udp_socket()

    def send(port, count):
        for frame in frames.heartbeats(count):
            sock.sendto(frame, ("127.0.0.1", port))
    return send


def test_a_router_with_a_ring_shows_its_messages_and_its_links(spawn, udp_port, vehicle):
    port = udp_port()
    router = spawn("route", f"udpin://127.0.0.1:{port}", "--ring", f"beside-{port}", "--web", "127.0.0.1:0")
    place = place_of(router)
    router.wait_output("listening")
    vehicle(port, 20)

    harness.wait_for(lambda: [(v["sys"], v["comp"]) for v in get(place, "vehicles")["vehicles"]] == [(1, 1)],
                     what="the vehicle on the page")
    shown = harness.wait_for(lambda: (at := hop(place, "router"))["frames_in"] == 20 and at, what="the router's counts")
    assert shown["name"] == f"beside-{port}" and shown["state"] == "up" and shown["hint"] is None
    assert [link["frames_in"] for link in shown["links"]] == [20]
    assert shown["links"][0]["name"].startswith(f"udpin://127.0.0.1:{port}#")
    assert harness.wait_for(lambda: hop(place, "web")["frames_in"] == 20, what="all frames on the page")
    assert router.stop().status == 130


def test_the_routes_of_a_router(spawn, udp_port, udp_socket):
    port, name = udp_port(), f"beside-{udp_port()}"
    router = spawn("route", f"udpin://127.0.0.1:{port}", "tcpout://127.0.0.1:1?name=nobody", "--name", name, "--web",
                   "127.0.0.1:0")
    place = place_of(router)
    router.wait_output("listening")
    ends = {}
    for system in (1, 2):
        sock = udp_socket()
        for frame in frames.heartbeats(3, system):
            sock.sendto(frame, ("127.0.0.1", port))
        ends[system] = f"udpin://127.0.0.1:{port}#127.0.0.1:{sock.getsockname()[1]}"

    def routes():
        of, = get(place, "routes")
        assert (of["router"], of["error"]) == (name, None)
        return {(r["sys"], r["comp"]): (r["link"], r["frames"]) for r in of["routes"]}
    expected = {(system, 1): (link, 3) for system, link in ends.items()}
    harness.wait_for(lambda: routes() == expected, what="both routes")

    def states():
        return {link["name"]: link["state"] for link in hop(place, "router").get("links", [])}
    harness.wait_for(lambda: states() == {ends[1]: "up", ends[2]: "up", "nobody": "down"}, what="all links")


def test_a_router_without_a_ring_shows_its_counters_and_how_to_start_one(spawn, run, udp_port, vehicle):
    port = udp_port()
    name = f"beside-{port}"
    router = spawn("route", f"udpin://127.0.0.1:{port}", "--name", name, "--web", "127.0.0.1:0")
    place = place_of(router)
    router.wait_output("listening")
    vehicle(port, 20)

    shown = harness.wait_for(lambda: (at := hop(place, "router"))["frames_in"] == 20 and at, what="the router's counts")
    assert f"its messages are not shown: start it with --ring {name}" in shown["hint"]
    assert get(place, "vehicles")["vehicles"] == []
    assert '"kind":"source"' in run("stat", name, "--json").stdout  # asks the router, which knows more than its page


def test_a_simulator_shows_its_vehicles(spawn, udp_port, udp_socket):
    port = udp_port()
    peer = udp_socket()
    simulator = spawn("sim", "--ring", f"beside-{port}", "--to", f"udpout://127.0.0.1:{peer.getsockname()[1]}", "--web",
                      "127.0.0.1:0")
    place = place_of(simulator)

    harness.wait_for(lambda: get(place, "systems"), what="the vehicle on the page")
    shown = harness.wait_for(lambda: (at := hop(place, "sim"))["state"] == "up" and len(at["links"]) == 2 and
                             all(link["frames_out"] > 0 for link in at["links"]) and at, what="both links")
    assert shown["frames_out"] == max(link["frames_out"] for link in shown["links"]), "the ring has the same frames"


@pytest.mark.parametrize("command", ["route", "sim"])
def test_a_file_may_have_the_place(spawn, tmp_path, udp_port, command):
    port = udp_port()
    url = f"udp{'in' if command == 'route' else 'out'}://127.0.0.1:{port}"
    file = tmp_path / "web.toml"
    file.write_text(f'[web]\nlisten = "127.0.0.1:0"\norigin = ["https://a.example"]\n[[endpoint]]\nurl = "{url}"\n' +
                    ("[sim]\n" if command == "sim" else ""))
    program = spawn(command, *(["--config"] if command == "route" else []), file, "--name", f"beside-{port}")
    request = urllib.request.Request(place_of(program) + "/api/v1/systems", headers={"Origin": "https://a.example"})

    assert urllib.request.urlopen(request, timeout=harness.DEFAULT_TIMEOUT_S).status == 200


@pytest.mark.parametrize("command", ["route", "sim"])
def test_a_place_that_is_taken_names_its_holder(run, udp_port, command):
    url = f"udp{'in' if command == 'route' else 'out'}://127.0.0.1:{udp_port()}"
    with socket.create_server(("127.0.0.1", 0)) as taken:
        done = run(command, *([url] if command == "route" else ["--to", url]), "--name", f"beside-{udp_port()}",
                   "--web", f"127.0.0.1:{taken.getsockname()[1]}")

    assert done.status == 1 and "--web: " in done.stderr and "in use by" in done.stderr, done
