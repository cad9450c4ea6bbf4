// SPDX-License-Identifier: MIT
// Formulas over the fields of a message, as in `sqrt(vx^2 + vy^2) / 100` or `voltages[0]`, or of several, as in
// `/1/1/VFR_HUD.alt - /2/1/VFR_HUD.alt`. They are parsed into functions; nothing is evaluated as JavaScript.

export type Numbers = (name: string, element: number | null, topic: string | null) => number;
export type Formula = (numbers: Numbers) => number;

export interface Use {
    topic: string | null; // null: the formula's own
    name: string;
    element: number | null;
    at: number;
}
export interface Parsed {
    formula: Formula;
    uses: Use[];
}
export class FormulaError extends Error {
    constructor(
        message: string,
        readonly at: number,
    ) {
        super(message);
    }
}

interface Token {
    kind: "number" | "name" | "topic" | "sign" | "end";
    text: string;
    at: number;
}

const CONSTANTS: Record<string, number> = { pi: Math.PI, e: Math.E };
const DEGREES = 180 / Math.PI;

interface Function_ {
    least: number;
    most: number;
    call: (...all: number[]) => number;
}
const one = (call: (x: number) => number): Function_ => ({ least: 1, most: 1, call });
const two = (call: (x: number, y: number) => number): Function_ => ({ least: 2, most: 2, call });
const many = (call: (...all: number[]) => number): Function_ => ({ least: 1, most: Infinity, call });

const FUNCTIONS: Record<string, Function_> = {
    abs: one(Math.abs),
    acos: one(Math.acos),
    asin: one(Math.asin),
    atan: one(Math.atan),
    atan2: two(Math.atan2),
    ceil: one(Math.ceil),
    cos: one(Math.cos),
    deg: one((x) => x * DEGREES),
    exp: one(Math.exp),
    floor: one(Math.floor),
    hypot: many(Math.hypot),
    log: one(Math.log),
    log10: one(Math.log10),
    max: many(Math.max),
    min: many(Math.min),
    mod: two((x, y) => x - y * Math.floor(x / y)),
    rad: one((x) => x / DEGREES),
    round: one(Math.round),
    sign: one(Math.sign),
    sin: one(Math.sin),
    sqrt: one(Math.sqrt),
    tan: one(Math.tan),
};

export const functionNames = Object.keys(FUNCTIONS);

const TOKEN = /\s*(?:(\d+\.?\d*(?:[eE][-+]?\d+)?|\.\d+(?:[eE][-+]?\d+)?)|([A-Za-z_]\w*)|([-+*/%^()[\],]))/y;
// With the dot before the field.
const TOPIC = /\s*(\/\d+\/\d+\/[A-Za-z_]\w*(?:\/\w+)?)\./y;
const MAX_LENGTH = 500,
    MAX_DEPTH = 50;

// There, a '/' is no division.
const isOperandNext = (last: Token | undefined): boolean =>
    last === undefined || (last.kind === "sign" && last.text !== ")" && last.text !== "]");

function tokens(text: string): Token[] {
    const all: Token[] = [];
    let at = 0;
    while (text.slice(at).trim() !== "") {
        const start = at + (text.slice(at).length - text.slice(at).trimStart().length);
        TOPIC.lastIndex = TOKEN.lastIndex = at;
        const topic = isOperandNext(all.at(-1)) ? TOPIC.exec(text) : null;
        const match = topic ?? TOKEN.exec(text);
        if (!match) throw new FormulaError(`'${[...text.slice(start)][0]}' does not belong in a formula`, start);
        const [, number, name, sign] = match;
        const kind = topic ? "topic" : number ? "number" : name ? "name" : "sign";
        all.push({ kind, text: number ?? name ?? sign ?? "", at: start });
        at = topic ? TOPIC.lastIndex : TOKEN.lastIndex;
    }
    all.push({ kind: "end", text: "", at: text.length });
    return all;
}

const SUMS: Record<string, (a: number, b: number) => number> = { "+": (a, b) => a + b, "-": (a, b) => a - b };
const PRODUCTS: Record<string, (a: number, b: number) => number> = {
    "*": (a, b) => a * b,
    "/": (a, b) => a / b,
    "%": (a, b) => a % b,
};

class Parser {
    readonly uses: Use[] = [];
    private next = 0;
    private depth = 0;
    constructor(private readonly all: Token[]) {}

    whole(): Formula {
        const formula = this.sum();
        if (this.token.kind !== "end") this.fail(`expected an operator before '${this.token.text}'`);
        return formula;
    }

    private get token(): Token {
        return this.all[this.next] as Token;
    }
    private fail(message: string, at = this.token.at): never {
        throw new FormulaError(message, at);
    }

