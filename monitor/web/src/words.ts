// What a state means for whoever looks at it, and what to do next.
import { OLD_MS, type Model, type Status, type TissueMap } from './model';
import { ballWords } from './plane';

export interface Words { icon: string; word: string; tone: 'live' | 'idle' | 'warn' | 'bad'; text: string }

const sentence = (text: string): string => text ? text.charAt(0).toUpperCase() + text.slice(1) + '. ' : '';

export function wordsOf(m: Model, stale: boolean, finger: boolean): Words {
  const s = m.status;
  if (m.refused) return { icon: '✕', word: 'Not allowed', tone: 'bad', text: 'Open the address that the program printed: its end behind # is the key of this run.' };
  if (!s || stale) return { icon: '▲', word: 'No data', tone: 'bad', text: s ? oldText(m) : 'Waiting for the program of this site.' };
  if (m.patient) return patientWords(s.state, s.reason);
  switch (s.state) {
    case 'PARKED':
      return s.link === 'DOWN' ? { icon: '○', word: 'Parked', tone: 'idle', text: 'No session yet: waiting for the patient site.' }
        : { icon: '○', word: 'Parked', tone: 'idle', text: s.peer_state === 'STOPPED' ? 'The patient site has stopped itself. Somebody there must reset it.' : 'The stage is being made ready. Wait a moment.' };
    case 'CLUTCHED':
      return { icon: '◐', word: 'Clutched', tone: 'idle', text: clutchedText(m, finger) };
    case 'ENGAGED':
      if (s.peer_state !== 'ENGAGED') return { icon: '◑', word: 'Engaging', tone: 'live', text: 'The patient site is asked to follow.' };
      if (s.force_short) return { icon: '▲', word: 'Engaged', tone: 'warn', text: shortText(s) };
      return { icon: '●', word: 'Engaged', tone: 'live', text: m.pilots ? 'You feel the tissue. Drag down to press, up to leave it, release to let go.' : 'The surgeon feels the tissue.' };
    case 'HOLD':
      return { icon: '❚❚', word: 'Hold', tone: 'warn', text: `Nothing heard for ${s.gap_ms.toFixed(0)} ms. The stage holds its place: keep still, or let go.` };
    case 'RETRACT':
      return { icon: '↥', word: 'Retract', tone: 'warn', text: `${sentence(s.reason)}The stage leaves the tissue. Wait until it is parked.` };
    case 'STOPPED':
      return { icon: '■', word: 'Stopped', tone: 'bad', text: `${sentence(s.reason)}${m.mayControl ? 'Reset there, then here (R).' : 'It must be reset at both sites.'}` };
  }
  return { icon: '?', word: s.state, tone: 'idle', text: '' };
}

/** What all touches together say, in a sentence or two. */
export function mapWords(map: TissueMap): string {
  const doubts = map.doubts.length > 0 ? ` Not trusted: ${map.doubts.join('; ')}.` : '';
  const next = map.next ? ` Next tap: ${map.next.x.toFixed(0)}, ${map.next.y.toFixed(0)} mm.`.replaceAll('-', '\u2212') : ' Enough taps.';
  return `${map.ball ? ballWords(map.ball) : `No inclusion found at ${map.places} places`}.${doubts}${next}`;
}

/** Why the hand feels less than the tissue, and by how much where somebody can say. */
function shortText(s: Status): string {
  const by = s.force_short_n > 0 ? ` (${s.force_short_n.toFixed(2)} N)` : '';
  return sentence(`${s.force_short}${by}`).trim();
}

function oldText(m: Model): string {
  return m.roundTrip > OLD_MS / 2 ? `What you see is old: the way to this page and back takes ${(m.roundTrip / 1e3).toFixed(1)} s.`
    : 'The program of this site does not answer. What you see is old.';
}

function clutchedText(m: Model, finger: boolean): string {
  const s = m.status!;
  const why = sentence(s.refused);
  if (!m.hasPointer) return `${why}No force. The pedal engages.`;
  if (!m.pilots) return s.pilot === 0 ? 'No force. Take the pointer to palpate.' : `No force. Client ${s.pilot}${s.pilot_name ? ` (${s.pilot_name})` : ''} has the pointer.`;
  if (s.pilot_obstacle) return `No force: ${s.pilot_obstacle}.`;
  if (s.peer_state !== 'CLUTCHED') return 'No force. The patient site is not ready yet: wait a moment.';
  if (s.peer_force_n > 0.1 && s.peer_position_mm > 0) return `${why}The tip still stands in the tissue: press once and it leaves, then press again.`;
  return finger ? `${why}Let go, and press again.` : `${why}No force. Press and hold in the section to engage.`;
}

function patientWords(state: string, reason: string): Words {
  switch (state) {
    case 'PARKED': return { icon: '○', word: 'Parked', tone: 'idle', text: 'The stage stands clear of the tissue. A surgeon may call.' };
    case 'CLUTCHED': return { icon: '◐', word: 'Clutched', tone: 'idle', text: 'The stage holds its place.' };
    case 'ENGAGED': return { icon: '●', word: 'Engaged', tone: 'live', text: 'The stage follows the surgeon. Keep hands away.' };
    case 'HOLD': return { icon: '❚❚', word: 'Hold', tone: 'warn', text: 'Nothing is heard of the surgeon. The stage holds its place.' };
    case 'RETRACT': return { icon: '↥', word: 'Retract', tone: 'warn', text: `${sentence(reason)}The stage leaves the tissue. Keep hands away.` };
    case 'STOPPED': return { icon: '■', word: 'Stopped', tone: 'bad', text: `${sentence(reason)}Reset at this site's terminal (r).` };
  }
  return { icon: '?', word: state, tone: 'idle', text: '' };
}
