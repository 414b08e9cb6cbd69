// The tissue in section: what was felt where, where the inclusion lies, where the tip is. Also the
// pad to palpate with.
import type { ComponentChildren } from 'preact';
import { useEffect, useRef } from 'preact/hooks';
import { onBeat } from './beat';
import { cividis, color } from './look';
import type { Model, Stroke } from './model';
import type { Span } from './plane';
import type { Pilot } from './pilot';

export const SPAN_MM = 52, ABOVE_MM = 9;
const FRAME_MS = 50;

/** Least and most stiffness felt [N/m]; a little apart at least. */
export function stiffnessRange(strokes: Stroke[]): [number, number] {
  const all = strokes.map(one => one.stiffness).filter(k => k > 0);
  if (all.length === 0) return [100, 200];
  const low = Math.floor(Math.min(...all) / 10) * 10, high = Math.ceil(Math.max(...all) / 10) * 10;
  return [low, Math.max(high, low + 20)];
}

/** Draws into both canvases, of so many pixels: what stands below, and what moves above it. */
export type Paint = (under: HTMLCanvasElement, over: HTMLCanvasElement, w: number, h: number) => void;

/** What one palpates on by pointer and keys: `SPAN_MM` wide. `control`: it moves the hand. */
export function Pad({ pilot, control, label, paint, children }: { pilot: Pilot; control: boolean; label: string; paint: Paint; children?: ComponentChildren }) {
  const pad = useRef<HTMLDivElement>(null), over = useRef<HTMLCanvasElement>(null), under = useRef<HTMLCanvasElement>(null);
  const scale = useRef(0.1), painter = useRef(paint);  // [mm/px]
  painter.current = paint;
  useEffect(() => {
    return onBeat(FRAME_MS, () => {
      const { clientWidth: w, clientHeight: h } = pad.current ?? { clientWidth: 0, clientHeight: 0 };
      if (w < 20 || h < 20) return;
      scale.current = SPAN_MM / w;
      painter.current(under.current!, over.current!, w, h);
    });
  }, []);
  return <div ref={pad} class="pad" id="pad" tabIndex={control ? 0 : -1} role="application" aria-label={label}
    onPointerDown={e => {
      if (!control || e.button !== 0 || !e.isPrimary) return;
      (e.currentTarget as HTMLElement).focus();
      (e.currentTarget as HTMLElement).setPointerCapture(e.pointerId);
      pilot.down(e.pointerId, e.clientX, e.clientY);
      e.preventDefault();
    }}
    onPointerMove={e => pilot.draw(e.pointerId, e.buttons, e.clientX, e.clientY, scale.current, e.shiftKey)}
    onPointerUp={() => pilot.up()} onPointerCancel={() => pilot.up()} onLostPointerCapture={() => pilot.up()}
    onContextMenu={e => e.preventDefault()}
    onKeyDown={e => { if (control && (e.repeat || pilot.key(e.key, true)) && e.key !== 'Escape' && e.key !== 'Tab') e.preventDefault(); }}
    onKeyUp={e => { if (control && pilot.key(e.key, false)) e.preventDefault(); }}
    onBlur={() => pilot.up()}>
    <canvas ref={under} aria-hidden="true" /><canvas ref={over} aria-hidden="true" />
    {children}
  </div>;
}

export function Section({ model, pilot, control }: { model: Model; pilot: Pilot; control: boolean }) {
  const view = useRef({ left: -16 });
  const [low, high] = stiffnessRange(model.strokes);
  return <section class="card section">
    <header><h2>Tissue in section</h2><span class="unit">stiffness felt, N/m</span>
      <span class="scale"><i>{low}</i><b /><i>{high}</i></span></header>
    <Pad pilot={pilot} control={control}
      label={control ? 'Palpation pad. Hold Space to engage, arrow keys move the finger, release Space to let go, Escape stops.' : 'Section through the tissue'}
      paint={(under, over, w, h) => draw(model, pilot, control, view.current, under, over, w, h)}>
      {control && <p class="hint"><kbd>hold</kbd> to engage, <kbd>drag down</kbd> to press, <kbd>sideways</kbd> to move, <kbd>release</kbd> to let go</p>}
    </Pad>
  </section>;
}

export function prepare(canvas: HTMLCanvasElement, w: number, h: number): CanvasRenderingContext2D {
  const k = devicePixelRatio || 1, wide = Math.round(w * k), high = Math.round(h * k);
  if (canvas.width !== wide || canvas.height !== high) { canvas.width = wide; canvas.height = high; }
  const g = canvas.getContext('2d')!;
  g.setTransform(k, 0, 0, k, 0, 0);
  g.clearRect(0, 0, w, h);
  return g;
}

