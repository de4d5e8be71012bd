/** How lanes look. */
import { inkOn } from "../colors";
import type { Segment } from "../messages";
import { nameOf } from "../segments";
import type { Store } from "../store";
import { cssColor } from "../theme";
import { ticksOf, toPixel, type Span } from "../view";
import { GUTTER, RULER, visible, type Lane } from "./lanes";

type Pen = CanvasRenderingContext2D;

const FONT = "11px system-ui, sans-serif";
const ROUND = 3;

/** A border on its way to another frame. */
export interface Drag {
  lane: string;
  frame: number;
  to: number;
}

export function drawLanes(
  pen: Pen,
  lanes: readonly Lane[],
  store: Store,
  drag: Drag | null,
  width: number,
): void {
  const range = store.range.value;
  const room = width - GUTTER;
  pen.font = FONT;
  pen.textBaseline = "middle";
  drawRuler(pen, range, room);
  const hatch = hatching(pen);
  for (const lane of lanes) {
    drawTitle(pen, lane);
    pen.save();
    pen.beginPath();
    pen.rect(GUTTER, lane.top - 2, room, lane.height + 4);
    pen.clip();
    pen.translate(GUTTER, 0);
    pen.fillStyle = cssColor("lane");
    pen.fillRect(0, lane.top, room, lane.height);
    drawSegments(pen, lane, moved(lane, drag, store.fps.value), { range, room, hatch, store });
    pen.restore();
  }
  drawLoop(pen, store.loop.value, range, room);
  drawInAndOut(pen, store, range, room);
}

interface Scene {
  range: Span;
  room: number;
  hatch: CanvasPattern | string;
  store: Store;
}

function drawSegments(pen: Pen, lane: Lane, segments: readonly Segment[], scene: Scene): void {
  const { range, room, hatch, store } = scene;
  const [from, to] = visible(segments, range.start_s, range.stop_s);
  const hovered = store.hovered.value;
  const edge = cssColor("edge");
  const rows = store.recording.value?.segmentation;
  const checked = new Set(
    lane.level ? rows?.checked.map((row) => rows.segments[row]!) : [], // none while it is dragged
  );
  let drawn = -Infinity; // right end of what has been drawn
  for (let i = from; i < to; i++) {
    const segment = segments[i]!;
    const left = toPixel(range, room, segment.start_s);
    const right = toPixel(range, room, segment.stop_s);
    if (right - drawn < 0.5) continue; // as fine as the screen
    drawn = right;
    const color = store.colorOf(segment);
    pen.fillStyle = color ?? hatch;
    const wide = right - left > 3;
    box(
      pen,
      left + (wide ? 0.75 : 0),
      lane.top,
      Math.max(right - left - (wide ? 1.5 : 0), 1),
      lane.height,
    );
    pen.fill();
    const pointed = hovered !== null && segment.cluster === hovered;
    if (wide || pointed) {
      pen.strokeStyle = pointed ? cssColor("accent") : edge;
      pen.lineWidth = pointed ? 2 : 0.75;
      pen.stroke();
    }
    if (color && right - left > 16) writeName(pen, lane, segment, left, right, room, inkOn(color));
    if (checked.has(segment) && right - left > 8) drawTick(pen, lane, right);
  }
  drawMarks(pen, lane, scene);
  drawTarget(pen, lane, scene);
}

/** A tick in the corner of a checked segment. */
function drawTick(pen: Pen, lane: Lane, right: number): void {
  pen.fillStyle = cssColor("panel");
  pen.strokeStyle = cssColor("text");
  pen.lineWidth = 1.5;
  const [x, y] = [right - 8, lane.top + lane.height - 6];
  pen.beginPath();
  pen.roundRect(x - 2, y - 2, 9, 7, 2);
  pen.fill();
  pen.beginPath();
  pen.moveTo(x, y + 1);
  pen.lineTo(x + 2, y + 3);
  pen.lineTo(x + 5, y - 1);
  pen.stroke();
}

/** Borders that the other result has not. */
function drawMarks(pen: Pen, lane: Lane, { range, room, store }: Scene): void {
  pen.fillStyle = cssColor("danger");
  for (const frame of lane.marks) {
    const x = toPixel(range, room, frame / store.fps.value);
    if (x < -2 || x > room + 2) continue;
    pen.fillRect(x - 1.5, lane.top - 2, 3, lane.height + 4);
  }
}

