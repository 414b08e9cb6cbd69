// A page in one of its states, at three sizes, dark and light: page_states.mjs BROWSER URL NAME
// UNTIL [CLICK]. UNTIL: an expression that holds in that state; CLICK: what to click first. Nothing
// may reach beyond its card or the page's width, and no error may be said. PALP_SHOTS: a folder for pictures.
import { Browser, pause } from './browser.mjs';

const [program, url, name, until, click] = process.argv.slice(2);
const sizes = { desktop: [1440, 900], tablet: [1024, 768], phone: [390, 844, true] };
const shots = process.env.PALP_SHOTS;
/** The first value that is drawn beyond its card; empty: none. */
const BEYOND = `[...document.querySelectorAll('.card dd, .plane-legend li')].find(dd =>
  dd.getBoundingClientRect().right > dd.closest('.card').getBoundingClientRect().right - 4)?.innerText ?? ''`;

/** What is wrong with a map, which is read by keys; empty: nothing, or there is none. */
async function mapFault(page) {
  if (!await page.eval("!!document.querySelector('.plane svg')")) return '';
  const high = await page.eval("document.querySelector('.plane svg').getBoundingClientRect().height");
  if (high < 150) return `the map is ${high.toFixed(0)} pixels high`;
  await page.eval("document.querySelector('.plane').focus()");
  await page.key('keyDown', 'ArrowLeft');
  await page.key('keyUp', 'ArrowLeft');
  const words = await page.eval("document.querySelector('.plane-readout').innerText");
  await page.eval("document.querySelector('.plane').blur()");
  return /times plain tissue, . \d+ %/.test(words) ? '' : `a cell of the map is read as "${words}"`;
}

const browser = await Browser.start(program);
let fault = '';
try {
  const page = await browser.open(url);
  await page.until("document.getElementById('state')?.dataset.state", 'a state', 20000);
  if (click) {
    await page.until(`document.getElementById('${click}')`, click, 20000);
    await page.click(click);
  }
  await page.until(until, name, 60000);
  for (const [size, [width, height, mobile = false]] of Object.entries(sizes)) {
    for (const light of [false, true]) {
      await page.look({ width, height, light, mobile });
      await pause(400);
      const wide = await page.eval('document.documentElement.scrollWidth');
      if (wide > width) fault ||= `${name} on a ${size} is ${wide} pixels wide instead of ${width}`;
      const beyond = await page.eval(BEYOND);
      if (beyond) fault ||= `${name} on a ${size}: "${beyond}" reaches beyond its card`;
      const map = await mapFault(page);
      if (map) fault ||= `${name} on a ${size}: ${map}`;
      if (shots) await page.picture(`${shots}/${name}-${size}-${light ? 'light' : 'dark'}.png`);
    }
  }
  if (!fault && page.errors.length > 0) fault = `${name}: ${page.errors[0]}`;
} catch (error) {
  fault = `${name}: ${error.message}`;
}
await browser.stop();
if (fault) {
  console.error(fault);
  process.exit(1);
}
