// What a page costs its browser: page_cost.mjs BROWSER URL.
import { readdirSync, readFileSync } from 'node:fs';
import { Browser, pause } from './browser.mjs';

const [program, url] = process.argv.slice(2);
const FIRST_PAINT_MAX_MS = 1000, CORE_MAX = 0.7, LOADS = 5, WINDOWS = 3, WINDOW_MS = 10000;
const TICKS_PER_S = 100;  // of /proc, on every Linux that we know
const median = list => [...list].sort((a, b) => a - b)[Math.floor(list.length / 2)];

/** What a process of the browser is for. */
const KINDS = { 'gpu-process': 'drawing', renderer: 'page', utility: 'network' };
function kindOf(pid) {
  const type = readFileSync(`/proc/${pid}/cmdline`, 'latin1').match(/--type=([a-z-]+)/)?.[1];
  return KINDS[type] ?? 'browser';
}

/** [s] of processor time of a process and all of its descendants, by what they are for. */
function processorTime(root) {
  const parents = new Map(), used = new Map();
  for (const pid of readdirSync('/proc').filter(name => /^\d+$/.test(name))) {
    try {
      const [, rest] = readFileSync(`/proc/${pid}/stat`, 'latin1').split(/\) (?=[A-Z] )/);
      const fields = rest.split(' ');
      parents.set(Number(pid), Number(fields[1]));
      used.set(Number(pid), (Number(fields[11]) + Number(fields[12])) / TICKS_PER_S);
    } catch { /* it has ended since */ }
  }
  const below = pid => pid === root || (parents.has(pid) && below(parents.get(pid)));
  const sums = { all: 0 };
  for (const [pid, time] of used) {
    if (!below(pid)) continue;
    const kind = kindOf(pid);
    sums[kind] = (sums[kind] ?? 0) + time;
    sums.all += time;
  }
  return sums;
}

async function firstPaint(browser) {
  const page = await browser.open(url);
  await page.until("performance.getEntriesByName('first-contentful-paint').length > 0", 'a first paint', 20000);
  const ms = await page.eval("performance.getEntriesByName('first-contentful-paint')[0].startTime");
  await page.close();
  return ms;
}

const browser = await Browser.start(program);
try {
  const paints = [];
  for (let i = 0; i < LOADS; i++) paints.push(await firstPaint(browser));
  console.log(`page_cost: first paint after ${median(paints).toFixed(0)} ms (median of ${LOADS}; ${Math.min(...paints).toFixed(0)} to ${Math.max(...paints).toFixed(0)})`);

  const page = await browser.open(url);
  await page.send('Network.disable');  // to be told of each frame would cost more than the page
  await page.until("document.querySelector('.plane svg') && palpPicture().drawn.length > 30", 'a map and pictures', 60000);
  const shares = [], rates = [];
  for (let n = 0; n < WINDOWS; n++) {
    await page.eval('palpPicture().drawn.length = 0');
    const begun = Date.now(), before = processorTime(browser.child.pid);
    await pause(WINDOW_MS);
    const seconds = (Date.now() - begun) / 1000, after = processorTime(browser.child.pid);
    shares.push(Object.fromEntries(Object.keys(after).map(kind => [kind, (after[kind] - (before[kind] ?? 0)) / seconds])));
    rates.push(await page.eval('palpPicture().drawn.length') / seconds);
  }
  const percent = share => (100 * share).toFixed(0), all = shares.map(one => one.all);
  const middle = shares.find(one => one.all === median(all));
  console.log(`page_cost: ${percent(median(all))} % of a core (median of ${WINDOWS}; ${all.map(percent).join(', ')}) at ${median(rates).toFixed(1)} pictures a second: `
    + Object.keys(middle).filter(kind => kind !== 'all').map(kind => `${kind} ${percent(middle[kind])}`).join(', '));
  const faults = [
    median(paints) > FIRST_PAINT_MAX_MS && `the first paint took more than ${FIRST_PAINT_MAX_MS} ms`,
    median(rates) < 20 && 'fewer than 20 pictures a second were drawn: what they cost is not known',
    median(all) > CORE_MAX && `the browser took more than ${percent(CORE_MAX)} % of a core`,
    page.errors[0],
  ].filter(Boolean);
  for (const fault of faults) console.log(fault);
  process.exitCode = faults.length > 0 ? 1 : 0;
} catch (error) {
  console.log(error.message);
  process.exitCode = 1;
}
await browser.stop();
