# SPDX-License-Identifier: MIT
"""udpbcast:// between two machines: who listens is found, who answers is fed alone."""
import socket

import pytest

import frames
import harness
import netns

pytestmark = pytest.mark.short

PORT = 14550


@pytest.fixture
def machines():
    yield from netns.two_machines()


@pytest.fixture
def start(program):
    running = []

    def call(machine, *args):
        running.append(harness.Running(machine.command(program, *args)))
        return running[-1]
    yield call
    for process in running:
        process.kill()


def relay_of(machine, start, url):
    """A relay on the machine with a source to feed it by."""
    relay = start(machine, "relay", "udpin://127.0.0.1:0", "--to", url)
    port = int(relay.wait_output(r"listening on port (\d+)", stream="err")[1])
    vehicle = machine.socket()

    def send(frame):
        vehicle.sendto(frame, ("127.0.0.1", port))
    return relay, send


@pytest.mark.parametrize("options", ["", "?iface=cable1"], ids=["by route", "by interface"])
@pytest.mark.parametrize("host", ["10.77.0.255", "255.255.255.255"])
def test_a_listener_that_answers_is_fed_alone(machines, start, host, options):
    here, there = machines
    _, send = relay_of(here, start, f"udpbcast://{host}:{PORT}{options}")
    listener, other = there.socket(), there.socket()
    for sock in (listener, other):
        sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    listener.bind(("", PORT))
    first, second, third = frames.heartbeats(3)
    send(first)
    got, source = listener.recvfrom(2048)
    assert (got, source[0]) == (first, here.host)

    answerer = there.socket()
    answers = frames.heartbeats(100, system=255, component=190)

    def fed():
        answerer.sendto(next(answers), source)
        send(second)
        answerer.settimeout(0.6)
        try:
            return answerer.recv(2048) == second
        except TimeoutError:
            return False
    harness.wait_for(fed, what="what is sent to the one who answered")
    listener.setblocking(False)
    while True:  # what was broadcast before the answer came
        try:
            listener.recv(2048)
        except BlockingIOError:
            break
    send(third)
    answerer.settimeout(60)
    while answerer.recv(2048) != third:
        pass
    with pytest.raises(BlockingIOError):
        listener.recv(2048)


def test_one_datagram_does_not_end_the_broadcast(machines, start):
    here, there = machines
    router = start(here, "route", f"udpin://127.0.0.1:{PORT}", f"udpbcast://10.77.0.255:{PORT}")
    router.wait_output(r"udpin://127.0.0.1:\d+: listening", stream="err")
    vehicle, listener, forger = here.socket(), there.socket(), there.socket()
    listener.bind(("", PORT))

    def send(frame):
        vehicle.sendto(frame, ("127.0.0.1", PORT))
    first, second = frames.heartbeats(2)
    send(first)
    while (received := listener.recvfrom(2048))[0] != first:
        pass

    forger.sendto(next(frames.heartbeats(1, system=255, component=190)), received[1])
    router.wait_output(rf"#{there.host}:{forger.getsockname()[1]}: up", stream="err")
    send(second)
    while listener.recv(2048) != second:
        pass


def test_two_mavlooms_find_each_other(machines, start):
    here, there = machines
    listening = start(there, "listen", f"udpin://0.0.0.0:{PORT}", "--count", "1")
    _, send = relay_of(here, start, f"udpbcast://10.77.0.255:{PORT}")

    def arrived():
        send(next(frames.heartbeats(1)))
        return not listening.alive
    harness.wait_for(arrived, what="the heartbeat")
    assert listening.wait().status == 0
