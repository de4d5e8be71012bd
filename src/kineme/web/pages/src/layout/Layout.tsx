/** The places of a page: header, viewer, matrix, side panel, transport bar, timeline. */
import type { ComponentChildren, JSX } from "preact";

interface Places {
  header: ComponentChildren;
  /** A column on the left, used by the studio. */
  left?: ComponentChildren;
  /** Nothing for a recording without a skeleton: the matrix then takes its place. */
  viewer: ComponentChildren;
  matrix: ComponentChildren;
  side: ComponentChildren;
  transport: ComponentChildren;
  timeline: ComponentChildren;
}

export function Layout(places: Places): JSX.Element {
  const names = ["layout"];
  if (places.left) names.push("with-left");
  if (!places.viewer) names.push("without-viewer");
  return (
    <div class={names.join(" ")}>
      <header class="place-header">{places.header}</header>
      {places.left && <aside class="place-left">{places.left}</aside>}
      {places.viewer && <main class="place-viewer">{places.viewer}</main>}
      <section class="place-matrix" aria-label="Self-similarity">
        {places.matrix}
      </section>
      <aside class="place-side">{places.side}</aside>
      <div class="place-transport">{places.transport}</div>
      <section class="place-timeline" aria-label="Timeline">
        {places.timeline}
      </section>
    </div>
  );
}
