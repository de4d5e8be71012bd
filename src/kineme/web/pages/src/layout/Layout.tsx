/** Arrange the panels of a page: a grid with movable edges, and tabs. */
import type { ComponentChildren, TargetedEvent } from "preact";
import { readStored } from "../util";
import { signal, useSignal, type Signal } from "@preact/signals";
import { isPlayerKey } from "../page";
import { Button } from "./controls";

interface LayoutProps {
  header: ComponentChildren;
  /** Left column; only the studio has one. */
  left?: ComponentChildren;
  /** Empty for a recording without a skeleton; the matrix then takes its place. */
  viewer: ComponentChildren;
  matrix: ComponentChildren;
  side: ComponentChildren;
  transport: ComponentChildren;
  timeline: ComponentChildren;
  /** Curves below the timeline, if shown. */
  curves?: ComponentChildren;
}

export function Layout(places: LayoutProps) {
  const names = ["layout"];
  if (places.left) names.push("with-left");
  if (!places.viewer) names.push("without-viewer");
  if (places.curves) names.push("with-curves");
  return (
    <div class={names.join(" ")} style={getSizeStyle()}>
      <header class="place-header">{places.header}</header>
      {places.left && (
        <aside class="place-left" aria-label="Recordings and segmentation">
          {places.left}
          <Splitter size={SIZES.left} at="right" />
        </aside>
      )}
      {places.viewer && <main class="place-viewer">{places.viewer}</main>}
      <section class="place-matrix" aria-label="Self-similarity">
        {places.matrix}
        {places.viewer && <Splitter size={SIZES.matrix} at="left" />}
      </section>
      <aside class="place-side" aria-label="Side panel">
        {places.side}
        <Splitter size={SIZES.side} at="left" />
      </aside>
      <div class="place-transport">{places.transport}</div>
      <section class="place-timeline" aria-label="Timeline">
        {places.timeline}
        <Splitter size={SIZES.timeline} at="top" />
      </section>
      {places.curves && (
        <section class="place-curves" aria-label="Curves">
          {places.curves}
          <Splitter size={SIZES.curves} at="top" />
        </section>
      )}
    </div>
  );
}

/** A panel's size in pixels; null for the default. */
interface Size {
  name: string;
  title: string;
  minimum: number;
  pixels: Signal<number | null>;
}

const STORAGE_KEY = "kineme.sizes";
const stored = (readStored(STORAGE_KEY) ?? {}) as Record<string, number | null>;

function createSize(name: string, title: string, minimum: number): Size {
  return { name, title, minimum, pixels: signal(stored[name] ?? null) };
}

const SIZES = {
  left: createSize("left", "recordings and segmentation", 150),
  matrix: createSize("matrix", "matrix", 160),
  side: createSize("side", "side panel", 220),
  timeline: createSize("timeline", "timeline", 110),
  curves: createSize("curves", "curves", 70),
};

/** Return the changed sizes as CSS variables of the layout. */
function getSizeStyle(): Record<string, string> {
  return Object.fromEntries(
    Object.values(SIZES).flatMap(({ name, pixels }) =>
      pixels.value === null ? [] : [[`--${name}`, `${pixels.value}px`]],
    ),
  );
}

/** Set a size between the minimum and `most` pixels; null restores the default. */
function setSize({ name, minimum, pixels }: Size, extent: number | null, most: number): void {
  pixels.value = extent === null ? null : Math.round(Math.min(Math.max(extent, minimum), most));
  stored[name] = pixels.value;
  localStorage.setItem(STORAGE_KEY, JSON.stringify(stored));
}

const STEP = 16; // pixels per arrow key

/**
 * Resize a panel by dragging or with arrow keys; a double click restores its size.
 *
 * @param at side of the panel
 */
function Splitter({ size, at }: { size: Size; at: "left" | "right" | "top" }) {
  const isVertical = at !== "top";
  const sign = at === "right" ? 1 : -1;
  const getExtent = (edge: HTMLElement): number =>
    isVertical ? edge.parentElement!.clientWidth : edge.parentElement!.clientHeight;
  const getPlace = (event: PointerEvent): number => (isVertical ? event.clientX : event.clientY);
  const resize = (extent: number | null): void =>
    setSize(size, extent, 0.6 * (isVertical ? innerWidth : innerHeight));
  const onPointerDown = (event: TargetedEvent<HTMLDivElement, PointerEvent>): void => {
    const edge = event.currentTarget;
    const from = getPlace(event);
    const before = getExtent(edge);
    event.preventDefault();
    edge.setPointerCapture(event.pointerId);
    edge.onpointermove = (move) => resize(before + sign * (getPlace(move) - from));
    edge.onpointerup = edge.onpointercancel = () => (edge.onpointermove = null);
  };
  const onKeyDown = (event: TargetedEvent<HTMLDivElement, KeyboardEvent>): void => {
    const keys = isVertical ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const by = keys.indexOf(event.key);
    if (by < 0 || isPlayerKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
    resize(getExtent(event.currentTarget) + sign * (by === 0 ? -STEP : STEP));
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
      onDblClick={() => resize(null)}
    />
  );
}

interface Tab {
  id: string;
  title: string;
  panel: () => ComponentChildren;
}

interface TabsProps {
  label: string;
  tabs: readonly Tab[];
  /** Id of the open tab; the first tab by default. */
  open?: Signal<string>;
}

export function Tabs({ label, tabs, open }: TabsProps) {
  const chosen = useSignal(tabs[0]?.id ?? "");
  const shown = open ?? chosen;
  const tab = tabs.find((each) => each.id === shown.value) ?? tabs[0];
  const onKeyDown = (event: KeyboardEvent): void => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!by || !tab || isPlayerKey(event)) return;
    event.preventDefault();
    event.stopPropagation();
    const next = tabs[(tabs.indexOf(tab) + by + tabs.length) % tabs.length]!;
    shown.value = next.id;
    document.getElementById(`tab-${next.id}`)?.focus();
  };
  return (
    <div class="tabs">
      <div class="tab-row" role="tablist" aria-label={label} onKeyDown={onKeyDown}>
        {tabs.map((each) => (
          <Button
            key={each.id}
            id={`tab-${each.id}`}
            role="tab"
            aria-selected={each === tab}
            aria-controls={`panel-${each.id}`}
            tabIndex={each === tab ? 0 : -1}
            onClick={(event) => {
              shown.value = each.id;
              scrollToPanel(event.currentTarget);
            }}
          >
            {each.title}
          </Button>
        ))}
      </div>
      {tab && (
        <div
          class="tab-panel"
          id={`panel-${tab.id}`}
          role="tabpanel"
          aria-labelledby={`tab-${tab.id}`}
          tabIndex={0}
        >
          {tab.panel()}
        </div>
      )}
    </div>
  );
}

/** On scrolling pages, scroll the opened panel to the top of the window. */
function scrollToPanel(tab: Element): void {
  if (document.documentElement.scrollHeight > innerHeight)
    tab.closest(".tabs")?.scrollIntoView({ block: "start" });
}
