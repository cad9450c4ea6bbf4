// SPDX-License-Identifier: MIT
// Values in units that people read: degE7 as degrees, mV as volts.
import { fixed, shortNumber } from "./format";

const UNITS: Record<string, [factor: number, unit: string, decimals: number]> = {
    degE7: [1e-7, "°", 7],
    cdeg: [0.01, "°", 2],
    rad: [180 / Math.PI, "°", 2],
    "rad/s": [180 / Math.PI, "°/s", 2],
    mm: [0.001, "m", 3],
    cm: [0.01, "m", 2],
    "cm/s": [0.01, "m/s", 2],
    "mm/s": [0.001, "m/s", 3],
    mV: [0.001, "V", 3],
    cV: [0.01, "V", 2],
    cA: [0.01, "A", 2],
    mA: [0.001, "A", 3],
    cdegC: [0.01, "°C", 2],
    "c%": [0.01, "%", 2],
    "d%": [0.1, "%", 1],
};

const twoDigits = (value: number): string => String(Math.floor(value)).padStart(2, "0");

const age = (seconds: number): string =>
    `${Math.floor(seconds / 3600)}:${twoDigits((seconds / 60) % 60)}:${twoDigits(seconds % 60)}`;

// Times since the start of a system are shown as hours; large ones are dates.
function time(seconds: number): string {
    return seconds > 1e9 ? new Date(seconds * 1000).toISOString().slice(0, 19).replace("T", " ") : age(seconds);
}

export function converted(value: number | bigint, unit: string): string {
    const number = Number(value);
    if (!Number.isFinite(number)) return "";
    if (unit === "us" && number >= 1e6) return time(number / 1e6);
    if (unit === "ms" && number >= 10_000) return time(number / 1e3);
    const known = UNITS[unit];
    if (!known) return "";
    const [factor, name, decimals] = known;
    const text = Math.abs(number * factor) >= 1e6 ? shortNumber(number * factor) : fixed(number * factor, decimals);
    return `${text}${name.startsWith("°") && name !== "°C" && name !== "°/s" ? "" : " "}${name}`;
}
