// SPDX-License-Identifier: MIT
// The server's JSON channels. Each is wanted only while a view shows it and the tab is visible. A new subscriber gets
// the whole first, then what changes.
import { effect, signal, type Signal } from "@preact/signals";
import { bump } from "../ui/ticker";
import { isLive, want, whenOpen } from "../wire/connection";

export const isVisible = signal(!document.hidden);
document.addEventListener("visibilitychange", () => {
    isVisible.value = !document.hidden;
});

const utf8 = new TextDecoder();

export class Feed {
    readonly version = signal(0);
    private readonly wanted = signal(0);
    private readonly loads = signal(0); // counts new connections
    private isNew = true;

    // `take` gets each object; `isFirst`: the first of a subscription.
    constructor(
        name: string,
        private readonly take: (object: never, isFirst: boolean) => void,
    ) {
        whenOpen(() => {
            this.loads.value += 1;
        });
        effect(() => {
            if (this.wanted.value === 0 || !isVisible.value || this.loads.value === 0) return undefined;
            this.isNew = true;
            return want(`/mavloom/${name}`, (data) => this.apply(utf8.decode(data)));
        });
    }

    // For as long as the returned function is not called.
    use(): () => void {
        this.wanted.value += 1;
        return () => {
            this.wanted.value -= 1;
        };
    }

    private apply(text: string): void {
        this.take(JSON.parse(text) as never, this.isNew);
        this.isNew = false;
        bump(this.version);
    }
}

// Server's time in us when the last object came, and when that was here: ages continue from there, but not while the
// connection is lost. Nothing is known of that time.
let serverUs = 0;
let hereMs = 0;

export function setServerTime(us: number): void {
    serverUs = us;
    hereMs = performance.now();
}

export function serverNow(): number {
    if (serverUs === 0) return Date.now() / 1000;
    return serverUs / 1e6 + (isLive.peek() ? (performance.now() - hereMs) / 1000 : 0);
}

// Changes once a second, for ages.
export const seconds: Signal<number> = signal(0);
setInterval(() => {
    if (!document.hidden) seconds.value += 1;
}, 1000);
