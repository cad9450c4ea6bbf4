# SPDX-License-Identifier: MIT
"""mavloom.columns() against pymavlink on the recorded flight. "Row N": the wishes listed in docs/guide/python.md."""
import contextlib
import copy
import datetime
import json
import os
import pickle
import signal
import subprocess
import sys

import numpy as np
import pytest

import mavloom
import pymavlink_vectors as vectors
from pymavlink import mavutil as pymavlink_mavutil
from mavloom import messages
from tlogs import frames_of, packer, record, write

NUMPY = {"uint8_t": "u1", "int8_t": "i1", "uint16_t": "u2", "int16_t": "i2", "uint32_t": "u4", "int32_t": "i4",
         "uint64_t": "u8", "int64_t": "i8", "float": "f4", "double": "f8", "uint8_t_mavlink_version": "u1"}


# The names that QGroundControl shows, by those of pymavlink.
QGC_NAMES = {"MANUAL": "Manual", "STABILIZED": "Stabilized", "ACRO": "Acro", "RATTITUDE": "Rattitude",
             "ALTCTL": "Altitude", "POSCTL": "Position", "LOITER": "Hold", "MISSION": "Mission", "RTL": "Return",
             "LAND": "Land", "FOLLOWME": "Follow Target", "OFFBOARD": "Offboard", "TAKEOFF": "Takeoff"}


def expected_mode(message):
    """The name of the mode of a HEARTBEAT of a PX4 or of another sender, but not of an ArduPilot."""
    assert message.autopilot != 3
    is_px4 = message.autopilot == 12 and message.base_mode & 1
    return QGC_NAMES.get(pymavlink_mavutil.mode_string_v10(message), "") if is_px4 else ""


def expected_columns(peer, message_class, rows):
    """The same arrays, by pymavlink: rows are (time in µs, its message)."""
    columns = {"time_ns": np.array([time * 1000 for time, _ in rows], "i8"),
               "sys": np.array([m.get_srcSystem() for _, m in rows], "u1"),
               "comp": np.array([m.get_srcComponent() for _, m in rows], "u1")}
    for field in vectors.fields_of(message_class):
        if field.is_text:
            columns[field.name] = np.array([getattr(m, f"_{field.name}_raw") for _, m in rows], f"S{field.count}")
        else:
            shape = (len(rows), field.array_length) if field.array_length else (len(rows),)
            columns[field.name] = np.array([getattr(m, field.name) for _, m in rows], NUMPY[field.type]).reshape(shape)
    if message_class.msgname == "HEARTBEAT":
        columns["mode"] = np.array([expected_mode(m) for _, m in rows], "U24")
    return columns


def test_the_mode_is_a_column_of_heartbeats(peer, tmp_path):
    beats = [(2, 12, 50593792), (2, 3, 5), (1, 3, 5), (6, 8, 0), (2, 12, 84148224)]  # type, autopilot, custom_mode
    sender = packer(peer)
    path = write(tmp_path / "x.tlog",
                 [sender.pack(peer.MAVLink_heartbeat_message(kind, pilot, 1, mode, 4, 3))
                  for kind, pilot, mode in beats])

    columns = mavloom.columns(path, "HEARTBEAT")

    assert columns["mode"].tolist() == ["Hold", "LOITER", "FBWA", "", "Return"] and list(columns)[-1] == "mode"
    assert (columns["mode"] == "Hold").tolist() == [True, False, False, False, False]
    assert list(mavloom.columns(path, "HEARTBEAT", fields=["mode"])) == ["time_ns", "sys", "comp", "mode"]
    assert columns.to_arrow()["mode"].to_pylist()[0] == "Hold" and columns.to_pandas()["mode"].iloc[1] == "LOITER"
    assert "mode" in mavloom.tables(path, fields="mode")["HEARTBEAT"]
    with pytest.raises(ValueError):
        mavloom.columns(path, "ATTITUDE", fields=["mode"])


