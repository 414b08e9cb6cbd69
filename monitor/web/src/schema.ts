// Reads protobuf messages by the descriptors that the site sends with each topic: no code is made
// for them beforehand, and none at run time, which the page's policy forbids.

export type Value = number | string | boolean | Uint8Array | Message;
export interface Message { [field: string]: Value }
interface Field { name: string; type: number; typeName: string }
export type Fields = Map<number, Field>;
export interface Schema { messages: Map<string, Fields>; enums: Map<string, Map<number, string>> }

const TEXT = new TextDecoder();

/** Each field of a message: number, wire type, and the varint or the bytes of it. */
function* parts(bytes: Uint8Array): Generator<[number, number, number, Uint8Array]> {
  let at = 0;
  const varint = (): number => {
    let value = 0, scale = 1, high = 0n;
    for (let i = 0; i < 10 && at < bytes.length; i++) {
      const one = bytes[at++]!;
      if (i < 7) value += (one & 127) * scale;
      else high |= BigInt(one & 127) << BigInt(7 * i);
      scale *= 128;
      if (one < 128) break;
    }
    return high === 0n ? value : Number(BigInt.asIntN(64, high | BigInt(value)));
  };
  while (at < bytes.length) {
    const key = varint(), wire = key & 7;
    let value = 0, size = 0;
    if (wire === 0) value = varint();
    else if (wire === 1) size = 8;
    else if (wire === 2) size = varint();
    else if (wire === 5) size = 4;
    else return;
    if (at + size > bytes.length) return;
    yield [Math.floor(key / 8), wire, value, bytes.subarray(at, at + size)];
    at += size;
  }
}

/** Of a FileDescriptorSet. */
export function readSchema(set: Uint8Array): Schema {
  const schema: Schema = { messages: new Map(), enums: new Map() };
  const readEnum = (bytes: Uint8Array, scope: string) => {
    const names = new Map<number, string>();
    let name = '';
    for (const [number, , , part] of parts(bytes)) {
      if (number === 1) name = TEXT.decode(part);
      if (number !== 2) continue;
      let word = '', of = 0;
      for (const [n, , v, p] of parts(part)) { if (n === 1) word = TEXT.decode(p); if (n === 2) of = v; }
      names.set(of, word);
    }
    schema.enums.set(`${scope}.${name}`, names);
  };
  const readMessage = (bytes: Uint8Array, scope: string) => {
    const fields: Fields = new Map(), all = [...parts(bytes)];
    const full = `${scope}.${TEXT.decode(all.find(p => p[0] === 1)![3])}`;
    for (const [number, , , part] of all) {
      if (number === 3) readMessage(part, full);
      if (number === 4) readEnum(part, full);
      if (number !== 2) continue;
      const field: Field = { name: '', type: 0, typeName: '' };
      let of = 0;
      for (const [n, , v, p] of parts(part)) {
        if (n === 1) field.name = TEXT.decode(p);
        if (n === 3) of = v;
        if (n === 5) field.type = v;
        if (n === 6) field.typeName = TEXT.decode(p);
      }
      fields.set(of, field);
    }
    schema.messages.set(full, fields);
  };
  for (const [, , , file] of parts(set)) {
    const all = [...parts(file)], scope = `.${TEXT.decode(all.find(p => p[0] === 2)![3])}`;
    for (const [number, , , part] of all) {
      if (number === 4) readMessage(part, scope);
      if (number === 5) readEnum(part, scope);
    }
  }
  return schema;
}

/** What a message says; what it leaves out is 0, empty or false, as in proto3. */
export function decode(schema: Schema, name: string, bytes: Uint8Array): Message {
  const fields = schema.messages.get(name), out: Message = {};
  if (!fields) return out;
  for (const field of fields.values()) {
    if (field.type === 8) out[field.name] = false;
    else if (field.type === 9) out[field.name] = '';
    else if (field.type === 14) out[field.name] = schema.enums.get(field.typeName)?.get(0) ?? '';
    else if (field.type !== 11) out[field.name] = 0;
  }
  for (const [number, , value, part] of parts(bytes)) {
    const field = fields.get(number);
    if (!field) continue;
    const view = new DataView(part.buffer, part.byteOffset, part.byteLength);
    switch (field.type) {
      case 1: out[field.name] = view.getFloat64(0, true); break;
      case 2: out[field.name] = view.getFloat32(0, true); break;
      case 6: out[field.name] = Number(view.getBigUint64(0, true)); break;
      case 8: out[field.name] = value !== 0; break;
      case 9: out[field.name] = TEXT.decode(part); break;
      case 12: out[field.name] = part; break;
      case 11: out[field.name] = decode(schema, field.typeName, part); break;
      case 14: out[field.name] = schema.enums.get(field.typeName)?.get(value) ?? String(value); break;
      default: out[field.name] = value;
    }
  }
  return out;
}
