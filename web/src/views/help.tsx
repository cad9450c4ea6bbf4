// SPDX-License-Identifier: MIT
import { useEffect, useRef } from "preact/hooks";
import { functionNames } from "../model/formula";
import { isHelpOpen } from "../model/state";
import { Icon } from "../ui/icon";
import { areLettersOn, switchLetters } from "../ui/keys";
import { serverName } from "../wire/connection";

const KEYS: [string, [string, string][]][] = [
    [
        "Everywhere",
        [
            ["1 2 3", "Overview, Messages, Plots"],
            ["/", "search messages"],
            ["t", "light, dark, as the system"],
            ["Esc", "close, leave a field"],
            ["?", "this list"],
        ],
    ],
    [
        "Messages",
        [
            ["j k, ↓ ↑", "next, previous row"],
            ["Enter", "open the row"],
            ["f", "freeze the table"],
            ["c", "compare with the frozen state"],
            ["Tab", "to the open message: its close button, then its fields; Enter plots one"],
        ],
    ],
    [
        "Plots",
        [
            ["Space", "stop, follow again"],
            ["+ −", "zoom"],
            ["← →", "earlier, later"],
            ["0", "follow the latest"],
            ["a", "add a formula"],
        ],
    ],
];

function Group({ title, keys }: { title: string; keys: [string, string][] }) {
    return (
        <section>
            <h3>{title}</h3>
            <dl class="keys">
                {keys.map(([key, does]) => [
                    <dt key={key}>
                        <kbd>{key}</kbd>
                    </dt>,
                    <dd key={does}>{does}</dd>,
                ])}
            </dl>
        </section>
    );
}

const Functions = () => (
    <p>
        Formulas have fields, array elements such as <code>voltages[0]</code>, <code>+ - * / % ^ ( )</code>,{" "}
        <code>pi</code>, <code>e</code> and{" "}
        {functionNames.map((name, i) => [i > 0 ? ", " : "", <code key={name}>{name}</code>])}. A field of another topic
        has its name before it, as in <code>alt - /2/1/VFR_HUD.alt</code>: the latest value counts.
    </p>
);

function close(): void {
    isHelpOpen.value = false;
}

export function Help() {
    const dialog = useRef<HTMLDialogElement>(null);
    useEffect(() => {
        if (isHelpOpen.value && !dialog.current?.open) dialog.current?.showModal();
        if (!isHelpOpen.value && dialog.current?.open) dialog.current?.close();
    }, [isHelpOpen.value]);
    return (
        <dialog ref={dialog} aria-labelledby="help-title" onClose={close}>
            <header>
                <h2 id="help-title">Keys</h2>
                <button class="quiet" onClick={close} aria-label="Close">
                    <Icon name="close" />
                </button>
            </header>
            <div class="groups">
                {KEYS.map(([title, keys]) => (
                    <Group key={title} title={title} keys={keys} />
                ))}
            </div>
            <label class="check">
                <input type="checkbox" checked={areLettersOn.value} onChange={switchLetters} /> Keys of one letter work
            </label>
            <Functions />
            <p class="dim">
                {serverName.value} · <a href="licences.txt">Licences of what this page contains</a>
            </p>
        </dialog>
    );
}
