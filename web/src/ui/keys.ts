// SPDX-License-Identifier: MIT
// Keys that work everywhere. Views add theirs. Nothing happens while the user types into a field.
import { signal } from "@preact/signals";
import { isHelpOpen, opened, view } from "../model/state";
import { nextTheme } from "./theme";

type Action = (event: KeyboardEvent) => void;
const KEY = "mavloom-keys";

// Speech input may type single letters by accident, so they can be switched off.
export const areLettersOn = signal(localStorage.getItem(KEY) !== "off");

export function switchLetters(): void {
    areLettersOn.value = !areLettersOn.value;
    localStorage.setItem(KEY, areLettersOn.value ? "on" : "off");
}

const ofViews = new Map<string, Action>();

// For as long as the returned function is not called.
export function useKeys(actions: Record<string, Action>): () => void {
    for (const [key, action] of Object.entries(actions)) ofViews.set(key, action);
    return () => {
        for (const [key, action] of Object.entries(actions)) if (ofViews.get(key) === action) ofViews.delete(key);
    };
}

let wanted = ""; // the last element that should get the focus

// An element that is not in the document yet may come with one of the next frames. Only the last one asked for counts.
export function focusOn(selector: string, frames = 30): void {
    wanted = selector;
    requestAnimationFrame(() => {
        if (wanted !== selector) return;
        const found = document.querySelector<HTMLElement>(selector);
        if (found) found.focus({ preventScroll: true });
        else if (frames > 0) focusOn(selector, frames - 1);
    });
}

// The focus returns from the message to its row.
export function closeMessage(): void {
    const topic = opened.value;
    const wasInside = document.activeElement?.closest("aside.message") != null;
    opened.value = null;
    if (!wasInside || topic === null) return;
    const row = document.querySelector<HTMLElement>(`[data-row$="${CSS.escape(` ${topic}`)}"]`);
    (row ?? document.querySelector<HTMLElement>("main .scroller"))?.focus();
}

const everywhere: Record<string, Action> = {
    "1": () => {
        view.value = "overview";
    },
    "2": () => {
        view.value = "messages";
    },
    "3": () => {
        view.value = "plots";
    },
    "?": () => {
        isHelpOpen.value = !isHelpOpen.value;
    },
    t: nextTheme,
    "/": () => {
        view.value = "messages";
        focusOn("#search");
    },
};

function isTyping(target: EventTarget | null): boolean {
    if (!(target instanceof HTMLElement)) return false;
    const isBox = target instanceof HTMLInputElement && target.type !== "checkbox";
    return isBox || target instanceof HTMLTextAreaElement || target instanceof HTMLSelectElement;
}

// An open menu. The focus returns to what opened it.
function closeMenu(): boolean {
    const menu = document.querySelector<HTMLDetailsElement>("details[open]");
    if (menu) menu.open = false;
    menu?.querySelector("summary")?.focus();
    return menu !== null;
}

function escape(target: EventTarget | null): void {
    if (isHelpOpen.value) isHelpOpen.value = false;
    else if (closeMenu()) return;
    else if (isTyping(target)) (target as HTMLElement).blur();
    else closeMessage();
}

export function takeKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    if (event.key === "Escape") {
        event.preventDefault(); // it would empty a search field, unseen by us
        return escape(event.target);
    }
    if (isTyping(event.target) || (!areLettersOn.value && event.key.length === 1)) return;
    if (event.key === " " && event.target instanceof HTMLButtonElement) return;
    const action = ofViews.get(event.key) ?? everywhere[event.key];
    if (!action || (isHelpOpen.value && event.key !== "?")) return;
    event.preventDefault();
    action(event);
}
