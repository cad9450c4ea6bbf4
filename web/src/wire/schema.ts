// SPDX-License-Identifier: MIT
// Reads the schemas of the server's channels: ROS 2 message definitions as docs/formats/ros2msg.md describes them.

export type Type =
    "int8" | "uint8" | "int16" | "uint16" | "int32" | "uint32" | "int64" | "uint64" | "float32" | "float64" | "string";

export interface Field {
    name: string;
    type: Type;
    length: number | null; // of an array; null: one value
    unit: string;
    invalid: string; // the definition's text for "not known": "UINT16_MAX", "(0)"; empty: none
    entries: Map<number, string> | null; // of its enum
    isFlags: boolean; // the entries are bits, which may occur together
}

export interface Schema {
    name: string; // MAVLink's
    id: number | null;
    fields: Field[];
    indexOf: Map<string, number>;
}

const SIZES: Record<Type, number> = {
    int8: 1,
    uint8: 1,
    int16: 2,
    uint16: 2,
    int32: 4,
    uint32: 4,
    int64: 8,
    uint64: 8,
    float32: 4,
    float64: 8,
    string: 4,
};

export const sizeOf = (type: Type): number => SIZES[type];

const TITLE = /^# MAVLink (\S+) \((\d+)\)/;
const CONSTANT = /^(\w+) (\w+)=(-?\d+)$/;
const FIELD = /^(\w+?)(?:\[(\d+)\])? (\w+)(?:\s*#(?: \[(.*?)\])?(?: invalid: (\S+))?)?$/;

// A schema does not state whether an enum is a bit mask. Two entries 1 and 2 are taken for an enum.
function areFlags(values: number[]): boolean {
    const bits = values.filter((value) => value !== 0);
    return bits.length > 1 && Math.max(...bits) > 2 && bits.every((value) => Number.isInteger(Math.log2(value)));
}

// If an earlier field has an entry of this name, the name of the field precedes it.
function entryName(constant: string, field: string, seen: Set<string>): string {
    const prefix = `${field.toUpperCase()}_`;
    const rest = constant.slice(prefix.length);
    return constant.startsWith(prefix) && seen.has(rest) ? rest : constant;
}

function entriesOf(field: string, constants: [string, number][], seen: Set<string>): Map<number, string> | null {
    if (constants.length === 0) return null;
    const entries = new Map(constants.map(([name, value]) => [value, entryName(name, field, seen)]));
    for (const [name] of constants) seen.add(name);
    return entries;
}

function makeField(match: RegExpMatchArray, constants: [string, number][], seen: Set<string>): Field {
    const [, type = "", length, name = "", unit = "", invalid = ""] = match;
    if (!(type in SIZES)) throw new Error(`the schema has a type that MAVLink does not have: ${type}`);
    const entries = entriesOf(name, constants, seen);
    return {
        name,
        type: type as Type,
        length: length === undefined ? null : Number(length),
        unit,
        invalid,
        entries,
        isFlags: entries !== null && areFlags([...entries.keys()]),
    };
}

export function parseSchema(text: string): Schema {
    const lines = text
        .split("\n")
        .map((line) => line.trim())
        .filter((line) => line !== "");
    const title = lines[0]?.match(TITLE);
    const fields: Field[] = [],
        seen = new Set<string>();
    let constants: [string, number][] = [];
    for (const line of lines) {
        const constant = line.match(CONSTANT);
        if (constant) constants.push([constant[2] ?? "", Number(constant[3])]);
        const field = constant || line.startsWith("#") ? null : line.match(FIELD);
        if (!field) continue;
        fields.push(makeField(field, constants, seen));
        constants = [];
    }
    return {
        name: title?.[1] ?? "",
        id: title ? Number(title[2]) : null,
        fields,
        indexOf: new Map(fields.map((field, index) => [field.name, index])),
    };
}
