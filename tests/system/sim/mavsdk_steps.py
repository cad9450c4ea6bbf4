# SPDX-License-Identifier: MIT
"""The steps that tests take with MAVSDK: python mavsdk_steps.py URL STEP ARGUMENTS-AS-JSON. Each step prints its
answers as lines of JSON. Runs without pytest; mavsdks.py starts it."""
import enum
import json
import math
import os
import pathlib
import sys
import tempfile
import threading
import time

try:
    from mavsdk import ComponentType, Configuration, Mavsdk
    from mavsdk.plugins.action import action as actions
    from mavsdk.plugins.calibration import calibration as calibrations
    from mavsdk.plugins.failure import failure as failures
    from mavsdk.plugins.ftp import ftp as ftps
    from mavsdk.plugins.geofence import geofence as geofences
    from mavsdk.plugins.gimbal import gimbal as gimbals
    from mavsdk.plugins.info import info as infos
    from mavsdk.plugins.log_files import log_files
    from mavsdk.plugins.manual_control import manual_control as manuals
    from mavsdk.plugins.mission import mission as missions
    from mavsdk.plugins.mission_raw import mission_raw as raw_missions
    from mavsdk.plugins.offboard import offboard as offboards
    from mavsdk.plugins.param import param as params
    from mavsdk.plugins.telemetry import telemetry as telemetries
except OSError as error:  # the library does not load on this machine
    print(json.dumps({"cannot": str(error)}), flush=True)
    sys.exit(0)

STEPS = {}
DEADLINE_S = 90


def step(function):
    STEPS[function.__name__] = function
    return function


def emit(**answer):
    print(json.dumps(named(answer)), flush=True)


def named(value):
    """With the names of enumerators; they are integers to JSON."""
    if isinstance(value, enum.Enum):
        return value.name
    if isinstance(value, dict):
        return {key: named(one) for key, one in value.items()}
    return [named(one) for one in value] if isinstance(value, (list, tuple)) else value


def proceed():
    sys.stdin.readline()


def wait_for(condition, what, timeout=DEADLINE_S):
    deadline = time.monotonic() + timeout
    while not (value := condition()):
        assert time.monotonic() < deadline, f"waited {timeout} s in vain for {what}"
        time.sleep(0.02)
    return value


def result_of(call, *arguments):
    """The name of the result: SUCCESS, or that of the error."""
    try:
        result = call(*arguments)
    except Exception as error:  # every plugin has an exception of its own, with a `result`
        return error.result.name
    return getattr(result, "name", "SUCCESS")


def in_background(call, *arguments, timeout=DEADLINE_S):
    """All (result, data) of an asynchronous call up to its end."""
    seen, ended = [], threading.Event()

    def note(result, data, _):
        seen.append((result.name, data))
        if result.name != "NEXT":
            ended.set()
    call(*arguments, note)
    assert ended.wait(timeout), f"{call.__name__} did not end: {seen[-3:]}"
    return seen


class Sdk:
    def __init__(self, url):
        self.sdk = Mavsdk(Configuration.create_with_component_type(ComponentType.GROUND_STATION))
        self.sdk.add_any_connection(url)
        self.system = self.sdk.first_autopilot(60.0)
        assert self.system, "no vehicle was heard"

    @property
    def telemetry(self):
        if not hasattr(self, "_telemetry"):
            self._telemetry = telemetries.Telemetry(self.system)
        return self._telemetry

    def healthy(self):
        wait_for(self.telemetry.health_all_ok, "health_all_ok")
        wait_for(lambda: self.telemetry.health().is_armable, "is_armable")


# ---- connection and information

@step
def watch_connection(sdk):
    emit(found=True)
    wait_for(lambda: not sdk.system.is_connected(), "the end of the connection")
    emit(at=time.time())


@step
def information(sdk):
    info = infos.Info(sdk.system)

    def known():
        try:
            return info.get_version()
        except infos.InfoError:
            return None
    version = wait_for(known, "the version")
    flights = []
    handle = info.subscribe_flight_information(lambda flight, _: flights.append(flight.time_boot_ms))
    wait_for(lambda: len(flights) >= 2, "flight information")
    info.unsubscribe_flight_information(handle)
    emit(version=[version.flight_sw_major, version.flight_sw_minor, version.flight_sw_patch],
         kind=version.flight_sw_version_type, uid=info.get_identification().legacy_uid,
         vendor=info.get_product().vendor_id, flights=flights, speed=info.get_speed_factor())