function draw(model: Model, pilot: Pilot, control: boolean, view: { left: number }, under: HTMLCanvasElement, over: HTMLCanvasElement, w: number, h: number): void {
  const s = model.status, mm = w / SPAN_MM;
  const tipX = s ? model.tipX(s) : 0;
  // The window follows a tip that comes near its edge.
  view.left += Math.max(0, tipX - (view.left + SPAN_MM - 8)) - Math.max(0, view.left + 8 - tipX);
  const X = (x: number) => (x - view.left) * mm, Y = (y: number) => (y + ABOVE_MM) * mm;
  const stamp = [w, h, view.left, model.strokes.length, model.strokes[0]?.stiffness, model.strokes[0]?.force, model.depth?.number, model.map?.number, color('--air')].join(' ');
  if (under.dataset.stamp !== stamp) {
    under.dataset.stamp = stamp;
    tissue(prepare(under, w, h), model, X, Y, w, h, view.left, mm);
  }
  // Nor is what moves, while it stands still.
  const f = pilot.finger, old = model.stale(performance.now());
  const moves = s && [model.tip(s).toFixed(2), tipX.toFixed(2), s.peer_sampled, old, f && [f.x, f.into, s.state, s.force_n.toFixed(2)]].join(' ');
  if (over.dataset.stamp === `${stamp} ${moves}`) return;
  over.dataset.stamp = `${stamp} ${moves}`;
  const g = prepare(over, w, h);
  if (!s) return;
  const tip = model.tip(s), known = model.patient || s.peer_sampled, tx = X(tipX);
  const dent = known ? Math.max(0, tip) : 0;
  g.strokeStyle = color('--text');
  g.lineWidth = 2;
  g.beginPath();
  for (let px = 0; px <= w; px += 3) {
    const y = Y(dent * Math.exp(-(((px - tx) / mm / 6) ** 2)));
    if (px) g.lineTo(px, y); else g.moveTo(px, y);
  }
  g.stroke();
  if (!known) return;
  indenter(g, tx, Y(Math.max(-ABOVE_MM + 1, tip)), mm, old);
  if (model.map?.next) nextTap(g, X(model.map.next.x), Y(0), model.map.next.y, w);
  if (f && control) {
    const engaged = s.state === 'ENGAGED' || s.state === 'HOLD';
    spring(g, tx, Y(tip), X(pilot.from.x + f.x), Y(pilot.from.tip + f.into) + 16, engaged ? Math.max(0, s.force_n) : 0, engaged);
  }
}

/** Stiffness as columns that fade with depth: a touch tells of a neighbourhood, not of a depth. */
function tissue(g: CanvasRenderingContext2D, model: Model, X: (x: number) => number, Y: (y: number) => number, w: number, h: number, left: number, mm: number): void {
  const [low, high] = stiffnessRange(model.strokes), felt = model.strokes.filter(one => one.stiffness > 0);
  g.fillStyle = color('--air');
  g.fillRect(0, 0, w, h);
  for (let px = 0; px < w; px += 3) {
    const x = left + px / mm;
    let weight = 0, sum = 0;
    for (const one of felt) { const near = Math.exp(-(((x - one.x) / 2.5) ** 2)); weight += near; sum += near * one.stiffness; }
    const column = (ink: string) => {
      const fade = g.createLinearGradient(0, Y(0), 0, h);
      fade.addColorStop(0, ink);
      fade.addColorStop(1, color('--deep'));
      g.fillStyle = fade;
      g.fillRect(px, Y(0), 3, h - Y(0));
    };
    column(color('--unknown'));
    if (weight < 0.02) continue;
    g.globalAlpha = Math.min(1, 1.5 * weight);
    column(cividis((sum / weight - low) / (high - low)));
    g.globalAlpha = 1;
  }
  g.font = '11px system-ui';
  g.strokeStyle = color('--depthline');
  g.fillStyle = color('--onmap');
  g.lineWidth = 1;
  for (let d = 5; Y(d) < h - 12; d += 5) {
    g.beginPath();
    g.moveTo(0, Math.round(Y(d)) + 0.5);
    g.lineTo(w, Math.round(Y(d)) + 0.5);
    g.stroke();
    g.fillText(`${d} mm`, 6, Y(d) - 4);
  }
  for (let x = Math.ceil(left / 10) * 10; X(x) < w - 20; x += 10) {
    g.fillStyle = color('--muted');
    g.textAlign = 'center';
    if (X(x) > 20) g.fillText(`${x}`, X(x), 14);
    g.fillRect(X(x), 18, 1, 4);
  }
  g.textAlign = 'left';
  g.fillStyle = color('--text');
  for (const one of model.strokes) { g.beginPath(); g.arc(X(one.x), Y(0), 2.5, 0, 7); g.fill(); }
  const newest = new Map<number, Stroke>();
  for (const one of model.strokes) {
    const place = Math.round(one.x / 2);
    if (one.depth && !newest.has(place)) newest.set(place, one);
  }
  const ball = model.map?.ball;
  if (ball) inclusion(g, X(ball.x.median), ball.depth, ball.radius.median, ball.trusted ? 'sized' : 'doubted', Y, w, mm);
  else if (!model.map) for (const { x, depth: d } of newest.values()) {
    if (d?.verdict === 'FOUND') inclusion(g, X(x), { median: d.depth, low: d.low, high: d.high }, 5, 'open', Y, w, mm);
  }
}

