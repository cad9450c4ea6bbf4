// SPDX-License-Identifier: MIT
// Plots as files: what they show, as CSV and as PNG.
import type { SeriesState } from "../model/url";
import { pointsOf, shownRange } from "../model/window";
import { colour, SERIES_COLOURS } from "./theme";

function save(name: string, data: Blob): void {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(data);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

const fileName = (ending: string): string =>
    `mavloom-${new Date().toISOString().slice(0, 19).replace("T", "-").replaceAll(":", "")}.${ending}`;

const quoted = (text: string): string => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

function label({ topic, formula, scale, offset }: SeriesState): string {
    const scaledBy = scale === 1 ? "" : ` * ${scale}`;
    return `${topic} ${formula}${scaledBy}${offset === 0 ? "" : ` + ${offset}`}`;
}

// A line for each time at which a series has a point. Cells of the others are empty.
function csvOf(plot: SeriesState[]): string {
    const lines = new Map<number, string[]>();
    const range = shownRange();
    plot.forEach((series, column) => {
        const [times, values] = pointsOf(series, range);
        for (let i = 0; i < times.length; ++i) {
            const time = times[i] as number,
                value = values[i] as number;
            if (time < range.from || time > range.to || Number.isNaN(value)) continue;
            const line = lines.get(time) ?? plot.map(() => "");
            line[column] = String(value * series.scale + series.offset);
            lines.set(time, line);
        }
    });
    const sorted = [...lines].sort(([a], [b]) => a - b).map(([time, cells]) => [time.toFixed(6), ...cells].join(","));
    return [["time_s", ...plot.map((series) => quoted(label(series)))].join(","), ...sorted, ""].join("\n");
}

export const saveCsv = (plot: SeriesState[]): void =>
    save(fileName("csv"), new Blob([csvOf(plot)], { type: "text/csv" }));

// The chart with its background and a line of names.
export function savePng(chart: HTMLCanvasElement, plot: SeriesState[]): void {
    const ratio = devicePixelRatio || 1,
        head = 24 * ratio;
    const canvas = document.createElement("canvas");
    canvas.width = chart.width;
    canvas.height = chart.height + head;
    const context = canvas.getContext("2d");
    if (!context) return;
    context.fillStyle = colour("panel");
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.drawImage(chart, 0, head);
    context.font = `${12 * ratio}px system-ui, sans-serif`;
    context.textBaseline = "middle";
    let x = 12 * ratio;
    plot.forEach((series, i) => {
        context.fillStyle = colour(`series-${i % SERIES_COLOURS}`);
        context.fillText(label(series), x, head / 2);
        x += context.measureText(label(series)).width + 24 * ratio;
    });
    canvas.toBlob((data) => {
        if (data) save(fileName("png"), data);
    });
}
