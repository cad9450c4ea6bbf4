// SPDX-License-Identifier: MIT
// What the user chose. All of it is in the address, so that reload, bookmarks and the back button keep it.
import { batch, effect, signal } from "@preact/signals";
import {
    decodeState,
    encodeState,
    MAX_PLOTS,
    MAX_SERIES,
    type SeriesState,
    type Sort,
    type State,
    type View,
} from "./url";

const first = decodeState(location.hash);
export const view = signal<View>(first.view);
export const query = signal(first.query);
export const sort = signal<Sort>(first.sort);
export const columns = signal<string[]>(first.columns);
export const opened = signal<string | null>(first.opened);
export const plots = signal<SeriesState[][]>(first.plots);
export const span = signal(first.span);

export const isHelpOpen = signal(false);
export const notice = signal(""); // what just happened, for a moment
let noticeTimer = 0;

export function announce(text: string): void {
    notice.value = text;
    clearTimeout(noticeTimer);
    noticeTimer = window.setTimeout(() => {
        notice.value = "";
    }, 4000);
}

export function current(): State {
    return {
        view: view.value,
        query: query.value,
        sort: sort.value,
        columns: columns.value,
        opened: opened.value,
        plots: plots.value,
        span: span.value,
    };
}

function load(state: State): void {
    batch(() => {
        view.value = state.view;
        query.value = state.query;
        sort.value = state.sort;
        columns.value = state.columns;
        opened.value = state.opened;
        plots.value = state.plots;
        span.value = state.span;
    });
}

// The back button returns to another view or message; other changes replace the address.
export function keepAddress(): void {
    let known = `${view.value} ${opened.value}`;
    effect(() => {
        const hash = `#${encodeState(current())}`;
        const place = `${view.value} ${opened.value}`;
        if (hash !== location.hash) history[place === known ? "replaceState" : "pushState"](null, "", hash);
        known = place;
    });
    const follow = () => {
        const state = decodeState(location.hash);
        known = `${state.view} ${state.opened}`;
        load(state);
    };
    addEventListener("popstate", follow);
}

export function newSeries(topic: string, formula: string): SeriesState {
    return { topic, formula, axis: 0, scale: 1, offset: 0 };
}

// Adds to this plot, or to a new one.
export function plot(
    series: SeriesState,
    to: number | null = plots.value.length > 0 ? plots.value.length - 1 : null,
): void {
    const target = to === null ? undefined : plots.value[to];
    const isThere = target?.some((one) => one.topic === series.topic && one.formula === series.formula);
    if (isThere) return announce(`${series.formula} is in plot ${(to ?? 0) + 1} already`);
    if (target && target.length < MAX_SERIES) {
        plots.value = plots.value.map((all, i) => (i === to ? [...all, series] : all));
        return announce(`${series.formula} added to plot ${(to ?? 0) + 1}`);
    }
    if (plots.value.length === MAX_PLOTS) return announce(`there are ${MAX_PLOTS} plots already: remove one first`);
    plots.value = [...plots.value, [series]];
    announce(`${series.formula} added to plot ${plots.value.length}`);
}