# ---- telemetry

STREAMS = ("position", "home", "in_air", "landed_state", "armed", "vtol_state", "attitude_quaternion", "attitude_euler",
           "attitude_angular_velocity_body", "velocity_ned", "gps_info", "raw_gps", "battery", "flight_mode", "health",
           "actuator_control_target", "actuator_output_status", "odometry", "position_velocity_ned", "ground_truth",
           "fixedwing_metrics", "imu", "scaled_imu", "raw_imu", "health_all_ok", "unix_epoch_time", "distance_sensor",
           "scaled_pressure", "heading", "altitude", "wind", "rc_status")
RATES = ("position", "home", "in_air", "landed_state", "vtol_state", "attitude_quaternion", "attitude_euler",
         "velocity_ned", "gps_info", "raw_gps", "battery", "rc_status", "actuator_control_target",
         "actuator_output_status", "odometry", "position_velocity_ned", "ground_truth", "fixedwing_metrics", "imu",
         "scaled_imu", "raw_imu", "unix_epoch_time", "distance_sensor", "altitude", "health")


@step
def telemetry(sdk, *not_expected):
    """Every rate is accepted, and every subscription gets something."""
    rates = {name: result_of(getattr(sdk.telemetry, f"set_rate_{name}"), 5.0) for name in RATES}
    counts = dict.fromkeys(STREAMS, 0)

    def count(name):
        def note(*_):
            counts[name] += 1
        return note
    for name in STREAMS:
        getattr(sdk.telemetry, f"subscribe_{name}")(count(name))
    expected = [name for name in STREAMS if name not in not_expected]

    def all_came():
        return all(counts[name] >= 2 for name in expected)
    try:
        wait_for(all_came, "all streams", 20)
    except AssertionError:
        pass
    sdk.healthy()
    health = sdk.telemetry.health()
    position, home = sdk.telemetry.position(), sdk.telemetry.home()
    emit(rates=rates, silent=[name for name in expected if counts[name] < 2],
         health={name: value for name, value in vars(health).items() if name.startswith("is_")},
         position=[position.latitude_deg, position.longitude_deg, position.absolute_altitude_m,
                   position.relative_altitude_m],
         home=[home.latitude_deg, home.longitude_deg, home.absolute_altitude_m],
         battery=[sdk.telemetry.battery().voltage_v, sdk.telemetry.battery().remaining_percent],
         satellites=sdk.telemetry.gps_info().num_satellites, fix=sdk.telemetry.gps_info().fix_type,
         mode=sdk.telemetry.flight_mode(), landed=sdk.telemetry.landed_state(), in_air=sdk.telemetry.in_air())


@step
def health(sdk):
    sdk.healthy()
    emit(healthy=True)


@step
def texts(sdk, count):
    """Status texts, as they come."""
    seen = []
    sdk.telemetry.subscribe_status_text(lambda text, _: seen.append(text.text))
    emit(ready=True)
    wait_for(lambda: len(seen) >= count, f"{count} texts; there are {seen}", 30)
    emit(texts=seen)


# ---- flying

def height(sdk):
    return sdk.telemetry.position().relative_altitude_m


def take_off(sdk, action, metres=10.0):
    assert result_of(action.set_takeoff_altitude, metres) == "SUCCESS"
    assert abs(action.get_takeoff_altitude() - metres) < 1e-3
    results = [result_of(action.arm), result_of(action.takeoff)]
    wait_for(lambda: abs(height(sdk) - metres) < 0.5, f"{metres} m")
    wait_for(lambda: sdk.telemetry.flight_mode().name == "HOLD", "Hold after the take-off")
    return results


