/** Draw the ruler, marks, titles and hatching of lanes. */
import type { Store } from "../store";
import { readColor } from "../theme";
import { computeTicks, toPixel, type Span } from "../view";
import { GUTTER_WIDTH, RULER_HEIGHT, type Lane } from "./lanes";

type Pen = CanvasRenderingContext2D;

export const FONT = "11px system-ui, sans-serif";

export function drawRuler(pen: Pen, range: Span, plotWidth: number): void {
  pen.fillStyle = readColor("quiet");
  pen.strokeStyle = readColor("line");
  pen.lineWidth = 1;
  for (const { seconds, label } of computeTicks(range, plotWidth)) {
    const x = Math.round(GUTTER_WIDTH + toPixel(range, plotWidth, seconds)) + 0.5;
    if (x > GUTTER_WIDTH + plotWidth - 1) continue;
    pen.beginPath();
    pen.moveTo(x, RULER_HEIGHT - 6);
    pen.lineTo(x, RULER_HEIGHT - 1);
    pen.stroke();
    if (x < GUTTER_WIDTH + plotWidth - 34) pen.fillText(label, x + 4, RULER_HEIGHT / 2 - 1);
  }
}

export function drawLoop(pen: Pen, loop: Span | null, range: Span, plotWidth: number): void {
  if (!loop) return;
  const left = Math.max(toPixel(range, plotWidth, loop.start_s), 0);
  const right = Math.min(toPixel(range, plotWidth, loop.stop_s), plotWidth);
  if (right <= left) return;
  pen.fillStyle = readColor("accent");
  pen.fillRect(GUTTER_WIDTH + left, RULER_HEIGHT - 4, right - left, 3);
}

/** Draw the marks as brackets on the ruler. */
export function drawMarks(pen: Pen, store: Store, range: Span, plotWidth: number): void {
  pen.fillStyle = readColor("accent");
  const { start_s, stop_s } = store.bounds.value;
  for (const [seconds, toward] of [
    [start_s, 1],
    [stop_s, -1],
  ] as const) {
    if (seconds === null) continue;
    const x = toPixel(range, plotWidth, seconds);
    if (x < 0 || x > plotWidth) continue;
    pen.fillRect(GUTTER_WIDTH + x - 1, 2, 2, RULER_HEIGHT - 4);
    pen.fillRect(GUTTER_WIDTH + (toward > 0 ? x : x - 6), 2, 6, 2);
    pen.fillRect(GUTTER_WIDTH + (toward > 0 ? x : x - 6), RULER_HEIGHT - 4, 6, 2);
  }
}

export function drawTitle(pen: Pen, lane: Lane): void {
  pen.font = lane.isActive ? `bold ${FONT}` : FONT;
  pen.fillStyle = readColor(lane.isActive ? "text" : "quiet");
  const title = shortenText(pen, lane.title, GUTTER_WIDTH - 14);
  pen.fillText(title, 10, lane.top + lane.height / 2 + 0.5);
  pen.font = FONT;
}

/** Return as much of a text as fits, with an ellipsis; empty if too little fits. */
export function shortenText(pen: Pen, text: string, space: number): string {
  if (pen.measureText(text).width <= space) return text;
  for (let n = text.length - 1; n >= 3; n--) {
    const part = text.slice(0, n) + "…";
    if (pen.measureText(part).width <= space) return part;
  }
  return "";
}

/** Return grey stripes, which mark segments without cluster. */
export function createHatch(pen: Pen): CanvasPattern | string {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 6;
  const brush = tile.getContext("2d")!;
  brush.strokeStyle = readColor("hatch");
  brush.lineWidth = 1.2;
  for (const shift of [-6, 0, 6]) {
    brush.moveTo(shift, 6);
    brush.lineTo(shift + 6, 0);
  }
  brush.stroke();
  return pen.createPattern(tile, "repeat") ?? readColor("hatch");
}
