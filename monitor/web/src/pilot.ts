// The finger that palpates: what holds it, how far it is drawn, and everything that ends it.
import type { Client } from './client';
import type { Model } from './model';

const EVERY_MS = 16;  // however fast the mouse is: the site gives a client 120 messages a second
const KEY_SPEED = 2;  // [mm/s], of an arrow key
const REACH_MM = 20, ASIDE_MM = 100;

const MAIN_BUTTON = 1;

export interface Finger { into: number; x: number; y: number }  // [mm], since the press

export class Pilot {
  /** Undefined: the finger is up. */
  finger: Finger | undefined;
  /** Where the tip was as it went down: x, y and depth [mm]. */
  from = { x: 0, y: 0, tip: 0 };
  private press = 0;
  private timer = 0;
  private by: number | undefined;  // the pointer that opened the press; undefined: the key did
  private origin = { x: 0, y: 0 };
  private keys = new Set<string>();
  private steppedAt = 0;

  constructor(private readonly client: Client, private readonly model: Model) {
    const up = () => this.up();
    addEventListener('blur', up);
    addEventListener('pagehide', up);
    document.addEventListener('visibilitychange', () => { if (document.hidden) up(); });
  }

  /** By a pointer at a point of the page [px], or by the key. */
  down(by: number | undefined, x = 0, y = 0): void {
    const s = this.model.status;
    if (this.finger || !s || !this.model.pilots || this.model.stale(performance.now())) return;
    this.press++;
    this.by = by;
    this.finger = { into: 0, x: 0, y: 0 };
    this.from = { x: this.model.tipX(s), y: this.model.tipY(s), tip: this.model.tip(s) };
    this.origin = { x, y };
    // A key that went down before may have come up unheard.
    this.keys.clear();
    this.steppedAt = performance.now();
    this.tell();
    this.timer = setInterval(() => this.tell(), EVERY_MS) as unknown as number;
  }

  /**
   * A pointer is at a point of the page [px], in its scale; `across`: it moves out of the plane of the section.
   * Only the one that went down draws, and only until its button is up.
   */
  draw(by: number, buttons: number, x: number, y: number, mmPerPx: number, across: boolean): void {
    const f = this.finger;
    if (!f || by !== this.by) return;
    if (!(buttons & MAIN_BUTTON)) return this.up();
    f.x = clamp(f.x + (across ? 0 : (x - this.origin.x) * mmPerPx), ASIDE_MM);
    f.y = clamp(f.y + (across ? (x - this.origin.x) * mmPerPx : 0), ASIDE_MM);
    f.into = clamp(f.into + (y - this.origin.y) * mmPerPx, REACH_MM);
    this.origin = { x, y };
  }

  up(): void {
    this.keys.clear();
    if (!this.finger) return;
    clearInterval(this.timer);
    const last = this.finger;
    this.finger = undefined;
    this.client.point({ press: this.press, held: false, into_m: last.into / 1e3, x_m: last.x / 1e3, y_m: last.y / 1e3 });
  }

  /** @returns whether the key was one of the pad's. */
  key(key: string, pressed: boolean): boolean {
    if (key === ' ') {
      if (pressed) this.down(undefined); else this.up();
      return true;
    }
    if (!/^Arrow(Up|Down|Left|Right)$/.test(key)) return false;
    if (pressed) this.keys.add(key); else this.keys.delete(key);
    return true;
  }

  private tell(): void {
    const f = this.finger, now = performance.now();
    if (!f) return;
    // Who does not see what the hand does lets go of it.
    if (this.model.stale(now)) return this.up();
    const step = KEY_SPEED * (now - this.steppedAt) / 1e3;
    this.steppedAt = now;
    const way = (plus: string, minus: string) => step * ((this.keys.has(plus) ? 1 : 0) - (this.keys.has(minus) ? 1 : 0));
    f.into = clamp(f.into + way('ArrowDown', 'ArrowUp'), REACH_MM);
    f.x = clamp(f.x + way('ArrowRight', 'ArrowLeft'), ASIDE_MM);
    this.client.point({ press: this.press, held: true, into_m: f.into / 1e3, x_m: f.x / 1e3, y_m: f.y / 1e3 });
  }
}

const clamp = (value: number, most: number): number => Math.max(-most, Math.min(most, value));
