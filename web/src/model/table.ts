// SPDX-License-Identifier: MIT
// Which rows the table of messages shows, in which order; and the state that it is compared with.
import { signal } from "@preact/signals";
import { ageOf, isSilent, rateOf, rows, type Row } from "./observed";
import { serverNow } from "./feeds";
import { openedMessage, type Opened } from "./latest";
import type { Sort } from "./url";

interface Frozen {
    at: number;
    opened: Opened | null;
    rows: Map<string, Row>;
}
export const frozen = signal<Frozen | null>(null);
export const isComparing = signal(false);

export function freeze(): void {
    frozen.value = { at: serverNow(), opened: openedMessage(), rows: new Map(rows) };
    isComparing.value = false;
}

export function thaw(): void {
    frozen.value = null;
    isComparing.value = false;
}

export function compare(): void {
    if (frozen.value === null) freeze();
    isComparing.value = !isComparing.value;
}

export const shownRows = (): Map<string, Row> => (frozen.value && !isComparing.value ? frozen.value.rows : rows);

type Mark = "new" | "silent" | "";

// New: not in the frozen state; without one, first seen a short while ago.
export function markOf(row: Row): Mark {
    const base = frozen.value;
    if (base && !isComparing.value) return isSilent(row, base.at - row.seenAt) ? "silent" : "";
    if (base ? !base.rows.has(row.key) : row.newAt > 0 && serverNow() - row.newAt < 10) return "new";
    return isSilent(row) ? "silent" : "";
}

export const shownAge = (row: Row): number =>
    frozen.value && !isComparing.value ? Math.max(0, frozen.value.at - row.seenAt) : ageOf(row);

export const shownRate = (row: Row): number => rateOf(row, shownAge(row));

// ---- search: each word must occur. "1/1" is a whole source, not a part of 11/1.

function matcher(query: string): (row: Row) => boolean {
    const wanted = query
        .toLowerCase()
        .split(/\s+/)
        .filter((word) => word !== "");
    const sources = wanted.filter((word) => /^\d+\/\d*$/.test(word));
    const parts = wanted.filter((word) => !sources.includes(word));
    return (row) => {
        const source = `${row.sys}/${row.comp}`;
        const isFrom = sources.every((word) => (word.endsWith("/") ? source.startsWith(word) : source === word));
        return isFrom && parts.every((word) => textOf(row).includes(word));
    };
}

const texts = new WeakMap<Row, string>();

function textOf(row: Row): string {
    const known = texts.get(row);
    if (known !== undefined) return known;
    const text = `${row.topic} ${row.link ?? ""} ${row.id}`.toLowerCase();
    texts.set(row, text);
    return text;
}

// ---- order. Rates are compared roughly, so that rows of the same rate do not change places all the time.

const rough = (value: number): number => (value === 0 ? 0 : Number(value.toPrecision(2)));

const NUMBERS: Record<string, (row: Row) => number> = {
    source: (row) => row.sys * 256 + row.comp,
    id: (row) => row.id,
    hz: (row) => rough(shownRate(row)),
    count: (row) => rough(row.count),
    bytes: (row) => rough(row.bytes),
    share: (row) => rough(row.share),
    gaps: (row) => rough(row.gap_max_ms ?? -1),
    jitter: (row) => rough(row.jitter_ms ?? -1),
    age: (row) => Math.floor(ageOf(row)),
};

const byPlace = (a: Row, b: Row): number =>
    a.sys - b.sys ||
    a.comp - b.comp ||
    byText(a.name, b.name) ||
    byInstance(a.instance, b.instance) ||
    byText(a.key, b.key);

const byText = (a: string, b: string): number => (a < b ? -1 : a > b ? 1 : 0);

// By number, where both are: NaN is falsy.
const byInstance = (a: Row["instance"], b: Row["instance"]): number =>
    Number(a) - Number(b) || byText(String(a ?? ""), String(b ?? ""));

function comparison(column: string): (a: Row, b: Row) => number {
    const number = NUMBERS[column];
    if (number) return (a, b) => number(a) - number(b);
    if (column === "link") return (a, b) => byText(a.link ?? "", b.link ?? "");
    return (a, b) => byText(a.name, b.name);
}

export function ordered(all: Iterable<Row>, query: string, sort: Sort): Row[] {
    const compareBy = comparison(sort.column),
        sign = sort.isDown ? -1 : 1;
    return [...all].filter(matcher(query)).sort((a, b) => sign * compareBy(a, b) || byPlace(a, b));
}
