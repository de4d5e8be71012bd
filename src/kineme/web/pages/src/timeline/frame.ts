/** What is around the segments of lanes: ruler, marks, titles, and the stripes of no cluster. */
import type { Store } from "../store";
import { cssColor } from "../theme";
import { ticksOf, toPixel, type Span } from "../view";
import { GUTTER, RULER, type Lane } from "./lanes";

type Pen = CanvasRenderingContext2D;

export const FONT = "11px system-ui, sans-serif";

export function drawRuler(pen: Pen, range: Span, room: number): void {
  pen.fillStyle = cssColor("quiet");
  pen.strokeStyle = cssColor("line");
  pen.lineWidth = 1;
  for (const { seconds, label } of ticksOf(range, room)) {
    const x = Math.round(GUTTER + toPixel(range, room, seconds)) + 0.5;
    if (x > GUTTER + room - 1) continue;
    pen.beginPath();
    pen.moveTo(x, RULER - 6);
    pen.lineTo(x, RULER - 1);
    pen.stroke();
    if (x < GUTTER + room - 34) pen.fillText(label, x + 4, RULER / 2 - 1);
  }
}

export function drawLoop(pen: Pen, loop: Span | null, range: Span, room: number): void {
  if (!loop) return;
  const left = Math.max(toPixel(range, room, loop.start_s), 0);
  const right = Math.min(toPixel(range, room, loop.stop_s), room);
  if (right <= left) return;
  pen.fillStyle = cssColor("accent");
  pen.fillRect(GUTTER + left, RULER - 4, right - left, 3);
}

/** The marks, as brackets on the ruler. */
export function drawInAndOut(pen: Pen, store: Store, range: Span, room: number): void {
  pen.fillStyle = cssColor("accent");
  const { start_s, stop_s } = store.bounds.value;
  for (const [seconds, toward] of [
    [start_s, 1],
    [stop_s, -1],
  ] as const) {
    if (seconds === null) continue;
    const x = toPixel(range, room, seconds);
    if (x < 0 || x > room) continue;
    pen.fillRect(GUTTER + x - 1, 2, 2, RULER - 4);
    pen.fillRect(GUTTER + (toward > 0 ? x : x - 6), 2, 6, 2);
    pen.fillRect(GUTTER + (toward > 0 ? x : x - 6), RULER - 4, 6, 2);
  }
}

export function drawTitle(pen: Pen, lane: Lane): void {
  pen.font = lane.front ? `bold ${FONT}` : FONT;
  pen.fillStyle = cssColor(lane.front ? "text" : "quiet");
  const title = shortened(pen, lane.title, GUTTER - 14);
  pen.fillText(title, 10, lane.top + lane.height / 2 + 0.5);
  pen.font = FONT;
}

/** As much of a text as fits, with an ellipsis; nothing if that says nothing. */
export function shortened(pen: Pen, text: string, space: number): string {
  if (pen.measureText(text).width <= space) return text;
  for (let n = text.length - 1; n >= 3; n--) {
    const part = text.slice(0, n) + "…";
    if (pen.measureText(part).width <= space) return part;
  }
  return "";
}

/** Grey stripes: what belongs to no cluster. */
export function hatching(pen: Pen): CanvasPattern | string {
  const tile = document.createElement("canvas");
  tile.width = tile.height = 6;
  const brush = tile.getContext("2d")!;
  brush.strokeStyle = cssColor("hatch");
  brush.lineWidth = 1.2;
  for (const shift of [-6, 0, 6]) {
    brush.moveTo(shift, 6);
    brush.lineTo(shift + 6, 0);
  }
  brush.stroke();
  return pen.createPattern(tile, "repeat") ?? cssColor("hatch");
}
