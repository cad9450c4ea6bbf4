// SPDX-License-Identifier: MIT
// Vehicles: a panel each while they are few, else a table. Ground stations, cameras and other components are a list.
import { signal } from "@preact/signals";
import type { ComponentChildren } from "preact";
import { seconds } from "../model/feeds";
import {
    alarmsOf,
    isVehicle,
    vehicleFeed,
    vehicleId,
    vehicles,
    type Alarm,
    type RoundTrip,
    type Vehicle,
} from "../model/observed";
import { query, view } from "../model/state";
import { duration, fixed, hertz, NOTHING, words } from "../ui/format";
import { Icon } from "../ui/icon";
import { focusOn } from "../ui/keys";
import { Table, type Column } from "../ui/table";
import { Nothing } from "./nothing";

const FEW = 6;

const FIXES: Record<string, string> = {
    GPS_FIX_TYPE_NO_GPS: "no GPS",
    GPS_FIX_TYPE_NO_FIX: "no fix",
    GPS_FIX_TYPE_2D_FIX: "2D",
    GPS_FIX_TYPE_3D_FIX: "3D",
    GPS_FIX_TYPE_DGPS: "DGPS",
    GPS_FIX_TYPE_RTK_FLOAT: "RTK float",
    GPS_FIX_TYPE_RTK_FIXED: "RTK fixed",
    GPS_FIX_TYPE_STATIC: "static",
    GPS_FIX_TYPE_PPP: "PPP",
};

function fixText(gps: Vehicle["gps"]): string {
    if (!gps || gps.fix === null) return NOTHING;
    return FIXES[gps.fix] ?? words(gps.fix, "GPS_FIX_TYPE_");
}

const lacksFix = (gps: Vehicle["gps"]): boolean => ["no GPS", "no fix"].includes(fixText(gps));
const heading = (position: Vehicle["position"]): string =>
    position?.heading_deg == null ? NOTHING : String(Math.round(position.heading_deg) % 360);
// Its latest: TIMESYNC, else PING, else a command.
function roundTrip(one: Vehicle): { text: string; help: string } {
    const all: [string, RoundTrip | null | undefined][] = [
        ["TIMESYNC", one.round_trip_ms?.timesync],
        ["PING", one.round_trip_ms?.ping],
        ["command", one.round_trip_ms?.command],
    ];
    const [name, first] = all.find(([, trip]) => trip != null) ?? ["", null];
    if (!first) return { text: NOTHING, help: "no TIMESYNC, PING or command has been answered" };
    return {
        text: first.last.toFixed(1),
        help: `${name}: least ${first.least.toFixed(1)} ms, mean ${first.mean.toFixed(1)} ms of ${first.count}`,
    };
}

function showMessages(one: Vehicle): void {
    query.value = `${vehicleId(one)} `;
    view.value = "messages";
}

// ---- parts that panels and the table share

const Armed = ({ armed }: { armed: boolean | null }) =>
    armed === null ? (
        <span class="dim">{NOTHING}</span>
    ) : (
        <span class={`pill ${armed ? "armed" : ""}`}>{armed ? "ARMED" : "disarmed"}</span>
    );

const levelOf = (percent: number): string => (percent <= 15 ? "error" : percent <= 30 ? "warning" : "");

function Gauge({ percent }: { percent: number | null | undefined }) {
    if (percent == null) return null;
    return (
        <svg class={`gauge ${levelOf(percent)}`} viewBox="0 0 100 10" preserveAspectRatio="none" aria-hidden="true">
            <rect class="empty" width="100" height="10" />
            <rect width={Math.max(0, Math.min(100, percent))} height="10" />
        </svg>
    );
}

function Percent({ battery }: { battery: Vehicle["battery"] }) {
    const percent = battery?.percent;
    if (percent == null) return <>{NOTHING}</>;
    const level = levelOf(percent);
    return (
        <span class={level}>
            {level !== "" && <Icon name={level as "error"} />}
            {Math.round(percent)} %
        </span>
    );
}

const Marks = ({ all }: { all: Alarm[] }) => {
    if (all.length === 0) return null;
    const worst =
        (["error", "warning", "info"] as const).find((severity) => all.some((one) => one.severity === severity)) ??
        "info";
    return (
        <span class={`mark ${worst}`} title={all.map((one) => one.text).join("\n")}>
            <Icon name={worst} />
            {all.length}
        </span>
    );
};

