// SPDX-License-Identifier: MIT
import { computed, signal } from "@preact/signals";
import { useEffect, useLayoutEffect, useRef } from "preact/hooks";
import { seconds } from "../model/feeds";
import { linkFeed, rateOf, rows, trafficFeed, type Row } from "../model/observed";
import { columns, opened, query, sort } from "../model/state";
import {
    compare,
    freeze,
    frozen,
    isComparing,
    markOf,
    ordered,
    shownAge,
    shownRate,
    shownRows,
    thaw,
} from "../model/table";
import { COLUMNS } from "../model/url";
import { bytes, count, duration, fixed, hertz, NOTHING } from "../ui/format";
import { Icon } from "../ui/icon";
import { focusOn, useKeys } from "../ui/keys";
import { Table, type Column } from "../ui/table";
import { Message } from "./message";
import { Nothing } from "./nothing";

const current = signal<string | null>(null);

const shown = computed(() => {
    trafficFeed.version.value;
    frozen.value;
    isComparing.value;
    if (sort.value.column === "age") seconds.value;
    return ordered(shownRows().values(), query.value, sort.value);
});

// By topic: each of its links has a row.
const rowsOf = computed(() => {
    const counts = new Map<string, number>();
    for (const { topic } of shown.value) counts.set(topic, (counts.get(topic) ?? 0) + 1);
    return counts;
});

// ---- the cells

function open(row: Row): void {
    current.value = row.key;
    opened.value = opened.value === row.topic ? null : row.topic;
}

// A link of several peers has its peer behind a '#'.
const peerOf = (row: Row): string => row.link?.split("#").at(-1) ?? "";

function Name({ row }: { row: Row }) {
    const isCurrent = row.key === (current.value ?? shown.value[0]?.key);
    return (
        <button
            class="name mono"
            data-row={row.key}
            tabIndex={isCurrent ? 0 : -1}
            aria-expanded={opened.value === row.topic}
            onClick={() => open(row)}
            onFocus={() => {
                current.value = row.key;
            }}>
            {row.name}
            {row.instance !== null && <span class="instance">/{row.instance}</span>}
            {(rowsOf.value.get(row.topic) ?? 0) > 1 && <span class="by dim">{peerOf(row)}</span>}
        </button>
    );
}

function marked(row: Row) {
    const mark = markOf(row);
    return mark === "" ? null : <span class={`mark ${mark}`}>{mark}</span>;
}

const Before = ({ row }: { row: Row }) => {
    const before = frozen.value?.rows.get(row.key);
    if (!before) return <>{NOTHING}</>;
    const isOther = Math.abs(before.hz - rateOf(row)) > 0.1 * Math.max(before.hz, row.hz, 1);
    return <span class={isOther ? "changed" : "dim"}>{hertz(before.hz)}</span>;
};

const More = ({ row }: { row: Row }) => {
    const more = row.count - (frozen.value?.rows.get(row.key)?.count ?? 0);
    return <span class={more === 0 ? "dim" : ""}>{more > 0 ? `+${count(more)}` : count(more)}</span>;
};

const gaps = (row: Row): string =>
    row.gap_min_ms == null ? NOTHING : `${fixed(row.gap_min_ms, 0)} – ${fixed(row.gap_max_ms, 0)}`;

const ALL: Record<string, Column<Row>> = {
    mark: { key: "mark", label: "", help: "new or silent", cell: marked },
    link: {
        key: "link",
        label: "Link",
        cell: (row) => (
            <span class="cut" title={row.link ?? ""}>
                {row.link ?? NOTHING}
            </span>
        ),
    },
    source: {
        key: "source",
        label: "From",
        help: "system/component",
        cell: (row) => (
            <span class="mono">
                {row.sys}/{row.comp}
            </span>
        ),
    },
    name: { key: "name", label: "Message", cell: (row) => <Name row={row} /> },
    id: { key: "id", label: "Id", isNumber: true, cell: (row) => row.id },
    hz: { key: "hz", label: "Rate /s", isNumber: true, cell: (row) => hertz(shownRate(row)) },
    before: {
        key: "before",
        label: "Then /s",
        help: "the rate in the frozen state",
        isNumber: true,
        cell: (row) => <Before row={row} />,
    },
    count: { key: "count", label: "Count", isNumber: true, cell: (row) => count(row.count) },
    more: {
        key: "more",
        label: "Since",
        help: "messages since the frozen state",
        isNumber: true,
        cell: (row) => <More row={row} />,
    },
    bytes: { key: "bytes", label: "Bytes", isNumber: true, cell: (row) => bytes(row.bytes) },
    share: {
        key: "share",
        label: "Share %",
        help: "of the link's bytes",
        isNumber: true,
        cell: (row) => fixed(row.share * 100, 1),
    },
    gaps: {
        key: "gaps",
        label: "Gaps ms",
        help: "shortest and longest time between two messages",
        isNumber: true,
        cell: gaps,
    },
    jitter: { key: "jitter", label: "Jitter ms", isNumber: true, cell: (row) => fixed(row.jitter_ms, 1) },
    age: {
        key: "age",
        label: "Age",
        help: "since the latest message",
        isNumber: true,
        cell: (row) => duration(shownAge(row)),
    },
};

