/** Resize a panel by dragging or with arrow keys; a double click restores its size. */
import type { JSX, TargetedEvent } from "preact";
import { isPlayerKey } from "../focus";
import { setSize, type Size } from "./sizes";

const STEP = 16; // pixels per arrow key

interface Props {
  size: Size;
  /** Side of the panel. */
  at: "left" | "right" | "top";
}

export function Splitter({ size, at }: Props): JSX.Element {
  const isVertical = at !== "top";
  const sign = at === "right" ? 1 : -1;
  const getExtent = (edge: HTMLElement): number =>
    isVertical ? edge.parentElement!.clientWidth : edge.parentElement!.clientHeight;
  const getMaximum = (): number => 0.6 * (isVertical ? innerWidth : innerHeight);
  const onPointerDown = (event: TargetedEvent<HTMLDivElement, PointerEvent>): void => {
    const edge = event.currentTarget;
    const from = isVertical ? event.clientX : event.clientY;
    const before = getExtent(edge);
    event.preventDefault();
    edge.setPointerCapture(event.pointerId);
    edge.onpointermove = (move) =>
      setSize(
        size,
        before + sign * ((isVertical ? move.clientX : move.clientY) - from),
        getMaximum(),
      );
    edge.onpointerup = edge.onpointercancel = () => (edge.onpointermove = null);
  };
  const onKeyDown = (event: TargetedEvent<HTMLDivElement, KeyboardEvent>): void => {
    const keys = isVertical ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const by = keys.indexOf(event.key);
    if (by < 0 || isPlayerKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
    setSize(size, getExtent(event.currentTarget) + sign * (by === 0 ? -STEP : STEP), getMaximum());
  };
  return (
    <div
      class={`splitter ${at}`}
      role="separator"
      tabIndex={0}
      aria-orientation={isVertical ? "vertical" : "horizontal"}
      aria-label={`Size of ${size.title}`}
      aria-valuenow={size.pixels.value ?? 0}
      aria-valuemin={size.minimum}
      title="Drag, or arrow keys; a double click gives the usual size back"
      onPointerDown={onPointerDown}
      onKeyDown={onKeyDown}
      onDblClick={() => setSize(size, null, getMaximum())}
    />
  );
}