@step
def flight(sdk):
    """Arm, take-off, go-to, orbit, return, land; a disarm in the air is refused, and kill disarms."""
    action = actions.Action(sdk.system)
    for name in ("position", "in_air", "landed_state"):
        getattr(sdk.telemetry, f"set_rate_{name}")(10.0)
    sdk.healthy()
    home, states, modes = sdk.telemetry.position(), [], []
    sdk.telemetry.subscribe_landed_state(
        lambda state, _: states.append(state.name) if not states or states[-1] != state.name else None)
    sdk.telemetry.subscribe_flight_mode(
        lambda mode, _: modes.append(mode.name) if not modes or modes[-1] != mode.name else None)
    answer = {"take_off": take_off(sdk, action)}
    answer["disarm_in_air"] = result_of(action.disarm)
    answer["in_air"] = sdk.telemetry.in_air()
    north = math.degrees(30 / 6371008.8)
    answer["goto"] = result_of(action.goto_location, home.latitude_deg + north, home.longitude_deg,
                               home.absolute_altitude_m + 15, 90.0)
    wait_for(lambda: abs(sdk.telemetry.position().latitude_deg - home.latitude_deg - north) < 1e-5
             and abs(height(sdk) - 15) < 1, "the position")
    wait_for(lambda: abs(sdk.telemetry.heading().heading_deg - 90) < 5, "the heading")
    answer["speed"] = result_of(action.set_current_speed, 3.0)
    answer["orbit"] = result_of(action.do_orbit, 20.0, 3.0, actions.OrbitYawBehavior(0), home.latitude_deg,
                                home.longitude_deg, home.absolute_altitude_m + 15)
    wait_for(lambda: sdk.telemetry.velocity_ned().east_m_s > 2 or sdk.telemetry.velocity_ned().east_m_s < -2, "speed")
    answer["orbit_mode"] = sdk.telemetry.flight_mode()
    answer["hold"] = result_of(action.hold)
    answer["return_altitude"] = [result_of(action.set_return_to_launch_altitude, 20.0),
                                 action.get_return_to_launch_altitude()]
    answer["return"] = result_of(action.return_to_launch)
    wait_for(lambda: not sdk.telemetry.armed(), "the end of the return")
    answer["states"], answer["modes"] = list(states), list(modes)
    answer["again"] = take_off(sdk, action, 5.0)
    answer["land"] = result_of(action.land)
    wait_for(lambda: not sdk.telemetry.armed(), "the landing")
    answer["third"] = take_off(sdk, action, 3.0)
    answer["kill"] = result_of(action.kill)
    wait_for(lambda: not sdk.telemetry.armed(), "the kill")
    emit(**answer)


@step
def short_flight(sdk, metres):
    """Arm, take-off (of ArduPilot: in Guided, as MAVSDK does it) and land."""
    action = actions.Action(sdk.system)
    sdk.healthy()
    results = [result_of(action.set_takeoff_altitude, metres), result_of(action.arm), result_of(action.takeoff)]
    wait_for(lambda: abs(height(sdk) - metres) < 1, f"{metres} m")
    emit(results=results, mode=sdk.telemetry.flight_mode())
    results = [result_of(action.land)]
    wait_for(lambda: not sdk.telemetry.armed(), "the landing")
    emit(results=results)


@step
def origin(sdk, latitude, longitude, altitude):
    action = actions.Action(sdk.system)
    result = result_of(action.set_gps_global_origin, latitude, longitude, altitude)
    got = sdk.telemetry.get_gps_global_origin()
    emit(result=result, origin=[got.latitude_deg, got.longitude_deg, got.altitude_m])


@step
def reboot(sdk):
    action = actions.Action(sdk.system)
    sdk.healthy()
    emit(result=result_of(action.reboot), actuator=result_of(action.set_actuator, 1, 0.5))


@step
def failsafe_actions(sdk):
    """Those that end a flight at once."""
    action = actions.Action(sdk.system)
    sdk.healthy()
    take_off(sdk, action, 5.0)
    emit(result=result_of(action.terminate))
    wait_for(lambda: not sdk.telemetry.armed(), "the end")
    emit(armed=sdk.telemetry.armed())


# ---- missions

def waypoint(home, north, east, metres, **more):
    return missions.MissionItem(
        latitude_deg=home.latitude_deg + math.degrees(north / 6371008.8),
        longitude_deg=home.longitude_deg + math.degrees(east / 6371008.8 / math.cos(math.radians(home.latitude_deg))),
        relative_altitude_m=metres, **more)


