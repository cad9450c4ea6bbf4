# SPDX-License-Identifier: MIT
"""`mavloom dialect list|show|check`: what it prints, as text and JSON, and with which status it ends."""
import json
import os

import harness

MINE = """<mavlink><enums><enum name="MINE_FLAGS" bitmask="true"><entry value="2**60" name="MINE_HIGH"/></enum></enums>
<messages><message id="60999" name="MINE">
<field type="char[4]" name="who"/><field type="uint64_t" name="flags" enum="MINE_FLAGS"/>
</message></messages></mavlink>
"""


def test_list_has_every_message_of_the_golden_table(run, golden):
    expected = [line.split("\t") for line in (golden / "dialect_all.tsv").read_text().splitlines()
                if line.startswith("M\t")]
    listed = [json.loads(line) for line in run("dialect", "list", "--json").lines]
    assert [(m["id"], m["name"], m["min_length"], m["max_length"]) for m in listed] == \
           [(int(m[1]), m[2], int(m[4]), int(m[5])) for m in expected]
    assert {m["name"]: m["origin"] for m in listed}["HEARTBEAT"] == "minimal.xml"


def test_list_as_text_is_one_line_a_message(run):
    done = run("dialect", "list")
    assert done.status == 0 and done.stderr == ""
    assert done.lines[0].split() == ["0", "HEARTBEAT", "9", "minimal.xml"]
    assert done.lines[1].split() == ["1", "SYS_STATUS", "31..43", "common.xml"]


def test_show_message_by_name_and_id(run):
    by_name, by_id = run("dialect", "show", "ATTITUDE"), run("dialect", "show", "30")
    assert by_name.status == 0 and by_name.stdout == by_id.stdout
    assert by_name.lines[0] == "ATTITUDE (30), common.xml, 28 bytes, CRC_EXTRA 39"
    assert by_name.lines[1].split() == ["0", "uint32_t", "time_boot_ms", "ms"]
    assert by_name.lines[7].split() == ["24", "float", "yawspeed", "rad/s"]


def test_show_message_as_json(run):
    shown = json.loads(run("dialect", "show", "BATTERY_STATUS", "--json").stdout)
    assert (shown["kind"], shown["id"], shown["crc_extra"]) == ("message", 147, 154)
    fields = {field["name"]: field for field in shown["fields"]}
    assert list(fields)[:2] == ["id", "battery_function"]
    assert fields["voltages"] == {"name": "voltages", "type": "uint16_t", "array_length": 10, "offset": 10,
                                  "extension": False, "instance": False, "bitmask": False, "units": "mV",
                                  "invalid": "[UINT16_MAX]"}
    assert fields["mode"]["extension"] and fields["mode"]["enum"] == "MAV_BATTERY_MODE"
    assert fields["id"]["instance"]


def test_show_enum_and_command(run):
    done = run("dialect", "show", "MAV_MODE_FLAG")
    assert done.lines[0] == "MAV_MODE_FLAG, 8 entries, flags"
    assert done.lines[-1].split() == ["128", "MAV_MODE_FLAG_SAFETY_ARMED"]
    done = run("dialect", "show", "MAV_CMD_NAV_WAYPOINT")
    assert done.lines[:2] == ["MAV_CMD_NAV_WAYPOINT = 16 in MAV_CMD", "  param1  Hold [s], at least 0"]
    shown = json.loads(run("dialect", "show", "MAV_CMD_NAV_WAYPOINT", "--json").stdout)
    assert (shown["kind"], shown["enum"], shown["value"], len(shown["params"])) == ("entry", "MAV_CMD", 16, 7)


def test_unknown_name_suggests_the_nearest(run):
    done = run("dialect", "show", "ATITUDE")
    assert (done.status, done.stdout) == (2, "")
    assert done.stderr == "mavloom: no message, enum or enum entry 'ATITUDE', did you mean 'ATTITUDE'?\n"


def test_dialect_file_adds_to_the_built_in_definitions(run, tmp_path):
    (tmp_path / "mine.xml").write_text(MINE)
    for order in (["show", "--dialect", "mine.xml", "MINE"], ["--dialect", "mine.xml", "show", "MINE"]):
        done = run("dialect", *order, cwd=tmp_path)
        assert done.status == 0 and done.lines[0] == "MINE (60999), mine.xml, 12 bytes, CRC_EXTRA 93", done
    assert json.loads(run("dialect", "show", "--dialect", "mine.xml", "MINE_HIGH", "--json",
                          cwd=tmp_path).stdout)["value"] == str(2**60)
    assert run("dialect", "show", "--dialect", "mine.xml", "ATTITUDE", cwd=tmp_path).status == 0


def test_check_counts_what_a_file_has(run, tmp_path):
    (tmp_path / "mine.xml").write_text(MINE)
    done = run("dialect", "check", "mine.xml", "--json", cwd=tmp_path)
    assert done.status == 0
    assert json.loads(done.stdout) == {"file": "mine.xml", "messages": 1, "fields": 2, "enums": 1, "entries": 1,
                                       "added": 1, "changed": 0}
    assert run("dialect", "check", harness.ROOT / "dialects" / "all.xml").lines[0].endswith(
        "good; 393 messages with 3042 fields, 260 enums with 2330 entries")


def test_check_names_file_and_line_of_a_fault(run, tmp_path):
    (tmp_path / "mine.xml").write_text(MINE.replace("uint64_t", "uint65_t"))
    done = run("dialect", "check", "mine.xml", cwd=tmp_path)
    assert (done.status, done.stdout) == (3, "")
    assert done.stderr.startswith("mavloom: mine.xml:3: type \"uint65_t\" of field 'flags'; expected ")
    assert run("dialect", "check", "none.xml", cwd=tmp_path).status == 3


def test_wrong_use_is_status_2(run):
    assert run("dialect").status == 2
    assert run("dialect", "show").status == 2
    assert run("dialect", "lst").status == 2


def test_full_disk_is_an_error_and_a_closed_pipe_is_not(spawn):
    with open("/dev/full", "wb") as full:
        done = spawn("dialect", "list", stdout=full).wait()
    assert done.status == 1 and "No space left on device" in done.stderr
    read_end, write_end = os.pipe()
    os.close(read_end)
    done = spawn("dialect", "list", stdout=write_end).wait()
    os.close(write_end)
    assert (done.status, done.stderr) == (0, "")
