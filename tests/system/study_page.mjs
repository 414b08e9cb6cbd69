// A participant as a script: study_page.mjs BROWSER RUN_LOG OUT. Opens each page that the run names,
// palpates where and when the page says, and answers which place gave way less, or in which order
// places did; it searches an area in rows, and says where the tissue gave way least. Writes its
// answers to OUT, JSON. PALP_SHOTS: a folder for pictures.
import { readFileSync } from 'node:fs';
import { Browser, finish, pause } from './browser.mjs';

const [program, log, out] = process.argv.slice(2);
const shots = process.env.PALP_SHOTS;
const CLEAR_MM = -4;  // where the finger waits
const PRESS_MM = Number(process.env.PALP_PRESS_MM ?? 7);  // how deep it is drawn
const browser = await Browser.start(program);
const result = { answers: [], errors: [], begun: 0 };
const must = (holds, what) => { if (!holds) throw new Error(what); };
const shot = new Set();

async function shoot(page, name) {
  if (!shots || shot.has(name)) return;
  shot.add(name);
  for (const light of [false, true]) {
    await page.look({ width: 1440, height: 900, light });
    await pause(200);
    await page.picture(`${shots}/study-${name}-${light ? 'light' : 'dark'}.png`);
  }
  await page.look({ width: 1440, height: 900 });
}

