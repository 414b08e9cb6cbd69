// What ends a press on the page and what may draw it: page_pilot.mjs FOLDER. FOLDER: the page's
// pilot.ts and model.ts as JavaScript. A page of nothing but events and a clock.
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { check } from './page_check.mjs';

const folder = process.argv[2];
const load = async name => import(pathToFileURL(`${folder}/${name}.js`).href);

let now = 0, timers = [];
const listeners = new Map();
const listen = (name, heard) => listeners.set(name, [...listeners.get(name) ?? [], heard]);
const happen = name => { for (const heard of listeners.get(name) ?? []) heard(); };
Object.assign(globalThis, {
  addEventListener: listen,
  document: { hidden: false, addEventListener: listen },
  setInterval: call => { timers.push(call); return timers.length; },
  clearInterval: id => { timers[id - 1] = () => {}; },
});
Object.defineProperty(globalThis, 'performance', { value: { now: () => now } });
const { Pilot } = await load('pilot');
const { Model } = await load('model');

const SCALE = 0.1;  // [mm/px]

/** A page that has the pointer, and what it tells the site. */
function rig() {
  listeners.clear();
  timers = [];
  const told = [], model = new Model();
  model.begin({ name: 'palp-surgeon', sessionId: 'r', metadata: { site: 'surgeon', right: 'control', pointer: 'yes', client: '1' } });
  const tell = () => model.hear('status', now, { pilot: 1, peer_position_mm: 0, peer_x_mm: 0, peer_y_mm: 0 }, now);
  tell();
  const pilot = new Pilot({ point: report => told.push(report) }, model);
  /** So many ms in which the site tells what happens. */
  const pass = ms => {
    for (let i = 0; i < ms; i += 16) { now += 16; tell(); for (const call of [...timers]) call(); }
  };
  return { pilot, model, told, pass, last: () => told.at(-1) };
}

const tests = {
  'a pointer that did not open the press draws nothing'() {
    const { pilot, pass, last } = rig();
    pilot.key(' ', true);
    pass(32);
    pilot.draw(1, 0, 700, 500, SCALE, false);
    pilot.draw(1, 1, 720, 520, SCALE, false);
    pass(32);
    assert.deepEqual(last(), { press: 1, held: true, into_m: 0, x_m: 0, y_m: 0 });
    pilot.key(' ', false);
    pilot.down(1, 700, 500);
    pilot.draw(2, 1, 0, 0, SCALE, false);
    pilot.draw(1, 1, 700, 510, SCALE, false);
    pass(16);
    assert.deepEqual(last(), { press: 2, held: true, into_m: 1e-3, x_m: 0, y_m: 0 });
  },
  'a pointer whose button is up lets go'() {
    const { pilot, last } = rig();
    pilot.down(1, 700, 500);
    pilot.draw(1, 0, 700, 600, SCALE, false);
    assert.equal(pilot.finger, undefined);
    assert.equal(last().held, false);
    assert.equal(last().into_m, 0);
  },
  'an arrow key moves two millimetres a second'() {
    const { pilot, pass, last } = rig();
    pilot.key(' ', true);
    pilot.key('ArrowDown', true);
    pass(1600);
    assert.ok(Math.abs(last().into_m - 3.2e-3) < 1e-9, `${last().into_m}`);
  },
  'a key that came up unheard moves nothing at the next press'() {
    for (const lost of [['blur', false], ['pagehide', false], ['visibilitychange', true], ['', false]]) {
      const { pilot, pass, last } = rig();
      pilot.key('ArrowDown', true);
      document.hidden = lost[1];
      happen(lost[0]);
      document.hidden = false;
      pilot.key(' ', true);
      pass(320);
      assert.equal(last().into_m, 0, lost[0]);
    }
  },
  'and none that was forgotten while no finger was down'() {
    const { pilot } = rig();
    pilot.key('ArrowDown', true);
    pilot.up();
    assert.equal(pilot.keys.size, 0);
  },
  'what comes evenly through a long queue is old, and lets go'() {
    const { pilot, model, pass, last } = rig();
    pilot.key(' ', true);
    pass(320);
    model.hear('client', now, { round_trip_ms: 450 }, now);
    assert.equal(model.stale(now), false);
    assert.equal(model.stale(now + 51), true);
    model.hear('client', now, { round_trip_ms: 3000 }, now);
    pass(32);
    assert.equal(model.stale(now), true);
    assert.equal(last().held, false);
    pilot.key(' ', true);
    assert.equal(pilot.finger, undefined, 'nor does a press begin');
    model.begin(model.greeting);
    assert.equal(model.stale(now), false, 'of another connection nothing is known yet');
  },
};

check(tests);
