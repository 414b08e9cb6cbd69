// The tissue from above: how stiff it is and how surely, where it was touched, where the inclusion
// lies and where the next tap tells most. Of the live page and of the report of a session.
import { cividis } from './look';

/** Lengths in mm; stiffness over that of the tissue without an inclusion. */
export interface Cell { x: number; y: number; stiffness: number; stddev: number; inclusion: number }
export interface Span { median: number; low: number; high: number }
export interface Spot { x: number; y: number }
export interface Ball { x: Span; y: Span; depth: Span; radius: Span; trusted: boolean }
export interface Plane {
  cells: Cell[];  // row by row, from the least y on
  touches: Spot[];
  ball: Ball | undefined;
  next: Spot | undefined;
  says: string;
}

const SVG = 'http://www.w3.org/2000/svg';
const LEFT = 38, RIGHT = 8, TOP = 8, BOTTOM = 22;  // [px] round the cells
const LEAST_PX = 60, LETTER_PX = 8;
/** From this doubt on a cell is hatched, and densely. */
const DOUBT = 0.02, DEEP_DOUBT = 0.04;
const LEAST_RANGE = 0.2;
const TIP_PX = 16;
const TIP = { d: 'M8 1L14 8L8 15L2 8Z', fill: '#ffb14a', stroke: '#000', 'stroke-width': 1.2 };

type Attributes = Record<string, string | number>;
function add(parent: Element, name: string, attributes: Attributes, text?: string): SVGElement {
  const one = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) one.setAttribute(key, String(value));
  if (text !== undefined) one.textContent = text;
  parent.append(one);
  return one;
}
/** Read on any ground: light upon a dark edge. */
function lined(parent: Element, name: string, attributes: Attributes, width: number): void {
  add(parent, name, { fill: 'none', stroke: '#000', 'stroke-opacity': 0.65, 'stroke-width': width + 2, ...attributes });
  add(parent, name, { fill: 'none', stroke: '#fff', 'stroke-width': width, ...attributes });
}
/** Beside `x`, on its left where it is told so or there is no room on its right. */
function word(parent: Element, x: number, apart: number, y: number, text: string, left: boolean, wide: number): void {
  const length = LETTER_PX * text.length, end = x + apart + length > wide - RIGHT || (left && x - apart - length > LEFT);
  add(parent, 'text', { x: end ? x - apart : x + apart, y, 'text-anchor': end ? 'end' : 'start', class: 'on-map' }, text);
}

const signed = (mm: number): string => mm.toFixed(1).replace(/^-(0\.0)$/, '$1').replace('-', '\u2212');
const between = (of: Span): string => `${signed(of.median)} mm (${signed(of.low)} to ${signed(of.high)})`;

/** A cell for people who do not see it. */
export function cellWords(cell: Cell): string {
  return `x ${signed(cell.x)}, y ${signed(cell.y)} mm: ${cell.stiffness.toFixed(2)} times plain tissue, `
    + `\u00b1 ${(100 * cell.stddev).toFixed(0)} %; an inclusion below: ${(100 * cell.inclusion).toFixed(0)} %`;
}

/** Of the ball, lengths with their 95 % intervals. */
export function ballWords(ball: Ball): string {
  return `Inclusion at x ${between(ball.x)}, y ${between(ball.y)}, its top ${between(ball.depth)} deep, radius ${between(ball.radius)}`;
}

/** Least and most of the scale: plain tissue is always in it. */
function range(cells: Cell[]): [number, number] {
  const all = cells.map(one => one.stiffness), low = Math.min(1, ...all);
  return [low, Math.max(low + LEAST_RANGE, ...all)];
}

function pitch(sorted: number[]): number { return sorted.length > 1 ? sorted[1]! - sorted[0]! : 2; }
const distinct = (all: number[]): number[] => [...new Set(all.map(one => Math.round(one * 1e3) / 1e3))].sort((a, b) => a - b);

/** Where things lie in the drawing, which is as large as there is room [px]. */
class Frame {
  readonly columns: number[];
  readonly rows: number[];
  readonly across: number;  // [mm] of a cell
  readonly up: number;
  readonly wide: number;
  readonly high: number;
  readonly left: number;  // of it in the room
  readonly top: number;
  private readonly scale: number;
  constructor(cells: Cell[], width: number, height: number) {
    this.columns = distinct(cells.map(one => one.x));
    this.rows = distinct(cells.map(one => one.y));
    [this.across, this.up] = [pitch(this.columns), pitch(this.rows)];
    const [x, y] = [this.across * this.columns.length, this.up * this.rows.length];
    this.scale = Math.min((width - LEFT - RIGHT) / x, (height - TOP - BOTTOM) / y);
    [this.wide, this.high] = [LEFT + RIGHT + this.scale * x, TOP + BOTTOM + this.scale * y];
    [this.left, this.top] = [(width - this.wide) / 2, (height - this.high) / 2];
  }
  x(mm: number): number { return LEFT + this.scale * (mm - this.columns[0]! + this.across / 2); }
  y(mm: number): number { return this.high - BOTTOM - this.scale * (mm - this.rows[0]! + this.up / 2); }
  px(mm: number): number { return this.scale * mm; }
}

