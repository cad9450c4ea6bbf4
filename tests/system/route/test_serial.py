# SPDX-License-Identifier: MIT
"""serial:// over pseudo-terminals: both spellings, unplugging, a full port, noise, an echo, the baud rate."""
import fcntl
import json
import os
import pathlib
import shutil
import struct
import time

import pytest

import frames
import harness

TCGETS2 = 0x802C542A


class Port(harness.SerialLine):
    def __init__(self):
        super().__init__()
        os.set_blocking(self.far, False)

    def baud(self):
        settings = fcntl.ioctl(self.far, TCGETS2, bytes(44))
        return struct.unpack_from("I", settings, 40)[0]

    def read(self):
        """The bytes that are there now."""
        got = b""
        try:
            while chunk := os.read(self.far, 1 << 16):
                got += chunk
        except OSError:  # nothing more, or nobody has the other end open
            pass
        return got


@pytest.fixture
def port():
    made = []

    def make():
        made.append(Port())
        return made[-1]
    yield make
    for one in made:
        one.unplug()


def put_link(name, target):
    """Like udev: the name is there in one step."""
    fresh = pathlib.Path(f"{name}.new")
    fresh.symlink_to(target)
    fresh.rename(name)


def relay_to(spawn, url, *options):
    """A relay to the port, and a way to feed it."""
    relay = spawn("relay", "udpin://127.0.0.1:0", "--to", url, *options)
    target = ("127.0.0.1", int(relay.wait_output(r"listening on port (\d+)", stream="err")[1]))
    vehicle = harness.udp_socket()
    return relay, lambda frame: vehicle.sendto(frame, target)


@pytest.mark.short
@pytest.mark.parametrize("spelling, baud", [("serial://{}", 57600), ("serial://{}?baud=1234567", 1234567),
                                            ("{}", 57600), ("{},115200", 115200)])
def test_listen_takes_both_spellings(spawn, port, spelling, baud):
    far = port()
    listen = spawn("listen", spelling.format(far.terminal), "--json", "--count", "3")
    harness.wait_for(lambda: far.baud() == baud, what=f"{baud} baud")
    far.write(b"".join(frames.heartbeats(3)))
    done = listen.wait()

    assert done.status == 0 and len(done.lines) == 3
    assert json.loads(done.lines[0])["link"] == f"serial://{far.terminal}"
    assert "port 0" not in done.stderr


@pytest.mark.short
def test_a_port_outside_dev_takes_a_baud_rate(spawn, port, tmp_path):
    far, name = port(), tmp_path / "autopilot"
    put_link(name, far.device)
    listen = spawn("listen", f"{name},115200", "--count", "1")
    harness.wait_for(lambda: far.baud() == 115200, what="115200 baud")
    far.write(next(frames.heartbeats(1)))

    assert listen.wait().status == 0


@pytest.mark.short
def test_a_missing_port_is_awaited(spawn, port, tmp_path):
    name = tmp_path / "autopilot"
    listen = spawn("listen", f"serial://{name}", "--count", "1")
    listen.wait_output(r"autopilot: No such file or directory; trying again", stream="err")
    far = port()
    far.write(next(frames.heartbeats(1)))
    put_link(name, far.device)

    assert listen.wait().status == 0


@pytest.mark.short
@pytest.mark.parametrize("url, status, said", [
    ("serial:///dev/no-such-port?required=true", 1, "No such file or directory"),
    ("serial:///dev/null", 2, "/dev/null is not a serial port"),
    ("/dev/ttyACM0,fast", 2, "fast"),
])
def test_what_cannot_work_is_reported_at_once(run, url, status, said):
    done = run("listen", url)

    assert done.status == status and said in done.stderr


@pytest.mark.short
def test_a_port_is_not_shared(spawn, run, port):
    far = port()
    listen = spawn("listen", far.terminal, "--count", "2")
    far.write(next(frames.heartbeats(1)))
    listen.wait_output("HEARTBEAT", stream="out")
    second = run("listen", far.terminal)
    far.write(next(frames.heartbeats(1)))

    assert second.status == 1 and "another program has locked it" in second.stderr
    assert listen.wait().status == 0


@pytest.mark.short
def test_record_and_relay_take_a_port_as_source(spawn, port, tmp_path):
    far, out = port(), tmp_path / "out.tlog"
    record = spawn("record", f"serial://{far.device}", "-o", out, "--count", "5")
    sent = list(frames.heartbeats(5))
    far.write(b"".join(sent))

    assert record.wait().status == 0
    assert [frame for _, frame in frames.read_tlog(out)] == sent


@pytest.mark.short
def test_a_deleted_byte_costs_one_frame(spawn, port):
    far = port()
    listen = spawn("listen", far.terminal, "--json", "--count", "9", "--stats")
    stream = bytearray(b"".join(frames.heartbeats(10)))
    del stream[5 * 21 + 12]
    far.write(bytes(stream))
    done = listen.wait()

    assert [json.loads(line)["seq"] for line in done.lines[:9]] == [0, 1, 2, 3, 4, 6, 7, 8, 9]


