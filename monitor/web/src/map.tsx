import { useEffect, useRef } from 'preact/hooks';
import { onBeat } from './beat';
import type { Model } from './model';
import { PlaneView, type Plane } from './plane';
import { mapWords } from './words';

const MOVE_MS = 67;

/** The stiffness map with the place of the next tap. */
export function MapCard({ model }: { model: Model }) {
  const box = useRef<HTMLDivElement>(null), view = useRef<PlaneView | undefined>(undefined);
  const known = model.plane, plane = known && { ...known, says: mapWords(model.map!) };
  useEffect(() => {
    return onBeat(MOVE_MS, () => {
      const s = model.status, known = s && (model.patient || s.peer_sampled);
      view.current?.move(known ? { x: model.tipX(s), y: model.tipY(s) } : undefined);
    });
  }, []);
  const shown = useRef<Plane | undefined>(undefined);
  useEffect(() => {
    // A map is drawn anew once a stroke.
    const before = shown.current;
    if (plane && before && plane.cells === before.cells && plane.says === before.says && plane.touches.length === before.touches.length) return;
    shown.current = plane;
    if (!plane) { box.current!.replaceChildren(); view.current = undefined; return; }
    view.current ??= new PlaneView(box.current!, true);
    view.current.show(plane);
  });
  return <section class="card map" id="map">
    <header><h2>Tissue from above</h2><span class="unit">× plain tissue</span></header>
    {!plane && <p class="empty">Taps at three places or more make a map here, with the place of the next tap.</p>}
    <div ref={box} class="plane-box" />
  </section>;
}