def assert_same(columns, expected):
    assert list(columns) == list(expected)
    for name, values in expected.items():
        found = columns[name]
        assert (found.dtype, found.shape) == (values.dtype, values.shape), name
        assert found.tobytes() == values.tobytes(), name
        assert found.flags.c_contiguous and found.flags.writeable and found.dtype.isnative, name


def test_example_8_every_message_of_the_flight_is_bit_equal_to_pymavlink(flight, peer):
    mav = peer.MAVLink(None)
    rows = {}
    for time, frame in frames_of(flight):
        message = mav.parse_char(frame)
        rows.setdefault(message.get_type(), []).append((time, message))
    assert len(rows) == 37
    tables = mavloom.tables(flight)
    assert set(tables) == set(rows)
    for name, found in rows.items():
        columns = mavloom.columns(flight, name)
        assert len(columns) == len(found) and columns.junk_bytes == 0
        expected = expected_columns(peer, type(found[0][1]), found)
        assert_same(columns, expected)
        assert_same(tables[name], expected)


def test_some_tables(flight):
    tables = mavloom.tables(flight, ["HEARTBEAT", "GPS_RTCM_DATA"], system=255)
    assert list(tables) == ["HEARTBEAT", "GPS_RTCM_DATA"]
    assert set(tables["HEARTBEAT"]["sys"]) == {255} and len(tables["GPS_RTCM_DATA"]) == 0
    assert list(mavloom.tables(flight, "ATTITUDE")) == ["ATTITUDE"]
    with pytest.raises(ValueError, match="did you mean 'ATTITUDE'"):
        mavloom.tables(flight, "ATITUDE")


def test_every_message_of_the_dialect_with_extreme_values(peer, tmp_path):
    for message_class in peer.mavlink_map.values():
        sender = packer(peer, 5, 6)
        made = [vectors.message_of(message_class, vectors.values_of(message_class, case))
                for case in ("zero", "maximum", "minimum", "nan", "infinite")]
        path = write(tmp_path / "x.tlog", [sender.pack(message) for message in made])
        mav = peer.MAVLink(None)
        rows = [(time, mav.parse_char(frame)) for time, frame in frames_of(path)]
        assert_same(mavloom.columns(path, message_class.msgname), expected_columns(peer, message_class, rows))


def test_row_9_an_absent_message_gives_empty_arrays_of_the_right_types(flight, peer):
    for message_class in peer.mavlink_map.values():
        if message_class.msgname in ("GPS_RTCM_DATA", "STATUSTEXT", "ODOMETRY", "OBSTACLE_DISTANCE"):
            columns = mavloom.columns(flight, message_class.msgname, system=99)
            assert len(columns) == 0
            assert_same(columns, expected_columns(peer, message_class, []))


def test_row_9_rows_of_one_instant_are_all_kept(peer, tmp_path):
    sender = packer(peer)
    frames = [sender.pack(peer.MAVLink_heartbeat_message(1, 2, 3, i, 5, 3)) for i in range(1000)]
    path = tmp_path / "x.tlog"
    path.write_bytes(b"".join((7).to_bytes(8, "big") + frame for frame in frames))
    columns = mavloom.columns(path, "HEARTBEAT")
    assert set(columns["time_ns"]) == {7000} and list(columns["custom_mode"]) == list(range(1000))


def test_row_9_instances(peer, tmp_path):
    sender = packer(peer)
    path = write(tmp_path / "x.tlog",
                 [sender.pack(peer.MAVLink_battery_status_message(i % 3, 2, 3, -4, [i] * 10, 5, 6, 7, -1))
                  for i in range(30)])

    columns = mavloom.columns(path, "BATTERY_STATUS", instance=1)

    assert columns["voltages"].shape == (10, 10) and list(columns["voltages"][:, 9]) == list(range(1, 30, 3))
    assert len(mavloom.columns(path, "BATTERY_STATUS", instance=7)) == 0
    with pytest.raises(ValueError, match="no field that distinguishes instances"):
        mavloom.columns(path, "HEARTBEAT", instance=0)
    with pytest.raises(mavloom.UsageError, match=r"instance: BATTERY_STATUS\.id is a number, not text"):
        mavloom.columns(path, "BATTERY_STATUS", instance="1")


