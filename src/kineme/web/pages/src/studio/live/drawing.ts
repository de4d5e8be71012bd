/** How the timeline and the curves of a stream look. */
import { clusterColor, inkOn, onPage } from "../../colors";
import { cssColor, theme } from "../../theme";
import { drawRuler, FONT, hatching, shortened } from "../../timeline/frame";
import { GUTTER, RULER } from "../../timeline/lanes";
import { toPixel } from "../../view";
import { drawPoses } from "../library/drawing";
import type { Flat } from "../library/flat";
import { CURVES_S, nameOf, partsToDraw, TIMELINE_S, type Live } from "./live";

type Pen = CanvasRenderingContext2D;

const GAP = 6;
const PALE = 0.45;
const LANES = [
  ["Activities", "activities"],
  ["Repetitions", "repetitions"],
] as const;

export function drawTimeline(pen: Pen, live: Live, width: number, height: number): void {
  const stop_s = Math.max(live.now_s, TIMELINE_S);
  const range = { start_s: stop_s - TIMELINE_S, stop_s };
  const room = width - GUTTER;
  const x = (seconds: number): number => GUTTER + toPixel(range, room, seconds);
  pen.font = FONT;
  pen.textBaseline = "middle";
  drawRuler(pen, range, room);
  const tall = (height - RULER) / LANES.length - GAP;
  LANES.forEach(([title, level], row) => {
    const top = RULER + row * (tall + GAP);
    pen.fillStyle = cssColor("quiet");
    pen.fillText(title, 10, top + tall / 2);
    pen.save();
    pen.beginPath();
    pen.rect(GUTTER, top, room, tall);
    pen.clip();
    pen.fillStyle = cssColor("lane");
    pen.fillRect(GUTTER, top, room, tall);
    for (const part of partsToDraw(live, level)) {
      const [left, right] = [x(part.start_s), x(part.stop_s)];
      const color = clusterColor(part.cluster);
      pen.globalAlpha = part.isFinal ? 1 : PALE;
      pen.fillStyle = color;
      pen.fillRect(left, top, Math.max(right - left - 1, 1), tall);
      pen.globalAlpha = 1;
      if (level === "repetitions") continue;
      pen.fillStyle = part.isFinal ? inkOn(color) : cssColor("text");
      const from = Math.max(left, GUTTER) + 5;
      pen.fillText(shortened(pen, nameOf(part), right - from - 4), from, top + tall / 2);
    }
    pen.fillStyle = hatching(pen);
    for (const { start_s, stop_s } of live.gaps)
      pen.fillRect(x(start_s), top, x(stop_s ?? live.now_s) - x(start_s), tall);
    pen.restore();
  });
}

/** One lane for each channel, from its least to its greatest value. */
export function drawChannels(pen: Pen, live: Live, width: number, height: number): void {
  const { channels, sample_fps } = live.head;
  const range = { start_s: live.now_s - CURVES_S, stop_s: live.now_s };
  const tall = height / channels.length;
  pen.font = FONT;
  pen.textBaseline = "middle";
  pen.lineWidth = 1.2;
  channels.forEach((name, channel) => {
    const seen = live.samples.flatMap(({ values }) => values[channel] ?? []);
    const [low, high] = [Math.min(...seen), Math.max(...seen)];
    const bottom = (channel + 0.9) * tall;
    pen.fillStyle = cssColor("quiet");
    pen.fillText(shortened(pen, name, GUTTER - 14), 10, (channel + 0.5) * tall);
    pen.strokeStyle = cssColor("accent");
    pen.beginPath();
    let last_s = -Infinity;
    for (const { seconds, values } of live.samples) {
      const value = values[channel];
      if (value === null || value === undefined) continue;
      const x = GUTTER + toPixel(range, width - GUTTER, seconds);
      const y = bottom - (high > low ? (value - low) / (high - low) : 0.5) * 0.8 * tall;
      // broken where samples are missing
      if (seconds - last_s > 1.5 / sample_fps) pen.moveTo(x, y);
      else pen.lineTo(x, y);
      last_s = seconds;
    }
    pen.stroke();
  });
}

/** The body as it was seen last, in the colour of what goes on. */
export function drawBody(pen: Pen, { head: { bones }, pose, current }: Live): void {
  const up = pose.filter((value, i) => i % 2 && value !== null) as number[];
  const low = Math.min(...up);
  // as wide as it is high, so that it keeps its size while it moves
  const half = Math.max(Math.max(...up) - low, 1) / 2;
  const box: Pick<Flat, "low" | "high"> = { low: [-half, low], high: [half, low + 2 * half] };
  const joints = Float32Array.from(pose, (value) => value ?? NaN);
  const color = current ? onPage(clusterColor(current.cluster), theme.value) : cssColor("body");
  pen.lineCap = "round";
  drawPoses(pen, { bones, fps: 1, poses: [joints], ...box }, [0], color);
}
