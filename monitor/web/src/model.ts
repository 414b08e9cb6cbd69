// All that the page knows of the session, and what it makes of it. Numbers in mm, N and ms.
import type { Greeting } from './client';
import type { Ball, Cell, Plane, Span, Spot } from './plane';
import type { Message } from './schema';

export interface Status {
  state: string; reason: string; refused: string; epoch: number;
  position_mm: number; force_n: number; force_missing_n: number; force_short: string; force_short_n: number; x_mm: number; y_mm: number;
  link: string; session: string; gap_ms: number; round_trip_ms: number;
  peer_heard: boolean; peer_state: string; peer_sampled: boolean;
  peer_position_mm: number; peer_force_n: number; peer_force_min_n: number; peer_force_max_n: number;
  peer_x_mm: number; peer_y_mm: number;
  ticks: number; ticks_missed: number; dropped: number; recording: boolean; clients: number;
  pilot: number; pilot_name: string; pilot_obstacle: string;
}

/** How the camera's pictures come. */
export interface Video { sending: boolean; state: string; age_ms: number; kbps: number; fps: number; standing_ms: number; touch_held_ms: number; delivered: number; repaired: number; not_shown: number }
export interface Depth { number: number; verdict: string; reason: string; depth: number; low: number; high: number; x: number; y: number }
/** What the strokes at three places or more say together of one round inclusion. */
export interface TissueMap { number: number; places: number; ball: Ball | undefined; doubts: string[]; next: Spot | undefined }
export interface Stroke { began: number; ended: number; x: number; y: number; press: number; force: number; stiffness: number; depth: Depth | undefined }
export interface Happening { at: number; text: string; tone: '' | 'warn' | 'bad' }
/** At the tissue and at the hand, newest last; extremes where the site told them. */
export interface Trace { t: number[]; tip: number[]; hand: number[]; contact: number[]; contactMin: number[]; contactMax: number[]; felt: number[] }

const SPAN_MS = 12500;
const CONTACT_N = 0.12, AIR_N = 0.06;
const KEPT = 200;
const LEADS_MS = 10000;
export const OLD_MS = 500;
const REASONS: Record<string, string> = {
  STROKE_TOO_SHORT: 'the press was too shallow', STROKE_TOO_FEW_SAMPLES: 'the press was too quick',
  STROKE_NOT_MONOTONE: 'the press went back and forth', NO_CONTACT: 'no contact was found',
  FORCE_SATURATED: 'the force sensor was saturated', HASH_OUT_OF_RANGE: 'outside the range of the formula',
  TOO_NOISY: 'the force is too noisy',
};
/** What is wrong with a map, and what helps; in the order of the bits. */
const DOUBTS = [
  'the force at a place grows as in no tissue that was assumed: tap slower',
  'one ball does not explain the stiffness at every place: touch between those that differ',
  'it may lie at either of two places: touch beside the line of the touches',
  'it may lie beyond the touched places: touch farther out on the stiff side',
];
const number = (value: unknown): number => typeof value === 'number' ? value : 0;

export class Model {
  greeting: Greeting | undefined;
  status: Status | undefined;
  heardAt = 0;  // page time of the newest status
  roundTrip = 0;  // [ms] between the site and this page, as the site measures it
  link: Message = {};
  video: Video | undefined;
  depth: Depth | undefined;
  strokes: Stroke[] = [];  // newest first
  happenings: Happening[] = [];  // newest first
  map: TissueMap | undefined;
  cells: Cell[] = [];  // of the newest stiffness map that came whole
  trace: Trace = { t: [], tip: [], hand: [], contact: [], contactMin: [], contactMax: [], felt: [] };
  refused = false;
  private onset: { stroke: Stroke; tip: number; force: number } | undefined;
  private lastDepth = 0;
  private coming: { number: number; cells: Cell[]; told: number } = { number: 0, cells: [], told: 0 };
  private session = '';
  private leads: { at: number; lead: number }[] = [];  // page time - the site's, of late

  get patient(): boolean { return this.greeting?.metadata.site === 'patient'; }
  get mayControl(): boolean { return this.greeting?.metadata.right === 'control'; }
  get hasPointer(): boolean { return this.mayControl && this.greeting?.metadata.pointer === 'yes'; }
  /** A study gives trials here: its page shows nothing else. */
  get inStudy(): boolean { return this.greeting?.metadata.study === 'yes'; }
  get client(): number { return Number(this.greeting?.metadata.client ?? 0); }
  get pilots(): boolean { return this.client !== 0 && this.status?.pilot === this.client; }

