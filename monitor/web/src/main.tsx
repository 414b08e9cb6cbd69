import { render, type ComponentChildren } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { beat, onBeat } from './beat';
import { ForceStrip, PlaceStrip } from './charts';
import { Camera } from './camera';
import { Client } from './client';
import { MapCard } from './map';
import { Model, type Depth, type Status, type TissueMap } from './model';
import { Picture } from './picture';
import { Pilot } from './pilot';
import { Section } from './section';
import { Sound } from './sound';
import { Answering, Area, ForceBar, StudyPage, type StudyView } from './study';
import { wordsOf } from './words';
import './style.css';

const FORCE_LIMIT_N = 8.5, FORCE_SCALE_N = 3;
/** Figures are read at this pace; what is news is drawn at once. */
const TEXT_MS = 200;
const TOKEN = 'palp-token';

/** From the address once, then kept by this tab alone. */
function token(): string {
  const given = location.hash.slice(1);
  if (given) {
    sessionStorage.setItem(TOKEN, given);
    history.replaceState(null, '', location.pathname + location.search);
  }
  return given || sessionStorage.getItem(TOKEN) || '';
}

const model = new Model(), sound = new Sound();
let wantsPointer = true, askedAt = -1e9;
let study: StudyView | undefined;  // what a study shows; undefined: there is none
const say = (text: string, tone: '' | 'warn' | 'bad' = '') => model.happen(Date.now(), text, tone);

const camera: Camera = new Camera({
  age: (stamp, now) => model.ageOf(stamp, now),
  early: age => model.early(age),
  ask: () => { client.follow(PICTURES, false); client.follow(PICTURES, true); },
  drew: beat,
});

const client: Client = new Client(token(), {
  greeted: greeting => { model.begin(greeting); camera.end(); study = undefined; },
  heard: (topic, stamp, message) => {
    const now = performance.now();
    if (topic === 'camera') return camera.hear(message.data as Uint8Array, stamp, now);
    if (topic === 'camera_jpeg') return void camera.hearJpeg(message.data as Uint8Array, stamp);
    if (topic === 'study') {
      study = message as unknown as StudyView;
      return redrawPage();
    }
    model.hear(topic, stamp, message, now);
    tellNews();
    if (topic !== 'status') return;
    const s = model.status!;
    sound.play(model.patient || model.inStudy ? 0 : Math.abs(s.force_n));
    if (wantsPointer && model.hasPointer && s.pilot === 0 && now - askedAt > 1000) void takePointer(now);
  },
  said: sentence => say(sentence, 'warn'),
  ended: refused => { pilot.up(); model.refused = refused && !model.greeting; },
});
const pilot = new Pilot(client, model);
const forceBar = new ForceBar(), searchArea = new Area();
const answering = new Answering((trial, choice) => {
  void client.call('study/answer', { trial, choice }).then(answer => { if (!answer.ok) say(answer.why, 'warn'); });
});

/** Draws the page at once where a word on it has changed. */
let redrawPage = () => {}, told = '';
function tellNews(): void {
  const s = model.status, newest = model.happenings[0];
  const words = [s?.state, s?.link, s?.refused, s?.pilot, s?.pilot_obstacle, s?.recording, newest?.at, newest?.text,
    model.depth?.number, model.map?.number, model.strokes.length, model.video?.state].join();
  if (words === told) return;
  told = words;
  redrawPage();
}

// Nobody looks at a hidden page: its pictures are not sent.
const PICTURES = ['camera', 'camera_jpeg'];
document.addEventListener('visibilitychange', () => {
  client.follow(PICTURES, !document.hidden);
  if (document.hidden) camera.end();
});

async function takePointer(now: number): Promise<void> {
  askedAt = now;
  const answer = await client.call('pointer/take', { name: new URLSearchParams(location.search).get('name') ?? '' });
  wantsPointer = answer.ok;
  if (!answer.ok) say(answer.why, 'warn');
}

async function ask(service: string): Promise<void> {
  if (service === 'stop') pilot.up();
  const answer = await client.call(service);
  if (!answer.ok) say(answer.why, 'warn');
}

addEventListener('keydown', e => {
  if (e.repeat || e.ctrlKey || e.altKey || e.metaKey) return;
  const key = e.key.toLowerCase();
  if (key === 'escape' && model.mayControl) void ask('stop');
  else if (key === 'm' && model.mayControl) void ask('mark');
  else if (key === 'r' && model.mayControl && model.status?.state === 'STOPPED') void ask('reset');
  else if (key === 's' && !model.inStudy) sound.toggle();
  else if (/^[1-9]$/.test(key)) answering.choose(study, Number(key));
});

function Row({ name, id, unit, tone, kind, children }: { name: string; id?: string; unit?: string; tone?: string; kind?: string; children: ComponentChildren }) {
  return <div class={'row ' + (kind ?? '')}><dt>{name}</dt><dd class={tone} id={id}>{children}{unit && <small> {unit}</small>}</dd></div>;
}