/** Where the next tap tells most: a ring on the surface, which only the map shows whole. */
function nextTap(g: CanvasRenderingContext2D, x: number, y: number, across: number, w: number): void {
  const at = Math.min(w - 12, Math.max(12, x)), label = `next tap, y ${across.toFixed(0).replace('-', '\u2212')} mm`;
  g.strokeStyle = g.fillStyle = color('--text');
  g.lineWidth = 2;
  g.beginPath();
  g.arc(at, y, 8, 0, 7);
  for (const side of [-1, 1]) { g.moveTo(at + side * 4, y); g.lineTo(at + side * 12, y); }
  g.stroke();
  g.font = '600 12px system-ui';
  const right = at + 18 + g.measureText(label).width < w;
  g.textAlign = right ? 'left' : 'right';
  g.lineWidth = 4;
  g.strokeStyle = color('--air');
  g.strokeText(label, right ? at + 16 : at - 16, y - 8);
  g.fillText(label, right ? at + 16 : at - 16, y - 8);
  g.textAlign = 'left';
}

/** `open`: only its top is known; else its size is, and the circle is closed. */
function inclusion(g: CanvasRenderingContext2D, x: number, d: Span, radius: number, kind: 'open' | 'sized' | 'doubted', Y: (y: number) => number, w: number, mm: number): void {
  const whole = kind !== 'open', bar = whole ? x : x + 5.6 * mm;
  g.fillStyle = 'rgba(255,255,255,.16)';
  g.strokeStyle = 'rgba(255,255,255,.8)';
  g.lineWidth = 1.25;
  g.setLineDash([5, 4]);
  // Its top is what was found; how far down it goes one place alone does not tell.
  g.beginPath();
  g.arc(x, Y(d.median + radius), radius * mm, Math.PI, whole ? 3 * Math.PI : 2 * Math.PI);
  g.fill();
  g.stroke();
  g.setLineDash([]);
  g.strokeStyle = g.fillStyle = '#fff';
  g.lineWidth = 2;
  g.beginPath();
  for (const y of [d.low, d.high]) { g.moveTo(bar - 5, Y(y)); g.lineTo(bar + 5, Y(y)); }
  g.moveTo(bar, Y(d.low));
  g.lineTo(bar, Y(d.high));
  g.stroke();
  g.font = '600 13px system-ui';
  const label = `${kind === 'doubted' ? '? ' : ''}${d.median.toFixed(1)} mm`, fits = bar + 16 + g.measureText(label).width < w;
  g.textAlign = fits ? 'left' : 'right';
  g.fillText(label, fits ? bar + 10 : Math.min(x - 5.6 * mm, bar - 10), (whole ? Y(d.high) + 18 : Y(d.median) + 4));
  g.textAlign = 'left';
}

function indenter(g: CanvasRenderingContext2D, x: number, y: number, mm: number, old: boolean): void {
  const r = 2.2 * mm, round = Math.min(r, 10);
  g.globalAlpha = old ? 0.35 : 0.92;
  g.fillStyle = color('--tissue');
  g.beginPath();
  g.moveTo(x - r, 0);
  g.lineTo(x + r, 0);
  g.lineTo(x + r, y - round);
  g.quadraticCurveTo(x + r, y, x, y);
  g.quadraticCurveTo(x - r, y, x - r, y - round);
  g.closePath();
  g.fill();
  g.globalAlpha = 1;
}

/** Between the tip, which is, and the finger, which is wanted: its length is the force; undefined: that is not told. */
export function spring(g: CanvasRenderingContext2D, tx: number, ty: number, fx: number, fy: number, force: number | undefined, engaged: boolean): void {
  const turns = 9;
  g.strokeStyle = color(engaged ? '--hand' : '--muted');
  g.lineWidth = 2.25;
  g.beginPath();
  g.moveTo(tx, ty);
  for (let i = 1; i < turns; i++) {
    const share = i / turns;
    g.lineTo(tx + (fx - tx) * share + (i % 2 ? 6 : -6), ty + (fy - ty) * share);
  }
  g.lineTo(fx, fy);
  g.stroke();
  g.fillStyle = color('--halo');
  g.beginPath();
  g.arc(fx, fy + 11, 13 + 14 * Math.min(3, force ?? 0), 0, 7);
  g.fill();
  g.lineWidth = 2.5;
  g.beginPath();
  g.arc(fx, fy + 11, 11, 0, 7);
  g.stroke();
  if (engaged && force !== undefined) {
    g.font = '600 13px system-ui';
    g.fillStyle = color('--text');
    g.fillText(`${force.toFixed(2)} N`, fx + 18 + 14 * Math.min(3, force), fy + 15);
  }
}
