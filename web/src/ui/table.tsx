// SPDX-License-Identifier: MIT
// A table whose rows may be thousands: only those that can be seen are in the document. All rows have the same height.
import type { ComponentChildren } from "preact";
import { useEffect, useLayoutEffect, useRef, useState } from "preact/hooks";

export interface Column<T> {
    key: string; // its width is that of class c-KEY in the style sheet
    label: string;
    help?: string;
    isNumber?: boolean;
    cell: (row: T) => ComponentChildren;
}

interface Properties<T> {
    caption: string;
    columns: Column<T>[];
    rows: T[];
    keyOf: (row: T) => string;
    classOf?: (row: T) => string;
    current: string | null; // the row that has the keyboard's focus, or would get it
    sort?: { column: string; isDown: boolean };
    onSort?: (column: string) => void;
}

const SPARE = 6; // rows above and below what can be seen

function useWindow(rows: number) {
    const scroller = useRef<HTMLDivElement>(null);
    const [at, setAt] = useState({ top: 0, height: 800, row: 26 });
    useLayoutEffect(() => {
        const element = scroller.current;
        if (!element) return undefined;
        const measure = () => {
            const row = parseFloat(getComputedStyle(element).getPropertyValue("--row")) || 26;
            setAt({ top: element.scrollTop, height: element.clientHeight, row });
        };
        const observer = new ResizeObserver(measure);
        observer.observe(element);
        element.addEventListener("scroll", measure, { passive: true });
        return () => {
            observer.disconnect();
            element.removeEventListener("scroll", measure);
        };
    }, []);
    const first = Math.max(0, Math.min(rows, Math.floor(at.top / at.row) - SPARE));
    return { scroller, row: at.row, first, end: Math.min(rows, Math.ceil((at.top + at.height) / at.row) + SPARE) };
}

function Head<T>({ columns, sort, onSort }: Pick<Properties<T>, "columns" | "sort" | "onSort">) {
    const direction = sort?.isDown ? ("descending" as const) : ("ascending" as const);
    return (
        <thead>
            <tr aria-rowindex={1}>
                {columns.map((column) => (
                    <th
                        key={column.key}
                        scope="col"
                        title={column.help}
                        class={`c-${column.key} ${column.isNumber ? "number" : ""}`}
                        aria-sort={sort?.column === column.key ? direction : undefined}>
                        {onSort && column.label !== "" ? (
                            <button onClick={() => onSort(column.key)}>{column.label}</button>
                        ) : (
                            column.label || <span class="hidden">{column.help}</span>
                        )}
                    </th>
                ))}
            </tr>
        </thead>
    );
}

// One cell: a style sheet may hide columns.
const Spacer = ({ rows, row }: { rows: number; row: number }) =>
    rows <= 0 ? null : (
        <tr class="spacer" aria-hidden="true">
            <td style={{ height: `${rows * row}px` }} />
        </tr>
    );

// Keeps the current row in sight when it changes.
function useSight<T>({ current, rows, keyOf }: Properties<T>, window: ReturnType<typeof useWindow>) {
    useEffect(() => {
        const element = window.scroller.current;
        const at = rows.findIndex((one) => keyOf(one) === current);
        if (!element || at < 0) return;
        const top = at * window.row,
            visible = element.clientHeight - 2 * window.row;
        if (top < element.scrollTop) element.scrollTop = top;
        else if (top > element.scrollTop + visible) element.scrollTop = top - visible;
    }, [current]);
}

function Cells<T>({ columns, row }: { columns: Column<T>[]; row: T }) {
    return (
        <>
            {columns.map((column) => (
                <td key={column.key} class={`c-${column.key} ${column.isNumber ? "number" : ""}`}>
                    {column.cell(row)}
                </td>
            ))}
        </>
    );
}

export function Table<T>(properties: Properties<T>) {
    const { caption, columns, rows, keyOf, classOf, current } = properties;
    const window = useWindow(rows.length);
    const { scroller, row, first, end } = window;
    const classes = (one: T) => `${classOf?.(one) ?? ""} ${keyOf(one) === current ? "current" : ""}`;
    useSight(properties, window);
    return (
        <div class="scroller" ref={scroller} tabIndex={-1}>
            <table aria-rowcount={rows.length + 1}>
                <caption class="hidden">{caption}</caption>
                <colgroup>
                    {columns.map((column) => (
                        <col key={column.key} class={`c-${column.key}`} />
                    ))}
                </colgroup>
                <Head {...properties} />
                <tbody>
                    <Spacer rows={first} row={row} />
                    {rows.slice(first, end).map((one, i) => (
                        <tr key={keyOf(one)} aria-rowindex={first + i + 2} class={classes(one)}>
                            {Cells({ columns, row: one })}
                        </tr>
                    ))}
                    <Spacer rows={rows.length - end} row={row} />
                </tbody>
            </table>
        </div>
    );
}
