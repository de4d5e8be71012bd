/** Draw the timeline's lanes. */
import { getTextColor } from "../colors";
import { createHatch, drawInside, FONT, type Pen, readColor, shortenText } from "../drawing";
import type { Segment } from "../messages";
import { getSegmentName } from "../segments";
import type { Drag, Store } from "../store";
import { computeTicks, toPixel, type Span } from "../view";
import { forEachVisible, GUTTER_WIDTH, RULER_HEIGHT, type Lane } from "./lanes";

const ROUND = 3;

export function drawLanes(pen: Pen, lanes: readonly Lane[], store: Store, width: number): void {
  const range = store.range.value;
  const plotWidth = width - GUTTER_WIDTH;
  pen.font = FONT;
  pen.textBaseline = "middle";
  drawRuler(pen, range, plotWidth);
  const scene = { range, plotWidth, hatch: createHatch(pen), store };
  for (const lane of lanes) {
    drawTitle(pen, lane);
    drawInside(pen, [GUTTER_WIDTH, lane.top - 2, plotWidth, lane.height + 4], () => {
      pen.translate(GUTTER_WIDTH, 0);
      pen.fillStyle = readColor("lane");
      pen.fillRect(0, lane.top, plotWidth, lane.height);
      drawSegments(pen, lane, scene);
      drawDifferences(pen, lane, scene);
      drawTarget(pen, lane, scene);
    });
  }
  drawLoop(pen, store.loop.value, range, plotWidth);
  drawMarks(pen, store, range, plotWidth);
}

/** Draw the axis of time above lanes or curves, right of the gutter. */
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

/** Draw the whole recording, with the invisible part paler. */
export function drawOverview(pen: Pen, width: number, height: number, store: Store): void {
  const recording = { start_s: 0, stop_s: store.duration.value };
  pen.fillStyle = readColor("lane");
  pen.fillRect(0, 0, width, height);
  for (const segment of store.activities.value) {
    const left = toPixel(recording, width, segment.start_s);
    const right = toPixel(recording, width, segment.stop_s);
    pen.fillStyle = store.getColor(segment) ?? "transparent";
    pen.fillRect(left, 2, Math.max(right - left, 0.5), height - 4);
  }
  const { start_s, stop_s } = store.range.value;
  const left = toPixel(recording, width, start_s);
  const right = toPixel(recording, width, stop_s);
  pen.globalAlpha = 0.6;
  pen.fillStyle = readColor("page");
  pen.fillRect(0, 0, left, height);
  pen.fillRect(right, 0, width - right, height);
  pen.globalAlpha = 1;
  pen.strokeStyle = readColor("quiet");
  pen.strokeRect(left + 0.5, 0.5, Math.max(right - left - 1, 2), height - 1);
}

interface Scene {
  range: Span;
  plotWidth: number;
  hatch: CanvasPattern | string;
  store: Store;
}

function drawSegments(pen: Pen, lane: Lane, { range, plotWidth, hatch, store }: Scene): void {
  const segments = applyDrag(lane, store.drag.value, store.fps.value);
  const hovered = store.hovered.value;
  forEachVisible(segments, range, plotWidth, (segment, left, right) => {
    const color = store.getColor(segment);
    const wide = right - left > 3;
    const inset = wide ? 0.75 : 0;
    pen.fillStyle = color ?? hatch;
    traceBox(pen, left + inset, lane.top, Math.max(right - left - 2 * inset, 1), lane.height);
    pen.fill();
    const pointed = hovered !== null && lane.person === null && segment.cluster === hovered;
    if (wide || pointed) {
      pen.strokeStyle = readColor(pointed ? "accent" : "edge");
      pen.lineWidth = pointed ? 2 : 0.75;
      pen.stroke();
    }
    if (color && right - left > 16) {
      pen.fillStyle = getTextColor(color);
      writeName(pen, lane, segment, Math.max(left, 0), Math.min(right, plotWidth));
    }
    if (lane.level && segment.checked && right - left > 8) drawTick(pen, lane, right);
    if (lane.level && segment.excluded) drawStrike(pen, lane, left, right);
  });
}

