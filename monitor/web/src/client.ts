// A client of the site's live protocol (Foxglove WebSocket, foxglove.sdk.v1).
import { decode, readSchema, type Message, type Schema } from './schema';

interface Topic { id: number; topic: string; encoding: string; schemaName: string; schema: string }
export interface Greeting { name: string; sessionId: string; metadata: Record<string, string> }
export interface Answer { ok: boolean; why: string }

export interface Listener {
  greeted(greeting: Greeting): void;
  /** `stamp`: ms since 1970, the sample's own instant. */
  heard(topic: string, stamp: number, message: Message): void;
  said(sentence: string): void;
  /** `refused`: the site was there and would not have us. */
  ended(refused: boolean): void;
}

const ENCODE = new TextEncoder(), DECODE = new TextDecoder();
const POINTER_CHANNEL = 1;
const RETRY_MS = 1000;

const nameOf = (topic: Topic): string => topic.topic.replace(/^.*\//, '');

function bytesOf(base64: string): Uint8Array {
  return Uint8Array.from(atob(base64), c => c.charCodeAt(0));
}

export class Client {
  private socket: WebSocket | undefined;
  private topics = new Map<number, { topic: Topic; schema: Schema | undefined }>();
  private services = new Map<string, number>();
  private calls = new Map<number, (answer: Answer) => void>();
  private lastCall = 0;
  private left = new Set<string>();  // topics that nobody wants now
  private open = false;

  constructor(private readonly token: string, private readonly listener: Listener) { this.connect(); }

  private connect(): void {
    const socket = new WebSocket(`ws://${location.host}/?token=${encodeURIComponent(this.token)}`, ['foxglove.sdk.v1']);
    socket.binaryType = 'arraybuffer';
    socket.onmessage = event => {
      if (typeof event.data === 'string') this.text(event.data); else this.bytes(new DataView(event.data as ArrayBuffer));
    };
    socket.onopen = () => { this.open = true; };
    socket.onclose = () => {
      const was = this.open;
      this.open = false;
      this.topics.clear();
      this.services.clear();
      for (const settle of this.calls.values()) settle({ ok: false, why: 'the site does not answer' });
      this.calls.clear();
      this.listener.ended(!was);
      setTimeout(() => this.connect(), RETRY_MS);
    };
    this.socket = socket;
  }

  private text(json: string): void {
    const said = JSON.parse(json) as { op: string; [more: string]: unknown };
    if (said.op === 'serverInfo') {
      const greeting = said as unknown as Greeting;
      if (greeting.metadata.right === 'control') {
        this.send({ op: 'advertise', channels: [{ id: POINTER_CHANNEL, topic: 'monitor/pointer', encoding: 'json', schemaName: 'palp.monitor.Pointer' }] });
      }
      this.listener.greeted(greeting);
    } else if (said.op === 'advertise') {
      const topics = said.channels as Topic[];
      for (const topic of topics) {
        this.topics.set(topic.id, { topic, schema: topic.encoding === 'protobuf' ? readSchema(bytesOf(topic.schema)) : undefined });
      }
      this.subscribe(topics.filter(t => !this.left.has(nameOf(t))));
    } else if (said.op === 'advertiseServices') {
      for (const one of said.services as { id: number; name: string }[]) this.services.set(one.name, one.id);
    } else if (said.op === 'status') {
      this.listener.said(String(said.message));
    } else if (said.op === 'serviceCallFailure') {
      this.settle(said.callId as number, { ok: false, why: String(said.message) });
    }
  }

  private bytes(view: DataView): void {
    const kind = view.getUint8(0);
    if (kind === 1) {
      const known = this.topics.get(view.getUint32(1, true));
      if (!known) return;
      const stamp = Number(view.getBigUint64(5, true) / 1000n) / 1000;
      const payload = new Uint8Array(view.buffer, 13);
      const message = known.schema ? decode(known.schema, `.${known.topic.schemaName}`, payload)
        : JSON.parse(DECODE.decode(payload)) as Message;
      this.listener.heard(nameOf(known.topic), stamp, message);
    } else if (kind === 3) {
      const encoding = view.getUint32(9, true);
      this.settle(view.getUint32(5, true), JSON.parse(DECODE.decode(new Uint8Array(view.buffer, 13 + encoding))) as Answer);
    }
  }

  private settle(call: number, answer: Answer): void {
    this.calls.get(call)?.(answer);
    this.calls.delete(call);
  }

  private send(json: unknown): void { if (this.open) this.socket!.send(JSON.stringify(json)); }

  private subscribe(topics: Topic[]): void {
    if (topics.length > 0) this.send({ op: 'subscribe', subscriptions: topics.map(t => ({ id: t.id, channelId: t.id })) });
  }

  /** Whether the site has such a topic. */
  tells(name: string): boolean { return [...this.topics.values()].some(one => nameOf(one.topic) === name); }

  /** Of these topics nothing more, or all of it from now on: of the camera a key frame first. */
  follow(names: string[], wanted: boolean): void {
    for (const name of names) if (wanted) this.left.delete(name); else this.left.add(name);
    const topics = [...this.topics.values()].map(one => one.topic).filter(t => names.includes(nameOf(t)));
    if (wanted) this.subscribe(topics);
    else if (topics.length > 0) this.send({ op: 'unsubscribe', subscriptionIds: topics.map(t => t.id) });
  }

  /** Whether the site has such a service for us. */
  offers(service: string): boolean { return this.services.has(service); }

  call(service: string, request: unknown = {}): Promise<Answer> {
    const id = this.services.get(service);
    if (id === undefined || !this.open) return Promise.resolve({ ok: false, why: 'the site does not offer this here' });
    const body = ENCODE.encode('json' + JSON.stringify(request)), view = new DataView(new ArrayBuffer(13 + body.length));
    const call = ++this.lastCall;
    view.setUint8(0, 2);
    view.setUint32(1, id, true);
    view.setUint32(5, call, true);
    view.setUint32(9, 4, true);
    new Uint8Array(view.buffer).set(body, 13);
    this.socket!.send(view);
    return new Promise(settle => this.calls.set(call, settle));
  }

  /** Where the pointer is; nothing is kept for later. */
  point(report: { press: number; held: boolean; into_m: number; x_m: number; y_m: number }): void {
    if (!this.open) return;
    const body = ENCODE.encode(JSON.stringify(report)), view = new DataView(new ArrayBuffer(5 + body.length));
    view.setUint8(0, 1);
    view.setUint32(1, POINTER_CHANNEL, true);
    new Uint8Array(view.buffer).set(body, 5);
    this.socket!.send(view);
  }
}
