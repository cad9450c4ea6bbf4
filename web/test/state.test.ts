// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { decodeState, encodeState, usualState, type State } from "../src/model/url";
import { converted } from "../src/ui/convert";
import { bytes, duration, fixed, hertz, value } from "../src/ui/format";

const FULL: State = {
    view: "plots",
    query: "1/1 a&b=c#d~e!f %41 é",
    sort: { column: "hz", isDown: true },
    columns: ["link", "name", "age"],
    opened: "/1/1/BATTERY_STATUS/0",
    span: 300,
    plots: [
        [
            { topic: "/1/1/ATTITUDE", formula: "deg(roll)", axis: 1, scale: -2.5, offset: 1e-7 },
            { topic: "/1/1/A~B!C", formula: "x^2 + y & 1", axis: 0, scale: 1, offset: 3 },
        ],
        [{ topic: "/2/1/VFR_HUD", formula: "alt", axis: 0, scale: 1, offset: 0 }],
    ],
};

test("the address keeps the whole state", () => {
    assert.deepEqual(decodeState(`#${encodeState(FULL)}`), FULL);
    assert.equal(encodeState(usualState()), "overview");
    assert.deepEqual(decodeState(""), usualState());
    assert.match(encodeState(FULL), /^[\x21-\x7e]+$/);
});

test("an address with wrong parts loses only these", () => {
    const state = decodeState(
        "#nowhere?q=%E0%A4%A&sort=-nothing&cols=hz,drop&span=7&plot=/1/1/A&plot=~~&plot=%ZZ~%ZZ&open=/1/1/A&x&=&plot=/1/1/B~z~9~x~",
    );
    assert.deepEqual(state, {
        ...usualState(),
        columns: ["name", "hz"],
        opened: "/1/1/A",
        plots: [[{ topic: "/1/1/B", formula: "z", axis: 0, scale: 1, offset: 0 }]],
    });
    assert.equal(decodeState(`#plots?${"plot=/1/1/A~b&".repeat(100)}`).plots.length, 8);
});

test("numbers are short and never -0.0", () => {
    assert.deepEqual([fixed(-0.01, 1), fixed(null, 1), fixed(NaN, 1)], ["0.0", "–", "–"]);
    assert.deepEqual([hertz(0), hertz(0.01), hertz(50), hertz(2690)], ["0.0", "<0.1", "50.0", "2,690.0"]);
    assert.deepEqual([bytes(999), bytes(1500), bytes(2e9)], ["999 B", "1.5 kB", "2.0 GB"]);
    assert.deepEqual(
        [duration(0.2), duration(119), duration(7199), duration(90_000)],
        ["<1 s", "119 s", "119 min", "25 h"],
    );
    assert.deepEqual(
        [value(NaN, true), value(-Infinity, true), value(2n ** 63n, false), value(0.5, true)],
        ["NaN", "−∞", "9223372036854775808", "0.50000"],
    );
});

test("raw units are shown in units that people read", () => {
    assert.equal(converted(473977418, "degE7"), "47.3977418°");
    assert.equal(converted(16795, "mV"), "16.795 V");
    assert.equal(converted(3_723_000_000, "us"), "1:02:03");
});
