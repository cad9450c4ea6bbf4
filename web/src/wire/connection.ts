// SPDX-License-Identifier: MIT
// The Foxglove WebSocket protocol to the server of this page. Connects again by itself, with growing pauses. Wanted
// topics are subscribed as soon as the server has them, and again after each new connection.
import { batch, signal } from "@preact/signals";
import { bump } from "../ui/ticker";
import { parseSchema, type Schema } from "./schema";

export interface Channel {
    id: number;
    topic: string;
    encoding: string;
    schema: Schema | null; // null: a type that is not MAVLink's
}

export type Handler = (data: DataView, timeUs: number) => void;

interface Advertised {
    id: number;
    topic: string;
    encoding: string;
    schemaName: string;
    schema: string;
}

const MAVLINK = "mavlink/msg/";
const FIRST_PAUSE_MS = 500,
    LONGEST_PAUSE_MS = 10_000;
const SILENT_MS = 10_000;
const OPENING_MS = 8_000; // for a connection that neither opens nor fails

export const isLive = signal(false);
export const retryAt = signal<number | null>(null); // by Date.now()
export const lostAt = signal<number | null>(null);
export const serverName = signal("");
export const slowness = signal(""); // what the server dropped because this page reads too slowly; empty: nothing
export const channelsVersion = signal(0);
export const channels = new Map<string, Channel>();

const schemas = new Map<string, Schema>();
const byId = new Map<number, string>();
const handlers = new Map<string, Set<Handler>>();
const onOpen = new Set<() => void>();
let socket: WebSocket | null = null;
let pauseMs = FIRST_PAUSE_MS;
let timer = 0;
let heardAt = 0; // by performance.now()

function schemaOf(channel: Advertised): Schema | null {
    if (!channel.schemaName.startsWith(MAVLINK)) return null;
    const known = schemas.get(channel.schemaName);
    if (known) return known;
    const schema = parseSchema(channel.schema);
    schemas.set(channel.schemaName, schema);
    return schema;
}

function send(message: object): void {
    if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
}

// The id of a subscription is its channel's.
function subscribe(topics: string[]): void {
    const ids = topics.flatMap((topic) => channels.get(topic)?.id ?? []);
    if (ids.length > 0) send({ op: "subscribe", subscriptions: ids.map((id) => ({ id, channelId: id })) });
}

function unsubscribe(topic: string): void {
    const channel = channels.get(topic);
    if (channel) send({ op: "unsubscribe", subscriptionIds: [channel.id] });
}

function advertise(all: Advertised[]): void {
    for (const one of all) {
        channels.set(one.topic, { id: one.id, topic: one.topic, encoding: one.encoding, schema: schemaOf(one) });
        byId.set(one.id, one.topic);
    }
    subscribe(all.map((one) => one.topic).filter((topic) => handlers.has(topic)));
    bump(channelsVersion);
}

// Their subscriptions have ended. Ids are never used again.
function forget(ids: number[]): void {
    for (const id of ids) {
        const topic = byId.get(id);
        if (topic !== undefined && channels.get(topic)?.id === id) channels.delete(topic);
        byId.delete(id);
    }
    bump(channelsVersion);
}

interface FromServer {
    op: string;
    channels?: Advertised[];
    channelIds?: number[];
    name?: string;
    id?: string;
    message?: string;
}

function takeText(text: string): void {
    const message = JSON.parse(text) as FromServer;
    if (message.op === "advertise") advertise(message.channels ?? []);
    else if (message.op === "unadvertise") forget(message.channelIds ?? []);
    else if (message.op === "serverInfo") serverName.value = message.name ?? "";
    else if (message.op === "status" && message.id === "drops") slowness.value = message.message ?? "";
    else if (message.op === "status") console.warn(message.message);
}

function takeData(buffer: ArrayBuffer): void {
    const data = new DataView(buffer);
    if (data.byteLength < 13 || data.getUint8(0) !== 1) return;
    const of = handlers.get(byId.get(data.getUint32(1, true)) ?? "");
    const timeUs = Number(data.getBigUint64(5, true) / 1000n);
    const payload = new DataView(buffer, 13);
    of?.forEach((handler) => handler(payload, timeUs));
}

function opened(): void {
    heardAt = performance.now();
    pauseMs = FIRST_PAUSE_MS;
    batch(() => {
        isLive.value = true;
        retryAt.value = lostAt.value = null;
    });
    for (const call of onOpen) call();
}

function closed(): void {
    clearTimeout(timer);
    socket = null;
    channels.clear();
    byId.clear();
    schemas.clear(); // the next server may have other definitions
    batch(() => {
        if (isLive.value || lostAt.value === null) lostAt.value = Date.now();
        isLive.value = false;
        retryAt.value = Date.now() + pauseMs;
        slowness.value = "";
    });
    timer = window.setTimeout(connect, pauseMs);
    pauseMs = Math.min(LONGEST_PAUSE_MS, pauseMs * 1.6);
}

// A connection may end without a sign, while the computer sleeps or a cable is out. Reports come twice a second.
export function watch(): void {
    document.addEventListener("visibilitychange", () => {
        heardAt = performance.now();
    });
    setInterval(() => {
        if (!isLive.value || document.hidden || performance.now() - heardAt < SILENT_MS) return;
        const old = socket;
        closed();
        old?.close();
    }, 1000);
}

export function connect(): void {
    clearTimeout(timer);
    if (socket) return;
    retryAt.value = null;
    const opening = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/`, [
        "foxglove.sdk.v1",
        "foxglove.websocket.v1",
    ]);
    opening.binaryType = "arraybuffer";
    opening.onopen = opened;
    opening.onclose = () => {
        if (socket === opening) closed();
    };
    opening.onmessage = ({ data }) => {
        heardAt = performance.now();
        if (typeof data === "string") takeText(data);
        else takeData(data as ArrayBuffer);
    };
    socket = opening;
    timer = window.setTimeout(() => {
        if (opening.readyState === WebSocket.CONNECTING) opening.close();
    }, OPENING_MS);
}

// Calls the handler with each message of the topic until the returned function is called. The second handler of a
// topic waits for its next message.
export function want(topic: string, handler: Handler): () => void {
    const all = handlers.get(topic) ?? new Set<Handler>();
    all.add(handler);
    handlers.set(topic, all);
    if (all.size === 1) subscribe([topic]);
    return () => {
        all.delete(handler);
        if (all.size > 0 || handlers.get(topic) !== all) return;
        handlers.delete(topic);
        unsubscribe(topic);
    };
}

// Calls `call` after each new connection.
export function whenOpen(call: () => void): void {
    onOpen.add(call);
    if (isLive.value) call();
}
