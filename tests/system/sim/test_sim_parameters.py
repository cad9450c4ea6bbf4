# SPDX-License-Identifier: MIT
"""Behaviours 34 to 42 of docs/guide/sim-behaviour.md: parameters."""
import json
import math
import pathlib

import pytest

import mavsdks
import qgroundcontrol
from ftp import FtpClient
from simulators import metadata_file
from stations import bits_of, float_of, mavlink

INT32, REAL32 = mavlink.MAV_PARAM_TYPE_INT32, mavlink.MAV_PARAM_TYPE_REAL32

CLIENT_NAMES = pathlib.Path(__file__).parents[2] / "data" / "client_parameters.tsv"


def names_that_clients_ask_for(firmware, kind):
    rows = [line.split("\t") for line in CLIENT_NAMES.read_text().splitlines() if not line.startswith("#")]
    return {name for of, name, kinds, _ in rows if of == firmware and kind in kinds.split(",")}


def metadata(station):
    """{name: entry} of the vehicle's own description of its parameters."""
    ftp = FtpClient(station)
    general = json.loads(metadata_file(ftp, station.ask_for(397, "COMPONENT_METADATA").uri))
    (entry,) = [one for one in general["metadataTypes"] if one["type"] == 1]
    return {one["name"]: one for one in json.loads(metadata_file(ftp, entry["uri"]))["parameters"]}


@pytest.mark.parametrize("firmware", ["px4", "ardupilot"])
def test_b34_the_list_is_complete(request, firmware):
    station = request.getfixturevalue(firmware)
    mark = station.mark()
    parameters = station.parameters(patience=10)
    values = [m for m in station.since(mark, "PARAM_VALUE") if m.param_index != 0xFFFF]

    assert len(parameters) == len(values) == values[0].param_count > 100
    assert [m.param_index for m in values] == list(range(len(values)))
    assert {m.param_count for m in values} == {len(values)}


def test_b35_the_hash_is_that_of_the_values(px4):
    volatile = {name for name, entry in metadata(px4).items() if entry.get("volatile")}
    leading = px4.parameter("_HASH_CHECK")
    mark = px4.mark()
    parameters = px4.parameters()
    first = px4.since(mark, "PARAM_VALUE")[0]

    assert (leading.param_type, leading.param_index) == (mavlink.MAV_PARAM_TYPE_UINT32, 0xFFFF)
    assert bits_of(leading.param_value) == qgroundcontrol.hash_of(parameters, volatile)
    assert (first.param_id, bits_of(first.param_value)) == ("_HASH_CHECK", bits_of(leading.param_value))
    assert len(volatile) > 5 and volatile & set(parameters) == volatile


def test_b36_a_set_value_is_stored_and_shown_to_all(sim):
    simulator = sim()
    with simulator.station() as first, simulator.station((254, 191)) as second:
        mark = second.mark()
        assert bits_of(first.set_parameter("GF_ACTION", float_of(3), INT32).param_value) == 3
        assert first.set_parameter("MIS_TAKEOFF_ALT", 12.5).param_value == 12.5
        heard = [second.expect("PARAM_VALUE", since=mark, where=lambda m, n=name: m.param_id == n)
                 for name in ("GF_ACTION", "MIS_TAKEOFF_ALT")]
        again = second.parameters()

    assert [bits_of(heard[0].param_value), heard[1].param_value] == [3, 12.5]
    assert bits_of(again["GF_ACTION"].param_value) == 3 and again["MIS_TAKEOFF_ALT"].param_value == 12.5


def test_b37_errors_have_a_message(px4):
    unknown = px4.parameter("NO_SUCH_NAME")
    wrong = px4.set_parameter("GF_ACTION", 1.5, REAL32)
    mark = px4.mark()
    px4.send_to_vehicle("param_request_read", b"", 9999)
    by_index = px4.expect("PARAM_ERROR", since=mark)
    read_only = px4.set_parameter("_HASH_CHECK", 1.0, REAL32)

    assert (unknown.get_type(), unknown.error) == ("PARAM_ERROR", mavlink.MAV_PARAM_ERROR_DOES_NOT_EXIST)
    assert (wrong.get_type(), wrong.error) == ("PARAM_ERROR", mavlink.MAV_PARAM_ERROR_TYPE_MISMATCH)
    assert (by_index.error, by_index.param_index) == (mavlink.MAV_PARAM_ERROR_DOES_NOT_EXIST, 9999)
    assert read_only.get_type() == "PARAM_ERROR" and read_only.error == mavlink.MAV_PARAM_ERROR_READ_ONLY


def test_b38_px4_sends_integers_byte_by_byte(px4):
    value = px4.parameter("COM_DL_LOSS_T")

    assert value.param_type == INT32
    assert value.get_msgbuf()[10:14] == (10).to_bytes(4, "little")


def test_b39_ardupilot_sends_integers_as_floats(ardupilot):
    parameters = ardupilot.parameters()
    mark = ardupilot.mark()
    assert ardupilot.set_parameter("DISARM_DELAY", 17.0, 2).param_value == 17.0
    assert ardupilot.set_parameter("DISARM_DELAY", 10.0, 2).param_value == 10.0

    assert {m.param_type for m in parameters.values()} <= {2, 4, INT32, REAL32}
    integers = [m for m in parameters.values() if m.param_type != REAL32]
    assert len(integers) > 20
    assert all(m.param_value == math.floor(m.param_value) and abs(m.param_value) < 2**31 for m in integers)
    assert ardupilot.latest("AUTOPILOT_VERSION") or ardupilot.ask_for(148, "AUTOPILOT_VERSION").capabilities & 131072
    assert not ardupilot.since(mark, "PARAM_ERROR")


def test_b40_a_name_of_16_characters_has_no_terminator(px4):
    longest = [m for name, m in px4.parameters().items() if len(name) == 16]

    assert longest
    for message in longest:
        assert 0 not in message.get_msgbuf()[18:34]
        assert px4.parameter(message.param_id).param_index == message.param_index


def test_b41_lost_values_can_be_requested(sim, rng):
    simulator = sim()
    simulator.fault("loss:0.1", rng)
    with simulator.station() as station:
        names = set(station.parameters())
        count = station.latest("PARAM_VALUE").param_count
    simulator.fault("off", rng)
    with simulator.station((254, 191)) as good:
        mark = good.mark()
        good.send_to_vehicle("param_request_list")
        good.until(lambda: len(good.since(mark, "PARAM_VALUE")) > 20, what="the list")
        assert set(good.parameters()) == names  # asks again, in the middle

    assert len(names) == count


def test_b42_the_setup_pages_find_their_parameters(px4):
    assert sorted(names_that_clients_ask_for("px4", "quad") - set(px4.parameters())) == []


def test_mavsdk_lists_and_sets_parameters(sim):
    simulator = sim()
    with simulator.station() as station:
        expected = station.parameters()
        answer = mavsdks.run(simulator.port, "parameters", "GF_ACTION", "MIS_TAKEOFF_ALT")

    assert set(answer["ints"]) | set(answer["floats"]) == set(expected)
    assert all(value == int.from_bytes(expected[name].get_msgbuf()[10:14], "little", signed=True)
               for name, value in answer["ints"].items())
    assert answer["set"] == ["SUCCESS", "SUCCESS"] and answer["got"] == [7, 3.5]
    assert answer["unknown"] == "DOES_NOT_EXIST"
    assert answer["wrong_type"] == "TYPE_MISMATCH"
