// What the page makes of a map and its cells: page_map.mjs FOLDER. FOLDER: the page's model.ts,
// plane.ts and words.ts as JavaScript.
import assert from 'node:assert/strict';
import { register } from 'node:module';
import { pathToFileURL } from 'node:url';
import { check } from './page_check.mjs';

// Its parts name each other without an ending, as the bundler has it.
const ENDED = 'export const resolve = (name, context, next) => next(/^[.][/][a-z]+$/.test(name) ? name + ".js" : name, context);';
register(`data:text/javascript,${encodeURIComponent(ENDED)}`);
globalThis.matchMedia = () => ({ addEventListener() {} });
const load = name => import(pathToFileURL(`${process.argv[2]}/${name}.js`).href);
const { Model } = await load('model'), { cellWords } = await load('plane'), { mapWords } = await load('words');

const MAP = { number: 5, places: 4, verdict: 'FOUND', doubts: 0, stop: 'GO_ON', x_m: 0.01, x_low_m: 0.008, x_high_m: 0.012,
  y_m: -0.002, y_low_m: -0.004, y_high_m: 0, depth_m: 0.005, depth_low_m: 0.004, depth_high_m: 0.006,
  radius_m: 0.015, radius_low_m: 0.01, radius_high_m: 0.018, next_x_m: 0.004, next_y_m: 0.012 };
const cell = (number, index, count) => ({ number, index, count, x_m: 0.002 * index, y_m: 0, stiffness: 1 + index, stiffness_stddev: 0.1, inclusion: 0.5 });
const hear = (model, topic, message) => model.hear(topic, 1, message, 1);
const status = session => ({ session, peer_heard: false });

const tests = {
  'a map is shown when its report and all of its cells are here, in whatever order'() {
    const model = new Model();
    for (const index of [2, 0]) hear(model, 'map_cell', cell(5, index, 3));
    hear(model, 'map', MAP);
    assert.equal(model.plane, undefined);
    hear(model, 'map_cell', cell(5, 0, 3));
    assert.equal(model.plane, undefined, 'one that came twice is no other');
    hear(model, 'map_cell', cell(5, 1, 3));
    assert.deepEqual(model.plane.cells.map(one => one.stiffness), [1, 2, 3]);
    assert.deepEqual(model.plane.next, { x: 4, y: 12 });
  },
  'the map before stays until the next one is whole'() {
    const model = new Model();
    hear(model, 'map', MAP);
    for (const index of [0, 1]) hear(model, 'map_cell', cell(5, index, 2));
    hear(model, 'map_cell', cell(6, 0, 3));
    assert.equal(model.plane.cells.length, 2);
    for (const index of [1, 2]) hear(model, 'map_cell', cell(6, index, 3));
    assert.equal(model.plane.cells.length, 3);
  },
  'another session has another map'() {
    const model = new Model();
    hear(model, 'status', status('1'));
    hear(model, 'map', MAP);
    hear(model, 'map_cell', cell(5, 0, 1));
    hear(model, 'status', status('1'));
    assert.ok(model.plane);
    hear(model, 'status', status('2'));
    assert.equal(model.plane, undefined);
    assert.equal(model.map, undefined);
  },
  'its words say place, depth, size, doubt and the next tap'() {
    const model = new Model();
    hear(model, 'map', { ...MAP, doubts: 8 });
    assert.match(mapWords(model.map), /x 10\.0 mm \(8\.0 to 12\.0\), y \u22122\.0 mm .*top 5\.0 mm \(4\.0 to 6\.0\) deep, radius 15\.0 mm/);
    assert.match(mapWords(model.map), /Not trusted: it may lie beyond/);
    assert.match(mapWords(model.map), /Next tap: 4, 12 mm/);
    assert.equal(model.map.ball.trusted, false);
    hear(model, 'map', { ...MAP, verdict: 'NONE', stop: 'KNOWN' });
    assert.match(mapWords(model.map), /^No inclusion found at 4 places\. Enough taps\.$/);
  },
  'a cell is told with its doubt and units'() {
    assert.equal(cellWords({ x: -4, y: 2, stiffness: 1.324, stddev: 0.061, inclusion: 0.84 }),
      'x \u22124.0, y 2.0 mm: 1.32 times plain tissue, \u00b1 6 %; an inclusion below: 84 %');
  },
};

check(tests);
