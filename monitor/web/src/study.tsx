// The page of a participant of a study: a prompt, a pad to palpate on, buttons to answer with. It
// shows nothing that differs from place to place but what the condition gives: where the own hand
// is drawn to by the force, and the force at the tip as a bar.
import { color } from './look';
import type { Model } from './model';
import type { Pilot } from './pilot';
import { ABOVE_MM, Pad, prepare, SPAN_MM, spring } from './section';

/** What the study wants to be shown. */
export interface StudyView {
  stage: string; trial: number; practice: boolean; place: number; count: number;
  interval: number; intervals: number; taps: number;
  instructions: string; question: string; choices: string[]; notice: string;
  right?: boolean; seconds?: number; draws_force?: boolean;
  side_mm?: number;  // of the area of a search
}

/** The force at the tip, and the greatest of each touch until the next begins. */
export class ForceBar {
  private static readonly FULL_N = 2;
  private static readonly TOUCH_N = 0.1;
  private most = 0;
  private touches = false;

  see(force: number): { force: number; most: number } {
    const touches = force > ForceBar.TOUCH_N;
    if (touches && !this.touches) this.most = 0;
    this.touches = touches;
    this.most = Math.max(this.most, touches ? force : 0);
    return { force, most: this.most };
  }
  /** [%] of the bar. */
  static share(force: number): number { return Math.min(100, Math.max(0, force / ForceBar.FULL_N * 100)); }
}

/** Of the trial that asks now; undefined: none does, or it has its answer. */
export class Answering {
  private given = 0;
  constructor(private readonly answer: (trial: number, choice: number) => void) {}

  awaits(view: StudyView | undefined): boolean {
    const asks = view?.stage === 'answer' || (view?.stage === 'touch' && view.side_mm !== undefined);
    return asks && view.trial !== this.given;
  }

  /** From 1; more than there are, or at another time, is none. */
  choose(view: StudyView | undefined, choice: number): void {
    if (!view || !this.awaits(view) || choice < 1 || choice > view.choices.length) return;
    this.given = view.trial;
    this.answer(view.trial, choice);
  }
}

export function promptOf(view: StudyView): string {
  const place = view.intervals === 1 ? '' : view.intervals === 2 ? ['first', 'second'][view.interval - 1] : `number ${view.interval}`;
  switch (view.stage) {
    case 'press': return 'Press the pad and hold.';
    case 'lift': return 'Lift: the tip must be out of the tissue.';
    case 'travel': return 'Keep holding, and wait.';
    case 'touch': return view.side_mm ? 'Search the area, and say so when you are over something hard.' : `Tap the ${place}${place && ' '}place${view.taps > 1 ? ` ${view.taps} times` : ''}.`;
    case 'answer': return view.question;
    case 'told': return view.right ? 'Right.' : 'Wrong.';
    case 'rest': return `Rest: ${view.seconds} s. Then open the page that the operator names.`;
    case 'over': return 'It is over. Thank you.';
  }
  return '';
}

/** Where in the area of a search the tip is: it begins in the middle. */
export class Area {
  private trial = 0;
  private origin: { x: number; y: number } | undefined;

  /** [mm] from the middle; undefined: the search has not begun. */
  see(view: StudyView, x: number, y: number): { x: number; y: number } | undefined {
    if (view.trial !== this.trial || view.stage === 'travel') this.origin = undefined;
    this.trial = view.trial;
    if (!this.origin && view.stage === 'touch') this.origin = { x, y };
    return this.origin && { x: x - this.origin.x, y: y - this.origin.y };
  }
}

function FromAbove({ model, view, area }: { model: Model; view: StudyView; area: Area }) {
  const side = view.side_mm!, s = model.status, half = side / 2;
  const tip = s && area.see(view, model.tipX(s), model.tipY(s));
  return <figure class="area">
    <svg id="area" viewBox={`${-half - 2} ${-half - 2} ${side + 4} ${side + 4}`} role="img" aria-label="The area from above, and where the tip is"
      data-x={tip?.x.toFixed(1)} data-y={tip?.y.toFixed(1)}>
      <rect x={-half} y={-half} width={side} height={side} />
      {tip && <circle cx={tip.x} cy={-tip.y} r={1.5} />}
    </svg>
    <figcaption>From above, {side.toFixed(0)} mm wide. Move <kbd>sideways</kbd>; with <kbd>Shift</kbd> up and down in this view.</figcaption>
  </figure>;
}

