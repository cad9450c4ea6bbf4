// SPDX-License-Identifier: MIT
// The attribute `invalid` of MAVLink's definitions: the value of a field, or of an array's elements, that means "not
// known". Its forms: "v"; "[v]", each element with this value; "[v:]", all elements if the first has it; "[v1,,v3]", a
// value for each element. Schemas have round brackets. Source: MAVLink guide, "MAVLink XML Schema".
import type { Scalar, Value } from "./cdr";
import type { Field } from "./schema";

// "UINT16_MAX", "INT8_MIN", an entry of the field's enum, or a number.
function numberOf(text: string, field: Field): number {
    const [, unsigned, bits, end] = text.match(/^(U?)INT(8|16|32|64)_(MAX|MIN)$/) ?? [];
    if (bits === undefined) return entryOf(text, field) ?? (text.toLowerCase() === "nan" ? NaN : Number(text));
    const size = Number(bits) - (unsigned ? 0 : 1);
    if (end === "MAX") return 2 ** size - 1;
    return unsigned ? 0 : -(2 ** size);
}

const entryOf = (text: string, field: Field): number | undefined =>
    [...(field.entries ?? [])].find(([, name]) => name === text)?.[0];

function equals(value: Scalar | undefined, text: string, field: Field): boolean {
    if (text === "" || value === undefined) return false;
    const wanted = numberOf(text, field);
    return Number(value) === wanted || (Number.isNaN(wanted) && Number.isNaN(Number(value)));
}

// `element`: of an array.
export function isInvalid(field: Field, whole: Value, element: number | null): boolean {
    const rule = field.invalid;
    if (rule === "" || field.type === "string") return false;
    const all = Array.isArray(whole) ? whole : [whole];
    const value = all[element ?? 0];
    if (!rule.startsWith("(")) return equals(value, rule, field);
    const inner = rule.slice(1, -1);
    if (inner.endsWith(":")) return equals(all[0], inner.slice(0, -1), field);
    return equals(value, inner.includes(",") ? (inner.split(",")[element ?? 0] ?? "") : inner, field);
}
