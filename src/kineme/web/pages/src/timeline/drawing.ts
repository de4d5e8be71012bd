/** How lanes look. */
import { inkOn } from "../colors";
import type { Segment } from "../messages";
import { nameOf } from "../segments";
import type { Drag } from "../state";
import type { Store } from "../store";
import { cssColor } from "../theme";
import { toPixel, type Span } from "../view";
import { drawInAndOut, drawLoop, drawRuler, drawTitle, FONT, hatching, shortened } from "./frame";
import { GUTTER, visible, type Lane } from "./lanes";

type Pen = CanvasRenderingContext2D;

const ROUND = 3;

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
    const pointed = hovered !== null && lane.person === null && segment.cluster === hovered;
    if (wide || pointed) {
      pen.strokeStyle = pointed ? cssColor("accent") : edge;
      pen.lineWidth = pointed ? 2 : 0.75;
      pen.stroke();
    }
    if (color && right - left > 16) writeName(pen, lane, segment, left, right, room, inkOn(color));
    if (lane.level && segment.checked && right - left > 8) drawTick(pen, lane, right);
    if (lane.level && segment.excluded) drawStrike(pen, lane, left, right);
  }
  drawDifferences(pen, lane, scene);
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

/** Through a repetition that people left out of means. */
function drawStrike(pen: Pen, lane: Lane, left: number, right: number): void {
  pen.strokeStyle = cssColor("panel");
  pen.lineWidth = 2;
  pen.beginPath();
  pen.moveTo(left + 1, lane.top + lane.height);
  pen.lineTo(right - 1, lane.top);
  pen.stroke();
}

/** Borders that the other result has not. */
function drawDifferences(pen: Pen, lane: Lane, { range, room, store }: Scene): void {
  pen.fillStyle = cssColor("danger");
  for (const frame of lane.differences) {
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

/** What edits are for: the segment, broken where it was not chosen, and the border nearest by. */
function drawTarget(pen: Pen, lane: Lane, { range, room, store }: Scene): void {
  const target = store.edit.value ? store.target.value : store.selected.value;
  if (!target || lane.level !== target.level) return;
  const left = toPixel(range, room, target.start_s);
  const right = toPixel(range, room, target.stop_s);
  pen.strokeStyle = cssColor("text");
  pen.lineWidth = 2;
  pen.setLineDash(store.selected.value ? [] : [4, 3]);
  box(pen, left, lane.top - 0.5, Math.max(right - left, 2), lane.height + 1);
  pen.stroke();
  pen.setLineDash([]);
  const border = store.edit.value && store.border.value;
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

function box(pen: Pen, x: number, y: number, width: number, height: number): void {
  pen.beginPath();
  if (width < 2 * ROUND) pen.rect(x, y, width, height);
  else pen.roundRect(x, y, width, height, ROUND);
}

/** The lane's segments with the dragged border where the pointer is. */
function moved(lane: Lane, drag: Drag | null, fps: number): readonly Segment[] {
  if (drag?.lane !== lane.id) return lane.segments;
  const { frame, to } = drag;
  return lane.segments.map((segment) => {
    const present = { ...segment, checked: false }; // these frames are not those that were checked
    if (segment.start_frame === frame) return { ...present, start_frame: to, start_s: to / fps };
    if (segment.stop_frame === frame) return { ...present, stop_frame: to, stop_s: to / fps };
    return segment;
  });
}
