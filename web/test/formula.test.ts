// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { FormulaError, parseFormula } from "../src/model/formula";
import { checkFormula, Evaluator, topicOf, unitOf } from "../src/model/series";
import { parseSchema } from "../src/wire/schema";

const FIELDS: Record<string, number> = {
    vx: 3,
    vy: 4,
    x: 2,
    "volts[1]": 12.5,
    "/1/1/VFR_HUD.alt": 20,
    "/1/1/BATTERY_STATUS/0.volts[1]": 4,
};

function valueOf(text: string): number {
    return parseFormula(text).formula(
        (name, element, topic) =>
            FIELDS[`${topic === null ? "" : `${topic}.`}${name}${element === null ? "" : `[${element}]`}`] ?? NaN,
    );
}

function faultOf(text: string): [at: number, message: string] {
    try {
        parseFormula(text);
    } catch (error) {
        if (error instanceof FormulaError) return [error.at, error.message];
    }
    assert.fail(`'${text}' was accepted`);
}

test("formulas have the values that mathematics gives them", () => {
    const wanted: [string, number][] = [
        ["sqrt(vx^2+vy^2)", 5],
        ["1 + 2 * 3", 7],
        ["(1 + 2) * 3", 9],
        ["8 / 4 / 2", 1],
        ["7 - 2 - 1", 4],
        ["2^3^2", 512],
        ["-x^2", -4],
        ["2^-1", 0.5],
        ["--x", 2],
        ["volts[1]*2", 25],
        ["1.5e3", 1500],
        [".5", 0.5],
        ["7 % 4", 3],
        ["mod(-1, 4)", 3],
        ["max(1, vx, vy)", 4],
        ["atan2(1, 1)", Math.PI / 4],
        ["deg(pi)", 180],
        ["hypot(3, 4)", 5],
        ["round(2.5e0)", 3],
        ["/1/1/VFR_HUD.alt", 20],
        ["x//1/1/VFR_HUD.alt", 0.1],
        ["-(/1/1/VFR_HUD.alt) / 2/1/1", -10],
        ["max(/1/1/VFR_HUD.alt,/1/1/BATTERY_STATUS/0.volts[1])-1", 19],
    ];
    for (const [text, value] of wanted) assert.equal(valueOf(text), value, text);
});

test("a formula that does not parse states where and why", () => {
    const wanted: [string, number, RegExp][] = [
        ["", 0, /too early/],
        ["vx +", 4, /too early/],
        ["vx vy", 3, /operator before 'vy'/],
        ["(vx", 3, /expected '\)'/],
        ["vx)", 2, /operator before '\)'/],
        ["vx $ 2", 3, /'\$' does not belong/],
        ["foo(1)", 0, /no function 'foo'/],
        ["sqrt()", 0, /sqrt takes one value, not 0/],
        ["atan2(1)", 0, /2 values/],
        ["volts[x]", 6, /number of an array element/],
        ["volts[1", 7, /expected '\]'/],
        ["* 2", 0, /before '\*'/],
        ["constructor(1)", 0, /no function/],
        ["vx = 2", 3, /'=' does not belong/],
        ["`alert`", 0, /does not belong/],
        ["/1/1/VFR_HUD", 0, /before '\/'/],
        ["x + /1/1/VFR_HUD.3", 17, /expected a field of \/1\/1\/VFR_HUD/],
    ];
    for (const [text, at, message] of wanted) {
        const [where, why] = faultOf(text);
        assert.equal(where, at, text);
        assert.match(why, message);
    }
});

test("formulas without bounds are refused", () => {
    assert.match(faultOf("(".repeat(400))[1], /parentheses/);
    assert.match(faultOf("x^".repeat(200) + "x")[1], /powers/);
    assert.match(faultOf("x+".repeat(300) + "x")[1], /at most/);
    assert.equal(valueOf("-".repeat(400) + "x"), 2);
});

const SCHEMA = parseSchema(
    "# MAVLink BATTERY_STATUS (147)\nint32 current_consumed  # [mAh]\nuint16[10] voltages  # [mV]\nstring text\n",
);

test("a formula that does not fit the message states the field", () => {
    const wanted: [string, RegExp][] = [
        ["voltage[0]", /no field voltage; is it voltages\?/],
        ["voltages", /choose an element/],
        ["voltages[10]", /10 elements/],
        ["text", /is text/],
        ["current_consumed[0]", /not an array/],
        ["2 * nothing_like_it", /it has current_consumed, voltages, text/],
    ];
    for (const [text, message] of wanted)
        assert.match(checkFormula(text, "/1/1/B", () => SCHEMA)?.message ?? "accepted", message, text);
    assert.equal(checkFormula("voltages[9] / 1000", "/1/1/B", () => SCHEMA), null);
    assert.match(checkFormula("/2/1/B.volts", "", () => SCHEMA)?.message ?? "", /no field volts; is it voltages/);
    assert.match(checkFormula("1 + volts", "", () => SCHEMA)?.message ?? "", /choose a topic/);
});

function battery(consumed: number): DataView {
    const data = new DataView(new ArrayBuffer(4 + 4 + 20 + 5));
    data.setUint8(1, 1);
    data.setInt32(4, consumed, true);
    data.setUint16(4 + 4 + 2, 4200, true);
    data.setUint32(4 + 24, 1, true);
    return data;
}

test("a formula reads its fields from the message", () => {
    const one = new Evaluator(parseFormula("voltages[1] + current_consumed"), "/1/1/B");
    assert.deepEqual(one.topics, ["/1/1/B"]);
    assert.equal(one.take("/1/1/B", SCHEMA, battery(-7)), 4193);
});

// UINT16_MAX means that there is no such cell.
test("a number that is not known is a gap", () => {
    const text = "int32 current_consumed  # [mAh]\nuint16[10] voltages  # [mV] invalid: (UINT16_MAX)\nstring text\n";
    const schema = parseSchema(`# MAVLink BATTERY_STATUS (147)\n${text}`);
    const one = new Evaluator(parseFormula("voltages[1] / 1000"), "/1/1/B");
    assert.equal(one.take("/1/1/B", schema, battery(0)), 4.2);
    const data = battery(0);
    data.setUint16(4 + 4 + 2, 65535, true);
    assert.equal(one.take("/1/1/B", schema, data), NaN);
});

test("a formula of several topics has a value for each message, with the latest of the others", () => {
    const both = new Evaluator(parseFormula("current_consumed - /2/1/B.current_consumed"), "/1/1/B");
    assert.deepEqual(both.topics, ["/1/1/B", "/2/1/B"]);
    assert.equal(both.take("/1/1/B", SCHEMA, battery(10)), null, "nothing is known of the other");
    assert.equal(both.take("/2/1/B", SCHEMA, battery(3)), 7);
    assert.equal(both.take("/2/1/B", SCHEMA, battery(4)), 6);
    assert.equal(both.take("/1/1/B", SCHEMA, battery(20)), 16);
});

test("a formula that names its topics needs no other one", () => {
    assert.equal(topicOf("1 + /2/1/B.current_consumed", ""), "/2/1/B");
    assert.equal(topicOf("1 + x", ""), "");
    assert.equal(topicOf("1 +", "/1/1/A"), "/1/1/A");
    assert.deepEqual(new Evaluator(parseFormula("/2/1/B.x - /3/1/B.x"), "/2/1/B").topics, ["/2/1/B", "/3/1/B"]);
    assert.equal(unitOf(" /2/1/B.voltages[1]", "", () => SCHEMA), "mV");
    assert.equal(unitOf("voltages[1] + 1", "/2/1/B", () => SCHEMA), "");
});