/** The surface, the finger, and the hand that it draws. */
function paint(model: Model, pilot: Pilot, under: HTMLCanvasElement, over: HTMLCanvasElement, w: number, h: number): void {
  const mm = w / SPAN_MM, Y = (y: number) => (y + ABOVE_MM) * mm, s = model.status, f = pilot.finger;
  const stamp = [w, h, color('--air')].join(' ');
  if (under.dataset.stamp !== stamp) {
    under.dataset.stamp = stamp;
    const g = prepare(under, w, h);
    g.fillStyle = color('--air');
    g.fillRect(0, 0, w, h);
    g.fillStyle = color('--unknown');
    g.fillRect(0, Y(0), w, h - Y(0));
  }
  const g = prepare(over, w, h);
  if (!s || !f) return;
  const engaged = s.state === 'ENGAGED' || s.state === 'HOLD';
  spring(g, w / 2, Y(model.hand(s)), w / 2, Y(pilot.from.tip + f.into) + 16, undefined, engaged);
}

/** What the places of a trial are called. */
function placesOf(view: StudyView): string[] {
  if (view.choices.length === view.intervals) return view.choices;
  return Array.from({ length: view.intervals }, (_, i) => `number ${i + 1}`);
}

function Drawn({ model, bar }: { model: Model; bar: ForceBar }) {
  const { force, most } = bar.see(model.status ? model.contact(model.status) : 0);
  return <div class="drawn" id="drawn" data-most={most.toFixed(2)}>
    <p>Force <b>{force.toFixed(2)} N</b>, greatest of the touch <b>{most.toFixed(2)} N</b></p>
    <div class="gauge" aria-hidden="true"><i style={{ width: `${ForceBar.share(force)}%` }} /><u style={{ left: `${ForceBar.share(most)}%` }} /></div>
  </div>;
}

export function StudyPage({ model, pilot, view, answering, bar, area }: { model: Model; pilot: Pilot; view: StudyView; answering: Answering; bar: ForceBar; area: Area }) {
  const gives = view.trial > 0, awaits = answering.awaits(view);
  const share = view.count > 0 ? (view.place - 1) / view.count * 100 : 0;
  return <main class="study">
    <section class="card section">
      <Pad pilot={pilot} control={model.hasPointer} paint={(under, over, w, h) => paint(model, pilot, under, over, w, h)}
        label="Palpation pad. Hold Space to engage, arrow keys move the finger, release Space to let go, Escape stops." />
    </section>
    <section class="card ask">
      {gives && <p class="progress" id="progress">{view.practice ? `Practice ${view.place}` : `Trial ${view.place} of ${view.count}`}</p>}
      {gives && <div class="gauge" aria-hidden="true"><i style={{ width: `${share}%` }} /></div>}
      <p class="prompt" id="prompt" role="status" data-stage={view.stage} data-trial={view.trial} data-interval={view.interval}>{promptOf(view)}</p>
      {gives && view.intervals > 1 && <ol class="places" aria-label="Places of this trial">{placesOf(view).map((name, i) => {
        const now = i + 1 === view.interval && ['travel', 'touch'].includes(view.stage);
        return <li key={name} class={now ? 'now' : ''} aria-current={now ? 'step' : undefined}>{name}</li>;
      })}</ol>}
      {gives && view.side_mm && <FromAbove model={model} view={view} area={area} />}
      {view.draws_force && <Drawn model={model} bar={bar} />}
      {view.notice && <p class="notice warn" id="notice">{view.notice}</p>}
      {gives && <div class="answers">{view.choices.map((name, i) =>
        <button key={name} id={`answer-${i + 1}`} disabled={!awaits} onClick={() => answering.choose(view, i + 1)}>{name} <kbd>{i + 1}</kbd></button>)}</div>}
      {gives && <p class="told">{view.instructions}</p>}
    </section>
  </main>;
}