/** The newest page that the run names, once there are so many. */
async function pageNumber(count) {
  for (const end = Date.now() + 60000; Date.now() < end; await pause(50)) {
    const named = [...readFileSync(log, 'utf8').matchAll(/the participant's page: (\S+)/g)];
    if (named.length >= count) return named[count - 1][1];
  }
  throw new Error(`the run names no page number ${count}`);
}

class Participant {
  constructor(page) { this.page = page; }
  async ask() {
    return this.page.eval(`(() => {
      const prompt = document.getElementById('prompt'), state = document.getElementById('state');
      return prompt ? { ...prompt.dataset, trial: +prompt.dataset.trial, interval: +prompt.dataset.interval, engaged: state.dataset.state === 'ENGAGED', tip: window.palpTip().tip, searches: !!document.getElementById('area') } : { stage: '' };
    })()`);
  }
  async press() {
    const [left, top, width, height] = await this.page.eval('(() => { const r = document.getElementById("pad").getBoundingClientRect(); return [r.left, r.top, r.width, r.height]; })()');
    this.pxPerMm = width / 52;
    this.x = left + width / 2;
    this.y = top + height / 2;
    await this.page.mouse('mouseMoved', this.x, this.y);
    await this.page.mouse('mousePressed', this.x, this.y);
    this.finger = (await this.ask()).tip;
  }
  /** From the middle of the area, so many mm, in the air. */
  async go(x, y) {
    const dx = (x - this.at.x) * this.pxPerMm, dy = (y - this.at.y) * this.pxPerMm;
    for (const [step, shift] of [[dx, false], [dy, true]]) {
      for (let i = 0; i < 8; i++) {
        this.x += step / 8;
        await this.page.mouse('mouseMoved', this.x, this.y, shift);
        await pause(20);
      }
    }
    this.at = { x, y };
    await pause(150);
  }
  /** @returns where the tissue gave way least; the tip stands there. */
  async search() {
    this.at = { x: 0, y: 0 };
    let best, least = Infinity;
    for (const y of [-13, 0, 13]) {
      for (const x of [-13, 0, 13]) {
        await this.go(x, y);
        await this.tap();
        const depth = await this.tap();
        if (depth < least) { least = depth; best = { x, y }; }
      }
    }
    await this.go(best.x, best.y);
    await pause(600);  // the tip comes after the hand
    return this.page.eval('(({ x, y }) => ({ x: +x, y: +y }))(document.getElementById("area").dataset)');
  }
  release() { return this.page.mouse('mouseReleased', this.x, this.y); }
  /** To so many mm below the surface, in so many ms. */
  async draw(to, ms) {
    const steps = Math.max(1, Math.round(ms / 25)), from = this.finger, y = this.y;
    for (let i = 1; i <= steps; i++) {
      this.finger = from + (to - from) * i / steps;
      this.y = y + (this.finger - from) * this.pxPerMm;
      await this.page.mouse('mouseMoved', this.x, this.y);
      await pause(25);
    }
  }
  /** @returns how deep the tip came. */
  async tap() {
    await this.draw(PRESS_MM, 450);
    await pause(250);
    const { tip } = await this.ask();
    await this.draw(CLEAR_MM, 350);
    return tip;
  }
  async answer(choice) {
    if (result.answers.length % 2 === 0) {
      await this.page.key('keyDown', `${choice}`, `Digit${choice}`);
      await this.page.key('keyUp', `${choice}`, `Digit${choice}`);
      return;
    }
    const [x, y] = await this.page.eval(`(() => { const r = document.getElementById('answer-${choice}').getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 2]; })()`);
    await this.page.mouse('mouseMoved', x, y);
    await this.page.mouse('mousePressed', x, y);
    await this.page.mouse('mouseReleased', x, y);
  }
}

/** What is said of how deep the tip came at each place. */
function choiceOf(depths, choices) {
  const places = Object.keys(depths).map(Number);
  const softestFirst = places.sort((a, b) => depths[b] - depths[a]);
  if (choices.length > places.length) return choices.indexOf(softestFirst.join(' ')) + 1;
  return softestFirst[softestFirst.length - 1];
}

/** All trials of a page, until it rests or is over; @returns whether it is over. */
async function goThrough(page) {
  const person = new Participant(page);
  let held = false, depths = {}, trial = 0, heldSince = 0;
  for (const end = Date.now() + 300000; Date.now() < end; await pause(15)) {
    const ask = await person.ask();
    if (ask.trial !== trial) { trial = ask.trial; depths = {}; }
    if (ask.stage === 'rest' || ask.stage === 'over') { if (held) await person.release(); return ask.stage === 'over'; }
    if (ask.stage === 'press') {
      if (held && Date.now() - heldSince > 2000) { await person.release(); held = false; await pause(100); }
      const may = await page.eval('/Press and hold/.test(document.getElementById("state").innerText) || /stands in the tissue/.test(document.getElementById("state").innerText)');
      if (!held && may) { await person.press(); held = true; heldSince = Date.now(); result.begun++; }
    } else if (ask.stage === 'lift' || (ask.stage === 'travel' && Math.abs(person.finger - CLEAR_MM) > 0.5)) {
      await person.draw(CLEAR_MM, 200);
    } else if (ask.stage === 'touch' && ask.searches) {
      const area = await person.search();
      await shoot(page, 'search');
      // By the key while the hand searches, or by the button, for which it has to let go.
      if (result.answers.length % 2 === 1) { await person.release(); held = false; }
      const at = await page.eval('Date.now()');
      await person.answer(1);
      result.answers.push({ choice: 1, at, area });
      await page.until(`+(document.getElementById('prompt')?.dataset.trial ?? 0) !== ${ask.trial}`, 'the next trial', 10000);
    } else if (ask.stage === 'touch' && depths[ask.interval] === undefined) {
      await shoot(page, 'touch');
      depths[ask.interval] = await person.tap();
      // A touch counts a moment after it has ended.
      for (let i = 0; i < 30; i++) {
        const now = await person.ask();
        if (now.stage !== 'touch' || now.interval !== ask.interval) break;
        await pause(20);
      }
      if (!(await person.ask()).engaged) depths = {};
    } else if (ask.stage === 'touch') {
      depths = {};  // it did not count: once more
    } else if (ask.stage === 'answer') {
      if (held) { await person.release(); held = false; }
      const text = await page.eval('document.body.innerText');
      must(!/velvet|linen|mmt|direct|newton|N\/m/i.test(text), `the page tells: ${text}`);
      await shoot(page, 'answer');
      const choice = choiceOf(depths, await page.eval('[...document.querySelectorAll(".answers button")].map(one => one.firstChild.data.trim())'));
      const drawn = await page.eval('(one => one && +one.dataset.most)(document.getElementById("drawn"))');
      const at = await page.eval('Date.now()');
      await person.answer(choice);
      result.answers.push({ choice, at, depths, drawn });
      await page.until(`+(document.getElementById('prompt')?.dataset.trial ?? 0) !== ${ask.trial}`, 'the next trial', 10000);
    }
  }
  throw new Error('the page came to no end');
}

try {
  for (let count = 1, over = false; !over; count++) {
    const page = await browser.open(await pageNumber(count));
    await page.until('document.getElementById("prompt")', 'a prompt');
    over = await goThrough(page);
    if (over) await shoot(page, 'over');
    result.errors.push(...page.errors.filter(one => !/WebSocket/.test(one)));
    await page.close();
  }
} catch (error) {
  result.fault = `${error.message} after ${result.answers.length} answers`;
} finally {
  await finish(browser, out, result);
}
