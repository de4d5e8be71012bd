/** Arrange the parts of a page. */
import type { ComponentChildren, JSX } from "preact";
import { getSizeStyle, SIZES } from "./sizes";
import { Splitter } from "./Splitter";

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

export function Layout(places: LayoutProps): JSX.Element {
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
