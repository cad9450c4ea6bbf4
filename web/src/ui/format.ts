// SPDX-License-Identifier: MIT
// Numbers as text, with the same number of decimals down a column.

export const NOTHING = "–";
const grouped = new Intl.NumberFormat("en-US"),
    rates = new Intl.NumberFormat("en-US", { minimumFractionDigits: 1, maximumFractionDigits: 1 });

export const count = (value: number | null | undefined): string => (value == null ? NOTHING : grouped.format(value));

export function fixed(value: number | null | undefined, decimals: number): string {
    if (value == null || !Number.isFinite(value)) return NOTHING;
    return value.toFixed(decimals).replace(/^-(?=[0.]*$)/, ""); // no -0.0
}

export function hertz(value: number | null | undefined): string {
    if (value == null) return NOTHING;
    if (value >= 1000) return rates.format(value);
    return value > 0 && value < 0.05 ? "<0.1" : value.toFixed(1);
}

export function bytes(value: number | null | undefined): string {
    if (value == null) return NOTHING;
    const units = ["B", "kB", "MB", "GB", "TB"];
    let unit = 0;
    while (value >= 1000 && unit < units.length - 1) {
        value /= 1000;
        ++unit;
    }
    return `${unit === 0 ? value : value.toFixed(value < 100 ? 1 : 0)} ${units[unit]}`;
}

export function duration(seconds: number | null | undefined): string {
    if (seconds == null || !Number.isFinite(seconds)) return NOTHING;
    if (seconds < 1) return "<1 s";
    if (seconds < 120) return `${Math.floor(seconds)} s`;
    if (seconds < 7200) return `${Math.floor(seconds / 60)} min`;
    return seconds < 172_800 ? `${Math.floor(seconds / 3600)} h` : `${Math.floor(seconds / 86_400)} d`;
}

const twoDigits = (value: number): string => String(value).padStart(2, "0");

export function clock(us: number): string {
    const date = new Date(us / 1000);
    return [date.getHours(), date.getMinutes(), date.getSeconds()].map(twoDigits).join(":");
}

// A number of a message: as many digits as a float32 has, without a tail of them.
export function value(raw: number | bigint | string, isFloat: boolean): string {
    if (typeof raw === "string") return raw;
    if (!isFloat || typeof raw === "bigint") return raw.toString();
    if (!Number.isFinite(raw)) return Number.isNaN(raw) ? "NaN" : raw > 0 ? "∞" : "−∞";
    const size = Math.abs(raw);
    if (raw !== 0 && (size >= 1e7 || size < 1e-6)) return raw.toExponential(4);
    return raw.toFixed(size >= 1000 ? 2 : size >= 100 ? 3 : size >= 10 ? 4 : 5);
}

export function shortNumber(raw: number): string {
    const size = Math.abs(raw);
    if (!Number.isFinite(raw)) return NOTHING;
    if (raw !== 0 && (size >= 1e7 || size < 1e-4)) return raw.toExponential(2);
    return raw.toFixed(size >= 1000 ? 1 : size >= 100 ? 2 : size >= 1 ? 3 : 4);
}

const NAMES: Record<string, string> = {
    px4: "PX4",
    ardupilotmega: "ArduPilot",
    gcs: "Ground station",
    adsb: "ADS-B",
    vtol: "VTOL",
    generic: "Generic autopilot",
};

// MAV_TYPE_QUADROTOR as "Quadrotor".
export function words(entry: string | null | undefined, prefix: string): string {
    if (entry == null) return NOTHING;
    const text = entry
        .replace(new RegExp(`^${prefix}`), "")
        .replaceAll("_", " ")
        .toLowerCase();
    return NAMES[text] ?? text.charAt(0).toUpperCase() + text.slice(1);
}