@step
def mission(sdk):
    """A mission of MAVSDK's items: up, down, started, paused, jumped, flown to the end."""
    plugin, action = missions.Mission(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    home, progress = sdk.telemetry.position(), []
    plugin.subscribe_mission_progress(lambda p, _: progress.append((p.current, p.total)))
    items = [waypoint(home, 0, 0, 8.0, is_fly_through=True, speed_m_s=5.0),
             waypoint(home, 30, 0, 8.0, is_fly_through=True, speed_m_s=6.0),
             waypoint(home, 30, 30, 10.0, is_fly_through=False, loiter_time_s=1.0),
             waypoint(home, 0, 30, 10.0, is_fly_through=True)]
    plan = missions.MissionPlan(items)
    answer = {"return_after": result_of(plugin.set_return_to_launch_after_mission, True)}
    answer["upload"] = result_of(plugin.upload_mission, plan)
    back = plugin.download_mission().mission_items
    answer["same"] = [abs(a.latitude_deg - b.latitude_deg) < 1e-6 and abs(a.longitude_deg - b.longitude_deg) < 1e-6
                      and abs(a.relative_altitude_m - b.relative_altitude_m) < 1e-3
                      for a, b in zip(items, back)] if len(items) == len(back) else [len(items), len(back)]
    answer["arm"] = result_of(action.arm)
    answer["start"] = result_of(plugin.start_mission)
    wait_for(lambda: any(current >= 1 for current, _ in progress), "the first item")
    answer["pause"] = result_of(plugin.pause_mission)
    wait_for(lambda: sdk.telemetry.flight_mode().name == "HOLD", "Hold")
    answer["finished_early"] = plugin.is_mission_finished()
    answer["set_current"] = result_of(plugin.set_current_mission_item, 3)
    answer["resume"] = result_of(plugin.start_mission)
    wait_for(plugin.is_mission_finished, "the end of the mission")
    wait_for(lambda: not sdk.telemetry.armed(), "the return")
    answer["progress"] = progress
    answer["clear"] = result_of(plugin.clear_mission)
    emit(**answer)


RAW_NAMES = ("seq", "frame", "command", "current", "autocontinue", "param1", "param2", "param3", "param4", "x", "y",
             "z", "mission_type")


def raw_items(rows):
    return [raw_missions.MissionItem(*row) for row in rows]


def rows_of(items):
    return [[getattr(item, name) for name in RAW_NAMES] for item in items]


@step
def raw_plans(sdk, mission_rows, fence_rows, rally_rows):
    """Uploads (unless empty) and downloads mission, fence and rally points."""
    plugin = raw_missions.MissionRaw(sdk.system)
    changes = []
    plugin.subscribe_mission_changed(lambda *_: changes.append(True))
    answer = {"uploads": []}
    for rows, upload in ((mission_rows, plugin.upload_mission), (fence_rows, plugin.upload_geofence),
                         (rally_rows, plugin.upload_rally_points)):
        if rows:
            answer["uploads"].append(result_of(upload, raw_items(rows)))
    answer["mission"] = rows_of(plugin.download_mission())
    answer["fence"] = rows_of(plugin.download_geofence())
    answer["rally"] = rows_of(plugin.download_rallypoints())
    emit(**answer)


@step
def refused_of_ardupilot(sdk, rows):
    """ArduPilot has no orbits, and its missions begin with home, in a frame that MAVSDK's missions do not know."""
    plugin, action = raw_missions.MissionRaw(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    home = sdk.telemetry.position()
    answer = {"orbit": result_of(action.do_orbit, 20.0, 3.0, actions.OrbitYawBehavior(0), home.latitude_deg,
                                 home.longitude_deg, home.absolute_altitude_m + 15)}
    answer["upload"] = result_of(plugin.upload_mission, raw_items(rows))
    answer["download"] = result_of(missions.Mission(sdk.system).download_mission)
    emit(**answer, raw=rows_of(plugin.download_mission()))


@step
def raw_mission(sdk, rows):
    """Flies a plan to its end."""
    plugin, action = raw_missions.MissionRaw(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    seen = []
    plugin.subscribe_mission_progress(lambda p, _: seen.append([p.current, p.total]))
    answer = {"upload": result_of(plugin.upload_mission, raw_items(rows)), "arm": result_of(action.arm)}
    answer["start"] = result_of(plugin.start_mission)
    wait_for(lambda: seen and seen[-1][0] > 0, "progress")
    answer["pause"] = result_of(plugin.pause_mission)
    answer["resume"] = result_of(plugin.start_mission)
    wait_for(plugin.is_mission_finished, "the end")
    answer["clear"] = result_of(plugin.clear_mission)
    emit(**answer, progress=seen)


@step
def geofence(sdk):
    plugin = geofences.Geofence(sdk.system)
    points = [geofences.Point(47.39 + a, 8.54 + b) for a, b in ((0, 0), (0.01, 0), (0.01, 0.01), (0, 0.01))]
    fence = geofences.GeofenceData([geofences.Polygon(points, geofences.FenceType.INCLUSION)],
                                   [geofences.Circle(points[2], 50.0, geofences.FenceType.EXCLUSION)])
    answer = {"upload": result_of(plugin.upload_geofence, fence)}
    back = plugin.download_geofence()
    answer["points"] = [[p.latitude_deg, p.longitude_deg] for polygon in back.polygons for p in polygon.points]
    answer["circles"] = [[c.radius, c.fence_type] for c in back.circles]
    answer["clear"] = result_of(plugin.clear_geofence)
    left = plugin.download_geofence()
    emit(**answer, left=len(left.polygons) + len(left.circles))


# ---- parameters, files, logs

@step
def parameters(sdk, an_int, a_float):
    plugin = params.Param(sdk.system)
    everything = plugin.get_all_params()
    answer = {"ints": {p.name: p.value for p in everything.int_params},
              "floats": {p.name: p.value for p in everything.float_params}}
    answer["set"] = [result_of(plugin.set_param_int, an_int, 7), result_of(plugin.set_param_float, a_float, 3.5)]
    answer["got"] = [plugin.get_param_int(an_int), plugin.get_param_float(a_float)]
    answer["unknown"] = result_of(plugin.get_param_int, "NO_SUCH_NAME")
    answer["wrong_type"] = result_of(plugin.set_param_float, an_int, 1.5)
    emit(**answer)


@step
def files(sdk, folder, download):
    """Lists a folder, downloads a file in bursts and piece by piece, and moves a file of its own about."""
    ftp = ftps.Ftp(sdk.system)
    entries = in_background(lambda note: ftp.list_directory_async(folder or "/", lambda r, d, u: note(r, d, u)))
    answer = {"root": [entries[-1][0], [entry.name for entry in entries[-1][1].entries]]}
    with tempfile.TemporaryDirectory() as local:
        for burst in (True, False):
            ended = in_background(lambda note, b=burst: ftp.download_async(download, local, b, note))
            answer[f"burst {burst}"] = ended[-1][0]
        path = pathlib.Path(local, os.path.basename(download))
        answer["size"] = path.stat().st_size
        answer["identical"] = in_background(lambda note: ftp.are_files_identical_async(str(path), download, note))[-1]
        own = pathlib.Path(local, "own.txt")
        own.write_bytes(bytes(range(256)) * 8)
        answer["mkdir"] = result_of(ftp.create_directory, f"{folder}/made")
        answer["upload"] = in_background(lambda note: ftp.upload_async(str(own), f"{folder}/made", note))[-1][0]
        answer["rename"] = result_of(ftp.rename, f"{folder}/made/own.txt", f"{folder}/made/other.txt")
        again = in_background(lambda note: ftp.download_async(f"{folder}/made/other.txt", local, True, note))[-1][0]
        answer["again"] = [again, pathlib.Path(local, "other.txt").read_bytes() == own.read_bytes()]
        answer["remove"] = result_of(ftp.remove_file, f"{folder}/made/other.txt")
        answer["rmdir"] = result_of(ftp.remove_directory, f"{folder}/made")
        answer["missing"] = in_background(lambda note: ftp.download_async(f"{folder}/none", local, True, note))[-1][0]
    emit(**answer)


@step
def download(sdk, path, burst):
    ftp = ftps.Ftp(sdk.system)
    with tempfile.TemporaryDirectory() as local:
        ended = in_background(lambda note: ftp.download_async(path, local, burst, note))
        content = pathlib.Path(local, os.path.basename(path)).read_bytes()
    emit(result=ended[-1][0], content=content.hex())


@step
def logs(sdk):
    plugin = log_files.LogFiles(sdk.system)
    try:
        entries = plugin.get_entries()
    except log_files.LogFilesError as error:
        emit(result=error.result)
        return
    contents = []
    with tempfile.TemporaryDirectory() as local:
        for number, entry in enumerate([*entries, *entries]):
            path = pathlib.Path(local, f"log-{number}")
            ended = in_background(lambda note, e=entry, p=path: plugin.download_log_file_async(e, str(p), note))
            assert ended[-1][0] == "SUCCESS", ended[-1]
            contents.append(path.read_bytes())
    half = len(contents) // 2
    emit(result="SUCCESS", entries=[[entry.id, entry.size_bytes] for entry in entries],
         sizes=[len(content) for content in contents], same=contents[:half] == contents[half:])


# ---- other plugins

@step
def calibration(sdk, kind):
    plugin = calibrations.Calibration(sdk.system)
    sdk.healthy()
    seen = in_background(getattr(plugin, f"calibrate_{kind}_async"))
    emit(result=seen[-1][0], progress=[data.progress for _, data in seen if data.has_progress],
         texts=[data.status_text for _, data in seen if data.has_status_text])


@step
def cancelled_calibration(sdk):
    plugin, seen = calibrations.Calibration(sdk.system), []
    sdk.healthy()
    plugin.calibrate_accelerometer_async(lambda result, data, _: seen.append(result.name))
    wait_for(lambda: "NEXT" in seen, "progress")
    cancelled = result_of(plugin.cancel)
    wait_for(lambda: seen[-1] != "NEXT", "the end")
    emit(cancel=cancelled, result=seen[-1])


@step
def gimbal(sdk):
    plugin = gimbals.Gimbal(sdk.system)
    found = wait_for(lambda: plugin.gimbal_list().gimbals, "a gimbal")
    one = found[0].gimbal_id
    answer = {"control": result_of(plugin.take_control, one, gimbals.ControlMode.PRIMARY)}
    answer["angles"] = result_of(plugin.set_angles, one, 0.0, -30.0, 20.0, gimbals.GimbalMode.YAW_FOLLOW,
                                 gimbals.SendMode.ONCE)
    attitude = wait_for(lambda: (a := plugin.get_attitude(one)) and abs(a.euler_angle_forward.pitch_deg + 30) < 2 and a,
                        "the angle")
    answer["yaw"] = attitude.euler_angle_forward.yaw_deg
    status = wait_for(lambda: (s := plugin.get_control_status(one)).sysid_primary_control and s, "the control status")
    answer["in_control"] = [status.control_mode, status.sysid_primary_control]
    answer["roi"] = result_of(plugin.set_roi_location, one, 47.4, 8.55, 500.0)
    answer["release"] = result_of(plugin.release_control, one)
    emit(**answer)


@step
def manual_control(sdk):
    """Sticks at 20 Hz: take-off by hand in Position, then forward."""
    plugin, action = manuals.ManualControl(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    sticks, ended = [0.0, 0.0, 0.5, 0.0], threading.Event()

    def move():
        while not ended.wait(0.05):
            plugin.set_manual_control_input(*sticks)
    thread = threading.Thread(target=move)
    thread.start()
    try:
        time.sleep(0.2)  # a few inputs; start_position_control repeats nothing
        answer = {"start": result_of(plugin.start_position_control), "arm": result_of(action.arm)}
        sticks[2] = 1.0
        wait_for(lambda: height(sdk) > 5, "5 m")
        sticks[2] = 0.5
        north = sdk.telemetry.position().latitude_deg
        sticks[0] = 0.8
        wait_for(lambda: sdk.telemetry.position().latitude_deg > north + 5e-5, "a move to the north")
        sticks[0] = 0.0
        answer["altitude"] = result_of(plugin.start_altitude_control)
        answer["mode"] = wait_for(lambda: sdk.telemetry.flight_mode().name == "ALTCTL" and "ALTCTL", "Altitude")
        answer["land"] = result_of(action.land)
    finally:
        ended.set()
        thread.join()
    emit(**answer)


@step
def offboard(sdk):
    """Set-points of every kind."""
    plugin, action = offboards.Offboard(sdk.system), actions.Action(sdk.system)
    for name in ("position_velocity_ned", "velocity_ned", "attitude_euler"):
        getattr(sdk.telemetry, f"set_rate_{name}")(10.0)
    sdk.healthy()
    answer = {"without": result_of(plugin.start), "take_off": take_off(sdk, action, 10.0)}
    where = sdk.telemetry.position_velocity_ned

    plugin.set_velocity_ned(offboards.VelocityNedYaw(2.0, 0.0, 0.0, 90.0))
    answer["start"] = result_of(plugin.start)
    wait_for(lambda: abs(where().velocity.north_m_s - 2) < 0.3, "2 m/s north")
    wait_for(lambda: abs(sdk.telemetry.attitude_euler().yaw_deg - 90) < 5, "the yaw")
    plugin.set_position_ned(offboards.PositionNedYaw(10.0, 5.0, -12.0, 0.0))
    wait_for(lambda: abs(where().position.north_m - 10) < 0.7 and abs(where().position.east_m - 5) < 0.7
             and abs(where().position.down_m + 12) < 0.7, "the position")
    plugin.set_velocity_body(offboards.VelocityBodyYawspeed(1.5, 0.0, 0.0, 0.0))
    wait_for(lambda: math.hypot(where().velocity.north_m_s, where().velocity.east_m_s) > 1.2, "speed ahead")
    plugin.set_attitude(offboards.Attitude(0.0, -10.0, 0.0, 0.6))
    wait_for(lambda: abs(sdk.telemetry.attitude_euler().pitch_deg + 10) < 2, "the pitch")
    answer["active"] = plugin.is_active()
    answer["mode"] = sdk.telemetry.flight_mode()
    answer["stop"] = result_of(plugin.stop)
    wait_for(lambda: sdk.telemetry.flight_mode().name == "HOLD", "Hold")
    answer["after"] = plugin.is_active()
    emit(**answer)


@step
def offboard_loss(sdk):
    """Offboard, until the vehicle leaves it: the test cuts the link."""
    plugin, action = offboards.Offboard(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    take_off(sdk, action, 5.0)
    plugin.set_velocity_ned(offboards.VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
    emit(start=result_of(plugin.start))
    wait_for(lambda: not plugin.is_active(), "the end of Offboard")
    emit(mode=sdk.telemetry.flight_mode())


@step
def motor_failure(sdk):
    """A flight that ends when a motor stops."""
    plugin, action = failures.Failure(sdk.system), actions.Action(sdk.system)
    sdk.healthy()
    take_off(sdk, action, 10.0)
    where = sdk.telemetry.position
    before = where().relative_altitude_m
    unit, kind = failures.FailureUnit, failures.FailureType
    answer = {"unsupported": result_of(plugin.inject, unit.SYSTEM_SERVO, kind.OFF, 0),
              "stop": result_of(plugin.inject, unit.SYSTEM_MOTOR, kind.OFF, 1)}
    wait_for(lambda: where().relative_altitude_m < 1, "the ground")
    emit(fell_m=before - where().relative_altitude_m, **answer)


@step
def three_at_once(sdk, name, value):
    """One client among others: parameters, a plan, a file."""
    plugin, raw = params.Param(sdk.system), raw_missions.MissionRaw(sdk.system)
    sdk.healthy()
    everything = plugin.get_all_params()
    answer = {"parameters": len(everything.int_params) + len(everything.float_params),
              "set": result_of(plugin.set_param_float, name, value)}
    answer["mission"] = len(raw.download_mission())
    emit(**answer)


def main():
    url, name, arguments = sys.argv[1:]
    sdk = Sdk(url)
    STEPS[name](sdk, *json.loads(arguments))
    os._exit(0)  # the library's threads need no end


if __name__ == "__main__":
    main()
