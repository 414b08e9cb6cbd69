// What the page makes of the camera's frames: page_camera.mjs FOLDER. FOLDER: the page's camera.ts
// as JavaScript. A decoder that does what the test says.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { check } from './page_check.mjs';

let now = 0, decoders = [], timers = [];
class Decoder {
  constructor(does) { Object.assign(this, { does, state: 'unconfigured', given: [] }); decoders.push(this); }
  configure(config) { this.state = 'configured'; this.config = config; }
  decode(chunk) { this.given.push(chunk); }
  close() { this.state = 'closed'; }
  /** Gives back the oldest that waits. */
  put() {
    const { timestamp } = this.given.shift();
    this.does.output({ timestamp, displayWidth: 4, displayHeight: 2, close() {} });
  }
}
Object.assign(globalThis, { setTimeout: (does, ms) => timers.push({ does, ms }), VideoDecoder: Decoder, EncodedVideoChunk: class { constructor(chunk) { Object.assign(this, chunk); } } });
Object.defineProperty(globalThis, 'performance', { value: { now: () => now } });
const { Camera, codecOf, lagWords } = await import(pathToFileURL(`${process.argv[2]}/camera.js`).href);

const KEY = Uint8Array.from([0, 0, 0, 1, 0x67, 0x42, 0xc0, 0x1f, 9, 0, 0, 0, 1, 0x65, 1, 2]);
const DELTA = Uint8Array.from([0, 0, 0, 1, 0x61, 1, 2, 3]);

function rig() {
  decoders = [];
  timers = [];
  now = 10000;
  const asked = [], touch = { age: 0 };
  const camera = new Camera({
    age: (stamp, at) => at - stamp, early: age => Math.max(0, touch.age - age), ask: () => asked.push(now), drew() {},
  });
  return { camera, asked, touch, decoder: () => decoders.at(-1) };
}

const tests = {
  'a frame with its parameter set names its codec, others begin nothing'() {
    assert.equal(codecOf(KEY), 'avc1.42C01F');
    assert.equal(codecOf(DELTA), undefined);
    assert.equal(codecOf(new Uint8Array(0)), undefined);
  },
  'nothing is decoded before a key frame, which is asked for'() {
    const { camera, asked } = rig();
    camera.hear(DELTA, 1, now);
    assert.equal(decoders.length, 0);
    assert.equal(asked.length, 1);
    camera.hear(DELTA, 2, now + 100);
    assert.equal(asked.length, 1, 'and not with each frame');
  },
  'a picture bears its stamp and its age'() {
    const { camera, decoder } = rig();
    camera.hear(KEY, 9990, now);
    assert.equal(decoder().config.codec, 'avc1.42C01F');
    assert.deepEqual(decoder().given.map(one => one.type), ['key']);
    now += 5;
    decoder().put();
    assert.deepEqual(camera.shown, { stamp: 9990, at: 10005, age: 15 });
  },
  'a frame that a decoder swallowed shifts no stamp'() {
    const { camera, decoder } = rig();
    camera.hear(KEY, 9970, now);
    camera.hear(DELTA, 9990, now);
    decoder().given.shift();
    decoder().put();
    assert.equal(camera.shown.stamp, 9990);
    for (let i = 0; i < 3; i++) camera.hear(DELTA, 9991 + i, now);
    assert.equal(camera.resets, 0, 'nor does it wait for ever');
  },
  'a decoder that is behind is begun anew, from a key frame only'() {
    const { camera, asked, decoder } = rig();
    camera.hear(KEY, 1, now);
    for (let i = 0; i < 4; i++) camera.hear(DELTA, 2 + i, now);
    assert.equal(decoder().state, 'closed');
    assert.equal(camera.resets, 1);
    assert.equal(asked.length, 1);
    camera.hear(DELTA, 9, now);
    assert.equal(decoders.length, 1, 'what rests on what was dropped is of no use');
    camera.hear(KEY, 10, now);
    assert.equal(decoders.length, 2);
    assert.equal(decoder().state, 'configured');
  },
  'one frame that waits too long is enough'() {
    const { camera, decoder } = rig();
    camera.hear(KEY, 1, now);
    camera.hear(DELTA, 2, now + 151);
    assert.equal(decoder().state, 'closed');
  },
  'what a closed decoder still gives back is not shown'() {
    const { camera, decoder } = rig();
    camera.hear(KEY, 1, now);
    const former = decoder();
    camera.end();
    former.put();
    assert.equal(camera.shown, undefined);
  },
  'a fault of the decoder begins it anew'() {
    const { camera, asked, decoder } = rig();
    camera.hear(KEY, 1, now);
    decoder().does.error(new Error('damaged'));
    assert.equal(asked.length, 1);
    assert.equal(decoder().state, 'closed');
  },
  'a picture that came before touch waits until touch is as old'() {
    const { camera, decoder, touch } = rig();
    touch.age = 40;
    camera.hear(KEY, 9990, now);
    decoder().put();
    assert.equal(camera.shown, undefined);
    assert.deepEqual(timers.map(one => one.ms), [30]);
    now += 30;
    timers[0].does();
    assert.deepEqual(camera.shown, { stamp: 9990, at: 10030, age: 40 });
  },
  'no picture is shown after a newer one, nor after its session'() {
    const { camera, decoder, touch } = rig();
    touch.age = 40;
    camera.hear(KEY, 9990, now);
    decoder().put();
    touch.age = 0;
    camera.hear(DELTA, 9995, now);
    decoder().put();
    timers[0].does();
    assert.equal(camera.shown.stamp, 9995);
    touch.age = 40;
    camera.hear(DELTA, 9999, now);
    decoder().put();
    camera.end();
    timers[1].does();
    assert.equal(camera.shown, undefined);
  },
  'a decoder keeps places: of pictures that wait there are four at most'() {
    const { camera, decoder, touch } = rig();
    touch.age = 900;
    for (let i = 0; i < 5; i++) {
      camera.hear(i === 0 ? KEY : DELTA, 9900 + i, now);
      decoder().put();
    }
    assert.equal(timers.length, 4);
    assert.equal(camera.shown.stamp, 9904);
  },
  'a browser without WebCodecs says so'() {
    const { camera } = rig();
    globalThis.VideoDecoder = undefined;
    camera.hear(KEY, 1, now);
    assert.match(camera.fault, /camera\.codec=jpeg/);
    globalThis.VideoDecoder = Decoder;
  },
  'how far behind touch, in words'() {
    assert.deepEqual([10, 40, 150, 250, 400].map(ms => lagWords(ms).tone), ['ok', 'ok', '', 'warn', 'bad']);
  },
};

check(tests);