function Gauge({ force }: { force: number }) {
  const share = Math.min(1, Math.max(0, force / FORCE_SCALE_N)) * 100;
  return <div class="gauge" role="meter" aria-valuemin={0} aria-valuemax={FORCE_LIMIT_N} aria-valuenow={+force.toFixed(2)} aria-label="Contact force in newtons"><i style={{ width: `${share}%` }} /></div>;
}

const two = (n: number): string => String(n).padStart(2, '0');
function clock(at: number): string {
  const date = new Date(at);
  return `${two(date.getHours())}:${two(date.getMinutes())}:${two(date.getSeconds())}`;
}

function Touch({ s }: { s: Status | undefined }) {
  const last = model.strokes.find(one => one.stiffness > 0);
  return <section class="card touch">
    <header><h2>Touch</h2><span class="unit">contact force</span></header>
    <p class="big"><span id="force">{s ? Math.max(0, model.contact(s)).toFixed(2) : '-'}</span> N</p>
    <Gauge force={s ? model.contact(s) : 0} />
    <dl>
      <Row name="Indentation" id="indentation" unit="mm">{s ? Math.max(0, model.tip(s)).toFixed(1) : '-'}</Row>
      {!model.patient && <Row name="Felt by the hand" unit="N" kind="spare">{s ? (Math.round(s.force_n * 100) / 100 || 0).toFixed(2) : '-'}</Row>}
      <Row name="Stiffness, last stroke" id="stiffness" unit="N/m">{last ? last.stiffness.toFixed(0) : '-'}</Row>
    </dl>
  </section>;
}

/** What the newest stroke says, or all of them where they were at three places or more. */
function Inclusion() {
  const map = model.map, d = model.depth;
  const [sign, verdict, tone] = map ? (map.doubts.length > 0 ? ['▲', 'not trusted', 'warn'] : map.ball ? ['✓', 'found', 'ok'] : ['○', 'no inclusion', ''])
    : !d ? ['○', 'no stroke yet', ''] : d.verdict === 'FOUND' ? ['✓', 'found', 'ok'] : d.verdict === 'NONE' ? ['○', 'no inclusion', ''] : ['▲', 'not trusted', 'warn'];
  return <section class="card inclusion">
    <header><h2>Inclusion</h2><span class="unit">{map ? `from all ${map.places} places` : 'below the surface'}</span></header>
    {map ? <OfMap map={map} /> : <OfStroke d={d} />}
    <dl><Row name="Verdict" id="verdict" tone={tone}><b aria-hidden="true">{sign}</b> {verdict}</Row>
      {map?.ball && <Row name="Axis at x, y" unit="mm">{place(map.ball.x.median, map.ball.y.median)}</Row>}
      {map?.ball && <Row name="Radius" unit="mm">{map.ball.radius.median.toFixed(1)}</Row>}
      {map && <Row name="Next tap" id="next-tap" unit={map.next && 'mm'}>{map.next ? place(map.next.x, map.next.y) : 'enough'}</Row>}
      <Row name="Strokes" id="stroke-count" kind="spare">{model.strokes.length}</Row></dl>
  </section>;
}

const place = (x: number, y: number): string => `${x.toFixed(0)}, ${y.toFixed(0)}`.replaceAll('-', '\u2212');

function Answer({ kind, big, unit, text }: { kind: string; big: string; unit?: string; text: string }) {
  return <><p class={'big ' + kind}><span id="depth">{big}</span>{unit && ` ${unit}`}</p><p class="interval" id="interval">{text}</p></>;
}

function OfMap({ map }: { map: TissueMap }) {
  const doubt = map.doubts[0], { ball } = map;
  const interval = ball && `top between ${ball.depth.low.toFixed(1)} and ${ball.depth.high.toFixed(1)} mm, 95 %`;
  const why = doubt && `${doubt.charAt(0).toUpperCase()}${doubt.slice(1)}.`;
  return ball ? <Answer kind={why ? 'none' : 'found'} big={ball.depth.median.toFixed(1)} unit="mm" text={why ?? interval!} />
    : <Answer kind="none" big="none" text={why ?? `none found at ${map.places} places`} />;
}

function OfStroke({ d }: { d: Depth | undefined }) {
  if (!d) return <Answer kind="none" big="-" text="Tap once: press 3 mm or more, and lift again." />;
  if (d.verdict === 'FOUND') {
    return <Answer kind="found" big={d.depth.toFixed(1)} unit="mm"
      text={d.high > d.low ? `between ${d.low.toFixed(1)} and ${d.high.toFixed(1)} mm, 95 %` : 'this estimator tells no interval'} />;
  }
  if (d.verdict === 'NONE') return <Answer kind="none" big="none" text={d.low > 0 ? `nothing of 5 mm radius or more above ${d.low.toFixed(1)} mm` : 'nothing is excluded'} />;
  return <Answer kind="none" big="?" text={`No statement: ${model.why(d)}.`} />;
}