# The relay opens a port again that was unplugged and came back under the same name.
@pytest.mark.short
def test_a_port_that_is_removed_and_made_again(spawn, port, tmp_path):
    name, first = tmp_path / "autopilot", port()
    put_link(name, first.device)
    relay, send = relay_to(spawn, f"serial://{name}")

    def through(far):
        def arrived():
            send(next(frames.heartbeats(1)))
            return far.read()
        return harness.wait_for(arrived, what="a frame at the port")
    through(first)
    name.unlink()
    first.unplug()
    relay.wait_output("trying again", stream="err")
    second = port()
    put_link(name, second.device)

    got = through(second)
    assert frames.split_frames(got)[0] == next(frames.heartbeats(1))
    assert relay.alive


# The reader of a full port sleeps for ten seconds.
def test_a_full_port_gets_whole_frames_when_its_reader_resumes(spawn, port):
    far = port()
    relay, send = relay_to(spawn, f"serial://{far.device}?baud=57600&queue_age=2")
    count, end = 0, time.monotonic() + 10
    while time.monotonic() < end:
        for frame in frames.heartbeats(100, sequence=count % 256):
            send(frame)
            count += 1
        time.sleep(0.02)  # 5,000 frames/s: nine times what the line carries
    got, quiet = b"", 0
    while quiet < 300:  # three seconds
        more = far.read()
        got, quiet = got + more, 0 if more else quiet + 1
        time.sleep(0.01)
    whole = frames.split_frames(got)
    done = relay.stop()

    assert b"".join(whole) == got and len({len(frame) for frame in whole}) == 1
    parser = frames.mavlink.MAVLink(None)
    assert all(parser.decode(bytearray(frame)).get_type() == "HEARTBEAT" for frame in whole)
    assert 0 < len(whole) < count
    assert "frames dropped: the far side was too slow" in done.stderr


# Such a UART sends back every byte that it receives. The commands must reach it all the same.
@pytest.mark.short
def test_commands_reach_a_uart_that_echoes_every_byte(spawn, port):
    far = port()
    relay, send = relay_to(spawn, f"serial://{far.device}")
    sent = list(frames.heartbeats(200, system=255, component=190))
    got = b""
    for frame in sent:
        send(frame)
        more = far.read()
        got += more
        far.write(more)

    def rest():
        nonlocal got
        more = far.read()
        got += more
        far.write(more)
        return len(got) >= 200 * 21
    harness.wait_for(rest, what="200 frames at the port")
    assert frames.split_frames(got)[:200] == sent
    assert relay.alive


@pytest.mark.short
def test_the_baud_rate_is_found(spawn, port):
    far = port()
    listen = spawn("listen", f"serial://{far.device}?baud=auto", "--json", "--count", "3")
    beats = frames.heartbeats(1000)
    seen = set()

    def found():
        baud = far.baud()
        seen.add(baud)
        far.write(next(beats) if baud == 921600 else os.urandom(17))
        time.sleep(0.05)  # the rate of the far end's frames
        return not listen.alive
    harness.wait_for(found, what="three frames")

    assert listen.wait().status == 0
    assert {57600, 115200, 921600} <= seen
    assert "921600 baud" in listen.stderr


IN_A_DEV_OF_ITS_OWN = """
set -e
mkdir "$1"; mount --bind /dev/pts "$1"
mount -t tmpfs none /dev
mkdir -p /dev/pts /dev/serial/by-id
mount --move "$1" /dev/pts
ln -s "$2" /dev/ttyACM0
ln -s ../../ttyACM0 /dev/serial/by-id/usb-Autopilot-if00
shift 2
exec "$@" < /dev/pts/ptmx
"""


# The number of a USB port may be another one after it was plugged in again; its name in /dev/serial/by-id stays.
@pytest.mark.short
@pytest.mark.skipif(os.geteuid() != 0 or not shutil.which("unshare"),
                    reason="a /dev of its own needs root and util-linux")
def test_a_port_comes_back_under_a_new_number(program, port, tmp_path):
    first = port()
    first.write(next(frames.heartbeats(1)))
    listen = harness.Running(["unshare", "-m", "sh", "-c", IN_A_DEV_OF_ITS_OWN, "sh", tmp_path / "pts", first.device,
                              program, "listen", "serial:///dev/ttyACM0", "--json"])
    try:
        listen.wait_output('"sys":1', stream="out")
        dev = pathlib.Path("/proc", str(listen.pid), "root", "dev")
        (dev / "serial/by-id/usb-Autopilot-if00").unlink()
        (dev / "ttyACM0").unlink()
        first.unplug()
        listen.wait_output("trying again", stream="err")
        second, stranger = port(), port()
        (dev / "ttyACM0").symlink_to(stranger.device)
        (dev / "ttyACM1").symlink_to(second.device)
        put_link(dev / "serial/by-id/usb-Autopilot-if00", "../../ttyACM1")
        second.write(next(frames.heartbeats(1, system=2)))
        listen.wait_output('"sys":2', stream="out")
        listen.wait_output("is back as /dev/serial/by-id/usb-Autopilot-if00", stream="err")
        assert '"link":"serial:///dev/ttyACM0"' in listen.stdout
    finally:
        listen.kill()
