// A person at the page of a live session, as a script: monitor.mjs BROWSER CONTROL_URL VIEW_URL OUT.
// Palpates at two places by pointer, reads what the page says, hangs the page while it presses,
// stops, ends. Writes what it read to OUT, JSON. PALP_SHOTS: a folder for pictures.
import { Browser, finish, pause } from './browser.mjs';

const [program, controlUrl, viewUrl, out] = process.argv.slice(2);
const shots = process.env.PALP_SHOTS;
const browser = await Browser.start(program);
const result = {};
const must = (holds, what) => { if (!holds) throw new Error(what); };
const shoot = async (page, name) => { if (shots) await page.picture(`${shots}/${name}.png`); };

/** Three sizes, dark and light; nothing may hang out of the page. */
async function shootAll(page, name) {
  for (const [width, height, mobile] of [[1440, 900, false], [1024, 768, false], [390, 844, true]]) {
    for (const light of [false, true]) {
      await page.look({ width, height, light, mobile });
      await pause(250);
      const over = await page.eval('document.documentElement.scrollWidth - innerWidth');
      must(over <= 1, `${name} is ${over} px too wide at ${width}`);
      await shoot(page, `${name}-${width}-${light ? 'light' : 'dark'}`);
    }
  }
  await page.look({ width: 1440, height: 900 });
}

class Hand {
  constructor(page) { this.page = page; }
  async find() {
    [this.left, this.top, this.width] = await this.page.eval(
      '(() => { const r = document.getElementById("pad").getBoundingClientRect(); return [r.left, r.top, r.width]; })()');
    this.pxPerMm = this.width / 52;
  }
  async press() {
    await this.find();
    this.x = this.left + this.width / 2;
    this.y = this.top + 200;
    await this.page.mouse('mouseMoved', this.x, this.y);
    await this.page.mouse('mousePressed', this.x, this.y);
    await this.page.until('document.querySelector("#state strong")?.innerText === "Engaged"', 'an engagement', 4000);
  }
  /** [mm], evenly, in so many ms; false: the engagement ended on the way. */
  async draw(dx, dy, ms) {
    const steps = Math.round(ms / 25), x = this.x, y = this.y;
    for (let i = 1; i <= steps; i++) {
      this.x = x + dx * this.pxPerMm * i / steps;
      this.y = y + dy * this.pxPerMm * i / steps;
      await this.page.mouse('mouseMoved', this.x, this.y);
      await pause(25);
    }
    return await this.page.eval('document.getElementById("state").dataset.state') === 'ENGAGED';
  }
  release() { return this.page.mouse('mouseReleased', this.x, this.y); }
}

const number = async (page, id) => Number.parseFloat(await page.text(id));

/** At x [mm]; a machine that is busy may let the hand go on the way, as it would a person's. */
async function tap(page, x) {
  const hand = new Hand(page);
  for (let tries = 0; tries < 30; tries++) {
    await page.state('CLUTCHED');
    await page.until('/Press and hold/.test(document.getElementById("state").innerText) || /stands in the tissue/.test(document.getElementById("state").innerText)', 'a hand that may press');
    try {
      await hand.press();
    } catch {
      await hand.release();
      continue;
    }
    const here = await page.eval('window.palpTip().x'), high = await page.eval('window.palpTip().tip');
    let held = await hand.draw(0, Math.min(0, -8 - high), 400);
    held = held && await hand.draw(x - here, 0, 1500) && await hand.draw(0, 0, 500);
    held = held && await hand.draw(0, 14, 1600) && await hand.draw(0, 0, 500);
    const read = { force: await number(page, 'force'), indentation: await number(page, 'indentation'), age: await number(page, 'age') };
    held = held && await hand.draw(0, -14, 1600) && await hand.draw(0, 0, 600);
    await hand.release();
    if (!held) continue;
    await page.state('CLUTCHED');
    return { ...read, tries };
  }
  throw new Error(`no whole tap at ${x} mm`);
}

try {
  // A name that is a script stays a name.
  const evil = '<img src=x onerror="window.hacked=1">';
  const page = await browser.open(controlUrl.replace('/#', `/?name=${encodeURIComponent(evil)}#`));
  await page.state('CLUTCHED');
  await page.until('document.getElementById("pointer")?.innerText === "you"', 'the pointer');
  must(!(await page.eval('location.href')).includes('#'), 'the key stands in the address still');
  const other = await browser.open(controlUrl);
  await other.until('document.getElementById("state").innerText.includes("(<img src=x onerror")', 'the name of who has the pointer, as it is');
  must(!(await other.eval('window.hacked || document.images.length')), 'the name became markup');
  const viewer = await browser.open(viewUrl);
  await viewer.state('CLUTCHED');
  must(!(await viewer.eval('document.getElementById("stop")')), 'who only looks has a stop');
  result.errors = [...page.errors, ...other.errors, ...viewer.errors];
  await other.close();
  await viewer.close();

  result.first = await tap(page, 0);
  await page.until('document.getElementById("depth").innerText !== "-"', 'a depth');
  result.second = await tap(page, 20);
  await page.until('document.getElementById("verdict").innerText.includes("found")', 'an inclusion');
  await page.key('keyDown', 'm', 'KeyM');
  await page.key('keyUp', 'm', 'KeyM');
  await page.until('/moment marked/i.test(document.getElementById("events").innerText)', 'the mark');
  result.depth = await number(page, 'depth');
  result.interval = await page.text('interval');
  result.strokes = (await page.eval('window.palpStrokes()')).filter(one => one.force > 0);
  await shootAll(page, 'found');
  result.errors.push(...page.errors);

  // A page that hangs while it presses.
  const hand = new Hand(page);
  for (let tries = 0; ; tries++) {
    await page.state('CLUTCHED');
    try { await hand.press(); break; } catch (error) { if (tries > 5) throw error; await hand.release(); }
  }
  result.hungAt = Date.now();
  void page.send('Runtime.evaluate', { expression: 'for (;;) {}' });
  await pause(1000);
  await page.close();

  // Space is the pedal, and a mouse that moves meanwhile draws nothing; Escape stops.
  const next = await browser.open(controlUrl);
  await next.state('CLUTCHED');
  await next.until('document.getElementById("pointer")?.innerText === "you"', 'the pointer, given back by the dead page');
  await next.eval('document.getElementById("pad").focus()');
  for (let tries = 0; ; tries++) {
    await next.key('keyDown', ' ', 'Space');
    try { await next.state('ENGAGED', 3000); break; } catch (error) { if (tries > 5) throw error; }
    await next.key('keyUp', ' ', 'Space');
    await next.state('CLUTCHED');
  }
  const tip = await next.eval('window.palpTip().tip'), beside = new Hand(next);
  await beside.find();
  for (const y of [50, 150, 250]) await next.mouse('mouseMoved', beside.left + beside.width / 2, beside.top + y);
  await pause(600);
  must(Math.abs(await next.eval('window.palpTip().tip') - tip) < 1, 'a mouse that holds nothing moves the tip');
  await shoot(next, 'engaged');
  await next.key('keyDown', 'Escape');
  await next.state('STOPPED');
  await next.key('keyUp', ' ', 'Space');
  await shootAll(next, 'stopped');
  result.errors.push(...next.errors);
  await next.click('end');
  await next.state('STALE');
  await shoot(next, 'ended');
} catch (error) {
  result.fault = error.message;
} finally {
  await finish(browser, out, result);
}