    private accept(text: string): boolean {
        if (this.token.kind !== "sign" || this.token.text !== text) return false;
        ++this.next;
        return true;
    }

    private expect(text: string, why: string): void {
        if (!this.accept(text)) this.fail(`expected '${text}' ${why}`);
    }

    private chain(table: Record<string, (a: number, b: number) => number>, operand: () => Formula): Formula {
        let left = operand();
        for (let call = this.operator(table); call; call = this.operator(table)) {
            const first = left,
                second = operand(),
                apply = call;
            left = (numbers) => apply(first(numbers), second(numbers));
        }
        return left;
    }

    private operator(table: Record<string, (a: number, b: number) => number>) {
        const { kind, text } = this.token;
        if (kind !== "sign" || !Object.hasOwn(table, text)) return null;
        ++this.next;
        return table[text];
    }

    private sum(): Formula {
        if (++this.depth > MAX_DEPTH) this.fail("too many parentheses");
        const formula = this.chain(SUMS, () => this.chain(PRODUCTS, () => this.signed()));
        --this.depth;
        return formula;
    }

    // -x^2 is -(x^2), and 2^-1 is allowed.
    private signed(): Formula {
        let isNegative = false;
        for (;;) {
            if (this.accept("-")) isNegative = !isNegative;
            else if (!this.accept("+")) break;
        }
        const formula = this.power();
        return isNegative ? (numbers) => -formula(numbers) : formula;
    }

    private power(): Formula {
        const base = this.primary();
        if (!this.accept("^")) return base;
        if (++this.depth > MAX_DEPTH) this.fail("too many powers");
        const exponent = this.signed();
        --this.depth;
        return (numbers) => base(numbers) ** exponent(numbers);
    }

    private primary(): Formula {
        const { kind, text, at } = this.token;
        if (this.accept("(")) {
            const inner = this.sum();
            this.expect(")", "for the '(' before");
            return inner;
        }
        if (kind === "end") this.fail("the formula ends too early: a number or a field is missing");
        if (kind === "sign") this.fail(`expected a number or a field before '${text}'`);
        ++this.next;
        if (kind === "number") {
            const value = Number(text);
            return () => value;
        }
        if (kind === "topic") return this.fieldOf(text);
        return this.accept("(") ? this.call(text, at) : this.named(text, at);
    }

    private fieldOf(topic: string): Formula {
        const { kind, text, at } = this.token;
        if (kind !== "name") this.fail(`expected a field of ${topic}`);
        ++this.next;
        return this.field(topic, text, at);
    }

    private named(name: string, at: number): Formula {
        const constant = Object.hasOwn(CONSTANTS, name) ? CONSTANTS[name] : undefined;
        const isElement = this.token.kind === "sign" && this.token.text === "[";
        return constant !== undefined && !isElement ? () => constant : this.field(null, name, at);
    }

    private field(topic: string | null, name: string, at: number): Formula {
        const element = this.accept("[") ? this.element() : null;
        this.uses.push({ topic, name, element, at });
        return (numbers) => numbers(name, element, topic);
    }

    private element(): number {
        const { kind, text } = this.token;
        if (kind !== "number" || !/^\d+$/.test(text)) this.fail("expected the number of an array element, as in [0]");
        ++this.next;
        this.expect("]", "after the number of the element");
        return Number(text);
    }

    private call(name: string, at: number): Formula {
        const found = Object.hasOwn(FUNCTIONS, name) ? FUNCTIONS[name] : undefined;
        if (!found) this.fail(`there is no function '${name}'; there are ${functionNames.join(", ")}`, at);
        const all = this.arguments();
        if (all.length < found.least || all.length > found.most) {
            const wanted =
                found.most === Infinity
                    ? "at least one value"
                    : found.least === 1
                      ? "one value"
                      : `${found.least} values`;
            this.fail(`${name} takes ${wanted}, not ${all.length}`, at);
        }
        return (numbers) => found.call(...all.map((argument) => argument(numbers)));
    }

    private arguments(): Formula[] {
        if (this.accept(")")) return [];
        const all = [this.sum()];
        while (this.accept(",")) all.push(this.sum());
        this.expect(")", "after the values of the function");
        return all;
    }
}

// Throws FormulaError, which states where and why.
export function parseFormula(text: string): Parsed {
    if (text.length > MAX_LENGTH) throw new FormulaError(`a formula has at most ${MAX_LENGTH} characters`, MAX_LENGTH);
    const parser = new Parser(tokens(text));
    return { formula: parser.whole(), uses: parser.uses };
}