function writeName(
  pen: Pen,
  lane: Lane,
  segment: Segment,
  left: number,
  right: number,
  room: number,
  ink: string,
): void {
  const from = Math.max(left, 0) + 5;
  const space = Math.min(right, room) - from - 4;
  const text = segment.label || (segment.cluster >= 0 ? String(segment.cluster) : nameOf(segment));
  const shown = shortened(pen, text, space);
  if (!shown) return;
  pen.fillStyle = ink;
  pen.fillText(shown, from, lane.top + lane.height / 2 + 0.5);
}

/** As much of a text as fits, with an ellipsis; nothing if that says nothing. */
function shortened(pen: Pen, text: string, space: number): string {
  if (pen.measureText(text).width <= space) return text;
  for (let n = text.length - 1; n >= 3; n--) {
    const part = text.slice(0, n) + "…";
    if (pen.measureText(part).width <= space) return part;
  }
  return "";
}

/** What edits are for: the segment, broken where it was not chosen, and the border nearest by. */
function drawTarget(pen: Pen, lane: Lane, { range, room, store }: Scene): void {
  const target = store.edits.value ? store.target.value : store.selected.value;
  if (!target || lane.level !== target.level) return;
  const left = toPixel(range, room, target.start_s);
  const right = toPixel(range, room, target.stop_s);
  pen.strokeStyle = cssColor("text");
  pen.lineWidth = 2;
  pen.setLineDash(store.selected.value ? [] : [4, 3]);
  box(pen, left, lane.top - 0.5, Math.max(right - left, 2), lane.height + 1);
  pen.stroke();
  pen.setLineDash([]);
  const border = store.edits.value && store.border.value;
  if (!border) return;
  const x = toPixel(range, room, border.start_s);
  pen.fillStyle = cssColor("text");
  for (const [tip, base] of [
    [lane.top + 5, lane.top - 2],
    [lane.top + lane.height - 5, lane.top + lane.height + 2],
  ] as const) {
    pen.beginPath();
    pen.moveTo(x, tip);
    pen.lineTo(x - 4, base);
    pen.lineTo(x + 4, base);
    pen.fill();
  }
}

function drawRuler(pen: Pen, range: Span, room: number): void {
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

function drawLoop(pen: Pen, loop: Span | null, range: Span, room: number): void {
  if (!loop) return;
  const left = Math.max(toPixel(range, room, loop.start_s), 0);
  const right = Math.min(toPixel(range, room, loop.stop_s), room);
  if (right <= left) return;
  pen.fillStyle = cssColor("accent");
  pen.fillRect(GUTTER + left, RULER - 4, right - left, 3);
}

/** The marks, as brackets on the ruler. */
function drawInAndOut(pen: Pen, store: Store, range: Span, room: number): void {
  pen.fillStyle = cssColor("accent");
  const { start_s, stop_s } = store.marks.value;
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

function drawTitle(pen: Pen, lane: Lane): void {
  pen.fillStyle = cssColor("quiet");
  const title = shortened(pen, lane.title, GUTTER - 14);
  pen.fillText(title, 10, lane.top + lane.height / 2 + 0.5);
}

function box(pen: Pen, x: number, y: number, width: number, height: number): void {
  pen.beginPath();
  if (width < 2 * ROUND) pen.rect(x, y, width, height);
  else pen.roundRect(x, y, width, height, ROUND);
}

/** Grey stripes: what belongs to no cluster. */
function hatching(pen: Pen): CanvasPattern | string {
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

/** The lane's segments with the dragged border where the pointer is. */
function moved(lane: Lane, drag: Drag | null, fps: number): readonly Segment[] {
  if (drag?.lane !== lane.id) return lane.segments;
  const { frame, to } = drag;
  return lane.segments.map((segment) => {
    if (segment.start_frame === frame) return { ...segment, start_frame: to, start_s: to / fps };
    if (segment.stop_frame === frame) return { ...segment, stop_frame: to, stop_s: to / fps };
    return segment;
  });
}
