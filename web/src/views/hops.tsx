// SPDX-License-Identifier: MIT
// The way of the frames: a box for each hop, with its rate and the losses that it counts, by name.
import {
    histories,
    hops,
    isDamaged,
    linkFeed,
    lossOf,
    lostLately,
    type Hop,
    type Link,
    type Loss,
} from "../model/observed";
import { bytes, count, hertz } from "../ui/format";
import { Icon, type IconName } from "../ui/icon";

const WIDTH = 120,
    HEIGHT = 22;

function Trend({ name }: { name: string }) {
    linkFeed.version.value;
    const rates = histories.get(name)?.rates ?? [];
    const most = Math.max(1, ...rates);
    const start = WIDTH - rates.length + 1;
    const points = rates.map((rate, i) => `${start + i},${(HEIGHT - 1 - (rate / most) * (HEIGHT - 3)).toFixed(1)}`);
    return (
        <svg
            class="trend"
            viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
            preserveAspectRatio="none"
            role="img"
            aria-label={`frames a second in the last minute, at most ${Math.round(most)}`}>
            {points.length > 1 && <polyline points={points.join(" ")} />}
        </svg>
    );
}

const LossRow = ({ loss }: { loss: Loss }) => (
    <li title={loss.help}>
        <span>{loss.name.replaceAll("_", " ")}</span>
        <b class="number">{count(loss.count)}</b>
        {loss.help && <small>{loss.help}</small>}
    </li>
);

function Losses({ hop }: { hop: Hop }) {
    const { count: lately, seconds } = lostLately(hop);
    const total = lossOf(hop);
    const word = isDamaged(hop) ? "lost or damaged" : "lost";
    if (total === 0)
        return (
            <p class="fine">
                <Icon name="ended" />
                nothing lost here
            </p>
        );
    return (
        <div class={`losses ${lately > 0 ? "error" : ""}`}>
            <p>
                <Icon name={lately > 0 ? "error" : "info"} />
                {count(total)} {word}
                {seconds > 0 && (
                    <span class="end">
                        {lately > 0 ? `+${count(lately)} in ${seconds} s` : `none in the last ${seconds} s`}
                    </span>
                )}
            </p>
            <ul>
                {hop.losses.map((loss) => (
                    <LossRow key={loss.name} loss={loss} />
                ))}
            </ul>
        </div>
    );
}

// The end of a recording is no fault.
const LINK_ICONS: Record<Link["state"], IconName> = { up: "up", down: "down", ended: "ended" };

function LinkRow({ link }: { link: Link }) {
    return (
        <li class={link.state}>
            <span class="link" title={link.name}>
                <Icon name={LINK_ICONS[link.state]} />
                <span class="mono cut">{link.name}</span>
                {link.state !== "up" && ` ${link.state}`}
            </span>
            <span class="number dim" title={`${bytes(link.bytes_in)} in, ${bytes(link.bytes_out)} out`}>
                <b>{hertz(link.hz_in)}</b> in <b>{hertz(link.hz_out)}</b> out
            </span>
            {link.losses.length > 0 && (
                <ul class="losses">
                    {link.losses.map((loss) => (
                        <LossRow key={loss.name} loss={loss} />
                    ))}
                </ul>
            )}
        </li>
    );
}

const Rate = ({ name, hz, frames }: { name: string; hz: number | null; frames: number }) => (
    <div>
        <dt>{name}</dt>
        <dd>
            <b>{hertz(hz)}</b>
            <span class="unit">/s</span>
        </dd>
        <dd class="dim">{count(frames)}</dd>
    </div>
);

// Of a ground station, only its silence is known. A source that was never there is waited for.
const isAwaited = (hop: Hop): boolean => hop.kind === "source" && hop.frames_in + hop.frames_out === 0;
const isMissing = (hop: Hop): boolean => hop.state !== "up" && hop.kind !== "station" && !isAwaited(hop);
const downText = (hop: Hop): string => (isAwaited(hop) ? "waiting" : isMissing(hop) ? "down" : "not here");

function Title({ hop }: { hop: Hop }) {
    const isUp = hop.state === "up";
    const kind = hop.name.endsWith(hop.kind) ? "" : hop.kind;
    return (
        <header>
            <h3>
                <Icon name={isUp ? "up" : "down"} />
                <span class="cut" title={hop.name}>
                    {hop.name}
                </span>
            </h3>
            <span class="end dim">
                <span class="kind">{kind}</span> {isUp ? "" : downText(hop)}
            </span>
        </header>
    );
}

function Box({ hop }: { hop: Hop }) {
    const classes = `panel hop ${isMissing(hop) ? "down" : ""} ${lostLately(hop).count > 0 ? "losing" : ""}`;
    return (
        <li class={classes}>
            <Title hop={hop} />
            <Trend name={hop.name} />
            <dl class="rates">
                <Rate name="in" hz={hop.hz_in} frames={hop.frames_in} />
                <Rate name="out" hz={hop.hz_out} frames={hop.frames_out} />
            </dl>
            <Losses hop={hop} />
            {hop.hint && <p class="hint">{hop.hint}</p>}
            {hop.links.length > 0 && (
                <ul class="links">
                    {hop.links.map((link) => (
                        <LinkRow key={link.name} link={link} />
                    ))}
                </ul>
            )}
        </li>
    );
}

const Chain = ({ all }: { all: Hop[] }) => (
    <ol class="hops">
        {all.map((hop, i) => [
            i > 0 && (
                <li key={`to ${hop.name}`} class="arrow" aria-hidden="true">
                    <Icon name="arrow" />
                </li>
            ),
            <Box key={hop.name} hop={hop} />,
        ])}
    </ol>
);

// Frames end at a ground station. Programs after it read elsewhere.
export function Hops() {
    linkFeed.version.value;
    const all = hops.value;
    const end = 1 + all.findIndex((hop) => hop.kind === "station") || all.length;
    return (
        <section aria-labelledby="hops">
            <h2 id="hops">
                Hops{" "}
                <span class="dim">{all.length > 0 && `${end}, in the order in which frames pass them`}</span>
            </h2>
            {all.length === 0 && <p class="empty">The server has not reported yet.</p>}
            <Chain all={all.slice(0, end)} />
            {end < all.length && (
                <>
                    <h3 class="aside dim">Beside them, reading along</h3>
                    <Chain all={all.slice(end)} />
                </>
            )}
        </section>
    );
}
