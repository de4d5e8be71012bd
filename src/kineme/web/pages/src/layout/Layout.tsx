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
          <Splitter name="left" title="recordings and segmentation" minimum={150} at="right" />
        </aside>
      )}
      {places.viewer && <main class="place-viewer">{places.viewer}</main>}
      <section class="place-matrix" aria-label="Self-similarity">
        {places.matrix}
        {places.viewer && <Splitter name="matrix" title="matrix" minimum={160} at="left" />}
      </section>
      <aside class="place-side" aria-label="Side panel">
        {places.side}
        <Splitter name="side" title="side panel" minimum={220} at="left" />
      </aside>
      <div class="place-transport">{places.transport}</div>
      <section class="place-timeline" aria-label="Timeline">
        {places.timeline}
        <Splitter name="timeline" title="timeline" minimum={110} at="top" />
      </section>
      {places.curves && (
        <section class="place-curves" aria-label="Curves">
          {places.curves}
          <Splitter name="curves" title="curves" minimum={70} at="top" />
        </section>
      )}
    </div>
  );
}

const STORAGE_KEY = "kineme.sizes";
/** Sizes of panels in pixels; null for the default. */
const sizes = signal((readStored(STORAGE_KEY) ?? {}) as Record<string, number | null>);

/** Return the changed sizes as CSS variables of the layout. */
function getSizeStyle(): Record<string, string> {
  const changed = Object.entries(sizes.value).filter(([, pixels]) => pixels !== null);
  return Object.fromEntries(changed.map(([name, pixels]) => [`--${name}`, `${pixels}px`]));
}

const STEP = 16; // pixels per arrow key

/**
 * Resize a panel by dragging or with arrow keys; a double click restores its size.
 *
 * @param at side of the panel
 */
function Splitter(props: {
  name: string;
  title: string;
  minimum: number;
  at: "left" | "right" | "top";
}) {
  const { name, title, minimum, at } = props;
  const isVertical = at !== "top";
  const sign = at === "right" ? 1 : -1;
  const getExtent = (edge: HTMLElement): number =>
    isVertical ? edge.parentElement!.clientWidth : edge.parentElement!.clientHeight;
  const getPlace = (event: PointerEvent): number => (isVertical ? event.clientX : event.clientY);
  const resize = (extent: number | null): void => {
    const most = 0.6 * (isVertical ? innerWidth : innerHeight);
    const pixels = extent === null ? null : Math.round(Math.min(Math.max(extent, minimum), most));
    sizes.value = { ...sizes.value, [name]: pixels };
    localStorage.setItem(STORAGE_KEY, JSON.stringify(sizes.value));
  };
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
      aria-label={`Size of ${title}`}
      aria-valuenow={sizes.value[name] ?? 0}
      aria-valuemin={minimum}
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
