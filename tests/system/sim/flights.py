# SPDX-License-Identifier: MIT
"""Steps of flights, by single messages of a Station. Flights run at a raised speed (--speed): time-outs of transfers
stay in real time, so clients notice nothing."""
import math

import harness
from simulators import HOLD, HOME, metres_between, place
from stations import NAN, mavlink

SPEED = 20


def ready_vehicle(sim, *options, speed=SPEED, identity=(255, 190), parameters=None, vehicle=None, autopilot="px4"):
    """A client at a vehicle that can be armed. It does not disarm by itself before a take-off, because 10 s are short
    at a raised speed."""
    patient = {"COM_DISARM_PRFLT": 600.0} if autopilot == "px4" else {"DISARM_DELAY": 127}
    simulator = sim("--speed", speed, *(["--autopilot", autopilot] if autopilot != "px4" else []), *options,
                    parameters={**patient, **(parameters or {})}, vehicle=vehicle)
    station = simulator.station(identity)
    station.simulator = simulator
    return station.ready()


def arm(station, **options):
    mark = station.mark()
    assert station.command(400, 1, **options) == 0, station.texts()
    station.armed_is(True, since=mark)


def take_off(station, height=10.0):
    """As QGroundControl does it: the altitude above sea level, then arm."""
    home = station.expect("HOME_POSITION", since=0).altitude / 1000
    mark = station.mark()
    assert station.command(22, -1, 0, 0, NAN, NAN, NAN, home + height) == 0, station.texts()
    arm(station)
    station.landed(2, since=mark)
    station.mode_is(HOLD, since=station.at)
    station.height_is(height)


def fly_to(station, north, east, height=10.0, *, frame=6, yaw=NAN, speed=-1, home=HOME):
    """DO_REPOSITION, without waiting."""
    from simulators import offset
    latitude, longitude = offset(*home[:2], north, east)
    result = station.command(192, speed, 1, 0, yaw, form="int", frame=frame, x=round(latitude * 1e7),
                             y=round(longitude * 1e7), p7=height)
    assert result == 0, station.texts()
    return latitude, longitude


def arrives(station, where, height=None, tolerance=1.0, timeout=harness.DEFAULT_TIMEOUT_S):
    return station.expect("GLOBAL_POSITION_INT", timeout=timeout, what=f"at {where}",
                          where=lambda m: metres_between(place(m), where) < tolerance and
                          (height is None or abs(m.relative_alt / 1000 - height) < tolerance) and
                          math.hypot(m.vx, m.vy) < 30)


def speed_of(message):
    """m/s over ground of GLOBAL_POSITION_INT."""
    return math.hypot(message.vx, message.vy) / 100


def flight_time(station, message):
    """Seconds since boot when a message left: those of the last one before it that has a time."""
    with station._news:
        at = next(i for i, (_, m) in enumerate(station.log) if m is message)
        timed = next(m for _, m in reversed(station.log[:at + 1]) if hasattr(m, "time_boot_ms"))
    return timed.time_boot_ms / 1000


def angle_between(a, b):
    """Degrees, 0 to 180."""
    return abs((a - b + 180) % 360 - 180)


def landed_and_disarmed(station, since, timeout=harness.DEFAULT_TIMEOUT_S):
    station.armed_is(False, timeout=timeout, since=since)
    return station.latest("GLOBAL_POSITION_INT")


def results_in_time(station, send, name, limit_s, tries=10):
    """Repeats a request until an answer comes within the limit: the machine may be busy. The messages of that try."""
    took = []
    import time
    for _ in range(tries):
        mark = station.mark()
        sent = time.time()
        send()
        station.expect(name, since=mark)
        arrived = next(when for when, m in station.log[mark:] if m.get_type() == name)
        took.append(arrived - sent)
        if took[-1] < limit_s:
            return station.since(mark)
    raise AssertionError(f"answers took {took} s, the limit is {limit_s} s")


def command_message(station, command, *params, form="long"):
    values = list(params) + [0] * (7 - len(params))
    if form == "int":
        return mavlink.MAVLink_command_int_message(*station.target, 0, command, 0, 0, *values[:4], 0, 0, 0)
    return mavlink.MAVLink_command_long_message(*station.target, command, 0, *values)
