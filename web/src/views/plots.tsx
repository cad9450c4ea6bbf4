// SPDX-License-Identifier: MIT
import { computed, signal, type Signal } from "@preact/signals";
import { useLayoutEffect, useRef } from "preact/hooks";
import type uPlot from "uplot";
import { seconds } from "../model/feeds";
import { keyOf, recorderOf, recordersVersion } from "../model/recorders";
import type { FormulaError } from "../model/formula";
import { checkFormula, topicOf } from "../model/series";
import { newSeries, opened, plot as addTo, plots, span } from "../model/state";
import { SPANS, type SeriesState } from "../model/url";
import { newPoints, pan, pause, pointsOf, resume, shownRange, standing, zoom } from "../model/window";
import { saveCsv, savePng } from "../ui/export";
import { count, shortNumber } from "../ui/format";
import { Icon } from "../ui/icon";
import { focusOn, useKeys } from "../ui/keys";
import { SERIES_COLOURS } from "../ui/theme";
import { channels, channelsVersion } from "../wire/connection";
import { Chart, cursorTime, valueAt } from "./chart";
import { Message, SERIES_TYPE } from "./message";

// ---- changes

function change(at: number, index: number, by: Partial<SeriesState> | null): void {
    plots.value = plots.value.flatMap((all, i) => {
        if (i !== at) return [all];
        const next = all.flatMap((one, j) => (j !== index ? [one] : by ? [{ ...one, ...by }] : []));
        return next.length > 0 ? [next] : [];
    });
}

// A field that was dragged into plot `to`, or into a new one.
export function takeDrop(event: DragEvent, to: number | null): void {
    const text = event.dataTransfer?.getData(SERIES_TYPE);
    if (!text) return;
    event.preventDefault();
    const { topic, formula } = JSON.parse(text) as SeriesState;
    addTo(newSeries(String(topic), String(formula)), to);
}

// ---- the form for formulas

const topic = signal("");
const formula = signal("");
const target = signal("new");
const topics = computed(() => {
    channelsVersion.value;
    return [...channels.values()]
        .filter((channel) => channel.schema)
        .map((channel) => channel.topic)
        .sort();
});
const fault = computed(() => {
    channelsVersion.value;
    if (formula.value === "") return null;
    return checkFormula(formula.value, topic.value, (one) => channels.get(one)?.schema);
});
const own = computed(() => topicOf(formula.value, topic.value));

function submit(event: Event): void {
    event.preventDefault();
    if (own.value === "" || formula.value === "" || fault.value) return;
    addTo(newSeries(own.value, formula.value), target.value === "new" ? null : Number(target.value));
    formula.value = "";
}

// Where a formula is wrong, and why.
function Fault({ text, found, id }: { text: string; found: FormulaError | null; id?: string }) {
    if (!found) return null;
    return (
        <p class="fault" role="alert" id={id}>
            <code>
                {text.slice(0, found.at)}
                <mark>{text.slice(found.at, found.at + 1) || " "}</mark>
                {text.slice(found.at + 1)}
            </code>
            <span>
                at {found.at + 1}: {found.message}
            </span>
        </p>
    );
}

const typedInto =
    (into: Signal<string>) =>
    (event: { currentTarget: { value: string } }): void => {
        into.value = event.currentTarget.value;
    };

// Starts with the topic of the open message.
function suggestTopic(): void {
    if (topic.value === "" && formula.value === "") topic.value = opened.value ?? "";
}

const TopicBox = () => (
    <label>
        Topic
        <input
            id="topic"
            list="topics"
            class="mono"
            placeholder="/1/1/VFR_HUD"
            value={topic.value}
            autocomplete="off"
            spellcheck={false}
            onFocus={suggestTopic}
            onInput={typedInto(topic)}
        />
        <datalist id="topics">
            {topics.value.slice(0, 500).map((one) => (
                <option key={one} value={one} />
            ))}
        </datalist>
    </label>
);

const FormulaBox = () => (
    <label class="grow">
        Formula
        <input
            id="formula"
            class="mono"
            placeholder="sqrt(vx^2 + vy^2) / 100"
            value={formula.value}
            autocomplete="off"
            spellcheck={false}
            aria-invalid={fault.value !== null}
            aria-describedby="fault"
            title="Fields of another topic have its name before them: /2/1/VFR_HUD.alt"
            onFocus={suggestTopic}
            onInput={typedInto(formula)}
        />
    </label>
);

