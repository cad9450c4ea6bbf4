// SPDX-License-Identifier: MIT
// The whole state of the page as text, for the part of the address after '#'. Usual values are left out.

export type View = "overview" | "messages" | "plots";
const VIEWS: View[] = ["overview", "messages", "plots"];

export interface Sort {
    column: string;
    isDown: boolean;
}

export interface SeriesState {
    topic: string;
    formula: string;
    axis: 0 | 1;
    scale: number;
    offset: number;
}

export interface State {
    view: View;
    query: string;
    sort: Sort;
    columns: string[];
    opened: string | null; // a topic
    plots: SeriesState[][];
    span: number; // seconds that plots show
}

export const COLUMNS = ["link", "source", "name", "id", "hz", "count", "bytes", "share", "gaps", "jitter", "age"];
const USUAL_COLUMNS = ["source", "name", "hz", "count", "share", "jitter", "age"];
export const SPANS = [10, 30, 60, 300, 900];
export const MAX_PLOTS = 8,
    MAX_SERIES = 8;

export function usualState(): State {
    return {
        view: "overview",
        query: "",
        sort: { column: "source", isDown: false },
        columns: [...USUAL_COLUMNS],
        opened: null,
        plots: [],
        span: 60,
    };
}

// Slashes and commas may stay: they make the address readable.
const encode = (text: string): string =>
    encodeURIComponent(text)
        .replace(/[~!']/g, (c) => `%${c.charCodeAt(0).toString(16).toUpperCase()}`)
        .replaceAll("%2F", "/")
        .replaceAll("%2C", ",");

function decoded(text: string): string {
    try {
        return decodeURIComponent(text);
    } catch {
        return "";
    }
}

function seriesText(series: SeriesState): string {
    const parts = [
        encode(series.topic),
        encode(series.formula),
        String(series.axis),
        String(series.scale),
        String(series.offset),
    ];
    const usual = ["", "", "0", "1", "0"];
    while (parts.length > 2 && parts.at(-1) === usual[parts.length - 1]) parts.pop();
    return parts.join("~");
}

const finite = (text: string | undefined, otherwise: number): number =>
    text !== undefined && text !== "" && Number.isFinite(Number(text)) ? Number(text) : otherwise;

function seriesOf(text: string): SeriesState[] {
    const [first = "", second = "", axis, scale, offset] = text.split("~");
    const topic = decoded(first),
        formula = decoded(second);
    if (topic === "" || formula === "") return [];
    return [
        {
            topic,
            formula,
            axis: axis === "1" ? 1 : 0,
            scale: finite(scale, 1),
            offset: finite(offset, 0),
        },
    ];
}

export function encodeState(state: State): string {
    const usual = usualState();
    const parts: string[] = [];
    const add = (key: string, value: string, otherwise: string) => {
        if (value !== otherwise) parts.push(`${key}=${value}`);
    };
    add("q", encode(state.query), "");
    add("sort", `${state.sort.isDown ? "-" : ""}${state.sort.column}`, usual.sort.column);
    add("cols", state.columns.join(","), usual.columns.join(","));
    add("open", encode(state.opened ?? ""), "");
    add("span", String(state.span), String(usual.span));
    for (const plot of state.plots) parts.push(`plot=${plot.map(seriesText).join("!")}`);
    return state.view + (parts.length > 0 ? `?${parts.join("&")}` : "");
}

function addPlot(state: State, plot: SeriesState[]): void {
    if (plot.length > 0) state.plots.push(plot);
}

function take(state: State, key: string, value: string): void {
    if (key === "q") state.query = decoded(value);
    if (key === "open") state.opened = decoded(value) || null;
    if (key === "span" && SPANS.includes(Number(value))) state.span = Number(value);
    if (key === "cols")
        state.columns = COLUMNS.filter((column) => column === "name" || value.split(",").includes(column));
    if (key === "plot" && state.plots.length < MAX_PLOTS)
        addPlot(state, value.split("!").flatMap(seriesOf).slice(0, MAX_SERIES));
    if (key !== "sort") return;
    const column = value.replace(/^-/, "");
    if (COLUMNS.includes(column)) state.sort = { column, isDown: value.startsWith("-") };
}

// Parts that are wrong are left out.
export function decodeState(hash: string): State {
    const state = usualState();
    const [view = "", rest = ""] = hash.replace(/^#/, "").split("?", 2);
    if (VIEWS.includes(view as View)) state.view = view as View;
    for (const part of rest.split("&")) {
        const at = part.indexOf("=");
        if (at > 0) take(state, part.slice(0, at), part.slice(at + 1));
    }
    return state;
}
