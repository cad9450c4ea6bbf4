// SPDX-License-Identifier: MIT
// One line of a plot: a formula over one or more topics, evaluated for each message. Keeps the latest points, a bounded
// number.
import { decode, numberAt, type Message } from "../wire/cdr";
import { isInvalid } from "../wire/invalid";
import type { Schema } from "../wire/schema";
import { FormulaError, parseFormula, type Parsed, type Use } from "./formula";

const MAX_POINTS = 20_000;

// Where the first time at or after `time` is, of those in [low, high).
export function lowerBound(times: Float64Array, time: number, low: number, high: number): number {
    while (low < high) {
        const middle = (low + high) >> 1;
        if ((times[middle] as number) < time) low = middle + 1;
        else high = middle;
    }
    return low;
}

// Times and values, oldest first. Twice the space is reserved, so that dropping old points rarely copies.
export class Points {
    readonly times = new Float64Array(2 * MAX_POINTS);
    readonly values = new Float64Array(2 * MAX_POINTS);
    private first = 0;
    private end = 0;

    get length(): number {
        return this.end - this.first;
    }
    get latest(): number {
        return this.end > this.first ? (this.values[this.end - 1] as number) : NaN;
    }
    get latestTime(): number {
        return this.end > this.first ? (this.times[this.end - 1] as number) : -Infinity;
    }

    add(time: number, value: number): void {
        if (this.end === this.times.length) this.compact();
        this.times[this.end] = time;
        this.values[this.end++] = value;
        if (this.length > MAX_POINTS) ++this.first;
    }

    // Points of [from, to], with one more on each side, so that lines reach the edge.
    range(from: number, to: number): [Float64Array, Float64Array] {
        const start = Math.max(this.first, lowerBound(this.times, from, this.first, this.end) - 1),
            end = Math.min(this.end, lowerBound(this.times, to, this.first, this.end) + 2);
        return [this.times.subarray(start, end), this.values.subarray(start, end)];
    }

    clear(): void {
        this.first = this.end = 0;
    }

    private compact(): void {
        this.times.copyWithin(0, this.first, this.end);
        this.values.copyWithin(0, this.first, this.end);
        this.end -= this.first;
        this.first = 0;
    }
}

function distance(a: string, b: string): number {
    let row = [...Array(b.length + 1).keys()];
    for (let i = 0; i < a.length; ++i) {
        const next = [i + 1];
        for (let j = 0; j < b.length; ++j)
            next.push(
                Math.min(
                    (next[j] as number) + 1,
                    (row[j + 1] as number) + 1,
                    (row[j] as number) + (a[i] === b[j] ? 0 : 1),
                ),
            );
        row = next;
    }
    return row[b.length] as number;
}

function nearest(name: string, schema: Schema): string {
    const scored = schema.fields
        .filter((field) => field.type !== "string")
        .map((field) => ({
            name: field.name,
            score: distance(name.toLowerCase(), field.name) - (field.name.startsWith(name) ? 3 : 0),
        }));
    scored.sort((a, b) => a.score - b.score);
    const best = scored[0];
    return best && best.score <= 3
        ? `; is it ${best.name}?`
        : `; it has ${schema.fields.map((f) => f.name).join(", ")}`;
}

function checkUse({ name, element, at }: Use, schema: Schema): void {
    const field = schema.fields[schema.indexOf.get(name) ?? -1];
    if (!field) throw new FormulaError(`${schema.name} has no field ${name}${nearest(name, schema)}`, at);
    if (field.type === "string") throw new FormulaError(`${name} is text, not a number`, at);
    if (field.length !== null && element === null)
        throw new FormulaError(
            `${name} is an array: choose an element, from ${name}[0] to ${name}[${field.length - 1}]`,
            at,
        );
    if (field.length === null && element !== null) throw new FormulaError(`${name} is not an array`, at);
    if (element !== null && element >= (field.length ?? 0))
        throw new FormulaError(
            `${name} has ${field.length} elements, the last is ${name}[${(field.length ?? 1) - 1}]`,
            at,
        );
}

export type Schemas = (topic: string) => Schema | null | undefined; // of the topics that the server has

// NaN, a gap in the line, if the number is not known.
function knownNumber(schema: Schema, message: Message, name: string, element: number | null): number {
    const index = schema.indexOf.get(name) ?? -1;
    const field = schema.fields[index],
        value = message[index];
    return field && value !== undefined && isInvalid(field, value, element) ? NaN : numberAt(message, index, element);
}

// Computes a formula from the latest message of each topic that it reads. Fields without a topic are of `own`.
export class Evaluator {
    readonly topics: string[];
    private readonly latest = new Map<string, { schema: Schema; message: Message }>();

    constructor(
        private readonly parsed: Parsed,
        private readonly own: string,
    ) {
        const used = new Set(parsed.uses.map((use) => use.topic ?? own));
        this.topics = used.size > 0 ? [...used] : [own];
    }

    // Throws FormulaError.
    check(schemas: Schemas): void {
        for (const use of this.parsed.uses) {
            const schema = schemas(use.topic ?? this.own);
            if (schema) checkUse(use, schema);
        }
    }

    // Null until each topic had a message.
    take(topic: string, schema: Schema, data: DataView): number | null {
        this.latest.set(topic, { schema, message: decode(schema, data) });
        if (this.latest.size < this.topics.length) return null;
        return this.parsed.formula((name, element, of) => {
            const from = this.latest.get(of ?? this.own);
            return from ? knownNumber(from.schema, from.message, name, element) : NaN;
        });
    }
}

// The unit, if the formula is only a field.
export function unitOf(text: string, own: string, schemas: Schemas): string {
    const [, topic, name] = text.trim().match(/^(?:(\/\S+)\.)?(\w+)(?:\[\d+\])?$/) ?? [];
    const schema = schemas(topic ?? own);
    return schema?.fields[schema.indexOf.get(name ?? "") ?? -1]?.unit ?? "";
}

// The topic that a series of this formula belongs to: the chosen one, or the first that the formula names.
export function topicOf(text: string, chosen: string): string {
    try {
        return chosen || (parseFormula(text).uses.find((use) => use.topic !== null)?.topic ?? "");
    } catch {
        return chosen;
    }
}

export function checkFormula(text: string, own: string, schemas: Schemas): FormulaError | null {
    try {
        const parsed = parseFormula(text);
        const lost = parsed.uses.find((use) => use.topic === null && own === "");
        if (lost) return new FormulaError(`choose a topic, or write it here, as in /1/1/VFR_HUD.${lost.name}`, lost.at);
        new Evaluator(parsed, own).check(schemas);
        return null;
    } catch (error) {
        if (error instanceof FormulaError) return error;
        throw error;
    }
}
