// SPDX-License-Identifier: MIT
// The fields of the open message, with units and names of enum entries. A click on a number plots it.
import { signal } from "@preact/signals";
import { seconds } from "../model/feeds";
import { latestVersion, openedMessage, type Opened } from "../model/latest";
import { frozen } from "../model/table";
import { newSeries, opened, plot, view } from "../model/state";
import { converted } from "../ui/convert";
import { clock, hertz, value as text } from "../ui/format";
import { Icon } from "../ui/icon";
import { closeMessage } from "../ui/keys";
import type { Message as Values, Scalar, Value } from "../wire/cdr";
import { channelsVersion, isLive } from "../wire/connection";
import { isInvalid } from "../wire/invalid";
import type { Field } from "../wire/schema";

export const SERIES_TYPE = "application/x-mavloom-series";
const SHORT = 16; // longer arrays are folded

const isFloat = (field: Field): boolean => field.type.startsWith("float");
const unfolded = signal(new Set<string>());

// The open message at the moment of the freeze, if it was open then.
function messageThen(now: Opened): Values | null {
    const base = frozen.value?.opened;
    return base?.topic === now.topic && base.schema === now.schema ? base.message : null;
}

// ---- what a number means

function flagsOf(field: Field, value: number): string[] {
    const names = [...(field.entries ?? [])].filter(([bit]) => bit !== 0 && Math.floor(value / bit) % 2 === 1);
    return names.map(([, name]) => shorten(name, field));
}

// Without the beginning that all entries share, up to a '_'.
function shorten(name: string, field: Field): string {
    const all = [...(field.entries?.values() ?? [])];
    if (all.length < 2) return name;
    let length = 0;
    while (all.every((one) => one[length] === all[0]?.[length] && length < one.length)) ++length;
    return name.slice(
        all[0]?.lastIndexOf("_", length - 1) === -1 ? 0 : (all[0]?.lastIndexOf("_", length - 1) ?? -1) + 1,
    );
}

const isUnknown = ({ field, whole, element }: Shown): boolean => isInvalid(field, whole, element);

function meaning(shown: Shown): string {
    const { field, raw: value } = shown;
    if (typeof value === "string") return "";
    const entry = field.entries?.get(Number(value));
    if (entry !== undefined) return shorten(entry, field);
    if (isUnknown(shown)) return "unknown";
    return field.isFlags ? flagsOf(field, Number(value)).join(", ") : converted(value, field.unit);
}

// ---- rows

// A line may end after each '_'.
const FieldName = ({ name }: { name: string }) => (
    <>
        {name.split(/(?<=_)/).flatMap((part, i) => (i === 0 ? [part] : [<wbr key={i} />, part]))}
    </>
);

function Number_({ field, raw, formula }: { field: Field; raw: Scalar; formula: string }) {
    const add = () => plot(newSeries(opened.value ?? "", formula));
    return (
        <button
            class="value mono"
            title={`Plot ${formula}`}
            aria-label={`Plot ${formula}, ${text(raw, isFloat(field))}`}
            onClick={add}>
            {text(raw, isFloat(field))}
        </button>
    );
}

interface Shown {
    field: Field;
    raw: Scalar;
    whole: Value; // the array that it is an element of, or itself
    before: Scalar | undefined;
    element: number | null; // of an array
}

const WIDE = 36; // what does not fit beside the value has a line of its own

const columnCount = (): number => (frozen.value ? 5 : 4);

function Before({ field, raw, before }: Shown) {
    if (!frozen.value) return null;
    const isOther = before !== undefined && !Object.is(before, raw);
    return (
        <td class={`number mono ${isOther ? "changed" : "dim"}`}>
            {before === undefined ? "" : text(before, isFloat(field))}
        </td>
    );
}

function NumberCells(shown: Shown & { formula: string }) {
    const { field, raw, formula } = shown;
    const means = meaning(shown);
    return (
        <>
            <td class="number">
                <Number_ field={field} raw={raw} formula={formula} />
            </td>
            <Before {...shown} />
            <td class="dim f-unit">{isUnknown(shown) ? "" : field.unit}</td>
            <td class="meaning">{means.length > WIDE ? "" : means}</td>
        </>
    );
}

function Row(shown: Shown) {
    const { field, raw, element } = shown;
    const formula = element === null ? field.name : `${field.name}[${element}]`;
    const isText = typeof raw === "string";
    const wide = isText ? raw : meaning(shown);
    const drag = (event: DragEvent) => {
        event.dataTransfer?.setData(SERIES_TYPE, JSON.stringify(newSeries(opened.value ?? "", formula)));
        event.dataTransfer?.setData("text/plain", formula);
    };
    return (
        <>
            <tr draggable={!isText} onDragStart={drag} class={element === null ? "" : "element"}>
                <th scope="row">{element === null ? <FieldName name={field.name} /> : `[${element}]`}</th>
                {isText ? (
                    <td class="text" colSpan={columnCount() - 1}>
                        {raw}
                    </td>
                ) : (
                    <NumberCells {...shown} formula={formula} />
                )}
            </tr>
            {!isText && wide.length > WIDE && (
                <tr class="more">
                    <td colSpan={columnCount()}>{wide}</td>
                </tr>
            )}
        </>
    );
}

