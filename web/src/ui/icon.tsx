// SPDX-License-Identifier: MIT
// Each state has a shape of its own, so that colour is not needed to tell them apart.

const PATHS = {
    error: "M8 1.5 15 14H1Z",
    warning: "M8 1 15 8 8 15 1 8Z",
    info: "M8 1.5a6.5 6.5 0 1 0 .01 0Z",
    live: "M8 3.5a4.5 4.5 0 1 0 .01 0Z",
    lost: "M3 3 13 13M13 3 3 13",
    connecting: "M8 2a6 6 0 1 1-6 6",
    down: "M3 3 13 13M13 3 3 13",
    up: "M8 3.5a4.5 4.5 0 1 0 .01 0Z",
    ended: "M3 8.5 6.5 12 13 4.5",
    auto: "M8 2a6 6 0 1 0 .01 0M8 2v12a6 6 0 0 0 0-12",
    light: "M8 5a3 3 0 1 0 .01 0M8 1v1.5M8 13.5V15M1 8h1.5M13.5 8H15M3 3l1 1M12 12l1 1M13 3l-1 1M4 12l-1 1",
    dark: "M13.5 9.5A6 6 0 1 1 6.5 2.5 5 5 0 0 0 13.5 9.5Z",
    help: "M5.5 5.5a2.5 2.5 0 1 1 3.5 2.3c-.7.4-1 .8-1 1.7M8 12.5v.3",
    close: "M4 4 12 12M12 4 4 12",
    plot: "M2 2v12h12M4.5 10.5 7.5 6.5 10 9 13.5 4",
    pause: "M5.5 3v10M10.5 3v10",
    play: "M5 3 13 8 5 13Z",
    arrow: "M1 8h13M10 4l4 4-4 4",
} as const;

export type IconName = keyof typeof PATHS;
const FILLED: IconName[] = ["error", "warning", "info", "live", "up", "play"];

export function Icon({ name }: { name: IconName }) {
    return (
        <svg class={`icon ${FILLED.includes(name) ? "filled" : ""}`} viewBox="0 0 16 16" aria-hidden="true">
            <path d={PATHS[name]} />
        </svg>
    );
}
