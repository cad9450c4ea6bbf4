// SPDX-License-Identifier: MIT
// One chart, drawn by uPlot on a canvas.
import { signal, type Signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import uPlot from "uplot";
import { recorderOf, recordersVersion } from "../model/recorders";
import { plots } from "../model/state";
import type { SeriesState } from "../model/url";
import { pause, pointsOf, shownRange, standing, thinned, zoom } from "../model/window";
import { followTouches } from "./touch";
import { colour, SERIES_COLOURS, themeVersion } from "../ui/theme";

const HEIGHT = 220;
const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3]];

export const cursorTime = signal<number | null>(null); // where the pointer is, in all charts

const pad = (value: number): string => String(value).padStart(2, "0");

function timeText(seconds: number, hasFraction: boolean): string {
    const date = new Date(seconds * 1000);
    const whole = `${pad(date.getHours())}:${pad(date.getMinutes())}:${pad(date.getSeconds())}`;
    return hasFraction ? `${whole}.${Math.floor(date.getMilliseconds() / 100)}` : whole;
}

const times = (_: uPlot, splits: number[], _axis: number, _space: number, step: number): string[] =>
    splits.map((split) => timeText(split, step < 1));

// As many decimals as the steps between them have: 1, 2, 2.5 or 5 times a power of ten.
function numbers(_: uPlot, splits: number[], _axis: number, _space: number, step: number): string[] {
    const [digits = "", power = "0"] = Number(step.toPrecision(3)).toExponential().split("e");
    const decimals = Math.max(0, Math.min(9, digits.replace(/\D/g, "").length - 1 - Number(power)));
    const largest = Math.max(...splits.map(Math.abs));
    return splits.map((split) => (largest >= 1e7 ? split.toExponential(2) : split.toFixed(decimals)));
}

const isRight = (series: SeriesState): boolean => series.axis === 1;

const LEAST_ROOM = 56;
const rooms = new Map<uPlot, number[]>(); // that the axes of each plot need

// Room for the longest number. All plots have the same, so that times are in line.
function sizeOf(chart: uPlot, texts: string[] | null, axis: number): number {
    for (const one of rooms.keys()) if (!one.root.isConnected) rooms.delete(one);
    const own = rooms.get(chart) ?? [];
    own[axis] = Math.max(0, ...(texts ?? []).map((text) => 7 * text.length + 12));
    rooms.set(chart, own);
    return Math.max(LEAST_ROOM, ...[...rooms.values()].flat());
}

// `hasRight`: a plot uses the right axis. All plots have its room then.
function axes(hasRight: boolean, isRightUsed: boolean): uPlot.Axis[] {
    const stroke = colour("dim"),
        line = { stroke: colour("line"), width: 1 };
    const font = "11px system-ui, sans-serif";
    const base = { stroke, font, ticks: { ...line, size: 4 }, grid: line };
    return [
        { ...base, values: times, space: 70, size: 28 },
        { ...base, scale: "0", values: numbers, size: sizeOf, space: 32 },
        {
            ...base,
            scale: "1",
            values: isRightUsed ? numbers : () => [],
            ticks: { ...base.ticks, show: isRightUsed },
            size: sizeOf,
            space: 32,
            side: 1,
            show: hasRight,
            grid: { show: false },
        },
    ];
}

// A line of one value gets some room above and below.
function rangeOf(_: uPlot, least: number | null, most: number | null): [number, number] {
    if (least === null || most === null || !Number.isFinite(least) || !Number.isFinite(most)) return [0, 1];
    const room = (most - least) * 0.08 || Math.abs(most) * 0.1 || 1;
    return [least - room, most + room];
}

function lines(plot: SeriesState[]): uPlot.Series[] {
    return plot.map((series, i) => ({
        label: series.formula,
        scale: String(series.axis),
        stroke: colour(`series-${i % SERIES_COLOURS}`),
        width: 1.5,
        dash: DASHES[Math.floor(i / 2) % DASHES.length] as number[],
        points: { size: 4 },
    }));
}

function options(plot: SeriesState[], width: number): uPlot.Options {
    return {
        width,
        height: HEIGHT,
        legend: { show: false },
        padding: [8, 24, 0, 0], // half a time
        cursor: { sync: { key: "time" }, drag: { x: true, y: false, setScale: false }, focus: { prox: -1 } },
        scales: { x: { time: true, auto: false }, 0: { range: rangeOf }, 1: { range: rangeOf } },
        axes: axes(plots.value.flat().some(isRight), plot.some(isRight)),
        series: [{}, ...lines(plot)],
        hooks: { setSelect: [select], setCursor: [follow] },
    };
}

