// SPDX-License-Identifier: MIT
import { computed, effect, signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { alarmFeed, alarms } from "./model/observed";
import { seconds } from "./model/feeds";
import { announce, current, isHelpOpen, notice, view } from "./model/state";
import { encodeState, type View } from "./model/url";
import { duration } from "./ui/format";
import { Icon } from "./ui/icon";
import { nextTheme, theme } from "./ui/theme";
import { connect, isLive, lostAt, retryAt, serverName, slowness } from "./wire/connection";
import { Help } from "./views/help";
import { Messages } from "./views/messages";
import { Overview } from "./views/overview";
import { Plots, takeDrop } from "./views/plots";

const TITLES: Record<View, string> = { overview: "Overview", messages: "Messages", plots: "Plots" };

const hrefOf = (to: View): string => `#${encodeState({ ...current(), view: to })}`;

const hasConnected = signal(false);
effect(() => {
    if (isLive.value) hasConnected.value = true;
});
effect(() => {
    if (slowness.value !== "") announce(slowness.value);
});
const state = computed(() => (isLive.value ? "live" : hasConnected.value ? "lost" : "connecting"));
const openAlarms = computed(() => alarms.value.filter((alarm) => alarm.ended_us === null && alarm.severity !== "info"));

function Tab({ to }: { to: View }) {
    const drop =
        to !== "plots"
            ? {}
            : {
                  onDragOver: (event: DragEvent) => event.preventDefault(),
                  onDrop: (event: DragEvent) => takeDrop(event, null),
              };
    return (
        <a href={hrefOf(to)} aria-current={view.value === to ? "page" : undefined} {...drop}>
            {TITLES[to]}
        </a>
    );
}

function Alarms() {
    const all = openAlarms.value;
    const worst = all.some((alarm) => alarm.severity === "error") ? "error" : "warning";
    if (all.length === 0) return null;
    return (
        <a class={`badge ${worst}`} href={hrefOf("overview")}>
            <Icon name={worst} />
            {all.length}
            <span class="wide"> {all.length === 1 ? "alarm" : "alarms"}</span>
        </a>
    );
}

function Connection() {
    const text = { live: "live", lost: "lost", connecting: "opening" }[state.value];
    return (
        <span class={`badge ${state.value}`} title={serverName.value}>
            <Icon name={state.value} />
            {text}
        </span>
    );
}

function Lost() {
    if (state.value !== "lost") return null;
    seconds.value;
    const wait = retryAt.value === null ? 0 : Math.max(0, Math.ceil((retryAt.value - Date.now()) / 1000));
    return (
        <div class="banner">
            <Icon name="lost" />
            <span>
                <strong>Connection lost</strong> {duration((Date.now() - (lostAt.value ?? Date.now())) / 1000)} ago.
                Values are old. {wait > 0 ? `Next attempt in ${wait} s.` : "Connecting…"}
            </span>
            <button onClick={connect}>Try now</button>
        </div>
    );
}

function Header() {
    return (
        <header>
            <h1>mavloom</h1>
            <nav aria-label="Views">
                <Tab to="overview" />
                <Tab to="messages" />
                <Tab to="plots" />
            </nav>
            <div class="right">
                <Alarms />
                <Connection />
                <button
                    class="quiet"
                    onClick={nextTheme}
                    title={`Colours: ${theme.value} (t)`}
                    aria-label={`Colours: ${theme.value}`}>
                    <Icon name={theme.value} />
                </button>
                <button
                    class="quiet"
                    onClick={() => {
                        isHelpOpen.value = true;
                    }}
                    title="Keys and licences (?)"
                    aria-label="Help">
                    <Icon name="help" />
                </button>
            </div>
        </header>
    );
}

const VIEW_OF = { overview: Overview, messages: Messages, plots: Plots };

export function App() {
    useEffect(() => alarmFeed.use(), []);
    useEffect(() => {
        document.title = `${TITLES[view.value]} · Mavloom`;
    }, [view.value]);
    const View = VIEW_OF[view.value];
    return (
        <div class={`app ${state.value}`}>
            <Header />
            <Lost />
            <main class={view.value}>
                <View />
            </main>
            <div class="notice" role="status" hidden={notice.value === ""}>
                {notice.value}
            </div>
            <div class="hidden" role="status">
                {state.value === "lost" ? "The connection is lost" : ""}
            </div>
            <Help />
        </div>
    );
}