def test_row_9_instances_that_are_text(peer, tmp_path):
    sender = packer(peer)
    names = (b"n000", b"n001", b"0123456789")
    path = write(tmp_path / "x.tlog",
                 [sender.pack(peer.MAVLink_named_value_float_message(i, names[i % 3], 0.0)) for i in range(9)])
    for number, name in enumerate(names):
        assert list(mavloom.columns(path, "NAMED_VALUE_FLOAT",
                                    instance=name.decode())["time_boot_ms"]) == [number, number + 3, number + 6]
    assert len(mavloom.columns(path, "NAMED_VALUE_FLOAT",
                               instance="n00")) == 0
    with pytest.raises(mavloom.UsageError, match=r"instance: NAMED_VALUE_FLOAT\.name is text, not a number"):
        mavloom.columns(path, "NAMED_VALUE_FLOAT", instance=110)


def test_row_3_systems_and_components(flight):
    assert set(mavloom.columns(flight, "HEARTBEAT")["sys"]) == {1, 255}
    ground = mavloom.columns(flight, "HEARTBEAT", system=255, component=190)
    assert set(ground["sys"]) == {255} and set(ground["type"]) == {6}
    assert len(mavloom.columns(flight, "HEARTBEAT", component=7)) == 0


def test_row_29_unknown_names(flight):
    with pytest.raises(ValueError, match="did you mean 'ATTITUDE'"):
        mavloom.columns(flight, "ATITUDE")
    with pytest.raises(KeyError):
        mavloom.columns(flight, "ATTITUDE")["rol"]
    with pytest.raises(FileNotFoundError):
        mavloom.columns(flight / "x", "ATTITUDE")


def test_row_29_a_source_that_is_none(flight):
    for call in (lambda **source: mavloom.columns(flight, "ATTITUDE", **source),
                 lambda **source: mavloom.tables(flight, **source), lambda **source: mavloom.read(flight, **source),
                 lambda **source: mavloom.read(flight).recv_match(**source)):
        with pytest.raises(mavloom.UsageError, match="^system: 256 is out of range, 0 to 255$"):
            call(system=256)
        with pytest.raises(mavloom.UsageError, match="^component: -1 is out of range, 0 to 255$"):
            call(component=-1)


def test_units_and_enum_names(flight):
    columns = mavloom.columns(flight, "HEARTBEAT")
    assert columns.enums == {"type": "MAV_TYPE", "autopilot": "MAV_AUTOPILOT", "base_mode": "MAV_MODE_FLAG",
                             "system_status": "MAV_STATE"}
    attitude = mavloom.columns(flight, "ATTITUDE")
    assert attitude.units["roll"] == "rad" and attitude.units["time_boot_ms"] == "ms" and "roll" in attitude
    assert list(attitude)[:3] == ["time_ns", "sys", "comp"]


def test_damage_is_skipped_and_counted(flight, tmp_path):
    data = bytearray(flight.read_bytes())
    data[100_000:100_300] = b"\xaa" * 300
    (tmp_path / "x.tlog").write_bytes(data)
    columns = mavloom.columns(tmp_path / "x.tlog", "ATTITUDE")
    whole = mavloom.columns(flight, "ATTITUDE")
    assert 300 <= columns.junk_bytes < 300 + 2 * 300
    assert set(columns["time_ns"]) <= set(whole["time_ns"]) and len(whole) - 10 <= len(columns) <= len(whole)


def test_row_8_no_object_for_each_row(flight):
    mavloom.columns(flight, "ATTITUDE")
    before = sys.getallocatedblocks()
    columns = mavloom.columns(flight, "ATTITUDE")
    assert len(columns) > 4000
    assert sys.getallocatedblocks() - before < 500


