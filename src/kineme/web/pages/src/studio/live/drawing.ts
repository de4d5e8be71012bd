/** Draw the timeline, curves and body of a live recording. */
import { adaptColor, getClusterColor, getTextColor } from "../../colors";
import {
  createHatch,
  drawInside,
  FONT,
  type Pen,
  readColor,
  shortenText,
  strokeLine,
  theme,
} from "../../drawing";
import { GUTTER_WIDTH, RULER_HEIGHT } from "../../panels/lanes";
import { drawRuler } from "../../panels/timelineDrawing";
import { toPixel } from "../../view";
import { drawPoses, type Flat } from "../library/Figure";
import { CURVES_S, getPartName, listPartsToDraw, TIMELINE_S, type Live } from "./live";

const GAP = 6;
const PALE = 0.45;
const LANES = [
  ["Activities", "activities"],
  ["Repetitions", "repetitions"],
] as const;

export function drawTimeline(pen: Pen, live: Live, width: number, height: number): void {
  const stop_s = Math.max(live.now_s, TIMELINE_S);
  const range = { start_s: stop_s - TIMELINE_S, stop_s };
  const plotWidth = width - GUTTER_WIDTH;
  const x = (seconds: number): number => GUTTER_WIDTH + toPixel(range, plotWidth, seconds);
  pen.font = FONT;
  pen.textBaseline = "middle";
  drawRuler(pen, range, plotWidth);
  const tall = (height - RULER_HEIGHT) / LANES.length - GAP;
  LANES.forEach(([title, level], row) => {
    const top = RULER_HEIGHT + row * (tall + GAP);
    pen.fillStyle = readColor("quiet");
    pen.fillText(title, 10, top + tall / 2);
    drawInside(pen, [GUTTER_WIDTH, top, plotWidth, tall], () => {
      pen.fillStyle = readColor("lane");
      pen.fillRect(GUTTER_WIDTH, top, plotWidth, tall);
      for (const part of listPartsToDraw(live, level)) {
        const [left, right] = [x(part.start_s), x(part.stop_s)];
        const color = getClusterColor(part.cluster);
        pen.globalAlpha = part.isFinal ? 1 : PALE;
        pen.fillStyle = color;
        pen.fillRect(left, top, Math.max(right - left - 1, 1), tall);
        pen.globalAlpha = 1;
        if (level === "repetitions") continue;
        pen.fillStyle = part.isFinal ? getTextColor(color) : readColor("text");
        const from = Math.max(left, GUTTER_WIDTH) + 5;
        pen.fillText(shortenText(pen, getPartName(part), right - from - 4), from, top + tall / 2);
      }
      pen.fillStyle = createHatch(pen);
      for (const { start_s, stop_s } of live.gaps)
        pen.fillRect(x(start_s), top, x(stop_s ?? live.now_s) - x(start_s), tall);
    });
  });
}

/** Draw one lane per channel, scaled from its minimum to its maximum. */
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
    pen.fillStyle = readColor("quiet");
    pen.fillText(shortenText(pen, name, GUTTER_WIDTH - 14), 10, (channel + 0.5) * tall);
    pen.strokeStyle = readColor("accent");
    let last_s = -Infinity;
    const points = live.samples.flatMap(({ seconds, values }): ([number, number] | null)[] => {
      const value = values[channel];
      if (value === null || value === undefined) return [];
      const x = GUTTER_WIDTH + toPixel(range, width - GUTTER_WIDTH, seconds);
      const y = bottom - (high > low ? (value - low) / (high - low) : 0.5) * 0.8 * tall;
      const isAfterGap = seconds - last_s > 1.5 / sample_fps;
      last_s = seconds;
      return isAfterGap ? [null, [x, y]] : [[x, y]];
    });
    strokeLine(pen, points);
  });
}

/** Draw the last pose in the colour of the current activity. */
export function drawBody(pen: Pen, { head: { bones }, pose, current }: Live): void {
  const up = pose.filter((value, i) => i % 2 && value !== null) as number[];
  const low = Math.min(...up);
  // A square box keeps the figure's size constant while it moves.
  const half = Math.max(Math.max(...up) - low, 1) / 2;
  const box: Pick<Flat, "low" | "high"> = { low: [-half, low], high: [half, low + 2 * half] };
  const joints = Float32Array.from(pose, (value) => value ?? NaN);
  const color = current
    ? adaptColor(getClusterColor(current.cluster), theme.value)
    : readColor("body");
  drawPoses(pen, { bones, fps: 1, poses: [joints], ...box }, [0], color);
}