function Strokes() {
  return <section class="card strokes">
    <header><h2>Strokes</h2><span class="unit">newest first</span></header>
    <div class="scroll" tabIndex={0} aria-label="Table of strokes"><table><thead><tr><th>time</th><th>place<small> mm</small></th><th>press<small> mm</small></th><th>force<small> N</small></th><th>stiffness<small> N/m</small></th><th>inclusion<small> mm</small></th></tr></thead>
      <tbody id="strokes">{model.strokes.map(one => <tr key={one.began}>
        <td>{clock(one.began)}</td><td>{one.x.toFixed(1)}</td><td>{one.force > 0 ? one.press.toFixed(1) : '-'}</td><td>{one.force > 0 ? one.force.toFixed(2) : '-'}</td>
        <td>{one.stiffness > 0 ? one.stiffness.toFixed(0) : '-'}</td>
        <td class={one.depth?.verdict === 'FOUND' ? '' : 'dim'}>{!one.depth ? '-' : one.depth.verdict === 'FOUND' ? one.depth.depth.toFixed(1) : one.depth.verdict === 'NONE' ? 'none' : '?'}</td>
      </tr>)}</tbody></table>
      {model.strokes.length === 0 && <p class="empty">No stroke yet.</p>}</div>
  </section>;
}

function LinkCard({ s, stale }: { s: Status | undefined; stale: boolean }) {
  const number = (name: string) => typeof model.link[name] === 'number' ? model.link[name] as number : 0;
  const sent = number('accepted') + number('lost'), live = s?.link === 'LIVE' && !stale;
  return <section class="card link">
    <header><h2>Link</h2><span class={'unit ' + (live ? 'ok' : 'bad')}>{live ? '✓' : '▲'} {stale ? 'unknown' : s!.link.toLowerCase()}</span></header>
    <dl>
      <Row name="Round trip" id="round-trip" unit="ms">{s ? s.round_trip_ms.toFixed(1) : '-'}</Row>
      <Row name="Jitter" unit="ms">{(number('jitter_ns') / 1e6).toFixed(1)}</Row>
      <Row name="Lost" unit="%">{sent > 0 ? (number('lost') / sent * 100).toFixed(2) : '-'}</Row>
      <Row name="Last heard" unit="ms ago" tone={live ? '' : 'bad'}>{s ? s.gap_ms.toFixed(0) : '-'}</Row>
      {!model.patient && <Row name="Touch is" id="age" unit="ms old">{s ? model.age(s).toFixed(0) : '-'}</Row>}
      <Row name="Missed ticks" unit={`of ${s ? s.ticks.toLocaleString('en') : 0}`}>{s ? s.ticks_missed.toLocaleString('en') : '-'}</Row>
    </dl>
  </section>;
}

function VideoCard() {
  const v = model.video, seen = v ? v.delivered + v.not_shown : 0;
  return <section class="card link">
    <header><h2>Picture</h2><span class={'unit ' + (v?.sending ? 'ok' : 'bad')}>{v?.sending ? '✓ sent' : '▲ not sent'}</span></header>
    <dl>
      <Row name="Rate" unit="kbit/s">{v ? v.kbps.toFixed(0) : '-'}</Row>
      <Row name="Pictures" unit="/s">{v ? v.fps.toFixed(0) : '-'}</Row>
      <Row name="Repaired" unit="%">{v && v.delivered > 0 ? (v.repaired / v.delivered * 100).toFixed(1) : '-'}</Row>
      <Row name="Not shown" unit="%">{seen > 0 ? (v!.not_shown / seen * 100).toFixed(1) : '-'}</Row>
      {v && v.touch_held_ms > 0 && <Row name="Touch waits for it" unit="ms">{v.touch_held_ms.toFixed(0)}</Row>}
    </dl>
  </section>;
}

function Session({ s }: { s: Status | undefined }) {
  const facts = model.greeting?.metadata ?? {};
  return <section class="card session">
    <header><h2>Session</h2></header>
    <dl>
      <Row name="Coupling">{facts.coupling ?? '-'}</Row>
      {!model.patient && <Row name="Master">{facts.master ?? '-'}</Row>}
      {model.hasPointer && <Row name="Pointer" id="pointer">{!s || s.pilot === 0 ? 'nobody' : model.pilots ? 'you' : `client ${s.pilot}${s.pilot_name ? ` (${s.pilot_name})` : ''}`}</Row>}
      <Row name="Looking on">{s ? s.clients : '-'}</Row>
    </dl>
    {model.hasPointer && s && s.pilot === 0 && !wantsPointer && <button onClick={() => { wantsPointer = true; void takePointer(performance.now()); }}>Take the pointer</button>}
    {model.pilots && <button onClick={() => { wantsPointer = false; pilot.up(); void ask('pointer/give'); }}>Give the pointer</button>}
    {model.mayControl && <button id="end" onClick={() => { if (confirm('End the session at this site?')) void ask('end_session'); }}>End session</button>}
  </section>;
}