let drawn = 0;

/** Draws itself into an element; its cells are read by pointer and by arrow keys. */
export class PlaneView {
  private plane: Plane | undefined;
  private frame: Frame | undefined;
  private at = -1;  // the cell that is read
  private readonly id = `plane-${++drawn}`;
  private readonly picture: HTMLElement;
  private readonly readout: HTMLElement;
  private readonly legend: HTMLElement;
  private cursor: SVGElement | undefined;
  private readonly tip: SVGElement | undefined;

  /** `live`: there is a tip that moves. */
  constructor(root: HTMLElement, live = false) {
    const make = (name: string, kind: string) => {
      const one = document.createElement(name);
      one.className = kind;
      root.append(one);
      return one;
    };
    this.picture = make('div', 'plane');
    this.picture.tabIndex = 0;
    this.picture.setAttribute('role', 'application');
    this.picture.setAttribute('aria-roledescription', 'map');
    this.readout = make('p', 'plane-readout');
    this.readout.setAttribute('aria-live', 'polite');
    this.legend = make('ul', 'plane-legend');
    if (live) {
      // A layer of its own: what it moves over is not drawn again.
      this.tip = document.createElementNS(SVG, 'svg');
      for (const [key, value] of [['class', 'plane-tip'], ['width', TIP_PX], ['height', TIP_PX], ['aria-hidden', 'true']] as const) this.tip.setAttribute(key, String(value));
      add(this.tip, 'path', TIP);
    }
    new ResizeObserver(() => this.fit()).observe(this.picture);
    this.picture.addEventListener('keydown', event => { if (this.step(event.key)) event.preventDefault(); });
    this.picture.addEventListener('focus', () => { if (this.at < 0) this.step('Home'); });
    this.picture.addEventListener('pointermove', event => this.point(event));
    for (const end of ['pointerleave', 'blur']) this.picture.addEventListener(end, () => { if (document.activeElement !== this.picture) this.read(-1); });
  }

  show(plane: Plane): void {
    this.plane = plane;
    const label = `Stiffness map from above. ${plane.says} Arrow keys read it cell by cell.`;
    this.picture.setAttribute('aria-label', label);
    this.explain(plane);
    this.fit();
  }

  /** Into the room there is. */
  private fit(): void {
    const { clientWidth, clientHeight } = this.picture;
    if (!this.plane || clientWidth < LEAST_PX || clientHeight < LEAST_PX) return;
    this.frame = new Frame(this.plane.cells, clientWidth, clientHeight);
    this.draw(this.plane, this.frame);
    this.read(Math.min(this.at, this.plane.cells.length - 1));
  }

  /** Where the tip is now; nothing where nobody knows. */
  move(tip: Spot | undefined): void {
    const f = this.frame, mark = this.tip;
    if (!mark || !f) return;
    const x = tip ? f.x(tip.x) : -1, y = tip ? f.y(tip.y) : -1;
    mark.style.visibility = x > LEFT && x < f.wide - RIGHT && y > TOP && y < f.high - BOTTOM ? 'visible' : 'hidden';
    const to = `translate(${(f.left + x - TIP_PX / 2).toFixed(1)}px, ${(f.top + y - TIP_PX / 2).toFixed(1)}px)`;
    if (mark.style.transform !== to) mark.style.transform = to;
  }

  private draw(plane: Plane, f: Frame): void {
    const svg = document.createElementNS(SVG, 'svg');
    const [wide, high] = [f.wide.toFixed(1), f.high.toFixed(1)];
    for (const [key, value] of [['viewBox', `0 0 ${wide} ${high}`], ['width', wide], ['height', high], ['aria-hidden', 'true']] as const) svg.setAttribute(key, value);
    this.hatches(add(svg, 'defs', {}));
    this.cells(svg, plane.cells, f);
    this.axes(svg, f);
    const inside = add(svg, 'g', { 'clip-path': `url(#${this.id}-clip)` });
    add(add(svg.firstElementChild!, 'clipPath', { id: `${this.id}-clip` }), 'rect', { x: LEFT, y: TOP, width: f.wide - LEFT - RIGHT, height: f.high - TOP - BOTTOM });
    if (plane.ball) this.ball(inside, plane.ball, plane.next, f);
    for (const one of plane.touches) add(inside, 'circle', { cx: f.x(one.x), cy: f.y(one.y), r: 3.2, fill: '#fff', stroke: '#000', 'stroke-width': 1.2 });
    if (plane.next) this.next(inside, f.x(plane.next.x), f.y(plane.next.y), f.wide);
    this.cursor = add(svg, 'g', { class: 'cursor', visibility: 'hidden' });
    lined(this.cursor, 'rect', { width: f.px(f.across), height: f.px(f.up) }, 2.5);
    this.picture.replaceChildren(svg, ...this.tip ? [this.tip] : []);
  }