// Columns of the comparison, and those that make place for them.
const COMPARED: Record<string, string[]> = {
    hz: ["hz", "before"],
    count: ["count", "more"],
    bytes: [],
    share: [],
    gaps: [],
    jitter: [],
};

function columnsNow(): Column<Row>[] {
    const chosen = COLUMNS.filter((column) => columns.value.includes(column));
    const wanted = chosen.toSpliced(chosen.indexOf("name") + 1, 0, "mark");
    const all = isComparing.value ? wanted.flatMap((one) => COMPARED[one] ?? [one]) : wanted;
    return all.flatMap((name) => ALL[name] ?? []);
}

function sortBy(column: string): void {
    if (!COLUMNS.includes(column)) return;
    const isText = ["source", "name", "link", "id"].includes(column);
    sort.value = sort.value.column === column ? { column, isDown: !sort.value.isDown } : { column, isDown: !isText };
}

// ---- above the table

function Chooser() {
    const toggle = (column: string) => {
        const has = columns.value.includes(column);
        columns.value = COLUMNS.filter((one) => (one === column ? !has : columns.value.includes(one)));
    };
    const menu = useRef<HTMLDetailsElement>(null);
    useEffect(() => {
        const close = (event: Event) => {
            if (menu.current && !menu.current.contains(event.target as Node)) menu.current.open = false;
        };
        document.addEventListener("pointerdown", close);
        return () => document.removeEventListener("pointerdown", close);
    }, []);
    return (
        <details class="chooser" ref={menu}>
            <summary>Columns</summary>
            <div class="menu">
                {COLUMNS.filter((column) => column !== "name").map((column) => (
                    <label key={column} class="check">
                        <input
                            type="checkbox"
                            checked={columns.value.includes(column)}
                            onChange={() => toggle(column)}
                        />{" "}
                        {ALL[column]?.label}
                    </label>
                ))}
            </div>
        </details>
    );
}

function Freeze() {
    const at = frozen.value;
    return (
        <span class="group">
            <button aria-pressed={at !== null} onClick={() => (at ? thaw() : freeze())} title="Freeze the table (f)">
                <Icon name={at ? "play" : "pause"} />
                {at ? "Thaw" : "Freeze"}
            </button>
            {at && (
                <button
                    aria-pressed={isComparing.value}
                    onClick={compare}
                    title="Live values beside the frozen ones (c)">
                    Compare
                </button>
            )}
        </span>
    );
}

function Summary() {
    trafficFeed.version.value;
    const rate = shown.value.reduce((sum, row) => sum + shownRate(row), 0);
    const frozenText = frozen.value === null ? "" : isComparing.value ? " · live, compared" : " · frozen";
    return (
        <span class="summary dim number" role="status" aria-live="off">
            {count(shown.value.length)}
            {shown.value.length < rows.size && ` of ${count(rows.size)}`} rows ·{" "}
            {Math.round(rate).toLocaleString("en-US")} /s{frozenText}
        </span>
    );
}

function Toolbar() {
    return (
        <div class="toolbar">
            <input
                id="search"
                type="search"
                placeholder="Search: 1/1 battery"
                aria-label="Search messages"
                value={query.value}
                autocomplete="off"
                spellcheck={false}
                onInput={(event) => {
                    query.value = event.currentTarget.value;
                }}
                onKeyDown={(event) => {
                    if (event.key === "Enter" || event.key === "ArrowDown") moveTo(0);
                }}
            />
            <Freeze />
            <Chooser />
            <Summary />
        </div>
    );
}

// ---- keys

function moveTo(index: number): void {
    const row = shown.value[Math.max(0, Math.min(shown.value.length - 1, index))];
    if (!row) return;
    current.value = row.key;
    focusOn(`[data-row="${CSS.escape(row.key)}"]`);
}

const position = (): number => shown.value.findIndex((row) => row.key === current.value);
const step = (by: number) => () => moveTo(position() < 0 ? 0 : position() + by);

const keys = {
    j: step(1),
    ArrowDown: step(1),
    k: step(-1),
    ArrowUp: step(-1),
    PageDown: step(20),
    PageUp: step(-20),
    Home: () => moveTo(0),
    End: () => moveTo(Infinity),
    f: () => (frozen.value ? thaw() : freeze()),
    c: compare,
};

// Of the open message on all links.
function rateOpen(): number | null {
    const open = shown.value.filter((row) => row.topic === opened.value);
    return open.length === 0 ? null : open.reduce((sum, row) => sum + shownRate(row), 0);
}

export function Messages() {
    useEffect(() => trafficFeed.use(), []);
    useEffect(() => linkFeed.use(), []);
    useLayoutEffect(() => useKeys(keys), []);
    seconds.value;
    return (
        <>
            <h2 class="hidden">Messages</h2>
            <div class="list">
                <Toolbar />
                <Table
                    caption="Messages, a row for each sender, message and instance"
                    columns={columnsNow()}
                    rows={shown.value}
                    keyOf={(row) => row.key}
                    current={current.value}
                    sort={sort.value}
                    onSort={sortBy}
                    classOf={(row) => `${markOf(row)} ${row.topic === opened.value ? "open" : ""}`}
                />
                {rows.size === 0 && <Nothing text="No message has come yet." />}
                {rows.size > 0 && shown.value.length === 0 && <p class="empty">No message matches the search.</p>}
            </div>
            {opened.value !== null && <Message hz={rateOpen()} />}
        </>
    );
}