const TargetBox = () => (
    <label>
        Into
        <select value={target.value} onChange={typedInto(target)}>
            <option value="new">a new plot</option>
            {plots.value.map((_, i) => (
                <option key={i} value={i}>
                    plot {i + 1}
                </option>
            ))}
        </select>
    </label>
);

function Form() {
    const isUnknown = topic.value !== "" && !channels.has(topic.value);
    return (
        <form class="formula" onSubmit={submit}>
            <TopicBox />
            <FormulaBox />
            <TargetBox />
            <button type="submit" disabled={own.value === "" || formula.value === "" || fault.value !== null}>
                Plot
            </button>
            {isUnknown && formula.value !== "" && (
                <p class="fault warning">No {topic.value} has come yet: the plot waits for it.</p>
            )}
            <Fault text={formula.value} found={fault.value} id="fault" />
        </form>
    );
}

// ---- above the plots

function Bar() {
    recordersVersion.value;
    const stands = standing.value !== null;
    return (
        <div class="toolbar">
            <button aria-pressed={stands} onClick={() => (stands ? resume() : pause())} title="Stop or follow (space)">
                <Icon name={stands ? "play" : "pause"} />
                {stands ? "Follow" : "Pause"}
            </button>
            <label>
                Last{" "}
                <select
                    value={span.value}
                    onChange={(event) => {
                        span.value = Number(event.currentTarget.value);
                        resume();
                    }}>
                    {SPANS.map((one) => (
                        <option key={one} value={one}>
                            {one < 60 ? `${one} s` : `${one / 60} min`}
                        </option>
                    ))}
                </select>
            </label>
            <span class="group">
                <button onClick={() => zoom(0.5)} aria-label="Zoom in" title="Zoom in (+)">
                    +
                </button>
                <button onClick={() => zoom(2)} aria-label="Zoom out" title="Zoom out (−)">
                    −
                </button>
            </span>
            <span class="summary dim number">{stands && `stands still · ${count(newPoints())} new points`}</span>
        </div>
    );
}

// ---- one plot

function extremes(series: SeriesState): [number, number] {
    const [, values] = pointsOf(series, shownRange());
    let least = Infinity,
        most = -Infinity;
    for (const value of values) {
        if (value < least) least = value;
        if (value > most) most = value;
    }
    const ends = [least * series.scale + series.offset, most * series.scale + series.offset];
    return [Math.min(...ends), Math.max(...ends)] as [number, number];
}

function NumberBox({ label, value, onValue }: { label: string; value: number; onValue: (value: number) => void }) {
    return (
        <input
            type="number"
            step="any"
            aria-label={label}
            title={label}
            value={value}
            onChange={(event) => {
                onValue(Number(event.currentTarget.value) || (label === "Scale" ? 1 : 0));
            }}
        />
    );
}

function Values({ series }: { series: SeriesState }) {
    recordersVersion.value;
    const recorder = recorderOf(series);
    const waits = recorder !== undefined && recorder.total === 0;
    if (recorder?.fault || waits)
        return (
            <td class={recorder?.fault ? "error" : "dim"} colSpan={4}>
                {recorder?.fault ? "wrong formula" : "waits for its first message"}
            </td>
        );
    const [least, most] = extremes(series);
    return (
        <>
            <td class="number mono strong">{shortNumber(valueAt(series, cursorTime))}</td>
            <td class="dim">{series.scale === 1 ? recorder?.unit : ""}</td>
            <td class="number mono dim">{shortNumber(least)}</td>
            <td class="number mono dim">{shortNumber(most)}</td>
        </>
    );
}

type Set = (by: Partial<SeriesState> | null) => void;

function Settings({ series, set }: { series: SeriesState; set: Set }) {
    const isRight = series.axis === 1;
    const label = `Axis of ${series.formula}: ${isRight ? "right" : "left"}`;
    return (
        <>
            <td>
                <button class="axis" aria-label={label} title={label} onClick={() => set({ axis: isRight ? 0 : 1 })}>
                    {isRight ? "right" : "left"}
                </button>
            </td>
            <td>
                <NumberBox label="Scale" value={series.scale} onValue={(scale) => set({ scale })} />
            </td>
            <td>
                <NumberBox label="Offset" value={series.offset} onValue={(offset) => set({ offset })} />
            </td>
            <td>
                <button class="quiet" aria-label={`Remove ${series.formula}`} title="Remove" onClick={() => set(null)}>
                    <Icon name="close" />
                </button>
            </td>
        </>
    );
}