function toggle(key: string): void {
    const next = new Set(unfolded.value);
    if (!next.delete(key)) next.add(key);
    unfolded.value = next;
}

function ArrayHead({ field, all, isOpen, name }: { field: Field; all: Scalar[]; isOpen: boolean; name: string }) {
    const beginning = all.slice(0, SHORT).map((one) => text(one, isFloat(field)));
    const size = `${all.length} elements`;
    return (
        <tr class="array">
            <th scope="row">
                <FieldName name={field.name} />
            </th>
            <td colSpan={frozen.value ? 2 : 1} class="dim">
                {all.length <= SHORT ? (
                    size
                ) : (
                    <button class="link" aria-expanded={isOpen} onClick={() => toggle(name)}>
                        {size}
                    </button>
                )}
            </td>
            <td class="dim f-unit">{field.unit}</td>
            <td class="meaning mono cut">{isOpen ? "" : `${beginning.join(" ")} …`}</td>
        </tr>
    );
}

function ArrayRows({ field, all, before }: { field: Field; all: Scalar[]; before: Value | undefined }) {
    const name = `${opened.value} ${field.name}`;
    const isOpen = all.length <= SHORT || unfolded.value.has(name);
    const then = Array.isArray(before) ? before : [];
    return (
        <>
            <ArrayHead field={field} all={all} isOpen={isOpen} name={name} />
            {isOpen && all.map((one, i) => <Row key={i} field={field} raw={one} whole={all} element={i} before={then[i]} />)}
        </>
    );
}

function FieldRows({ field, raw, before }: { field: Field; raw: Value; before: Value | undefined }) {
    if (Array.isArray(raw)) return <ArrayRows field={field} all={raw} before={before} />;
    return <Row field={field} raw={raw} whole={raw} before={before as Scalar | undefined} element={null} />;
}

const FieldsHead = () => (
    <thead class={frozen.value ? "" : "hidden"}>
        <tr>
            <th scope="col">Field</th>
            <th scope="col" class="number">
                Value
            </th>
            {frozen.value && (
                <th scope="col" class="number">
                    Then
                </th>
            )}
            <th scope="col" class="f-unit">
                Unit
            </th>
            <th scope="col">Meaning</th>
        </tr>
    </thead>
);

function Fields({ now }: { now: Opened }) {
    const before = messageThen(now);
    const { schema, message } = now;
    if (!message) return <p class="empty">{now.error || "No message has come yet."}</p>;
    return (
        <table class={`fields ${frozen.value ? "compared" : ""}`}>
            <caption class="hidden">Fields of {schema.name}</caption>
            <colgroup>
                <col class="f-name" />
                <col class="f-value" />
                {frozen.value && <col class="f-value" />}
                <col class="f-unit" />
                <col />
            </colgroup>
            <FieldsHead />
            <tbody>
                {schema.fields.map((field, i) => (
                    <FieldRows key={field.name} field={field} raw={message[i] as Value} before={before?.[i]} />
                ))}
            </tbody>
        </table>
    );
}

const Unknown = () => (
    <p class="empty">
        {channelsVersion.value > 0 && isLive.value ? "Nothing with this name was heard." : "Waiting for the server."}
    </p>
);

const MessageHead = ({ topic }: { topic: string }) => (
    <header>
        <h3>
            <span class="mono cut" title={topic}>
                {topic}
            </span>
        </h3>
        <button class="quiet end" onClick={closeMessage} aria-label="Close the message" title="Close (Esc)">
            <Icon name="close" />
        </button>
    </header>
);

export function Message({ hz }: { hz: number | null }) {
    latestVersion.value;
    seconds.value;
    const now = openedMessage();
    const topic = opened.value ?? "";
    return (
        <aside class="message" aria-label={`Message ${topic}`}>
            <MessageHead topic={topic} />
            <p class="dim number about">
                {now && `id ${now.schema.id}`}
                {hz !== null && <span>{hertz(hz)} /s</span>}
                {now && now.timeUs > 0 && <span>at {clock(now.timeUs)}</span>}
            </p>
            <div class="scroller" tabIndex={-1}>
                {now ? <Fields now={now} /> : <Unknown />}
            </div>
            <p class="hint dim">
                {view.value === "plots" ? "Click a number, or drag it into a plot." : "Click a number to plot it."}
            </p>
        </aside>
    );
}
