// SPDX-License-Identifier: MIT
// Fingers on a chart: one moves it sideways, two zoom. Upwards and downwards, the page scrolls.
import { pan, zoom } from "../model/window";

interface Touch {
    fingers: number;
    middle: number;
    spread: number;
}

const START_PX = 8; // a tap moves less

function touchOf(event: TouchEvent): Touch {
    const all = [...event.touches].map((touch) => touch.clientX);
    const least = Math.min(...all),
        most = Math.max(...all);
    return { fingers: all.length, middle: (least + most) / 2, spread: most - least };
}

export function followTouches(over: HTMLElement): void {
    let last: Touch | null = null;
    over.addEventListener("touchstart", (event) => (last = touchOf(event)), { passive: true });
    over.addEventListener("touchend", () => (last = null), { passive: true });
    over.addEventListener(
        "touchmove",
        (event) => {
            const now = touchOf(event);
            const { left, width } = over.getBoundingClientRect();
            if (!last || last.fingers !== now.fingers) last = now;
            if (Math.abs(now.middle - last.middle) + Math.abs(now.spread - last.spread) < START_PX) return;
            if (now.fingers > 1 && now.spread > 0 && last.spread > 0)
                zoom(last.spread / now.spread, (now.middle - left) / width);
            pan((last.middle - now.middle) / width);
            last = now;
        },
        { passive: true },
    );
}
