// SPDX-License-Identifier: MIT
// The latest message of the topic that the user opened. It is decoded when it is drawn, not when it arrives.
import { effect, signal } from "@preact/signals";
import { bump } from "../ui/ticker";
import { decode, type Message } from "../wire/cdr";
import { channels, channelsVersion, want } from "../wire/connection";
import type { Schema } from "../wire/schema";
import { isVisible } from "./feeds";
import { opened } from "./state";

export const latestVersion = signal(0);

interface Latest {
    topic: string;
    schema: Schema; // at that time: the next server may have another one
    data: DataView;
    timeUs: number;
}
let latest: Latest | null = null;

export interface Opened {
    topic: string;
    schema: Schema;
    message: Message | null;
    timeUs: number;
    error: string;
}

export function openedMessage(): Opened | null {
    latestVersion.value;
    channelsVersion.value;
    const topic = opened.value;
    if (topic === null) return null;
    const now = latest?.topic === topic ? latest : null;
    const schema = now?.schema ?? channels.get(topic)?.schema;
    if (!schema) return null;
    const base = { topic, schema, message: null, timeUs: now?.timeUs ?? 0, error: "" };
    if (!now) return base;
    try {
        return { ...base, message: decode(schema, now.data) };
    } catch (error) {
        return { ...base, error: String(error) };
    }
}

export function followOpened(): void {
    effect(() => {
        const topic = opened.value;
        if (topic === null || !isVisible.value) return undefined;
        return want(topic, (data, timeUs) => {
            const schema = channels.get(topic)?.schema;
            if (!schema) return;
            latest = { topic, schema, data, timeUs };
            bump(latestVersion);
        });
    });
}
