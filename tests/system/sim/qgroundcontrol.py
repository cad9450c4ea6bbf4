# SPDX-License-Identifier: MIT
"""QGroundControl's side of a connection: the requests that it sends to a new PX4 vehicle, one after the other, with its
time-outs. tests/data/px4_gcs_session.tlog has such a session."""
import dataclasses
import time

from ftp import FtpClient
from stations import bits_of, crc32, mavlink

ANSWER_S = 1.2  # after that, QGroundControl shows that the vehicle did not respond


@dataclasses.dataclass
class Session:
    seconds: float = 0
    parameters: int = 0
    parameter_count: int = 0
    parameter_hash: int = 0
    modes: int = 0


def connect(station, cached=None):
    """Everything up to the end of the loading bar. `cached` is the hash of the parameters that the station has."""
    session, started = Session(), time.monotonic()
    station.heartbeat()
    station.ask_for(148, "AUTOPILOT_VERSION", timeout=ANSWER_S)
    session.modes = load_modes(station)
    load_metadata(station)
    load_parameters(station, session, cached)
    for plan in (0, 1, 2):
        station.download(plan, timeout=10)
    session.seconds = time.monotonic() - started
    return session


def load_modes(station):
    first = station.ask_for(435, "AVAILABLE_MODES", 1, timeout=ANSWER_S)
    for index in range(2, first.number_modes + 1):
        assert station.ask_for(435, "AVAILABLE_MODES", index, timeout=ANSWER_S).mode_index == index
    return first.number_modes


def load_metadata(station):
    place = station.ask_for(397, "COMPONENT_METADATA", timeout=ANSWER_S)
    assert place.uri.startswith("mftp://")
    ftp = FtpClient(station)
    assert ftp.read(place.uri.removeprefix("mftp:/"))


def load_parameters(station, session, cached):
    answer = station.parameter("_HASH_CHECK", timeout=1)
    assert answer.get_type() == "PARAM_VALUE"
    session.parameter_hash = bits_of(answer.param_value)
    session.parameter_count = answer.param_count
    if session.parameter_hash == cached:  # "stop sending"
        station.send_to_vehicle("param_set", b"_HASH_CHECK", answer.param_value, mavlink.MAV_PARAM_TYPE_UINT32)
        return
    session.parameters = len(station.parameters())


def hash_of(parameters, left_out):
    """Of {name: PARAM_VALUE}: what QGroundControl computes over its cache."""
    names = sorted(name for name in parameters if name not in left_out and name != "_HASH_CHECK")
    return crc32(b"".join(name.encode() + bits_of(parameters[name].param_value).to_bytes(4, "little")
                          for name in names))