function Events() {
  return <section class="card events">
    <header><h2>Events</h2></header>
    <ol tabIndex={0} aria-label="Events, newest first" id="events">{model.happenings.slice(0, 40).map((one, i) => <li key={`${one.at} ${i}`} class={one.tone}><time>{clock(one.at)}</time>{one.tone === 'bad' ? '■ ' : one.tone === 'warn' ? '▲ ' : ''}{one.text}</li>)}</ol>
  </section>;
}

function Bar({ stale }: { stale: boolean }) {
  const s = model.status, words = wordsOf(model, stale, pilot.finger !== undefined), alarm = words.tone === 'bad' || words.word === 'Hold';
  const live = s?.link === 'LIVE' && !stale;
  return <header class="bar">
    <span class="brand">Palp<small>{model.greeting ? `${model.patient ? 'patient' : 'surgeon'} site${model.mayControl ? '' : ', only to look'}` : 'monitor'}</small></span>
    <span class={'state ' + words.tone} role={alarm ? 'alert' : 'status'} id="state" data-state={stale ? 'STALE' : s!.state}><b aria-hidden="true">{words.icon}</b><strong>{words.word}</strong><span>{words.text}</span></span>
    {!model.inStudy && <span class={'chip ' + (live ? 'ok' : 'bad')}><b aria-hidden="true">{live ? '✓' : '▲'}</b>Link {stale ? 'unknown' : s!.link.toLowerCase()} <em>{s && !stale ? `${s.round_trip_ms.toFixed(0)} ms` : ''}</em></span>}
    <span class={'chip ' + (s?.recording && !stale ? 'rec' : '')}><b aria-hidden="true">{s?.recording && !stale ? '●' : '○'}</b>{stale ? 'Recording unknown' : s?.recording ? 'Recording' : 'Not recording'}</span>
    {!model.patient && !model.inStudy && <button class="ghost" aria-pressed={sound.on} onClick={() => sound.toggle()}>{sound.on ? 'Sound on' : 'Sound off'} <kbd>S</kbd></button>}
    {model.mayControl && <button class="ghost" id="mark" onClick={() => void ask('mark')}>Mark <kbd>M</kbd></button>}
    {model.mayControl && s?.state === 'STOPPED' && <button id="reset" onClick={() => void ask('reset')}>Reset <kbd>R</kbd></button>}
    {model.mayControl && <button class="stop" id="stop" onClick={() => void ask('stop')}>Stop <kbd>Esc</kbd></button>}
  </header>;
}

function Page() {
  const [, redraw] = useState(0);
  useEffect(() => {
    redrawPage = () => redraw(n => n + 1);
    return onBeat(TEXT_MS, redrawPage);
  }, []);
  const s = model.status, stale = model.stale(performance.now());
  if (model.inStudy) {
    return <div class={'page' + (stale ? ' stale' : '')}>
      <Bar stale={stale} />
      {study && <StudyPage model={model} pilot={pilot} view={study} answering={answering} bar={forceBar} area={searchArea} />}
    </div>;
  }
  return <div class={'page' + (stale ? ' stale' : '')}>
    <Bar stale={stale} />
    <main>
      <div class="left">
        <Section model={model} pilot={pilot} control={model.hasPointer} />
        <div class="pair"><MapCard model={model} /><div class="stack"><Touch s={s} /><Inclusion /></div></div>
      </div>
      <div class="middle">{client.tells('camera') && <Picture model={model} camera={camera} now={performance.now()} />}<ForceStrip model={model} /><PlaceStrip model={model} /><Strokes /></div>
      <aside class="right"><LinkCard s={s} stale={stale} />{camera.shown && <VideoCard />}<Session s={s} /><Events /></aside>
    </main>
  </div>;
}

// What is shown, in numbers, for whoever automates a browser.
Object.assign(window, {
  palpStrokes: () => model.strokes.map(one => ({ ...one, verdict: one.depth?.verdict ?? '' })),
  palpPicture: () => ({ shown: camera.shown, drawn: camera.drawn, resets: camera.resets, video: model.video, behind: camera.shown ? model.behindTouch(camera.shown.age) : 0 }),
  palpMap: () => ({ map: model.map, cells: model.cells }),
  palpWay: () => model.way,
  palpTip: () => { const s = model.status!; return { x: model.tipX(s), y: model.tipY(s), tip: model.tip(s) }; },
});

render(<Page />, document.getElementById('page')!);
