// SPDX-License-Identifier: MIT
// Records what plots show, for as long as they show it, in hidden tabs too. Two series with the same formula over the
// same topic share a recorder.
import { effect, signal } from "@preact/signals";
import { bump } from "../ui/ticker";
import { channels, channelsVersion, isLive, want } from "../wire/connection";
import { FormulaError, parseFormula } from "./formula";
import { Evaluator, Points, unitOf } from "./series";
import { plots } from "./state";
import type { SeriesState } from "./url";
import type { Schema } from "../wire/schema";

export const recordersVersion = signal(0);

const schemaOf = (topic: string): Schema | null => channels.get(topic)?.schema ?? null;

class Recorder {
    readonly points = new Points();
    fault: FormulaError | null = null;
    unit = "";
    total = 0;
    arrivedMs = 0;
    private evaluator: Evaluator | null = null;
    private schemas: (Schema | null)[] = []; // those that were checked
    private stopWanting: (() => void)[] = [];

    constructor(
        private readonly topic: string,
        private readonly formula: string,
    ) {
        this.attempt(() => {
            const evaluator = new Evaluator(parseFormula(formula), topic);
            this.evaluator = evaluator;
            this.stopWanting = evaluator.topics.map((one) =>
                want(one, (data, timeUs) => this.take(evaluator, one, data, timeUs)),
            );
        });
        this.compile();
    }

    // Schemas are known when the server has the topics; another server may have other ones.
    compile(): void {
        const { evaluator } = this;
        const now = evaluator?.topics.map(schemaOf) ?? [];
        if (now.every((schema, i) => schema === this.schemas[i])) return;
        this.schemas = now;
        this.attempt(() => {
            evaluator?.check(schemaOf);
            this.unit = unitOf(this.formula, this.topic, schemaOf);
            this.fault = null;
        });
    }

    // A gap in the line.
    interrupt(): void {
        if (this.points.length > 0 && !Number.isNaN(this.points.latest)) this.points.add(this.points.latestTime, NaN);
    }

    stop(): void {
        for (const stop of this.stopWanting) stop();
    }

    private attempt(what: () => void): void {
        try {
            what();
        } catch (error) {
            this.fault = error instanceof FormulaError ? error : new FormulaError(String(error), 0);
        }
    }

    // A time that goes backwards is the beginning of other data.
    private take(evaluator: Evaluator, topic: string, data: DataView, timeUs: number): void {
        this.compile(); // the first message may come before the next frame
        const schema = schemaOf(topic);
        if (!schema || this.fault) return;
        const value = evaluator.take(topic, schema, data);
        if (value === null) return;
        const time = timeUs / 1e6;
        if (time < this.points.latestTime - 5) this.points.clear();
        this.points.add(Math.max(time, this.points.latestTime), value);
        ++this.total;
        this.arrivedMs = performance.now();
        bump(recordersVersion);
    }
}

const recorders = new Map<string, Recorder>();
export const keyOf = (series: SeriesState): string => `${series.topic} ${series.formula}`;

export const recorderOf = (series: SeriesState): Recorder | undefined => recorders.get(keyOf(series));

function update(wanted: SeriesState[]): void {
    const keys = new Set(wanted.map(keyOf));
    for (const [key, recorder] of recorders) {
        if (keys.has(key)) continue;
        recorder.stop();
        recorders.delete(key);
    }
    for (const series of wanted)
        if (!recorders.has(keyOf(series))) recorders.set(keyOf(series), new Recorder(series.topic, series.formula));
    bump(recordersVersion);
}

export function record(): void {
    effect(() => update(plots.value.flat()));
    effect(() => {
        channelsVersion.value;
        recorders.forEach((recorder) => recorder.compile());
    });
    effect(() => {
        if (!isLive.value) recorders.forEach((recorder) => recorder.interrupt());
    });
}
