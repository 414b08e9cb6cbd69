// Headless Chromium, driven through its debugging pipe: no other program, no library.
import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

export const pause = ms => new Promise(done => setTimeout(done, ms));

/** Writes what was read to `out`, ends the browser, and the process with 1 where there is a fault. */
export async function finish(browser, out, result) {
  writeFileSync(out, JSON.stringify(result, null, 2));
  await browser.stop();
  if (!result.fault) return;
  console.log(result.fault);
  process.exit(1);
}

export class Browser {
  static async start(program) {
    const browser = new Browser();
    browser.folder = mkdtempSync(join(tmpdir(), 'palp-browser-'));
    browser.child = spawn(program, ['--headless', '--no-sandbox', '--disable-gpu',
      '--disable-dev-shm-usage', '--no-first-run', '--disable-extensions',
      '--disable-background-networking', '--autoplay-policy=no-user-gesture-required',
      '--disable-background-timer-throttling', '--disable-renderer-backgrounding',
      '--disable-backgrounding-occluded-windows',
      `--user-data-dir=${browser.folder}`, '--remote-debugging-pipe', 'about:blank'],
      { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'],
        env: { ...process.env, HOME: browser.folder } });
    browser.waiting = new Map();
    browser.listeners = new Map();
    browser.last = 0;
    let rest = '';
    browser.child.stdio[4].on('data', data => {
      rest += data.toString();
      const messages = rest.split('\0');
      rest = messages.pop();
      for (const one of messages) browser.hear(JSON.parse(one));
    });
    browser.child.stdio[3].on('error', () => {});
    return browser;
  }

  hear(message) {
    if (message.id) {
      const { settle, fail } = this.waiting.get(message.id);
      this.waiting.delete(message.id);
      if (message.error) fail(new Error(message.error.message)); else settle(message.result);
    } else {
      this.listeners.get(message.sessionId)?.(message.method, message.params);
    }
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.last;
    this.child.stdio[3].write(JSON.stringify({ id, method, params, sessionId }) + '\0');
    return new Promise((settle, fail) => this.waiting.set(id, { settle, fail }));
  }

  async open(url, { width = 1440, height = 900, light = false, mobile = false } = {}) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank', newWindow: true });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    this.listeners.set(sessionId, (method, params) => page.hear(method, params));
    await page.send('Page.enable');
    await page.send('Runtime.enable');
    await page.send('Log.enable');
    await page.send('Network.enable');
    await page.look({ width, height, light, mobile });
    await page.send('Page.navigate', { url });
    return page;
  }

  async stop() {
    this.child.kill('SIGKILL');
    await new Promise(done => this.child.once('exit', done));
    rmSync(this.folder, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }
}

export class Page {
  constructor(browser, session, target) {
    Object.assign(this, { browser, session, target, errors: [] });
  }
  send(method, params) { return this.browser.send(method, params, this.session); }
  /** Every error, and every refusal of the page's own policy. */
  hear(method, params) {
    if (method === 'Runtime.exceptionThrown') this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'warning'].includes(params.type)) this.errors.push(params.args.map(one => one.value).join(' '));
    if (method === 'Log.entryAdded' && ['error', 'warning'].includes(params.entry.level)) this.errors.push(params.entry.text);
    if (method === 'Page.javascriptDialogOpening') void this.send('Page.handleJavaScriptDialog', { accept: true });
  }
  async look({ width, height, light = false, mobile = false }) {
    await this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile });
    await this.send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: light ? 'light' : 'dark' }] });
  }
  async eval(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }
  text(id) { return this.eval(`document.getElementById('${id}')?.innerText ?? ''`); }
  /** Waits until the expression holds; says what it waited for. */
  async until(expression, what, ms = 60000) {
    for (const end = Date.now() + ms; ;) {
      if (await this.eval(`!!(${expression})`).catch(() => false)) return;
      if (Date.now() > end) throw new Error(`waited ${ms} ms for: ${what}; state ${await this.text('state').catch(() => '?')}`);
      await pause(20);
    }
  }
  state(name, ms) { return this.until(`document.getElementById('state')?.dataset.state === '${name}'`, `state ${name}`, ms); }
  mouse(type, x, y, shift = false) { return this.send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons: type === 'mouseReleased' ? 0 : 1, clickCount: 1, modifiers: shift ? 8 : 0 }); }
  async click(id) { await this.eval(`document.getElementById('${id}').click()`); }
  async key(type, key, code = key) {
    const text = type === 'keyDown' && key.length === 1 ? key : undefined;
    await this.send('Input.dispatchKeyEvent', { type, key, code, text });
  }
  async picture(file) {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png' });
    writeFileSync(file, Buffer.from(data, 'base64'));
  }
  close() { return this.browser.send('Target.closeTarget', { targetId: this.target }); }
}