function Line({ series, at, index }: { series: SeriesState; at: number; index: number }) {
    const found = recorderOf(series)?.fault ?? null;
    const line = (
        <tr>
            <td>
                <i class={`swatch s${index % SERIES_COLOURS} d${Math.floor(index / 2) % 4}`} />
            </td>
            <th scope="row" class="mono">
                <span class="cut" title={`${series.formula} of ${series.topic}`}>
                    {series.formula}{" "}
                    {!series.formula.includes(series.topic) && <span class="dim">{series.topic}</span>}
                </span>
            </th>
            <Values series={series} />
            <Settings series={series} set={(by) => change(at, index, by)} />
        </tr>
    );
    if (!found) return line;
    return (
        <>
            {line}
            <tr class="wrong">
                <td />
                <td colSpan={9}>
                    <Fault text={series.formula} found={found} />
                </td>
            </tr>
        </>
    );
}

function Legend({ plot, at }: { plot: SeriesState[]; at: number }) {
    recordersVersion.value;
    return (
        <table class="legend">
            <caption class="hidden">Series of plot {at + 1}</caption>
            <thead>
                <tr>
                    <td />
                    <th scope="col">Series</th>
                    <th scope="col" class="number">
                        {cursorTime.value === null ? "Latest" : "Pointer"}
                    </th>
                    <td />
                    <th scope="col" class="number">
                        Least
                    </th>
                    <th scope="col" class="number">
                        Most
                    </th>
                    <th scope="col">Axis</th>
                    <th scope="col">Scale</th>
                    <th scope="col">Offset</th>
                    <td />
                </tr>
            </thead>
            <tbody>
                {plot.map((series, i) => (
                    <Line key={keyOf(series)} series={series} at={at} index={i} />
                ))}
            </tbody>
        </table>
    );
}

interface Buttons {
    at: number;
    plot: SeriesState[];
    savePicture: () => void;
}

function PlotHead({ at, plot, savePicture }: Buttons) {
    const remove = () => {
        plots.value = plots.value.filter((_, i) => i !== at);
    };
    return (
        <header>
            <h3>Plot {at + 1}</h3>
            <span class="group end">
                <button onClick={() => saveCsv(plot)} title="Save what is shown as CSV">
                    CSV
                </button>
                <button onClick={savePicture} title="Save the picture">
                    PNG
                </button>
                <button class="quiet" onClick={remove} aria-label={`Remove plot ${at + 1}`} title="Remove the plot">
                    <Icon name="close" />
                </button>
            </span>
        </header>
    );
}

function Plot({ plot, at }: { plot: SeriesState[]; at: number }) {
    const chart = useRef<uPlot | null>(null);
    const keep = (made: uPlot | null) => {
        chart.current = made;
    };
    const savePicture = () => {
        if (chart.current) savePng(chart.current.ctx.canvas, plot);
    };
    return (
        <section
            class="panel plot"
            aria-label={`Plot ${at + 1}`}
            onDragOver={(event) => event.preventDefault()}
            onDrop={(event) => takeDrop(event, at)}>
            <PlotHead at={at} plot={plot} savePicture={savePicture} />
            <Chart plot={plot} onChart={keep} />
            <Legend plot={plot} at={at} />
        </section>
    );
}

function Empty() {
    return (
        <div class="empty start">
            <Icon name="plot" />
            <p>
                Open a message under <b>Messages</b> and click a number, or type a formula above.
            </p>
        </div>
    );
}

const keys = {
    " ": () => (standing.value ? resume() : pause()),
    "+": () => zoom(0.5),
    "=": () => zoom(0.5),
    "-": () => zoom(2),
    ArrowLeft: () => pan(-0.25),
    ArrowRight: () => pan(0.25),
    "0": resume,
    a: () => focusOn("#formula"),
};

export function Plots() {
    useLayoutEffect(() => useKeys(keys), []);
    seconds.value;
    const showsMessage = opened.value !== null;
    return (
        <>
            <h2 class="hidden">Plots</h2>
            <div
                class="list"
                onDragOver={(event) => event.preventDefault()}
                onDrop={(event) => {
                    if (!event.defaultPrevented) takeDrop(event, null);
                }}>
                <Bar />
                <Form />
                <div class="scroller" tabIndex={-1}>
                    {plots.value.length === 0 ? (
                        <Empty />
                    ) : (
                        plots.value.map((plot, i) => <Plot key={i} plot={plot} at={i} />)
                    )}
                </div>
            </div>
            {showsMessage && <Message hz={null} />}
        </>
    );
}