  private hatches(defs: Element): void {
    for (const [name, apart] of [['some', 7], ['much', 3.5]] as const) {
      const pattern = add(defs, 'pattern', { id: `${this.id}-${name}`, width: apart, height: apart, patternUnits: 'userSpaceOnUse', patternTransform: 'rotate(45)' });
      add(pattern, 'path', { d: `M0 0V${apart}`, stroke: '#fff', 'stroke-opacity': 0.55, 'stroke-width': 1.4 });
    }
  }

  private cells(svg: Element, cells: Cell[], f: Frame): void {
    const [low, high] = range(cells), size = { width: f.px(f.across) + 0.3, height: f.px(f.up) + 0.3 };
    const place = (one: Cell) => ({ x: f.x(one.x - f.across / 2), y: f.y(one.y + f.up / 2), ...size });
    for (const one of cells) add(svg, 'rect', { ...place(one), fill: cividis((one.stiffness - low) / (high - low)) });
    for (const one of cells) {
      if (one.stddev >= DOUBT) add(svg, 'rect', { ...place(one), fill: `url(#${this.id}-${one.stddev >= DEEP_DOUBT ? 'much' : 'some'})` });
    }
  }

  private axes(svg: Element, f: Frame): void {
    const step = [1, 2, 5, 10, 20, 50].find(mm => f.px(mm) >= 40) ?? 100, bottom = f.high - BOTTOM;
    const ticks = (of: number[], cell: number) => {
      const from = Math.ceil((of[0]! - cell / 2) / step), to = Math.floor((of.at(-1)! + cell / 2) / step);
      return Array.from({ length: to - from + 1 }, (_, i) => step * (from + i));
    };
    const text = (mm: number) => String(mm).replace('-', '\u2212');
    for (const mm of ticks(this.frame!.columns, f.across)) {
      add(svg, 'path', { d: `M${f.x(mm)} ${bottom}v4`, class: 'tick' });
      if (f.x(mm) < f.wide - 50) add(svg, 'text', { x: f.x(mm), y: bottom + 15, 'text-anchor': 'middle', class: 'tick' }, text(mm));
    }
    for (const mm of ticks(this.frame!.rows, f.up)) {
      add(svg, 'path', { d: `M${LEFT} ${f.y(mm)}h-4`, class: 'tick' });
      if (f.y(mm) > TOP + 16) add(svg, 'text', { x: LEFT - 7, y: f.y(mm) + 4, 'text-anchor': 'end', class: 'tick' }, text(mm));
    }
    add(svg, 'text', { x: f.wide - RIGHT, y: bottom + 15, 'text-anchor': 'end', class: 'tick' }, 'x, mm');
    add(svg, 'text', { x: 0, y: TOP + 8, class: 'tick' }, 'y, mm');
  }

  /** Its middle circle, what its radius may be dashed, and how far its axis may lie off. */
  private ball(svg: Element, ball: Ball, next: Spot | undefined, f: Frame): void {
    const [x, y] = [f.x(ball.x.median), f.y(ball.y.median)], r = f.px(ball.radius.median);
    for (const one of [ball.radius.low, ball.radius.high]) lined(svg, 'circle', { cx: x, cy: y, r: f.px(one), 'stroke-dasharray': '4 5' }, 1);
    lined(svg, 'circle', { cx: x, cy: y, r, ...(ball.trusted ? {} : { 'stroke-dasharray': '1.5 5', 'stroke-linecap': 'round' }) }, 2.2);
    const [left, right, low, high] = [f.x(ball.x.low), f.x(ball.x.high), f.y(ball.y.low), f.y(ball.y.high)];
    lined(svg, 'path', { d: `M${left} ${y}H${right}M${left} ${y - 4}v8M${right} ${y - 4}v8M${x} ${low}V${high}M${x - 4} ${low}h8M${x - 4} ${high}h8` }, 1.8);
    word(svg, x, 8, y - 8, `${ball.trusted ? '' : '? '}${ball.depth.median.toFixed(1)} mm deep`, next !== undefined && next.x > ball.x.median, f.wide);
  }

