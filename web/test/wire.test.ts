// SPDX-License-Identifier: MIT
// Schemas and messages in the forms of docs/formats/ros2msg.md. Bytes are written by hand.
import assert from "node:assert/strict";
import { test } from "node:test";
import { decode, numberAt } from "../src/wire/cdr";
import { isInvalid } from "../src/wire/invalid";
import { parseSchema } from "../src/wire/schema";

const TEXT = `# MAVLink EXAMPLE (9000)
uint64 time_usec  # [us]
float32 roll  # [rad]
int16[2] pair
uint8 MODE_A=0
uint8 MODE_B=1
uint8 mode
uint8 FLAG_ONE=1
uint8 FLAG_TWO=2
uint8 FLAG_FOUR=4
uint8 flags
uint8 OTHER_MODE_A=0
uint8 OTHER_MODE_C=2
uint8 other
string text
float64 last
`;

test("a schema has the fields, units and entries of the message", () => {
    const schema = parseSchema(TEXT);
    assert.deepEqual([schema.name, schema.id], ["EXAMPLE", 9000]);
    assert.deepEqual(
        schema.fields.map((field) => field.name),
        ["time_usec", "roll", "pair", "mode", "flags", "other", "text", "last"],
    );
    assert.deepEqual(
        schema.fields.map((field) => field.unit),
        ["us", "rad", "", "", "", "", "", ""],
    );
    assert.equal(schema.fields[2]?.length, 2);
    assert.deepEqual(
        [...(schema.fields[3]?.entries ?? [])],
        [
            [0, "MODE_A"],
            [1, "MODE_B"],
        ],
    );
    assert.deepEqual(
        schema.fields.map((field) => field.isFlags),
        [false, false, false, false, true, false, false, false],
    );
    assert.deepEqual(
        [...(schema.fields[5]?.entries ?? [])],
        [
            [0, "MODE_A"],
            [2, "OTHER_MODE_C"],
        ],
        "the name of the field precedes a repeated entry",
    );
});

function example(): DataView {
    const data = new DataView(new ArrayBuffer(4 + 48));
    data.setUint8(1, 1);
    data.setBigUint64(4, 2n ** 60n, true);
    data.setFloat32(12, 0.5, true);
    data.setInt16(16, -2, true);
    data.setInt16(18, 300, true);
    data.setUint8(20, 1);
    data.setUint8(21, 5);
    data.setUint8(22, 2);
    data.setUint32(24, 4, true); // at 20 of the body, aligned to 4
    new Uint8Array(data.buffer).set([0xc3, 0xa9, 0x21, 0], 28);
    data.setFloat64(36, -1.25, true); // at 32, aligned to 8
    return data;
}

test("messages are decoded with CDR's alignment", () => {
    assert.deepEqual(decode(parseSchema(TEXT), example()), [2n ** 60n, 0.5, [-2, 300], 1, 5, 2, "é!", -1.25]);
});

test("a message that is too short, or not CDR, is refused", () => {
    const schema = parseSchema(TEXT);
    assert.throws(() => decode(schema, new DataView(example().buffer, 0, 30)), RangeError);
    assert.throws(() => decode(schema, new DataView(new ArrayBuffer(2))), RangeError);
    const long = example();
    long.setUint32(24, 4_000_000_000, true);
    assert.throws(() => decode(schema, long), RangeError);
});

test("numbers for plots come from fields and elements", () => {
    const message = decode(parseSchema(TEXT), example());
    assert.deepEqual(
        [numberAt(message, 2, 1), numberAt(message, 0, null), numberAt(message, 6, null)],
        [300, 2 ** 60, NaN],
    );
});

// Definitions of GPS_RAW_INT, BATTERY_STATUS and MOUNT_ORIENTATION, and one of each further form.
const INVALID = parseSchema(`# MAVLink EXAMPLE (9001)
uint16 cog  # [cdeg] invalid: UINT16_MAX
int16 temperature  # [cdegC] invalid: INT16_MAX
float32 yaw  # [deg] invalid: NaN
uint16[3] voltages  # [mV] invalid: (UINT16_MAX)
float32[2] q  # invalid: (NaN:)
uint8[3] levels  # invalid: (7,,9)
uint8 MODE_NONE=4
uint8 mode  # invalid: MODE_NONE
uint8 free
`);

test("the definition's values for 'not known' are recognized", () => {
    const wanted: [string, number | number[], number | null, boolean][] = [
        ["cog", 65535, null, true],
        ["cog", 0, null, false],
        ["temperature", 32767, null, true],
        ["yaw", NaN, null, true],
        ["yaw", 0, null, false],
        ["voltages", [4200, 65535, 65535], 1, true],
        ["voltages", [4200, 65535, 65535], 0, false],
        ["q", [NaN, 1], 1, true],
        ["q", [1, NaN], 1, false],
        ["levels", [7, 7, 9], 0, true],
        ["levels", [7, 7, 9], 1, false],
        ["levels", [7, 7, 9], 2, true],
        ["mode", 4, null, true],
        ["free", 255, null, false],
    ];
    for (const [name, whole, element, is] of wanted) {
        const field = INVALID.fields[INVALID.indexOf.get(name) ?? -1];
        assert.ok(field);
        assert.equal(isInvalid(field, whole, element), is, `${name} ${whole} ${element}`);
    }
    assert.deepEqual([INVALID.fields[0]?.unit, INVALID.fields[4]?.unit, INVALID.fields[7]?.invalid], ["cdeg", "", ""]);
});
