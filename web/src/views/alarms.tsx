// SPDX-License-Identifier: MIT
import { seconds, serverNow } from "../model/feeds";
import { alarmFeed, alarms, alarmsLeftOut, type Alarm } from "../model/observed";
import { clock, count, duration } from "../ui/format";
import { Icon } from "../ui/icon";

const SHOWN = 100;

function about(alarm: Alarm): string {
    const source = alarm.sys === null ? "" : `${alarm.sys}${alarm.comp === null ? "" : `/${alarm.comp}`}`;
    return [source, alarm.link ?? ""].filter((part) => part !== "").join(" ");
}

function Row({ alarm }: { alarm: Alarm }) {
    const isOver = alarm.ended_us !== null;
    const lasted = (isOver ? (alarm.ended_us ?? 0) / 1e6 : serverNow()) - alarm.since_us / 1e6;
    return (
        <li class={isOver ? "over" : alarm.severity}>
            <span class="severity">
                <Icon name={isOver ? "ended" : alarm.severity} />
                {isOver ? "over" : alarm.severity}
            </span>
            <time class="number dim" dateTime={new Date(alarm.since_us / 1000).toISOString()}>
                {clock(alarm.since_us)}
            </time>
            <span class="mono about">{about(alarm)}</span>
            <span class="text">{alarm.text}</span>
            <span class="lasted number dim">{isOver ? `lasted ${duration(lasted)}` : `for ${duration(lasted)}`}</span>
        </li>
    );
}

// Screen readers hear of the newest one only, and once.
function Newest({ alarm }: { alarm: Alarm | undefined }) {
    return (
        <p class="hidden" role="status" aria-live="polite">
            {alarm ? `${alarm.severity}: ${about(alarm)} ${alarm.text}` : ""}
        </p>
    );
}

const LeftOut = ({ number }: { number: number }) =>
    number === 0 ? null : (
        <li class="note dim">
            {count(number)} older {number === 1 ? "one has" : "ones have"} left the list, which was full
        </li>
    );

export function Alarms() {
    alarmFeed.version.value;
    seconds.value;
    const all = [...alarms.value].sort(
        (a, b) => Number(a.ended_us !== null) - Number(b.ended_us !== null) || b.since_us - a.since_us,
    );
    const open = all.filter((alarm) => alarm.ended_us === null);
    return (
        <section aria-labelledby="alarms">
            <h2 id="alarms">
                Alarms <span class="dim">{open.length > 0 ? `${open.length} now` : ""}</span>
            </h2>
            <Newest alarm={open[0]} />
            {all.length === 0 &&
                (alarmFeed.version.value === 0 ? (
                    <p class="empty">The server has not reported yet.</p>
                ) : (
                    <p class="empty">
                        <Icon name="ended" />
                        No alarm now, and none in the last ten minutes.
                    </p>
                ))}
            <ul class="alarms panel" hidden={all.length === 0}>
                {all.slice(0, SHOWN).map((alarm) => (
                    <Row key={alarm.id} alarm={alarm} />
                ))}
                {all.length > SHOWN && <li class="note dim">and {all.length - SHOWN} more</li>}
                <LeftOut number={alarmsLeftOut.value} />
            </ul>
        </section>
    );
}