@pytest.mark.parametrize("read", ["mavloom.columns(path, 'ATTITUDE')", "mavloom.tables(path)"])
def test_example_11_ctrl_c_ends_the_reading_of_an_endless_file(read, tmp_path, child_environment):
    """In which the message does not occur."""
    os.mkfifo(tmp_path / "pipe")
    child = subprocess.Popen([sys.executable, "-c", "import mavloom, sys\npath = sys.argv[1]\n"
                                                    f"print('ready', flush=True)\n{read}", tmp_path / "pipe"],
                             stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=child_environment)
    try:
        assert child.stdout.readline() == "ready\n"
        data = b"".join(record(mavloom.Dialect().encode("HEARTBEAT"), number) for number in range(1000))
        written = 0
        with contextlib.suppress(BrokenPipeError), open(tmp_path / "pipe", "wb", buffering=0) as pipe:
            while True:
                pipe.write(data)
                written += len(data)
                if written > 1 << 20:
                    child.send_signal(signal.SIGINT)
        child.communicate(timeout=60)
        assert child.returncode == -signal.SIGINT  # by KeyboardInterrupt, whose traceback further signals may cut short
    finally:
        child.kill()
        child.communicate()


def test_arrays_outlive_everything(flight):
    roll = mavloom.columns(flight, "ATTITUDE")["roll"]
    expected = roll.copy()
    for _ in range(50):
        mavloom.columns(flight, "ATTITUDE")
    assert (roll == expected).all()
    roll += 1
    assert (roll == expected + 1).all()


def test_columns_are_copied_and_pickled(flight):
    att = mavloom.columns(flight, "ATTITUDE", fields=["roll"])
    for other in (copy.copy(att), copy.deepcopy(att), att.copy(), pickle.loads(pickle.dumps(att))):
        assert type(other) is mavloom.Columns and (other.name, other.junk_bytes) == ("ATTITUDE", 0)
        assert other.units == att.units and all((other[name] == att[name]).all() for name in att)
    copy.deepcopy(att)["roll"][0] = 7
    assert att["roll"][0] != 7


def test_the_columns_cannot_be_exchanged(flight):
    att = mavloom.columns(flight, "ATTITUDE", system=1)
    for wrong in (lambda: att.update(x=1), lambda: att.pop("roll"), lambda: att.__setitem__("roll", 1), att.clear):
        with pytest.raises(TypeError, match="cannot be changed"):
            wrong()
    assert dict(att) == dict(att.items()) and att == att and att != dict(att) and len({att, att}) == 1
    assert "roll" in att and att.get("nothing") is None and [1] not in att.keys()


def test_columns_in_reverse_order_and_as_json(flight):
    targets = mavloom.columns(flight, "ATTITUDE_TARGET", fields=["q", "thrust"])
    assert list(reversed(targets)) == ["thrust", "q", "comp", "sys", "time_ns"]
    with pytest.raises(TypeError, match="ndarray is not JSON serializable"):
        json.dumps(targets)
    loaded = json.loads(json.dumps(targets, default=np.ndarray.tolist))
    assert list(loaded) == ["time_ns", "sys", "comp", "q[0]", "q[1]", "q[2]", "q[3]", "thrust"] == targets.keys()
    assert loaded["q[1]"] == targets["q"][:, 1].tolist() and {**targets}.keys() == loaded.keys()
    none = dict(mavloom.columns(flight, "ATTITUDE_TARGET", fields=["q"], end=1).items())
    assert json.loads(json.dumps(none, default=np.ndarray.tolist, indent=1)) == dict.fromkeys(
        ["time_ns", "sys", "comp", "q[0]", "q[1]", "q[2]", "q[3]"], [])


