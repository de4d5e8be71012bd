/** The edge of a panel: dragged, or moved with arrow keys; a double click gives the size back. */
import type { JSX, TargetedEvent } from "preact";
import { isForPlayer } from "../focus";
import { setSize, type Size } from "./sizes";

const STEP = 16; // pixels an arrow key moves it

interface Props {
  size: Size;
  /** The side of the panel that it is at. */
  at: "left" | "right" | "top";
}

export function Splitter({ size, at }: Props): JSX.Element {
  const upright = at !== "top";
  const sign = at === "right" ? 1 : -1;
  const extentOf = (edge: HTMLElement): number =>
    upright ? edge.parentElement!.clientWidth : edge.parentElement!.clientHeight;
  const most = (): number => 0.6 * (upright ? innerWidth : innerHeight);
  const onPointerDown = (event: TargetedEvent<HTMLDivElement, PointerEvent>): void => {
    const edge = event.currentTarget;
    const from = upright ? event.clientX : event.clientY;
    const before = extentOf(edge);
    event.preventDefault();
    edge.setPointerCapture(event.pointerId);
    edge.onpointermove = (move) =>
      setSize(size, before + sign * ((upright ? move.clientX : move.clientY) - from), most());
    edge.onpointerup = edge.onpointercancel = () => (edge.onpointermove = null);
  };
  const onKeyDown = (event: TargetedEvent<HTMLDivElement, KeyboardEvent>): void => {
    const keys = upright ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const by = keys.indexOf(event.key);
    if (by < 0 || isForPlayer(event)) return;
    event.preventDefault();
    event.stopPropagation();
    setSize(size, extentOf(event.currentTarget) + sign * (by === 0 ? -STEP : STEP), most());
  };
  return (
    <div
      class={`splitter ${at}`}
      role="separator"
      tabIndex={0}
      aria-orientation={upright ? "vertical" : "horizontal"}
      aria-label={`Size of ${size.title}`}
      aria-valuenow={size.pixels.value ?? 0}
      aria-valuemin={size.least}
      title="Drag, or arrow keys; a double click gives the usual size back"
      onPointerDown={onPointerDown}
      onKeyDown={onKeyDown}
      onDblClick={() => setSize(size, null, most())}
    />
  );
}
