// SPDX-License-Identifier: MIT
// What the server observes: vehicles, hops with their losses, alarms, and the traffic of each topic.
import { signal } from "@preact/signals";
import { Feed, serverNow, setServerTime } from "./feeds";

export interface RoundTrip {
    last: number;
    least: number;
    mean: number;
    count: number;
}
export interface Vehicle {
    sys: number;
    comp: number;
    type: string | null;
    autopilot: string | null;
    mode: string | null;
    armed: boolean | null;
    status: string | null;
    age_s: number | null;
    silent: boolean;
    hz: number | null;
    battery: { percent: number | null; voltage_v: number | null; current_a: number | null } | null;
    gps: { fix: string | null; satellites: number | null } | null;
    position: {
        lat_deg: number | null;
        lon_deg: number | null;
        alt_m: number | null;
        relative_alt_m: number | null;
        heading_deg: number | null;
        ground_speed_m_s: number | null;
    } | null;
    round_trip_ms: { timesync: RoundTrip | null; ping: RoundTrip | null; command: RoundTrip | null } | null;
}
export interface Loss {
    name: string;
    count: number;
    help?: string;
}
export interface Link {
    name: string;
    state: "up" | "down" | "ended";
    frames_in: number;
    frames_out: number;
    bytes_in: number;
    bytes_out: number;
    hz_in: number | null;
    hz_out: number | null;
    losses: Loss[];
}
export interface Hop {
    name: string;
    kind: string;
    state: string;
    hz_in: number | null;
    hz_out: number | null;
    frames_in: number;
    frames_out: number;
    losses: Loss[];
    links: Link[];
    hint?: string | null;
}
export interface Alarm {
    id: number | string;
    kind: string;
    severity: "error" | "warning" | "info";
    link: string | null;
    sys: number | null;
    comp: number | null;
    text: string;
    since_us: number;
    ended_us: number | null;
}
export interface Row {
    key: string;
    topic: string;
    link: string | null;
    sys: number;
    comp: number;
    id: number;
    name: string;
    instance: number | string | null;
    count: number;
    hz: number;
    bytes: number;
    share: number;
    gap_min_ms: number | null;
    gap_max_ms: number | null;
    jitter_ms: number | null;
    age_s: number | null;
    silent_after_s: number | null; // null: silence is no news
    seenAt: number; // server's time, s
    newAt: number; // since when the page knows it; 0: from the beginning
}

export const vehicles = signal<Vehicle[]>([]);
export const hops = signal<Hop[]>([]);
export const alarms = signal<Alarm[]>([]);
export const alarmsLeftOut = signal(0); // that have left for lack of room
export const rows = new Map<string, Row>();

// ---- vehicles and alarms

export const vehicleFeed = new Feed("vehicles", (object: { time_us: number; vehicles: Vehicle[] }) => {
    setServerTime(object.time_us);
    vehicles.value = object.vehicles;
});

export const alarmFeed = new Feed("alarms", (object: { time_us: number; alarms: Alarm[]; left_out: number }) => {
    setServerTime(object.time_us);
    alarms.value = object.alarms;
    alarmsLeftOut.value = object.left_out;
});

export const vehicleId = (one: { sys: number; comp: number }): string => `${one.sys}/${one.comp}`;

export function alarmsOf(vehicle: Vehicle): Alarm[] {
    return alarms.value.filter(
        (alarm) =>
            alarm.ended_us === null &&
            alarm.sys === vehicle.sys &&
            (alarm.comp === null || alarm.comp === vehicle.comp),
    );
}

// Autopilots are vehicles; ground stations, cameras and others are not.
export const isVehicle = (one: Vehicle): boolean =>
    one.autopilot !== null && one.autopilot !== "MAV_AUTOPILOT_INVALID" && one.type !== "MAV_TYPE_GCS";

// ---- hops

const HISTORY = 120; // one each half second
interface History {
    rates: number[];
    lost: { at: number; total: number }[];
}
export const histories = new Map<string, History>();

const lossesOf = (hop: Hop): Loss[] => [hop, ...hop.links].flatMap((one) => one.losses);
export const lossOf = (hop: Hop): number => lossesOf(hop).reduce((sum, loss) => sum + loss.count, 0);

// Faults also send on what they damage.
const DAMAGES = ["fault_corrupted", "fault_cut"];
export const isDamaged = (hop: Hop): boolean =>
    lossesOf(hop).some((loss) => loss.count > 0 && DAMAGES.includes(loss.name));

function remember(hop: Hop): void {
    const history = histories.get(hop.name) ?? { rates: [], lost: [] };
    histories.set(hop.name, history);
    history.rates.push(Math.max(hop.hz_in ?? 0, hop.hz_out ?? 0));
    history.lost.push({ at: performance.now() / 1000, total: lossOf(hop) });
    if (history.rates.length > HISTORY) history.rates.shift();
    if (history.lost.length > HISTORY) history.lost.shift();
}

// Frames lost in the last ten seconds, or in those that the page has seen, if it was opened or was hidden since.
export function lostLately(hop: Hop): { count: number; seconds: number } {
    const now = performance.now() / 1000;
    const before = histories.get(hop.name)?.lost.find((one) => one.at >= now - 10);
    if (!before) return { count: 0, seconds: 0 };
    return { count: Math.max(0, lossOf(hop) - before.total), seconds: Math.round(now - before.at) };
}

export const linkFeed = new Feed("links", (object: { time_us: number; hops: Hop[] }) => {
    setServerTime(object.time_us);
    hops.value = object.hops;
    object.hops.forEach(remember);
});

// Texts for people: which messages are missing, and what to do.
export const hints = (): string[] => hops.value.flatMap((hop) => hop.hint ?? []);

// ---- traffic

type Wire = Omit<Row, "key" | "seenAt" | "newAt">;
let wholeUs = 0; // when the whole state began to come, in several objects
const WHOLE_US = 400_000;

const MAX_ROWS = 20_000,
    OLD_S = 60;

function takeRow(row: Wire, nowUs: number): void {
    const key = `${row.link ?? ""} ${row.topic}`;
    const newAt = rows.get(key)?.newAt ?? (nowUs < wholeUs + WHOLE_US ? 0 : nowUs / 1e6);
    rows.set(key, { ...row, key, seenAt: nowUs / 1e6 - (row.age_s ?? 0), newAt });
}

// Senders may be invented.
function dropOld(): void {
    if (rows.size <= MAX_ROWS) return;
    for (const row of rows.values()) if (ageOf(row) > OLD_S) rows.delete(row.key);
}

export const trafficFeed = new Feed("traffic", (object: { time_us: number; rows: Wire[] }, isFirst: boolean) => {
    setServerTime(object.time_us);
    if (isFirst) {
        rows.clear();
        wholeUs = object.time_us;
    }
    for (const row of object.rows) takeRow(row, object.time_us);
    dropOld();
});

export const ageOf = (row: Row): number => Math.max(0, serverNow() - row.seenAt);

export const isSilent = (row: Row, age = ageOf(row)): boolean =>
    row.silent_after_s != null && age > row.silent_after_s;

// The server reports a row only when it changes, so the rate of one that fell silent is its last.
export function rateOf(row: Row, age = ageOf(row)): number {
    if (isSilent(row, age)) return 0;
    return age > 1.5 && age * row.hz > 3 ? 1 / age : row.hz;
}