def test_several_files_follow_each_other(flight, tmp_path):
    records = list(frames_of(flight))
    parts = [write(tmp_path / f"{i}.tlog", [frame for _, frame in part]) for i, part in
             enumerate((records[:9000], records[9000:]))]
    whole = mavloom.columns(write(tmp_path / "whole.tlog", [frame for _, frame in records]), "ATTITUDE")
    for columns in (mavloom.columns(parts, "ATTITUDE"), mavloom.tables(iter(parts))["ATTITUDE"],
                    mavloom.columns(tuple(map(str, parts)), ["HEARTBEAT", "ATTITUDE"])["ATTITUDE"]):
        assert all((columns[name] == whole[name]).all() for name in whole if name != "time_ns")
    with pytest.raises(mavloom.UsageError, match="an empty list of recordings"):
        mavloom.columns([], "ATTITUDE")


def test_a_part_of_the_time_and_of_the_fields(flight):
    whole = mavloom.columns(flight, "ATTITUDE")
    first, last = (int(whole["time_ns"][i]) for i in (100, 300))
    at = datetime.datetime(1970, 1, 1, tzinfo=datetime.timezone.utc) + datetime.timedelta(microseconds=first // 1000)
    for start, end in ((first, last), (whole["time_ns"][100], np.datetime64(last, "ns")), (at, last)):
        part = mavloom.columns(flight, "ATTITUDE", start=start, end=end, fields=["yaw", "roll"])
        assert list(part) == ["time_ns", "sys", "comp", "roll", "yaw"]
        assert part["roll"].tolist() == whole["roll"][100:300].tolist()
    assert len(mavloom.tables(flight, start=first, end=last)["ATTITUDE"]) == 200
    parts = mavloom.tables(flight, fields=["yaw", "roll"])
    assert list(parts["ATTITUDE"]) == list(part) and "HEARTBEAT" not in parts
    assert list(mavloom.tables(flight, "HEARTBEAT", fields="type")["HEARTBEAT"]) == ["time_ns", "sys", "comp", "type"]
    assert list(mavloom.tables(flight, ["HEARTBEAT", "ATTITUDE"], fields="roll")["HEARTBEAT"]) == list(part)[:3]
    with pytest.raises(mavloom.UsageError, match="none of the messages has a field 'rol'"):
        mavloom.tables(flight, fields=["rol"])
    with pytest.raises(mavloom.UsageError, match="no field 'rol', did you mean 'roll'"):
        mavloom.columns(flight, "ATTITUDE", fields=["rol"])
    with pytest.raises(mavloom.UsageError, match="start: a time is .*, not '20"):
        mavloom.columns(flight, "ATTITUDE", start=at.isoformat())
    for none in (np.datetime64("NaT"), np.datetime64("NaT", "ns"), pytest.importorskip("pandas").NaT):
        for limit in ("start", "end"):
            with pytest.raises(mavloom.UsageError, match=f"{limit}: NaT is not a time"):
                mavloom.columns(flight, "ATTITUDE", **{limit: none})
    with pytest.raises(mavloom.UsageError, match="has no time zone"):
        mavloom.columns(flight, "ATTITUDE", start=datetime.datetime(2026, 1, 1))
    with pytest.raises(mavloom.UsageError, match="start: a time is Unix time in ns"):
        mavloom.columns(flight, "ATTITUDE", start="yesterday")


@pytest.mark.parametrize("far", [np.datetime64("3000-01-01"), np.datetime64("1600", "Y"),
                                 np.datetime64("2262-01", "s")])
def test_times_that_numpy_cannot_hold_in_ns(far, flight):
    with pytest.raises(mavloom.UsageError, match="is out of range, the years 1678 to 2261"):
        mavloom.columns(flight, "ATTITUDE", end=far)
    assert len(mavloom.columns(flight, "ATTITUDE", end=np.datetime64("2261-12-31"))) > 0


def test_an_array_that_is_no_copy_is_refused(flight):
    columns = mavloom.columns(flight, "ATTITUDE")
    with pytest.raises(ValueError, match="separate arrays"):  # as numpy 2 expects of __array__
        columns.__array__(copy=False)
    assert len(columns.__array__(copy=True)) == len(columns.__array__()) == len(np.asarray(columns)) == len(columns)


def test_several_messages_are_a_dictionary(flight):
    both = mavloom.columns(flight, ["ATTITUDE", "RPM"], fields=["roll", "rpm1"])
    assert list(both) == ["ATTITUDE", "RPM"]
    assert list(both["ATTITUDE"])[3:] == ["roll"] and list(both["RPM"])[3:] == ["rpm1"] and len(both["RPM"]) == 0
    with pytest.raises(mavloom.UsageError, match="none of ATTITUDE, RPM has a field 'rol'"):
        mavloom.columns(flight, ["ATTITUDE", "RPM"], fields=["roll", "rol"])
    for wrong in (None, 3, ["ATTITUDE", 3]):
        with pytest.raises(mavloom.UsageError, match="name= takes a name or a list of names"):
            mavloom.columns(flight, wrong)


def test_messages_are_named_by_their_classes_too(flight):
    attitude = mavloom.columns(flight, messages.ATTITUDE)
    assert attitude.name == "ATTITUDE" and len(attitude) == len(mavloom.columns(flight, "ATTITUDE"))
    assert list(mavloom.columns(flight, [messages.VFR_HUD, "ATTITUDE"], fields=["roll"])) == ["VFR_HUD", "ATTITUDE"]
    with pytest.raises(mavloom.UsageError, match="unknown message 'int'"):
        mavloom.columns(flight, int)
    with pytest.raises(mavloom.UsageError, match="fields= takes a name or a list of names, not"):
        mavloom.columns(flight, "ATTITUDE", fields=[messages.VFR_HUD])


def test_tables_take_at_most_twice_the_memory_of_their_result(flight, child_environment):
    """The peak of the process, beyond what it has before."""
    code = ("import resource, sys, mavloom\n"
            "peak = lambda: resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024\n"
            "mavloom.tables(sys.argv[1])\nbefore = peak()\n"
            "made = mavloom.tables([sys.argv[1]] * 100)\n"
            "print(sum(c[n].nbytes for c in made.values() for n in c), peak() - before)")
    # The address sanitizer, where one runs, would keep what was freed.
    no_quarantine = os.environ.get("ASAN_OPTIONS", "") + ":quarantine_size_mb=0:thread_local_quarantine_size_kb=0"
    done = subprocess.run([sys.executable, "-c", code, flight], check=True, capture_output=True, text=True,
                          env={**child_environment, "ASAN_OPTIONS": no_quarantine})
    size, more = map(int, done.stdout.split())
    assert size > 100e6 and more <= 2 * size


# ---- tables

def test_pandas_and_numpy_take_columns_as_they_are(flight):
    import pandas
    att, bat = mavloom.columns(flight, "ATTITUDE"), mavloom.columns(flight, "BATTERY_STATUS")
    df = pandas.DataFrame(att)
    assert list(df) == list(att) and all((df[name] == att[name]).all() for name in att) and df["roll"].dtype == "f4"
    df = pandas.DataFrame(bat)
    assert df["voltages[3]"].tolist() == bat["voltages"][:, 3].tolist() == bat["voltages[3]"].tolist()
    assert np.asarray(att)["roll"].tolist() == att["roll"].tolist()
    assert list(pandas.DataFrame(att, columns=["yaw", "roll"])) == ["yaw", "roll"]


def test_arrow_takes_columns_as_they_are(flight):
    import pyarrow
    att = mavloom.columns(flight, "ATTITUDE")
    assert pyarrow.table(att)["roll"] == att.to_arrow()["roll"]
    assert pyarrow.RecordBatchReader.from_stream(att).read_all() == att.to_arrow()


def test_names_of_enum_entries_in_pandas(flight):
    beats = mavloom.columns(flight, "HEARTBEAT")
    df, plain = beats.to_pandas(enums=True), beats.to_pandas()
    assert set(df["type"]) == {"MAV_TYPE_QUADROTOR", "MAV_TYPE_GCS"}
    assert [name == "MAV_TYPE_GCS" for name in df["type"]] == [kind == 6 for kind in plain["type"]]
    assert df["base_mode"].tolist() == plain["base_mode"].tolist()  # flags


def test_columns_are_shown_as_a_table(flight):
    att = mavloom.columns(flight, "ATTITUDE")
    assert repr(att).startswith("<ATTITUDE: 5312 rows of time_ns, sys, comp, time_boot_ms, roll")
    shown = att._repr_html_()
    assert shown.count("<tr>") == 11 and "<th>roll [rad]</th>" in shown
    assert "roll" in att._ipython_key_completions_()


def test_example_9_arrow_and_parquet_keep_units_and_enum_names(flight, tmp_path):
    import pyarrow.parquet
    columns = mavloom.columns(flight, "HEARTBEAT")
    pyarrow.parquet.write_table(columns.to_arrow(), tmp_path / "x.parquet")

    table = pyarrow.parquet.read_table(tmp_path / "x.parquet")

    assert table.schema.metadata[b"message"] == b"HEARTBEAT"
    assert table.schema.field("type").metadata[b"enum"] == b"MAV_TYPE"
    assert str(table.schema.field("time_ns").type) == "timestamp[ns, tz=UTC]"
    assert table["custom_mode"].to_numpy().tolist() == columns["custom_mode"].tolist()
    assert table["time_ns"].cast("int64").to_numpy().tolist() == columns["time_ns"].tolist()
    attitude = mavloom.columns(flight, "ATTITUDE").to_arrow()
    assert attitude.schema.field("roll").metadata[b"unit"] == b"rad"


def test_arrow_of_text_and_arrays(peer, tmp_path):
    sender = packer(peer)
    frames = [sender.pack(peer.MAVLink_statustext_message(6, "höhe".encode())),
              sender.pack(peer.MAVLink_statustext_message(5, b"\xffA")),
              sender.pack(peer.MAVLink_battery_status_message(0, 2, 3, -4, list(range(10)), 5, 6, 7, -1))]
    path = write(tmp_path / "x.tlog", frames)
    assert mavloom.columns(path, "STATUSTEXT").to_arrow()["text"].to_pylist() == ["höhe", "\ufffdA"]
    assert mavloom.columns(path, "BATTERY_STATUS").to_arrow()["voltages"].to_pylist() == [list(range(10))]
    for name in ("STATUSTEXT", "BATTERY_STATUS"):
        empty = mavloom.columns(path, name, system=99).to_arrow()
        assert empty.num_rows == 0 and empty.schema == mavloom.columns(path, name).to_arrow().schema


def test_example_9_pandas(flight, tmp_path):
    att = mavloom.columns(flight, "ATTITUDE")
    df = att.to_pandas()
    assert str(df.index.dtype) == "datetime64[ns, UTC]" and df.index[0].value == att["time_ns"][0]
    assert df["roll"].dtype == np.float32 and df["roll"].tolist() == att["roll"].tolist()
    assert df.attrs["units"]["roll"] == "rad"
    assert np.isfinite(df["roll"].rolling("1s").mean().iloc[-1])
    quaternion = mavloom.columns(flight, "ATTITUDE_TARGET").to_pandas()
    assert [name for name in quaternion if name.startswith("q[")] == ["q[0]", "q[1]", "q[2]", "q[3]"]


@pytest.mark.parametrize("method, module", [("to_pandas", "pandas"), ("to_arrow", "pyarrow")])
def test_what_is_missing_is_named_with_how_to_install_it(flight, method, module, child_environment):
    code = (f"import sys, mavloom\nsys.modules[{module!r}] = None\n"
            f"mavloom.columns({str(flight)!r}, 'ATTITUDE').{method}()")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=child_environment)
    assert done.returncode == 1 and f"{method}() needs {module}: pip install {module}\n" in done.stderr


def test_row_27_only_numpy_is_needed(child_environment):
    code = "import sys, mavloom\nassert not {'pandas', 'pyarrow', 'pymavlink'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, env=child_environment)