/** Draw a tick in the corner of a checked segment. */
function drawTick(pen: Pen, lane: Lane, right: number): void {
  pen.fillStyle = readColor("panel");
  pen.strokeStyle = readColor("text");
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

/** Strike through a repetition excluded from means. */
function drawStrike(pen: Pen, lane: Lane, left: number, right: number): void {
  pen.strokeStyle = readColor("panel");
  pen.lineWidth = 2;
  pen.beginPath();
  pen.moveTo(left + 1, lane.top + lane.height);
  pen.lineTo(right - 1, lane.top);
  pen.stroke();
}

/** Mark borders that the other result lacks. */
function drawDifferences(pen: Pen, lane: Lane, { range, plotWidth, store }: Scene): void {
  pen.fillStyle = readColor("danger");
  for (const frame of lane.differences) {
    const x = toPixel(range, plotWidth, frame / store.fps.value);
    if (x < -2 || x > plotWidth + 2) continue;
    pen.fillRect(x - 1.5, lane.top - 2, 3, lane.height + 4);
  }
}

function writeName(pen: Pen, lane: Lane, segment: Segment, left: number, right: number): void {
  const { label, cluster } = segment;
  const text = label || (cluster >= 0 ? String(cluster) : getSegmentName(segment));
  const shown = shortenText(pen, text, right - left - 9);
  if (shown) pen.fillText(shown, left + 5, lane.top + lane.height / 2 + 0.5);
}

/** Outline the segment that edits apply to (dashed if not selected) and mark the nearest border. */
function drawTarget(pen: Pen, lane: Lane, { range, plotWidth, store }: Scene): void {
  const target = store.edit.value ? store.target.value : store.selected.value;
  if (!target || lane.level !== target.level) return;
  const left = toPixel(range, plotWidth, target.start_s);
  const right = toPixel(range, plotWidth, target.stop_s);
  pen.strokeStyle = readColor("text");
  pen.lineWidth = 2;
  pen.setLineDash(store.selected.value ? [] : [4, 3]);
  traceBox(pen, left, lane.top - 0.5, Math.max(right - left, 2), lane.height + 1);
  pen.stroke();
  pen.setLineDash([]);
  const border = store.edit.value && store.border.value;
  if (!border) return;
  const x = toPixel(range, plotWidth, border.start_s);
  pen.fillStyle = readColor("text");
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

function traceBox(pen: Pen, x: number, y: number, width: number, height: number): void {
  pen.beginPath();
  if (width < 2 * ROUND) pen.rect(x, y, width, height);
  else pen.roundRect(x, y, width, height, ROUND);
}

/** Return the lane's segments with the dragged border at the pointer. */
function applyDrag(lane: Lane, drag: Drag | null, fps: number): readonly Segment[] {
  if (drag?.lane !== lane.id) return lane.segments;
  const { frame, to } = drag;
  return lane.segments.map((segment) => {
    const present = { ...segment, checked: false }; // the check was for other frames
    if (segment.start_frame === frame) return { ...present, start_frame: to, start_s: to / fps };
    if (segment.stop_frame === frame) return { ...present, stop_frame: to, stop_s: to / fps };
    return segment;
  });
}

function drawLoop(pen: Pen, loop: Span | null, range: Span, plotWidth: number): void {
  if (!loop) return;
  const left = Math.max(toPixel(range, plotWidth, loop.start_s), 0);
  const right = Math.min(toPixel(range, plotWidth, loop.stop_s), plotWidth);
  if (right <= left) return;
  pen.fillStyle = readColor("accent");
  pen.fillRect(GUTTER_WIDTH + left, RULER_HEIGHT - 4, right - left, 3);
}

/** Draw the marks as brackets on the ruler. */
function drawMarks(pen: Pen, store: Store, range: Span, plotWidth: number): void {
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

function drawTitle(pen: Pen, lane: Lane): void {
  pen.font = lane.isActive ? `bold ${FONT}` : FONT;
  pen.fillStyle = readColor(lane.isActive ? "text" : "quiet");
  const title = shortenText(pen, lane.title, GUTTER_WIDTH - 14);
  pen.fillText(title, 10, lane.top + lane.height / 2 + 0.5);
  pen.font = FONT;
}
