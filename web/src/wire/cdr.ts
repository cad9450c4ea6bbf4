// SPDX-License-Identifier: MIT
// Decodes messages in CDR: four bytes of header, then the fields, each number aligned to its size.
import { sizeOf, type Field, type Schema, type Type } from "./schema";

export type Scalar = number | bigint | string;
export type Value = Scalar | Scalar[];
export type Message = Value[]; // in the order of the schema's fields

const HEADER = 4;
const utf8 = new TextDecoder();

// 64-bit integers are numbers as long as those are exact.
function exact(value: bigint): number | bigint {
    return value <= Number.MAX_SAFE_INTEGER && value >= Number.MIN_SAFE_INTEGER ? Number(value) : value;
}

const READERS: Record<Exclude<Type, "string">, (data: DataView, at: number) => number | bigint> = {
    int8: (data, at) => data.getInt8(at),
    uint8: (data, at) => data.getUint8(at),
    int16: (data, at) => data.getInt16(at, true),
    uint16: (data, at) => data.getUint16(at, true),
    int32: (data, at) => data.getInt32(at, true),
    uint32: (data, at) => data.getUint32(at, true),
    int64: (data, at) => exact(data.getBigInt64(at, true)),
    uint64: (data, at) => exact(data.getBigUint64(at, true)),
    float32: (data, at) => data.getFloat32(at, true),
    float64: (data, at) => data.getFloat64(at, true),
};

class Reader {
    private at = HEADER;
    constructor(private readonly data: DataView) {}

    field(field: Field): Value {
        if (field.length === null) return this.scalar(field.type);
        const all: Scalar[] = new Array(field.length);
        for (let i = 0; i < field.length; ++i) all[i] = this.scalar(field.type);
        return all;
    }

    private scalar(type: Type): Scalar {
        const size = sizeOf(type);
        this.at = HEADER + Math.ceil((this.at - HEADER) / size) * size;
        if (type === "string") return this.text();
        const value = READERS[type](this.data, this.at);
        this.at += size;
        return value;
    }

    // The length counts the final NUL.
    private text(): string {
        const length = this.data.getUint32(this.at, true);
        const bytes = new Uint8Array(this.data.buffer, this.data.byteOffset + this.at + 4, Math.max(0, length - 1));
        this.at += 4 + length;
        return utf8.decode(bytes);
    }
}

// Throws RangeError if the message is too short.
export function decode(schema: Schema, data: DataView): Message {
    if (data.byteLength < HEADER || data.getUint8(1) !== 1) throw new RangeError("not a little-endian CDR message");
    const reader = new Reader(data);
    return schema.fields.map((field) => reader.field(field));
}

// One number of a message, for plots. Texts and elements that do not exist are NaN.
export function numberAt(message: Message, field: number, element: number | null): number {
    const value = message[field];
    const one = Array.isArray(value) ? value[element ?? 0] : value;
    return typeof one === "string" || one === undefined ? NaN : Number(one);
}