const Title = ({ one }: { one: Vehicle }) => (
    <>
        <b class="mono">{vehicleId(one)}</b> {words(one.type, "MAV_TYPE_")}
    </>
);

const Name = ({ one }: { one: Vehicle }) => (
    <button class="name" onClick={() => showMessages(one)} title="Show its messages">
        <Title one={one} />
    </button>
);

// Where the table has no room for all columns, the panel of one vehicle is above it.
const selected = signal<string | null>(null);
const narrow = window.matchMedia("(max-width: 1380px)");
const isNarrow = signal(narrow.matches);
narrow.addEventListener("change", () => {
    isNarrow.value = narrow.matches;
});

function Opener({ one }: { one: Vehicle }) {
    if (!isNarrow.value) return <Name one={one} />;
    const id = vehicleId(one);
    const isOpen = selected.value === id;
    return (
        <button
            class="name"
            aria-expanded={isOpen}
            title="Show its state"
            onClick={() => {
                selected.value = isOpen ? null : id;
                if (!isOpen) focusOn(".panels.one .name");
            }}>
            <Title one={one} />
        </button>
    );
}

// ---- panels

const Pair = ({ name, title, children }: { name: string; title?: string | undefined; children: ComponentChildren }) => (
    <div class="pair" title={title}>
        <dt>{name}</dt>
        <dd>{children}</dd>
    </div>
);

interface FigureOf {
    name: string;
    value: string;
    unit: string;
    help?: string;
}

const Figure = ({ name, value, unit, help }: FigureOf) => (
    <Pair name={name} title={help}>
        {value}
        {value !== NOTHING && <span class="unit">{unit}</span>}
    </Pair>
);

function Power({ battery }: { battery: Vehicle["battery"] }) {
    return (
        <>
            <Pair name="Battery">
                <Percent battery={battery} />
                <Gauge percent={battery?.percent} />
            </Pair>
            <Figure name="Voltage" value={fixed(battery?.voltage_v, 2)} unit="V" />
            <Figure name="Current" value={fixed(battery?.current_a, 1)} unit="A" />
        </>
    );
}

function Place({ position }: { position: Vehicle["position"] }) {
    return (
        <>
            <Figure name="Height" help="above home" value={fixed(position?.relative_alt_m, 1)} unit="m" />
            <Figure name="Speed" help="over ground" value={fixed(position?.ground_speed_m_s, 1)} unit="m/s" />
            <Figure name="Heading" value={heading(position)} unit="°" />
            <Figure name="Latitude" value={fixed(position?.lat_deg, 6)} unit="°" />
            <Figure name="Longitude" value={fixed(position?.lon_deg, 6)} unit="°" />
            <Figure name="Altitude" help="above mean sea level" value={fixed(position?.alt_m, 1)} unit="m" />
        </>
    );
}

function Figures({ one }: { one: Vehicle }) {
    const { battery, gps, position } = one;
    const trip = roundTrip(one);
    return (
        <dl class="figures">
            <Power battery={battery} />
            <Pair name="GPS">
                <span class={lacksFix(gps) ? "warning" : ""}>
                    {lacksFix(gps) && <Icon name="warning" />}
                    {fixText(gps)}
                </span>
            </Pair>
            <Pair name="Satellites">{gps?.satellites ?? NOTHING}</Pair>
            <Figure name="Round trip" help={trip.help} value={trip.text} unit="ms" />
            <Place position={position} />
        </dl>
    );
}

function Panel({ one }: { one: Vehicle }) {
    const all = alarmsOf(one);
    return (
        <article class={`panel vehicle ${one.silent ? "silent" : ""}`}>
            <header>
                <h3>
                    <Name one={one} />
                </h3>
                <Marks all={all} />
                <span class="end dim">
                    {one.silent ? (
                        <>
                            <Icon name="lost" />
                            silent for {duration(one.age_s)}
                        </>
                    ) : (
                        `${hertz(one.hz)} /s`
                    )}
                </span>
            </header>
            <p class="mode">
                <strong>{one.mode ?? NOTHING}</strong>
                <Armed armed={one.armed} />
                <span class="end dim">
                    {words(one.status, "MAV_STATE_")} · {words(one.autopilot, "MAV_AUTOPILOT_")}
                </span>
            </p>
            <Figures one={one} />
        </article>
    );
}

