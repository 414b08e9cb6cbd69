// Strips of the last seconds.
import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import { onBeat } from './beat';
import { color } from './look';
import type { Model, Trace } from './model';

const SPAN_S = 12, FRAME_MS = 100;

interface Line { label: string; ink: string; value: keyof Trace; band?: [keyof Trace, keyof Trace] }

function Strip({ title, unit, lines, model, least }: { title: string; unit: string; lines: Line[]; model: Model; least: [number, number] }) {
  const box = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const scheme = matchMedia('(prefers-color-scheme: light)');
    let plot: uPlot | undefined;
    const make = () => {
      plot?.destroy();
      const series: uPlot.Series[] = [{}], bands: uPlot.Band[] = [];
      for (const line of lines) {
        const stroke = color(line.ink);
        if (line.band) {
          series.push({ stroke: 'transparent', points: { show: false } }, { stroke: 'transparent', points: { show: false } });
          bands.push({ series: [series.length - 1, series.length - 2], fill: stroke + '48' });
        }
        series.push({ label: line.label, stroke, width: 1.75, points: { show: false } });
      }
      const axis = { stroke: color('--muted'), grid: { stroke: color('--grid'), width: 1 }, ticks: { show: false }, font: '11px system-ui' };
      plot = new uPlot({
        width: box.current!.clientWidth, height: Math.max(60, box.current!.clientHeight), series, bands,
        legend: { show: false }, cursor: { show: false }, padding: [6, 16, 0, 0],
        scales: { x: { time: false, range: [-SPAN_S, 0] }, y: { range: (_u, low, high) => [Math.min(least[0], low ?? 0), Math.max(least[1], (high ?? 0) * 1.08)] } },
        axes: [{ ...axis, size: 22, values: (_u, all) => all.map(x => x === 0 ? 'now' : `${x} s`) }, { ...axis, size: 38 }],
      }, data(model, lines), box.current!);
    };
    make();
    scheme.addEventListener('change', make);
    const watch = new ResizeObserver(() => { if (box.current) plot?.setSize({ width: box.current.clientWidth, height: Math.max(60, box.current.clientHeight) }); });
    watch.observe(box.current!);
    const end = onBeat(FRAME_MS, () => plot?.setData(data(model, lines), true));
    return () => { end(); watch.disconnect(); scheme.removeEventListener('change', make); plot?.destroy(); };
  }, [model.patient]);
  return <section class="card strip">
    <header><h2>{title}</h2><span class="unit">{unit}</span>
      <ul class="legend">{lines.map(line => <li key={line.label}><i class={line.ink.slice(2)} />{line.label}</li>)}</ul></header>
    <div ref={box} class="plot" role="img" aria-label={`${title} of the last ${SPAN_S} seconds, ${unit}`} />
  </section>;
}

function data(model: Model, lines: Line[]): uPlot.AlignedData {
  const t = model.trace, last = t.t[t.t.length - 1] ?? 0, columns: number[][] = [t.t.map(one => (one - last) / 1e3)];
  for (const line of lines) {
    if (line.band) columns.push(t[line.band[0]], t[line.band[1]]);
    columns.push(t[line.value]);
  }
  return columns as uPlot.AlignedData;
}

export function ForceStrip({ model }: { model: Model }) {
  const tissue: Line = { label: 'at the tissue', ink: '--tissue', value: 'contact', band: ['contactMin', 'contactMax'] };
  const hand: Line = { label: 'at the hand', ink: '--hand', value: 'felt' };
  return <Strip title="Force" unit="N" model={model} least={[-0.05, 1]} lines={model.patient ? [tissue] : [hand, tissue]} />;
}

export function PlaceStrip({ model }: { model: Model }) {
  return <Strip title="Depth of tip and hand" unit="mm below the surface" model={model} least={[-5, 5]} lines={[
    { label: 'hand', ink: '--hand', value: 'hand' }, { label: 'tip', ink: '--tissue', value: 'tip' }]} />;
}
