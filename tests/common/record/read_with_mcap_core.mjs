// Opens a session file with readers that are not ours (@mcap/core, protobufjs, fzstd) and with
// nothing but the schemas embedded in it. Prints one JSON object:
//   {"closed": true, "messages": 3, "topics": {"patient/tick": 2, ...}, "attachments": [...],
//    "metadata": {...}, "first": {"patient/tick": {...}}}
// Exit code 1: a message could not be decoded, or the counts of the file's statistics differ.
// Usage: node read_with_mcap_core.mjs FILE [--cut-off]     (--cut-off: a file without its end)
import { open, readFile } from "node:fs/promises";
import process from "node:process";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";
import protobuf from "protobufjs";
import descriptor from "protobufjs/ext/descriptor/index.js";

const { FileDescriptorSet } = descriptor;

const decompressHandlers = {
  zstd: (bytes, size) => decompress(bytes, new Uint8Array(Number(size))),
};

class Readable {
  constructor(handle, size) {
    this.handle = handle;
    this.bytes = size;
  }
  async size() {
    return BigInt(this.bytes);
  }
  async read(offset, length) {
    const buffer = new Uint8Array(Number(length));
    const { bytesRead } = await this.handle.read(buffer, 0, buffer.length, Number(offset));
    if (bytesRead !== buffer.length) {
      throw new Error(`only ${bytesRead} of ${length} bytes at ${offset}`);
    }
    return buffer;
  }
}

class Tally {
  topics = {};
  first = {};
  messages = 0;
  #types = new Map();
  #channels = new Map();
  #schemas = new Map();

  schema(record) {
    this.#schemas.set(record.id, record);
  }
  channel(record) {
    this.#channels.set(record.id, record);
  }
  message(record) {
    const channel = this.#channels.get(record.channelId);
    const type = this.#type(channel.schemaId);
    const value = type.decode(record.data);
    this.messages += 1;
    this.topics[channel.topic] = (this.topics[channel.topic] ?? 0) + 1;
    this.first[channel.topic] ??= type.toObject(value, { longs: String, enums: String });
  }
  #type(schemaId) {
    if (!this.#types.has(schemaId)) {
      const schema = this.#schemas.get(schemaId);
      if (schema.encoding !== "protobuf") {
        throw new Error(`schema ${schema.name} is encoded as ${schema.encoding}`);
      }
      const root = protobuf.Root.fromDescriptor(FileDescriptorSet.decode(schema.data));
      this.#types.set(schemaId, root.lookupType(schema.name));
    }
    return this.#types.get(schemaId);
  }
}

async function readClosed(path, tally) {
  const handle = await open(path);
  const { size } = await handle.stat();
  const reader = await McapIndexedReader.Initialize({
    readable: new Readable(handle, size),
    decompressHandlers,
  });
  for (const schema of reader.schemasById.values()) tally.schema(schema);
  for (const channel of reader.channelsById.values()) tally.channel(channel);
  for await (const message of reader.readMessages({ validateCrcs: true })) tally.message(message);
  const attachments = [];
  for await (const attachment of reader.readAttachments()) attachments.push(attachment.name);
  const metadata = {};
  for await (const record of reader.readMetadata()) {
    metadata[record.name] = Object.fromEntries(record.metadata);
  }
  if (reader.statistics.messageCount !== BigInt(tally.messages)) {
    throw new Error(`statistics: ${reader.statistics.messageCount}, read: ${tally.messages}`);
  }
  await handle.close();
  return { closed: true, attachments, metadata };
}

async function readCutOff(path, tally) {
  const reader = new McapStreamReader({ decompressHandlers, validateCrcs: true });
  reader.append(await readFile(path));
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Schema") tally.schema(record);
    if (record.type === "Channel") tally.channel(record);
    if (record.type === "Message") tally.message(record);
  }
  return { closed: reader.done() };
}

const [path, mode] = process.argv.slice(2);
const tally = new Tally();
try {
  const rest = await (mode === "--cut-off" ? readCutOff : readClosed)(path, tally);
  const { messages, topics, first } = tally;
  console.log(JSON.stringify({ ...rest, messages, topics, first }));
} catch (error) {
  console.error(`${path}: ${error.message}`);
  process.exitCode = 1;
}