  private next(svg: Element, x: number, y: number, wide: number): void {
    lined(svg, 'path', { d: `M${x - 9} ${y}a9 9 0 1 0 18 0a9 9 0 1 0 -18 0M${x} ${y - 13}v8M${x} ${y + 5}v8M${x - 13} ${y}h8M${x + 5} ${y}h8` }, 2);
    word(svg, x, 15, Math.max(y + 4, TOP + 12), 'next tap', false, wide);
  }

  private explain(plane: Plane): void {
    const [low, high] = range(plane.cells), item = (draw: (svg: Element) => void, text: string, wide = 18) => {
      const line = document.createElement('li'), svg = document.createElementNS(SVG, 'svg');
      svg.setAttribute('viewBox', `0 0 ${wide} 14`);
      svg.setAttribute('width', String(wide));
      svg.setAttribute('height', '14');
      svg.setAttribute('aria-hidden', 'true');
      draw(svg);
      line.append(svg, text);
      return line;
    };
    const all = [item(svg => {
      for (let i = 0; i < 24; i++) add(svg, 'rect', { x: i * 3, y: 3, width: 3.2, height: 8, fill: cividis(i / 23) });
    }, `${low.toFixed(2)} to ${high.toFixed(2)} \u00d7 plain tissue`, 72)];
    if (plane.cells.some(one => one.stddev >= DOUBT)) {
      all.push(item(svg => {
        add(svg, 'rect', { width: 40, height: 14, fill: cividis(0.25) });
        for (const [x, name] of [[0, 'some'], [20, 'much']] as const) add(svg, 'rect', { x, width: 20, height: 14, fill: `url(#${this.id}-${name})` });
      }, `doubt > ${(100 * DOUBT).toFixed(0)}, ${(100 * DEEP_DOUBT).toFixed(0)} %`, 40));
    }
    const ground = (svg: Element) => add(svg, 'rect', { width: 18, height: 14, rx: 3, fill: '#454c5a' });
    all.push(item(svg => { ground(svg); add(svg, 'circle', { cx: 9, cy: 7, r: 3.2, fill: '#fff', stroke: '#000', 'stroke-width': 1.2 }); }, 'touched'));
    if (this.tip) all.push(item(svg => { ground(svg); add(svg, 'path', { ...TIP, transform: 'translate(2.6 .6) scale(.8)' }); }, 'tip'));
    if (plane.ball) all.push(item(svg => { ground(svg); lined(svg, 'circle', { cx: 9, cy: 7, r: 4.5 }, 2); }, 'inclusion, 95 %'));
    if (plane.next) all.push(item(svg => { ground(svg); lined(svg, 'path', { d: 'M5 7a4 4 0 1 0 8 0a4 4 0 1 0 -8 0M9 1v4M9 9v4M3 7h4M11 7h4' }, 1.4); }, 'next tap'));
    this.legend.replaceChildren(...all);
  }

  private point(event: PointerEvent): void {
    const svg = this.picture.firstElementChild as SVGSVGElement | null, f = this.frame;
    if (!svg || !f || !this.plane) return;
    const matrix = svg.getScreenCTM();
    if (!matrix) return;
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(matrix.inverse());
    this.read(this.plane.cells.findIndex(one => Math.abs(f.x(one.x) - x) <= f.px(f.across) / 2 && Math.abs(f.y(one.y) - y) <= f.px(f.up) / 2));
  }

  private step(key: string): boolean {
    const f = this.frame, cells = this.plane?.cells;
    if (!f || !cells || cells.length === 0) return false;
    const wide = f.columns.length, at = this.at < 0 ? Math.floor(cells.length / 2) : this.at;
    const column = at % wide, moves: Record<string, number> = {
      Home: at, ArrowLeft: column > 0 ? at - 1 : at, ArrowRight: column < wide - 1 ? at + 1 : at,
      ArrowUp: at + wide < cells.length ? at + wide : at, ArrowDown: at >= wide ? at - wide : at,
    };
    const to = moves[key];
    if (to === undefined) return false;
    this.read(to);
    return true;
  }

  private read(at: number): void {
    this.at = at;
    const cell = this.plane?.cells[at], f = this.frame;
    this.cursor?.setAttribute('visibility', cell ? 'visible' : 'hidden');
    if (cell && f) this.cursor!.setAttribute('transform', `translate(${f.x(cell.x - f.across / 2)} ${f.y(cell.y + f.up / 2)})`);
    const text = cell ? cellWords(cell) : 'Point at a cell, or use arrow keys.';
    if (this.readout.textContent !== text) this.readout.textContent = text;
  }
}
