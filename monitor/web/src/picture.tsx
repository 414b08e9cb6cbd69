import { useEffect, useRef } from 'preact/hooks';
import { lagWords, type Camera } from './camera';
import type { Model } from './model';

/** [ms] beyond the way here; an older picture is shown as old. */
const OLD_PICTURE_MS = 150;

/** Why there is no picture, or that one is waited for; empty: there is one. */
export function whyNoPicture(m: Model, camera: Camera): string {
  if (camera.fault) return camera.fault;
  const video = m.video;
  if (!video) return 'Nothing is known of a picture yet.';
  if (!video.sending) return `${video.state.charAt(0).toUpperCase()}${video.state.slice(1)}.`;
  return camera.shown ? '' : 'Waiting for the first picture.';
}

const span = (ms: number): string => ms < 1000 ? `${ms.toFixed(0)} ms` : `${(ms / 1e3).toFixed(1)} s`;

/** The camera of the patient's site, whole, with its age. */
export function Picture({ model, camera, now }: { model: Model; camera: Camera; now: number }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  useEffect(() => { camera.canvas = canvas.current ?? undefined; return () => { camera.canvas = undefined; }; }, []);
  const why = whyNoPicture(model, camera), shown = camera.shown;
  const age = shown ? model.ageOf(shown.stamp, now) : 0, old = !!shown && age > model.way + OLD_PICTURE_MS;
  const behind = model.behindTouch(shown ? shown.age : 0), words = lagWords(behind);
  return <section class={'card camera' + (shown ? '' : ' none') + (old ? ' old' : '')} id="camera">
    <header><h2>Camera</h2>
      {shown && <span class="unit"><span id="picture-age">{old ? <b class="bad">▲ Old picture, {span(age)}</b> : `${span(shown.age)} old`}</span></span>}
      {shown && !old && <span class={'unit lag ' + words.tone} title="15 ms: first noticed; 45: by half; 200: mild; 300: the most that surgeons accept">behind touch <b id="behind-touch">{span(Math.max(0, behind))}</b>: {words.text}</span>}</header>
    <div class="frame" hidden={!shown}><canvas id="picture" ref={canvas} role="img" aria-label={old ? 'Old picture of the patient site' : 'Live picture of the patient site'} /></div>
    {why && <p class="empty" id="no-picture" role="status">{why}</p>}
  </section>;
}
