// SPDX-License-Identifier: MIT
// Light or dark: as the system has it, or as the user chose here.
import { signal } from "@preact/signals";

export type Theme = "auto" | "light" | "dark";
const NAMES: Theme[] = ["auto", "light", "dark"];
const KEY = "mavloom-colours";

function stored(): Theme {
    const name = localStorage.getItem(KEY) as Theme;
    return NAMES.includes(name) ? name : "auto";
}

export const theme = signal<Theme>(stored());
export const themeVersion = signal(0); // changes when colours do

function apply(): void {
    document.documentElement.dataset["theme"] = theme.value;
    themeVersion.value += 1;
}

export function nextTheme(): void {
    theme.value = NAMES[(NAMES.indexOf(theme.value) + 1) % NAMES.length] as Theme;
    localStorage.setItem(KEY, theme.value);
    apply();
}

matchMedia("(prefers-color-scheme: light)").addEventListener("change", apply);
apply();

export const SERIES_COLOURS = 8; // series-0 to series-7 of the style sheet

// A colour of the style sheet, for canvases.
export function colour(name: string): string {
    const probe = document.createElement("i");
    probe.style.color = `var(--${name})`;
    document.body.append(probe);
    const found = getComputedStyle(probe).color;
    probe.remove();
    return found;
}
