# SPDX-License-Identifier: MIT
"""The rules by which all messages of a flight agree with each other. Each rule reads a recording and returns its
violations as texts. Distances and bearings come from geographiclib, frames from pymavlink."""
import bisect
import math
import threading
import time

import numpy as np
from geographiclib.geodesic import Geodesic

from stations import mavlink

G = 9.80665

# Asked for in one datagram, so that the vehicle answers all of them in one step. ATTITUDE stands at both ends: equal
# times show that no step came in between.
SNAPSHOT = [30, 31, 32, 33, 74, 141, 24, 331, 0, 245, 436, 147, 1, 242, 36, 87, 85, 83, 30]


def snapshots_of(station, stop, every_s):
    """Requests snapshots until `stop` is set."""
    while not stop.wait(every_s):
        with station._sending:
            frames = [mavlink.MAVLink_command_long_message(*station.target, 512, 0, number, 0, 0, 0, 0, 0, 0)
                      for number in SNAPSHOT]
            data = b""
            for frame in frames:
                data += frame.pack(station._coder)
                station._coder.seq = (station._coder.seq + 1) % 256
            station.write(data)


class Snapshots:
    """with Snapshots(station): ... requests one each `every_s` seconds."""

    def __init__(self, station, every_s=0.05):
        self._stop = threading.Event()
        self._thread = threading.Thread(target=snapshots_of, args=(station, self._stop, every_s), daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()


class Recording:
    """All messages of a flight, in the order of their arrival."""

    def __init__(self, messages):
        self.messages = messages
        self.by_name = {}
        for message in messages:
            self.by_name.setdefault(message.get_type(), []).append(message)
        self.snapshots = list(self._find_snapshots())

    def of(self, name):
        return self.by_name.get(name, [])

    def series(self, name, *fields):
        """Time in seconds and the fields of each message, one row each; the first of those with the same time."""
        rows, last = [], None
        for message in self.of(name):
            stamp = milliseconds(message)
            if stamp != last:
                rows.append([stamp / 1000, *(getattr(message, field) for field in fields)])
            last = stamp
        return np.array(rows, dtype=float)

    def _find_snapshots(self):
        """{name: message} of each answered burst of requests whose messages are all of one step."""
        messages, used = self.messages, -1
        acks = [i for i, m in enumerate(messages) if m.get_type() == "COMMAND_ACK" and m.command == 512]
        for first, last in zip(acks, acks[len(SNAPSHOT) - 1:]):
            start = first - 1
            if first <= used:
                continue
            if start < 0 or messages[start].get_type() != "ATTITUDE":
                continue
            found = messages[start:last]
            if sum(m.get_type() == "COMMAND_ACK" for m in found) != len(SNAPSHOT) - 1:
                continue
            stamps = {milliseconds(m) for m in found if hasattr(m, "time_boot_ms")}
            if len(stamps) == 1 and messages[last - 1].get_type() == "ATTITUDE":
                used = last
                current = [m for m in messages[:start] if m.get_type() == "MISSION_CURRENT"][-1:]
                yield {m.get_type(): m for m in [*current, *found]}


def milliseconds(message):
    return message.time_boot_ms if hasattr(message, "time_boot_ms") else message.time_usec / 1000


def quaternion_of(message):
    q = message.q if hasattr(message, "q") else (message.q1, message.q2, message.q3, message.q4)
    return np.array(q[:4], dtype=float)


def matrix_of(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def quaternion_of_angles(roll, pitch, yaw):
    cr, sr, cp, sp, cy, sy = (f(a / 2) for a in (roll, pitch, yaw) for f in (math.cos, math.sin))
    return np.array([cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
                     cr * cp * sy - sr * sp * cy])


def product(a, b):
    w, x, y, z = a
    return np.array([w * b[0] - x * b[1] - y * b[2] - z * b[3], w * b[1] + x * b[0] + y * b[3] - z * b[2],
                     w * b[2] - x * b[3] + y * b[0] + z * b[1], w * b[3] + x * b[2] - y * b[1] + z * b[0]])


def angle_of(a, b):
    """The angle in radians between two attitudes."""
    return 2 * math.acos(min(1.0, abs(float(np.dot(a, b)))))


def turn(radians):
    return math.remainder(radians, 2 * math.pi)


class Complaints(list):
    """At most a few of each rule, with the largest violation in front."""

    def check(self, is_good, where, text):
        if not is_good:
            self.append(f"{where}: {text}")


# ---- rules over time

def position_is_the_integral_of_velocity(recording):
    wrong = Complaints()
    rows = recording.series("LOCAL_POSITION_NED", "x", "y", "z", "vx", "vy", "vz")
    steps = (rows[1:, 4:] + rows[:-1, 4:]) / 2 * np.diff(rows[:, 0])[:, None]
    integral = np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
    off = np.linalg.norm(rows[:, 1:4] - rows[0, 1:4] - integral, axis=1)  # over the whole flight
    # The error of a step grows with the square of its length, and a stall of the machine skips instants.
    lengths = np.diff(rows[:, 0])
    allowed = 0.004 * np.maximum(1, lengths / np.median(lengths)) ** 2
    whole = 0.05 + allowed[lengths > 1.5 * np.median(lengths)].sum()
    wrong.check(off.max() < whole, f"{rows[off.argmax(), 0]:.2f} s", f"{off.max():.3f} m off")
    for at in np.argsort(np.abs(np.diff(off)) / allowed)[::-1][:2]:
        wrong.check(abs(off[at + 1] - off[at]) < allowed[at], f"{rows[at, 0]:.3f} s",
                    f"{off[at + 1] - off[at]:.4f} m off in {lengths[at]:.3f} s")
    return wrong


def attitude_is_the_integral_of_body_rates(recording):
    wrong = Complaints()
    rows = recording.series("ATTITUDE", "roll", "pitch", "yaw", "rollspeed", "pitchspeed", "yawspeed")
    worst = []
    for a, b in zip(rows, rows[1:]):
        dt = b[0] - a[0]
        if dt > 0.03:
            continue
        rate = (a[4:] + b[4:]) / 2
        size = np.linalg.norm(rate) * dt
        change = np.array([math.cos(size / 2), *(math.sin(size / 2) * rate * dt / size if size else rate)])
        off = angle_of(product(quaternion_of_angles(*a[1:4]), change), quaternion_of_angles(*b[1:4]))
        worst.append((off, a[0], dt))
    for off, at, dt in sorted(worst, reverse=True)[:3]:
        wrong.check(off < 0.004, f"{at:.3f} s", f"the attitude is {off:.4f} rad off after {dt:.3f} s")
    return wrong


def accelerometers_show_the_change_of_velocity(recording):
    """R f + g = dv/dt, each averaged over half a second, because the accelerometers are noisy."""
    wrong, judged = Complaints(), 0
    imu = recording.series("HIGHRES_IMU", "xacc", "yacc", "zacc")
    attitude = recording.series("ATTITUDE", "roll", "pitch", "yaw")
    velocity = recording.series("LOCAL_POSITION_NED", "vx", "vy", "vz")
    for start in np.arange(imu[0, 0], imu[-1, 0] - 0.5, 0.5):
        inside = imu[(imu[:, 0] >= start) & (imu[:, 0] < start + 0.5)]
        v0, v1 = (sample(velocity, t) for t in (start, start + 0.5))
        if v0 is None or v1 is None:
            continue
        forces = []
        for row in inside:
            angles = sample(attitude, row[0], angles=True)
            if angles is not None:
                forces.append(matrix_of(quaternion_of_angles(*angles)) @ row[1:4] + (0, 0, G))
        if len(forces) < 45:  # of 50; a stalled simulator leaves out instants
            continue
        judged += 1
        off = np.linalg.norm(np.mean(forces, axis=0) - (v1 - v0) / 0.5)
        wrong.check(off < 0.35, f"{start:.2f} s", f"{off:.2f} m/s^2: {np.mean(forces, axis=0)}, {(v1 - v0) / 0.5}")
    wrong.check(judged > 10, "the flight", f"{judged} half seconds without gaps")
    return wrong[:3]


def sample(rows, at, angles=False):
    """The row interpolated at a time; None if the samples next to it are far."""
    i = bisect.bisect_left(rows[:, 0], at)
    if i == 0 or i == len(rows) or rows[i, 0] - rows[i - 1, 0] > 0.05:
        return None
    share = (at - rows[i - 1, 0]) / (rows[i, 0] - rows[i - 1, 0])
    change = rows[i, 1:] - rows[i - 1, 1:]
    if angles:
        change = np.array([turn(c) for c in change])
    return rows[i - 1, 1:] + share * change


def tilt_accelerates(recording):
    """In level flight, the horizontal acceleration is g times the tangent of the tilt, less the drag."""
    wrong = Complaints()
    velocity = recording.series("LOCAL_POSITION_NED", "vx", "vy", "vz")
    attitude = recording.series("ATTITUDE", "roll", "pitch", "yaw")
    checked = 0
    for start in np.arange(velocity[0, 0], velocity[-1, 0] - 0.3, 0.3):
        v0, v1 = (sample(velocity, t) for t in (start, start + 0.3))
        angles = sample(attitude, start + 0.15, angles=True)
        if v0 is None or v1 is None or angles is None or abs(v0[2]) > 0.3 or abs(v1[2]) > 0.3:
            continue
        acceleration, speed = (v1 - v0)[:2] / 0.3, (v0 + v1)[:2] / 2
        thrust = -matrix_of(quaternion_of_angles(*angles))[:, 2]
        tilt = G * thrust[:2] / -thrust[2]
        if np.linalg.norm(tilt) < 1.0:
            continue
        checked += 1
        drag = tilt - acceleration  # against the speed, and small
        wrong.check(np.linalg.norm(drag) < 0.8 + 0.6 * np.linalg.norm(speed), f"{start:.2f} s",
                    f"tilt gives {tilt}, acceleration is {acceleration} at {speed} m/s")
    wrong.check(checked > 2, "flight", f"only {checked} instants with tilt")
    return wrong[:3]


def consumed_charge_is_the_integral_of_current(recording):
    wrong = Complaints()
    rows, last, is_armed = [], None, False
    for message in recording.messages:
        if hasattr(message, "time_boot_ms"):
            last = message.time_boot_ms / 1000
        elif message.get_type() == "HEARTBEAT":
            is_armed = bool(message.base_mode & 128)
        elif message.get_type() == "BATTERY_STATUS" and is_armed:  # it is full again when it is disarmed
            rows.append((last, message.current_battery / 100, message.current_consumed, message.battery_remaining))
    rows = np.array(rows)
    charge = np.concatenate([[0], np.cumsum((rows[1:, 1] + rows[:-1, 1]) / 2 * np.diff(rows[:, 0]) / 3.6)])  # mAh
    used = rows[:, 2] - rows[0, 2]
    wrong.check(used[-1] > 20, "flight", f"only {used[-1]} mAh were used")
    for at in np.argsort(np.abs(charge - used))[::-1][:2]:
        wrong.check(abs(charge[at] - used[at]) < 2 + 0.02 * used[-1], f"{rows[at, 0]:.2f} s",
                    f"consumed {used[at]} mAh, the current gives {charge[at]:.1f}")
    percent = 100 * (1 - rows[:, 2] / 5000)  # the capacity of the battery
    for at in np.argsort(np.abs(percent - rows[:, 3]))[::-1][:2]:
        wrong.check(abs(percent[at] - rows[at, 3]) <= 1.01, f"{rows[at, 0]:.2f} s",
                    f"{rows[at, 3]} % remain, {percent[at]:.1f} % by charge")
    wrong.check(all(np.diff(rows[:, 2]) >= 0), "flight", "consumed charge went back")
    return wrong


def times_never_run_backwards(recording):
    wrong, last = Complaints(), 0
    for message in recording.messages:
        if hasattr(message, "time_boot_ms") or hasattr(message, "time_usec") and message.get_type() != "PING":
            stamp = milliseconds(message)
            wrong.check(stamp >= last - (0 if hasattr(message, "time_boot_ms") else 1), message.get_type(),
                        f"{stamp} ms after {last} ms")
            last = max(last, stamp)
    offsets = {m.time_unix_usec - m.time_boot_ms * 1000 for m in recording.of("SYSTEM_TIME")}
    wrong.check(not offsets or max(offsets) - min(offsets) <= 2000, "SYSTEM_TIME", f"offsets {offsets}")
    now = time.time()
    for m in recording.of("SYSTEM_TIME")[:1]:
        wrong.check(abs(m.time_unix_usec / 1e6 - now) < 3600, "SYSTEM_TIME", f"{m.time_unix_usec} is far from now")
    return wrong[:5]


# ---- rules of one instant

def each(rule):
    """Makes a rule of all snapshots of a rule of one."""
    def of_all(recording):
        wrong = Complaints()
        for snapshot in recording.snapshots:
            rule(snapshot, lambda good, text, s=snapshot: wrong.check(good, f"{s['ATTITUDE'].time_boot_ms} ms", text))
        return wrong[:4]
    of_all.__name__ = rule.__name__
    return of_all


def has(snapshot, *names):
    return all(name in snapshot for name in names)


@each
def attitudes_are_equal(s, check):
    attitude = quaternion_of_angles(s["ATTITUDE"].roll, s["ATTITUDE"].pitch, s["ATTITUDE"].yaw)
    for name in ("ATTITUDE_QUATERNION", "ODOMETRY"):
        off = angle_of(attitude, quaternion_of(s[name]))
        check(off < 1e-3, f"{name} is {off} rad from ATTITUDE")
    a, q, o = s["ATTITUDE"], s["ATTITUDE_QUATERNION"], s["ODOMETRY"]
    for name in ("rollspeed", "pitchspeed", "yawspeed"):
        check(abs(getattr(a, name) - getattr(q, name)) < 1e-6, f"{name} differs: {a}, {q}")
        check(abs(getattr(a, name) - getattr(o, name)) < 1e-6, f"{name} differs: {a}, {o}")


@each
def headings_are_equal(s, check):
    yaw = math.degrees(s["ATTITUDE"].yaw) % 360
    hdg, shown = s["GLOBAL_POSITION_INT"].hdg / 100, s["VFR_HUD"].heading
    check(abs((yaw - hdg + 180) % 360 - 180) < 0.02, f"yaw {yaw}, hdg {hdg}")
    check(abs((yaw - shown + 180) % 360 - 180) <= 1.0, f"yaw {yaw}, VFR_HUD {shown}")
    check(0 <= hdg < 360 and 0 <= shown < 360, f"hdg {hdg}, VFR_HUD {shown}")


@each
def altitudes_are_equal(s, check):
    if not has(s, "HOME_POSITION"):
        return
    gpi, local = s["GLOBAL_POSITION_INT"], s["LOCAL_POSITION_NED"]
    home = s["HOME_POSITION"]
    amsl, relative = gpi.alt / 1000, gpi.relative_alt / 1000
    check(abs(amsl - relative - home.altitude / 1000) < 0.003, f"alt {amsl}, relative {relative}, home {home.altitude}")
    check(abs(s["VFR_HUD"].alt - amsl) < 0.002, f"alt {amsl}, VFR_HUD {s['VFR_HUD'].alt}")
    check(abs(s["ALTITUDE"].altitude_amsl - amsl) < 0.002, f"alt {amsl}, {s['ALTITUDE']}")
    check(abs(s["ALTITUDE"].altitude_relative - relative) < 0.003, f"relative {relative}, {s['ALTITUDE']}")
    check(abs(s["ALTITUDE"].altitude_local + local.z) < 0.002, f"z {local.z}, {s['ALTITUDE']}")
    # home in the local frame, and the vehicle: the same height over it in both frames
    check(abs(home.z - local.z - relative) < 0.05, f"z {local.z}, of home {home.z}, relative {relative}")


@each
def velocities_are_equal(s, check):
    gpi, local, shown, odometry = (s[n] for n in ("GLOBAL_POSITION_INT", "LOCAL_POSITION_NED", "VFR_HUD", "ODOMETRY"))
    for name in ("vx", "vy", "vz"):
        check(abs(getattr(gpi, name) / 100 - getattr(local, name)) < 0.0101, f"{name}: {gpi}, {local}")
    check(abs(shown.climb + local.vz) < 0.001, f"climb {shown.climb}, vz {local.vz}")
    check(abs(shown.groundspeed - math.hypot(local.vx, local.vy)) < 0.001, f"{shown}, {local}")
    velocity = np.array([odometry.vx, odometry.vy, odometry.vz])
    if odometry.child_frame_id == mavlink.MAV_FRAME_BODY_FRD:
        velocity = matrix_of(quaternion_of(odometry)) @ velocity
    check(np.linalg.norm(velocity - (local.vx, local.vy, local.vz)) < 0.002, f"{odometry}, {local}")
    check(np.linalg.norm(np.array([odometry.x - local.x, odometry.y - local.y, odometry.z - local.z])) < 0.002,
          f"{odometry}, {local}")


@each
def modes_and_states_are_equal(s, check):
    beat, mode, state = s["HEARTBEAT"], s["CURRENT_MODE"], s["EXTENDED_SYS_STATE"]
    armed = bool(beat.base_mode & mavlink.MAV_MODE_FLAG_SAFETY_ARMED)
    check(mode.custom_mode == beat.custom_mode, f"{mode}, {beat}")
    check(armed == (beat.system_status in (mavlink.MAV_STATE_ACTIVE, mavlink.MAV_STATE_CRITICAL,
                                           mavlink.MAV_STATE_EMERGENCY)), f"{beat}")
    check(armed or state.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND, f"disarmed, and {state}")
    height = s["GLOBAL_POSITION_INT"].relative_alt / 1000
    if state.landed_state == mavlink.MAV_LANDED_STATE_ON_GROUND:
        check(height < 0.5, f"on the ground at {height} m")
        check(abs(s["VFR_HUD"].climb) < 0.6 and s["VFR_HUD"].groundspeed < 0.5, f"on the ground: {s['VFR_HUD']}")
    if state.landed_state == mavlink.MAV_LANDED_STATE_IN_AIR:
        check(height > 0.2, f"in the air at {height} m")
    if height > 1.0:
        check(state.landed_state != mavlink.MAV_LANDED_STATE_ON_GROUND, f"{height} m high, and {state}")


@each
def batteries_are_equal(s, check):
    battery, status = s["BATTERY_STATUS"], s["SYS_STATUS"]
    cells = [v for v in battery.voltages if v != 65535]
    check(abs(sum(cells) - status.voltage_battery) <= len(cells) + 1, f"{cells}, {status.voltage_battery} mV")
    check(abs(battery.battery_remaining - status.battery_remaining) <= 1, f"{battery}, {status}")
    if status.current_battery != -1:  # PX4's built-in simulator sends -1
        check(abs(battery.current_battery - status.current_battery) <= 1, f"{battery}, {status}")


@each
def outputs_agree_with_arming(s, check):
    armed = s["HEARTBEAT"].base_mode & 128
    motors = [getattr(s["SERVO_OUTPUT_RAW"], f"servo{n}_raw") for n in range(1, 5)]
    if not armed:
        check(motors == [1000] * 4 or max(motors) <= 1000, f"disarmed, and the motors get {motors}")
        check(s["VFR_HUD"].throttle == 0, f"disarmed, and the throttle is {s['VFR_HUD'].throttle}")
    elif s["GLOBAL_POSITION_INT"].relative_alt > 2000:
        check(all(1050 < m < 1960 for m in motors), f"flying, and the motors get {motors}")
        check(10 < s["VFR_HUD"].throttle < 95, f"flying, and the throttle is {s['VFR_HUD'].throttle}")


@each
def gnss_is_near_the_estimate(s, check):
    gps, gpi = s["GPS_RAW_INT"], s["GLOBAL_POSITION_INT"]
    line = Geodesic.WGS84.Inverse(gps.lat / 1e7, gps.lon / 1e7, gpi.lat / 1e7, gpi.lon / 1e7)
    speed = math.hypot(gpi.vx, gpi.vy) / 100
    check(line["s12"] < 1.0 + 0.25 * speed, f"{line['s12']:.2f} m apart at {speed} m/s")
    check(abs(gps.alt - gpi.alt) < 2000, f"altitudes {gps.alt}, {gpi.alt}")
    check(abs(gps.vel / 100 - speed) < 1.0, f"speeds {gps.vel / 100}, {speed}")
    check(gps.fix_type == 3, f"{gps}")


def global_and_local_position_are_the_same_place(recording):
    """Azimuthal equidistant around the origin of the local frame."""
    wrong = Complaints()
    origin = recording.of("GPS_GLOBAL_ORIGIN")[-1]
    for s in recording.snapshots:
        gpi, local = s["GLOBAL_POSITION_INT"], s["LOCAL_POSITION_NED"]
        line = Geodesic.WGS84.Inverse(origin.latitude / 1e7, origin.longitude / 1e7, gpi.lat / 1e7, gpi.lon / 1e7)
        north = line["s12"] * math.cos(math.radians(line["azi1"]))
        east = line["s12"] * math.sin(math.radians(line["azi1"]))
        off = math.hypot(north - local.x, east - local.y)
        wrong.check(off < 0.02, f"{gpi.time_boot_ms} ms", f"{off:.3f} m apart: {north, east}, {local.x, local.y}")
        height = gpi.alt / 1000 - origin.altitude / 1000
        wrong.check(abs(height + local.z) < 0.02, f"{gpi.time_boot_ms} ms", f"z {local.z}, {height} m over the origin")
    return wrong[:4]


def targets_are_those_of_the_mission(recording):
    wrong, seen = Complaints(), 0
    items = {(m.x, m.y) for m in recording.of("MISSION_ITEM_INT")}
    for s in recording.snapshots:
        is_item = s["HEARTBEAT"].custom_mode == 0x4040000 and s["MISSION_CURRENT"].seq < 4  # then, a return
        if not is_item or not has(s, "POSITION_TARGET_GLOBAL_INT"):
            continue
        target = s["POSITION_TARGET_GLOBAL_INT"]
        near = min((abs(target.lat_int - x) + abs(target.lon_int - y) for x, y in items if x), default=0)
        seen += 1
        wrong.check(near < 10, f"{target.time_boot_ms} ms", f"{target} is no item of the mission")
    wrong.check(seen > 10, "flight", f"only {seen} targets in Mission")
    return wrong[:3]


RULES = [position_is_the_integral_of_velocity, attitude_is_the_integral_of_body_rates,
         accelerometers_show_the_change_of_velocity, tilt_accelerates, consumed_charge_is_the_integral_of_current,
         times_never_run_backwards, attitudes_are_equal, headings_are_equal, altitudes_are_equal, velocities_are_equal,
         modes_and_states_are_equal, batteries_are_equal, outputs_agree_with_arming, gnss_is_near_the_estimate,
         global_and_local_position_are_the_same_place, targets_are_those_of_the_mission]