function select(chart: uPlot): void {
    const { left, width } = chart.select;
    if (width < 4) return;
    pause({ from: chart.posToVal(left, "x"), to: chart.posToVal(left + width, "x") });
    chart.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
}

function follow(chart: uPlot): void {
    const { left } = chart.cursor;
    cursorTime.value = left == null || left < 0 ? null : chart.posToVal(left, "x");
}

const scaled = (values: Float64Array, { scale, offset }: SeriesState): (number | null)[] =>
    Array.from(values, (value) => (Number.isFinite(value) ? value * scale + offset : null));

function dataOf(plot: SeriesState[], width: number): uPlot.AlignedData {
    const range = shownRange();
    const tables = plot.map((series) => {
        const [at, values] = thinned(pointsOf(series, range), width);
        return [at, scaled(values, series)] as unknown as uPlot.AlignedData;
    });
    return tables.length === 1
        ? (tables[0] as uPlot.AlignedData)
        : uPlot.join(
              tables,
              tables.map((table) => table.map(() => 1)),
          );
}

function draw(chart: uPlot, plot: SeriesState[]): void {
    const { from, to } = shownRange();
    chart.batch(() => {
        chart.setData(dataOf(plot, chart.width), false);
        chart.setScale("x", { min: from, max: to });
    });
}

function wheel(event: WheelEvent, chart: uPlot): void {
    event.preventDefault();
    const { left, width } = chart.over.getBoundingClientRect();
    zoom(event.deltaY > 0 ? 1.25 : 0.8, (event.clientX - left) / width);
}

function make(element: HTMLElement, plot: SeriesState[]): { chart: uPlot; destroy: () => void } {
    const chart = new uPlot(
        options(plot, element.clientWidth),
        [[], ...plot.map(() => [])] as uPlot.AlignedData,
        element,
    );
    chart.over.addEventListener("wheel", (event) => wheel(event, chart), { passive: false });
    followTouches(chart.over);
    const observer = new ResizeObserver(() => {
        chart.setSize({ width: element.clientWidth, height: HEIGHT });
    });
    observer.observe(element);
    return {
        chart,
        destroy: () => {
            observer.disconnect();
            chart.destroy();
        },
    };
}

// While a plot follows the latest, time moves it also if nothing arrives.
function everyFrame(call: () => void): () => void {
    const timer = setInterval(() => {
        if (!document.hidden && standing.value === null) call();
    }, 250);
    return () => clearInterval(timer);
}

export function Chart({ plot, onChart }: { plot: SeriesState[]; onChart: (chart: uPlot | null) => void }) {
    const element = useRef<HTMLDivElement>(null);
    const chart = useRef<uPlot | null>(null);
    const shape = JSON.stringify([plot, plots.value.flat().some(isRight)]);
    useEffect(() => {
        if (!element.current) return undefined;
        const made = make(element.current, plot);
        chart.current = made.chart;
        onChart(made.chart);
        draw(made.chart, plot);
        const stop = everyFrame(() => draw(made.chart, plot));
        return () => {
            stop();
            made.destroy();
            chart.current = null;
            onChart(null);
        };
    }, [shape, themeVersion.value]);
    useEffect(() => {
        if (chart.current) draw(chart.current, plot);
    }, [recordersVersion.value, standing.value]);
    return (
        <div
            class="chart"
            ref={element}
            role="img"
            aria-label={`Plot of ${plot.map((one) => one.formula).join(", ")}`}
        />
    );
}

// For the list of series: the value at the pointer, else the latest.
export function valueAt(series: SeriesState, at: Signal<number | null>): number {
    const raw = (() => {
        if (at.value === null && standing.value === null) return recorderOf(series)?.points.latest ?? NaN;
        const { from, to } = shownRange();
        const time = at.value ?? to;
        const [when, values] = pointsOf(series, { from, to });
        let last = NaN;
        for (let i = 0; i < when.length && (when[i] as number) <= time; ++i) last = values[i] as number;
        return last;
    })();
    return raw * series.scale + series.offset;
}