// ---- the table

const COLUMNS: Column<Vehicle>[] = [
    { key: "vehicle", label: "Vehicle", cell: (one) => <Opener one={one} /> },
    { key: "marks", label: "Alarms", cell: (one) => <Marks all={alarmsOf(one)} /> },
    { key: "mode", label: "Mode", cell: (one) => one.mode ?? NOTHING },
    { key: "armed", label: "Armed", cell: (one) => <Armed armed={one.armed} /> },
    {
        key: "percent",
        label: "Battery",
        isNumber: true,
        cell: (one) => (
            <>
                <Gauge percent={one.battery?.percent} />
                <Percent battery={one.battery} />
            </>
        ),
    },
    { key: "voltage", label: "V", isNumber: true, cell: (one) => fixed(one.battery?.voltage_v, 2) },
    { key: "fix", label: "GPS", cell: (one) => fixText(one.gps) },
    { key: "satellites", label: "Sats", isNumber: true, cell: (one) => one.gps?.satellites ?? NOTHING },
    { key: "height", label: "Height m", isNumber: true, cell: (one) => fixed(one.position?.relative_alt_m, 1) },
    { key: "speed", label: "m/s", isNumber: true, cell: (one) => fixed(one.position?.ground_speed_m_s, 1) },
    { key: "heading", label: "Heading", isNumber: true, cell: (one) => heading(one.position) },
    { key: "lat", label: "Latitude", isNumber: true, cell: (one) => fixed(one.position?.lat_deg, 6) },
    { key: "lon", label: "Longitude", isNumber: true, cell: (one) => fixed(one.position?.lon_deg, 6) },
    { key: "trip", label: "Trip ms", help: "round trip", isNumber: true, cell: (one) => roundTrip(one).text },
    { key: "rate", label: "/s", help: "messages a second", isNumber: true, cell: (one) => hertz(one.hz) },
    { key: "age", label: "Age", isNumber: true, cell: (one) => duration(one.age_s) },
];

function Others({ all }: { all: Vehicle[] }) {
    if (all.length === 0) return null;
    return (
        <ul class="others" aria-label="Other components">
            {all.slice(0, 40).map((one) => (
                <li key={vehicleId(one)} class={one.silent ? "silent" : ""}>
                    <Name one={one} />{" "}
                    <span class="dim">
                        {one.silent ? `silent for ${duration(one.age_s)}` : `${hertz(one.hz)} /s`}
                    </span>
                </li>
            ))}
            {all.length > 40 && <li class="dim">and {all.length - 40} more</li>}
        </ul>
    );
}

function List({ all }: { all: Vehicle[] }) {
    const open = isNarrow.value ? all.find((one) => vehicleId(one) === selected.value) : undefined;
    if (all.length > FEW)
        return (
            <>
                {open && (
                    <div class="panels one">
                        <Panel one={open} />
                    </div>
                )}
                <Table
                    caption="Vehicles"
                    columns={COLUMNS}
                    rows={all}
                    keyOf={vehicleId}
                    current={open ? selected.value : null}
                    classOf={(one) => `${one.silent ? "silent" : ""} ${one === open ? "open" : ""}`}
                />
            </>
        );
    return (
        <div class="panels">
            {all.map((one) => (
                <Panel key={vehicleId(one)} one={one} />
            ))}
        </div>
    );
}

export function Vehicles() {
    vehicleFeed.version.value;
    seconds.value;
    const all = vehicles.value.filter(isVehicle).sort((a, b) => a.sys - b.sys || a.comp - b.comp);
    const silent = all.filter((one) => one.silent).length;
    return (
        <section aria-labelledby="vehicles">
            <h2 id="vehicles">
                Vehicles{" "}
                <span class="dim">
                    {all.length > 0 && all.length}
                    {silent > 0 && `, ${silent} silent`}
                </span>
            </h2>
            {all.length === 0 && <Nothing text="No vehicle has sent a HEARTBEAT yet." />}
            <List all={all} />
            <Others all={vehicles.value.filter((one) => !isVehicle(one))} />
        </section>
    );
}