  /**
   * What nobody tells any more is old, and so is what comes late: behind a long queue it comes as
   * evenly as ever. The whole round trip counts, for nobody knows in which direction the queue is.
   */
  stale(now: number): boolean { return !this.status || now - this.heardAt + this.roundTrip > OLD_MS; }

  tip(s: Status): number { return this.patient ? s.position_mm : s.peer_position_mm; }
  contact(s: Status): number { return this.patient ? s.force_n : s.peer_force_n; }
  hand(s: Status): number { return this.patient ? s.peer_position_mm : s.position_mm; }
  tipX(s: Status): number { return this.patient ? s.x_mm : s.peer_x_mm; }
  tipY(s: Status): number { return this.patient ? s.y_mm : s.peer_y_mm; }
  /** [ms] how old what is shown of the other site is: its way here, and the silence since. */
  age(s: Status): number {
    const way = number(this.link.delay_in_ns) / 1e6 || s.round_trip_ms / 2;
    return this.patient ? 0 : way + s.gap_ms + this.held;
  }

  /** [ms] that touch is held back to be as old as the picture. */
  private get held(): number { return this.video?.touch_held_ms ?? 0; }
  /** [ms] until touch is as old as a picture of that age; 0 where it does not wait for pictures. */
  early(age: number): number { return this.held > 0 ? Math.max(0, this.way + this.held - age) : 0; }
  /** [ms] of the way between the sites. */
  get way(): number { return number(this.link.delay_in_ns) / 1e6 || (this.status?.round_trip_ms ?? 0) / 2; }
  /** [ms] since the site's instant `stamp`: messages that took least tell the site's clock. */
  ageOf(stamp: number, now: number): number {
    const lead = this.leads.reduce((least, one) => Math.min(least, one.lead), Infinity);
    return Math.max(0, now - stamp - lead + this.roundTrip / 2);
  }
  /** [ms] that a picture of that age lags behind touch. A model of the tissue gives the force of
   *  what the hand does now; its picture shows what the hand did a way there before. Else force is
   *  as old as it is. */
  behindTouch(age: number): number {
    const local = this.greeting?.metadata.coupling === 'mmt';
    return local ? age + this.way : age - (this.status ? this.age(this.status) : 0);
  }

  begin(greeting: Greeting): void {
    if (this.greeting && this.greeting.sessionId !== greeting.sessionId) Object.assign(this, new Model());
    // The site tells again what happened before.
    this.happenings = [];
    this.lastDepth = 0;
    this.forgetMap();
    this.roundTrip = 0;
    this.greeting = greeting;
    this.refused = false;
  }

  hear(topic: string, stamp: number, message: Message, now: number): void {
    if (topic === 'status') this.hearStatus(message as unknown as Status, stamp, now);
    else if (topic === 'client') this.roundTrip = number(message.round_trip_ms);
    else if (topic === 'link') this.link = message;
    else if (topic === 'video') this.video = message as unknown as Video;
    else if (topic === 'depth') this.hearDepth(message, stamp);
    else if (topic === 'map') this.hearMap(message);
    else if (topic === 'map_cell') this.hearCell(message);
    else if (topic === 'event') this.hearEvent(message, stamp);
  }

  private hearStatus(s: Status, stamp: number, now: number): void {
    // Another session: perhaps another tissue.
    if (this.session && s.session !== this.session) this.forgetMap();
    this.session = s.session;
    this.status = s;
    this.heardAt = now;
    this.leads.push({ at: now, lead: now - stamp });
    while (this.leads[0]!.at < now - LEADS_MS) this.leads.shift();
    const t = this.trace;
    t.t.push(stamp);
    t.tip.push(this.tip(s));
    t.hand.push(this.hand(s));
    t.contact.push(this.contact(s));
    t.contactMin.push(this.patient ? s.force_n : s.peer_force_min_n);
    t.contactMax.push(this.patient ? s.force_n : s.peer_force_max_n);
    t.felt.push(this.patient ? 0 : s.force_n);
    let old = 0;
    while (old < t.t.length && t.t[old]! < stamp - SPAN_MS) old++;
    if (old > 50) for (const column of Object.values(t) as number[][]) column.splice(0, old);
    this.follow(s, stamp);
  }

  /** A stroke: from the first touch until the tip is in the air again. */
  private follow(s: Status, stamp: number): void {
    const force = this.patient ? s.force_n : s.peer_force_max_n, tip = this.tip(s);
    if (!this.onset) {
      if (force < CONTACT_N || !s.peer_heard) return;
      const stroke: Stroke = { began: stamp, ended: stamp, x: this.tipX(s), y: this.tipY(s), press: tip, force, stiffness: 0, depth: undefined };
      this.onset = { stroke, tip, force };
      this.strokes.unshift(stroke);
      if (this.strokes.length > KEPT) this.strokes.pop();
    }
    const { stroke } = this.onset;
    stroke.ended = stamp;
    if (force > stroke.force) stroke.force = force;
    if (tip > stroke.press) {
      stroke.press = tip;
      if (tip > this.onset.tip + 0.3) stroke.stiffness = (stroke.force - this.onset.force) / (tip - this.onset.tip) * 1e3;
    }
    if (force < AIR_N) this.onset = undefined;
  }

