// SPDX-License-Identifier: MIT
// In the place of vehicles or messages, while there are none.
import { hints, linkFeed } from "../model/observed";

// A hop that does not show all of its messages has a hint. Then it is not known whether there are none.
export function Nothing({ text }: { text: string }) {
    const all = hints();
    if (linkFeed.version.value === 0) return <p class="empty">The server has not reported yet.</p>;
    if (all.length === 0) return <p class="empty">{text}</p>;
    return (
        <ul class="empty hints">
            {all.map((hint) => (
                <li key={hint}>{hint}.</li>
            ))}
        </ul>
    );
}
