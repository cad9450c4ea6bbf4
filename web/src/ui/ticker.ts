// SPDX-License-Identifier: MIT
// Data arrives faster than anybody reads. Changes are drawn at most ten times a second, with a frame of the browser; a
// hidden tab has no frames and draws nothing.
import { batch, type Signal } from "@preact/signals";

const LEAST_GAP_MS = 95;

const changed = new Set<Signal<number>>();
let isWaiting = false;
let last = 0;

function draw(now: number): void {
    if (now - last < LEAST_GAP_MS) {
        requestAnimationFrame(draw);
        return;
    }
    isWaiting = false;
    last = now;
    const all = [...changed];
    changed.clear();
    batch(() =>
        all.forEach((version) => {
            version.value += 1;
        }),
    );
}

// Components that read `version` are drawn again soon.
export function bump(version: Signal<number>): void {
    changed.add(version);
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(draw);
}