  private hearDepth(m: Message, stamp: number): void {
    const depth: Depth = {
      number: number(m.number), verdict: String(m.verdict), reason: String(m.reason),
      depth: number(m.depth_m) * 1e3, low: number(m.depth_low_m) * 1e3, high: number(m.depth_high_m) * 1e3,
      x: number(m.x_m) * 1e3, y: number(m.y_m) * 1e3,
    };
    if (depth.number === 0 || depth.number === this.lastDepth) return;
    this.lastDepth = depth.number;
    this.depth = depth;
    const stroke = this.strokes.find(one => !one.depth && Math.hypot(one.x - depth.x, one.y - depth.y) < 1);
    if (stroke) stroke.depth = depth;
    // Of before this page was opened: what it felt like nobody knows any more.
    else this.strokes.unshift({ began: stamp, ended: stamp, x: depth.x, y: depth.y, press: 0, force: 0, stiffness: 0, depth });
    this.happen(stamp, depth.verdict === 'FOUND' ? `Inclusion ${depth.depth.toFixed(1)} mm deep` : depth.verdict === 'NONE' ? 'No inclusion here' : `No depth: ${this.why(depth)}`, '');
  }

  why(depth: Depth): string { return REASONS[depth.reason] ?? depth.reason.toLowerCase().replaceAll('_', ' '); }

  private forgetMap(): void {
    this.map = undefined;
    this.cells = [];
    this.coming = { number: 0, cells: [], told: 0 };
  }

  private hearMap(m: Message): void {
    const mm = (name: string) => number(m[name]) * 1e3;
    const span = (of: string): Span => ({ median: mm(`${of}_m`), low: mm(`${of}_low_m`), high: mm(`${of}_high_m`) });
    const doubts = DOUBTS.filter((_, bit) => number(m.doubts) >> bit & 1);
    const found = m.verdict === 'FOUND';
    this.map = {
      number: number(m.number), places: number(m.places), doubts,
      ball: found ? { x: span('x'), y: span('y'), depth: span('depth'), radius: span('radius'), trusted: doubts.length === 0 } : undefined,
      next: m.stop === 'GO_ON' ? { x: mm('next_x_m'), y: mm('next_y_m') } : undefined,
    };
  }

  /** A map is shown when all of it is here: its cells come one by one, and lost ones later. */
  private hearCell(m: Message): void {
    const index = number(m.index), count = number(m.count);
    if (this.coming.number !== m.number) this.coming = { number: number(m.number), cells: [], told: 0 };
    const { cells } = this.coming;
    if (index >= count || cells[index]) return;
    cells[index] = { x: number(m.x_m) * 1e3, y: number(m.y_m) * 1e3, stiffness: number(m.stiffness), stddev: number(m.stiffness_stddev), inclusion: number(m.inclusion) };
    if (++this.coming.told === count) this.cells = cells;
  }

  /** The tissue from above; nothing before its first map came. */
  get plane(): Omit<Plane, 'says'> | undefined {
    if (!this.map || this.cells.length === 0) return undefined;
    const touches: Spot[] = [];
    for (const one of this.strokes) if (!touches.some(other => Math.hypot(one.x - other.x, one.y - other.y) < 1)) touches.push({ x: one.x, y: one.y });
    return { cells: this.cells, touches, ball: this.map.ball, next: this.map.next };
  }

  private hearEvent(m: Message, stamp: number): void {
    const state = (value: unknown) => String(value).toLowerCase();
    const text = m.kind === 'TRANSITION' ? `${state(m.to)}: ${String(m.text)}` : String(m.text) + (m.code === 49 ? ` (${number(m.detail)})` : '');
    const to = m.kind === 'TRANSITION' ? state(m.to) : '';
    this.happen(stamp, text.charAt(0).toUpperCase() + text.slice(1), to === 'stopped' ? 'bad' : to === 'hold' || to === 'retract' ? 'warn' : '');
  }

  happen(at: number, text: string, tone: Happening['tone']): void {
    this.happenings.unshift({ at, text, tone });
    this.happenings.sort((a, b) => b.at - a.at);
    if (this.happenings.length > KEPT) this.happenings.pop();
  }
}
