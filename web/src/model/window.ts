// SPDX-License-Identifier: MIT
// Which time all plots show: the latest seconds, or a part that the user chose. While they stand, what they show is
// kept, and recording continues.
import { signal } from "@preact/signals";
import { bump } from "../ui/ticker";
import { keyOf, recorderOf, recordersVersion } from "./recorders";
import { lowerBound } from "./series";
import { plots, span } from "./state";
import type { SeriesState } from "./url";

export interface Range {
    from: number;
    to: number;
}
export const standing = signal<Range | null>(null); // null: the latest seconds

type Data = [Float64Array, Float64Array];
const kept = new Map<string, Data>();
let keptTotal = 0;

const total = (): number => plots.value.flat().reduce((sum, series) => sum + (recorderOf(series)?.total ?? 0), 0);
export const newPoints = (): number => Math.max(0, total() - keptTotal);

// Time continues after the last point, up to half a plot.
function now(): number {
    let latest = -Infinity;
    for (const series of plots.value.flat()) {
        const recorder = recorderOf(series);
        if (!recorder || recorder.points.length === 0) continue;
        const waited = Math.min((performance.now() - recorder.arrivedMs) / 1000, span.value / 2);
        latest = Math.max(latest, recorder.points.latestTime + waited);
    }
    return Number.isFinite(latest) ? latest : Date.now() / 1000;
}

export function shownRange(): Range {
    const to = now();
    return standing.value ?? { from: to - span.value, to };
}

export function pause(range: Range = shownRange()): void {
    if (standing.value === null) {
        keptTotal = total();
        for (const series of plots.value.flat()) {
            const data = recorderOf(series)?.points.range(-Infinity, Infinity);
            if (data) kept.set(keyOf(series), [data[0].slice(), data[1].slice()]);
        }
    }
    standing.value = range;
    bump(recordersVersion);
}

export function resume(): void {
    kept.clear();
    standing.value = null;
    bump(recordersVersion);
}

export function zoom(factor: number, at = 0.5): void {
    const { from, to } = shownRange();
    const width = Math.min(7200, Math.max(0.05, (to - from) * factor));
    const anchor = from + (to - from) * at;
    pause({ from: anchor - width * at, to: anchor + width * (1 - at) });
}

export function pan(part: number): void {
    const { from, to } = shownRange();
    const by = (to - from) * part;
    pause({ from: from + by, to: to + by });
}

// The points of a series in the range.
export function pointsOf(series: SeriesState, { from, to }: Range): Data {
    const whole = standing.value === null ? undefined : kept.get(keyOf(series));
    if (!whole) return recorderOf(series)?.points.range(from, to) ?? [new Float64Array(), new Float64Array()];
    const start = Math.max(0, lowerBound(whole[0], from, 0, whole[0].length) - 1),
        end = lowerBound(whole[0], to, 0, whole[0].length) + 2;
    return [whole[0].subarray(start, end), whole[1].subarray(start, end)];
}

// The least and the greatest of each slice of time, if there are more points than pixels.
export function thinned([times, values]: Data, slices: number): Data {
    if (times.length <= 4 * slices) return [times, values];
    const out: [number, number][] = [];
    for (let slice = 0; slice < slices; ++slice) {
        const start = Math.floor((slice * times.length) / slices),
            end = Math.floor(((slice + 1) * times.length) / slices);
        let least = start,
            most = start;
        for (let i = start; i < end; ++i) {
            if (!((values[i] as number) >= (values[least] as number))) least = i;
            if (!((values[i] as number) <= (values[most] as number))) most = i;
        }
        for (const i of least < most ? [least, most] : [most, least])
            out.push([times[i] as number, values[i] as number]);
    }
    return [Float64Array.from(out, (one) => one[0]), Float64Array.from(out, (one) => one[1])];
}
